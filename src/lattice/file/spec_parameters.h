/* spec_parameters.h - "parameters": what a lattice file says of its placeholders. */
#ifndef FFD_LATTICE_FILE_SPEC_PARAMETERS_H
#define FFD_LATTICE_FILE_SPEC_PARAMETERS_H

#include "lattice/spec.h"
#include "json/json_reader.h"

/* Reads the object; each default must be within its bounds. */
ffd_status ffd_spec_parse_parameters(json_cursor cursor, lattice_spec *spec);
/* Fails at the cursor where a number of value, which may be within arrays, is outside the parameter's bounds.
   What is not a number has no bounds. */
ffd_status ffd_spec_check_bounds(json_cursor cursor, const spec_parameter *parameter, const json_span *value);

#endif
