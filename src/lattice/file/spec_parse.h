/* spec_parse.h - reads a lattice file. Declares functions of spec_parse.c and file.c. */
#ifndef FFD_LATTICE_FILE_SPEC_PARSE_H
#define FFD_LATTICE_FILE_SPEC_PARSE_H

#include "lattice/spec.h"

/* Reads the JSON text of a lattice file (data/schema/lattice.md). settings: values for placeholders; may be
   NULL. Free the spec with ffd_spec_free. Errors: those of ffd_lattice_parse. */
ffd_status ffd_spec_parse(const char *text, size_t size, const char *name, const spec_settings *settings,
                          lattice_spec **spec, ffd_error *error);

/* The same for a file or a text. *size is its size in bytes. Further errors: FFD_E_IO, and FFD_E_ARGUMENT for
   standard input or a text that names meshes, because their paths are relative to the lattice file. */
ffd_status ffd_spec_load(const ffd_lattice_source *source, const spec_settings *settings, lattice_spec **spec,
                         size_t *size, ffd_error *error);

/* Returns the path of mesh i that the rest box goes round; free it with ffd_free. Errors: FFD_E_MEMORY. */
ffd_status ffd_spec_mesh(const lattice_spec *spec, size_t i, char **path, ffd_error *error);

#endif
