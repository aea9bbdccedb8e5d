/* spec_parameters.h - reads "parameters", the declarations of placeholders in a lattice file. */
#ifndef FFD_LATTICE_FILE_SPEC_PARAMETERS_H
#define FFD_LATTICE_FILE_SPEC_PARAMETERS_H

#include "lattice/spec.h"
#include "json/json_reader.h"

/* Reads the object. Each default must be within its bounds. */
ffd_status ffd_spec_parse_parameters(json_cursor cursor, lattice_spec *spec);
/* Fails at the cursor if a number in value, which may be in nested arrays, is out of the parameter's bounds.
   Other kinds of values have no bounds. */
ffd_status ffd_spec_check_bounds(json_cursor cursor, const spec_parameter *parameter, const json_tree *value);
/* The same for a value of the file. */
ffd_status ffd_spec_check_value(json_cursor value, const spec_parameter *parameter);

#endif
