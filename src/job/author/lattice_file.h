/* lattice_file.h - reading lattices that are not JSON. */
#ifndef FFD_JOB_AUTHOR_LATTICE_FILE_H
#define FFD_JOB_AUTHOR_LATTICE_FILE_H

#include "lattice/formats/formats.h"
#include "mesh/memory_budget.h"
#include <ffd/lattice.h>

/* The format of a lattice to read, by its name. An object, and a text whose name has no ending of a lattice,
   is JSON. NULL: it is none that is known. */
const lattice_format *ffd_lattice_source_format(const ffd_lattice_source *source);
/* The same, by what a .json file holds. A stream is not looked into. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_lattice_find_format(const ffd_lattice_source *source, const lattice_format **format,
                                   ffd_error *error);
/* Checks that a format is read, or written. Errors: FFD_E_ARGUMENT. */
ffd_status ffd_lattice_format_check(const lattice_format *format, const char *name, bool written,
                                    ffd_error *error);
/* Reads a lattice of a format that is not JSON, of which the budget is taken. The caller destroys *lattice.
   Errors: those of format_reader, FFD_E_IO. */
ffd_status ffd_lattice_read(const lattice_format *format, const ffd_lattice_source *source,
                            const format_wish *wish, memory_budget *budget, ffd_lattice **lattice,
                            ffd_error *error);

#endif
