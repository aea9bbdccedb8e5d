/* spec_parse.h - reads a lattice file. */
#ifndef FFD_LATTICE_SPEC_PARSE_H
#define FFD_LATTICE_SPEC_PARSE_H

#include "lattice/spec.h"

/* Reads the JSON text of a lattice file (data/schema/lattice.md), with these values for placeholders (NULL:
   none). Free the spec with ffd_spec_free. Errors as ffd_lattice_parse. */
ffd_status ffd_spec_parse(const char *text, size_t size, const char *name, const spec_settings *settings,
                          lattice_spec **spec, ffd_error *error);

#endif
