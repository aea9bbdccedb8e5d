/* spec_parse.h - reads a lattice file. Declares functions of spec_parse.c and file.c. */
#ifndef FFD_LATTICE_FILE_SPEC_PARSE_H
#define FFD_LATTICE_FILE_SPEC_PARSE_H

#include "lattice/spec.h"

/* Reads the JSON text of a lattice file (data/schema/lattice.md), with these values for placeholders (NULL:
   none). Free the spec with ffd_spec_free. Errors as ffd_lattice_parse. */
ffd_status ffd_spec_parse(const char *text, size_t size, const char *name, const spec_settings *settings,
                          lattice_spec **spec, ffd_error *error);

/* The same of a file. *size: its bytes. Errors also: FFD_E_IO, and FFD_E_ARGUMENT for a stream that names
   meshes, which would be beside it. */
ffd_status ffd_spec_load(const char *path, const spec_settings *settings, lattice_spec **spec, size_t *size,
                         ffd_error *error);

/* The path of a mesh that the box goes round; free with ffd_free. Errors: FFD_E_MEMORY. */
ffd_status ffd_spec_mesh(const lattice_spec *spec, size_t i, char **path, ffd_error *error);

#endif
