/* spec_text.h - writes a lattice file. Declares a function of file.c too. */
#ifndef FFD_LATTICE_FILE_SPEC_TEXT_H
#define FFD_LATTICE_FILE_SPEC_TEXT_H

#include "base/file/output.h"
#include "lattice/spec.h"

/* Returns the text of a lattice file: *size bytes, ending with a line break, followed by a 0; free it with
   ffd_free. NULL if memory runs out. */
char *ffd_spec_text(const lattice_spec *spec, size_t *size);

/* Writes a lattice as ffd_lattice_save does, as the only file of an empty set, and commits it. */
ffd_status ffd_lattice_write(const ffd_lattice *lattice, file_output *output, const char *path, bool force,
                             ffd_error *error);

#endif
