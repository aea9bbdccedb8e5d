/* spec_parse_moves.h - reads the moves of a lattice file. */
#ifndef FFD_LATTICE_FILE_SPEC_PARSE_MOVES_H
#define FFD_LATTICE_FILE_SPEC_PARSE_MOVES_H

#include "lattice/spec.h"
#include "json/json_reader.h"

/* Reads the array of moves into the spec, whose sizes must be known. pointer: its JSON pointer. */
ffd_status ffd_spec_parse_moves(json_cursor cursor, const char *pointer, lattice_spec *spec);

/* Refuses an action that stands beside the moves in place of in one. */
ffd_status ffd_spec_refuse_actions(json_cursor root);

#endif
