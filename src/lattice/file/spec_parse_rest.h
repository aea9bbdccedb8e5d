/* spec_parse_rest.h - reads the control points at rest of a lattice file. */
#ifndef FFD_LATTICE_FILE_SPEC_PARSE_REST_H
#define FFD_LATTICE_FILE_SPEC_PARSE_REST_H

#include "lattice/spec.h"
#include "json/json_reader.h"

/* Reads the rest into the spec, whose sizes must be known. */
ffd_status ffd_spec_parse_rest(json_cursor cursor, lattice_spec *spec);

#endif
