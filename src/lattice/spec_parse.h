/* spec_parse.h - the parts of the lattice file's reader. Each reads the value that stands at place. */
#ifndef FFD_LATTICE_SPEC_PARSE_H
#define FFD_LATTICE_SPEC_PARSE_H

#include "lattice/spec.h"
#include "json/json_reader.h"

/* spec_parse.c: 3*count numbers, one array of three a control point, into a new block. */
ffd_status ffd_spec_parse_points(json_place *place, const json_t *value, size_t count, double **points);
/* A direction: three numbers, not all 0, or "x", "y", "z". */
ffd_status ffd_spec_parse_axis(json_place *place, const json_t *object, const char *key, double axis[3]);

/* spec_parse_rest.c */
ffd_status ffd_spec_parse_rest(json_place *place, const json_t *value, lattice_spec *spec);

/* spec_parse_moves.c; needs the sizes. */
ffd_status ffd_spec_parse_moves(json_place *place, const json_t *value, lattice_spec *spec);

#endif
