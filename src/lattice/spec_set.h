/* spec_set.h - values for the placeholders of a lattice file's moves. */
#ifndef FFD_LATTICE_SPEC_SET_H
#define FFD_LATTICE_SPEC_SET_H

#include "lattice/spec.h"
#include "json/json_reader.h"

/* Puts values in the place of every {"$": "NAME"} within moves, which stands at place and is changed. Those
   that are used are marked. Errors: FFD_E_INVALID for one that has no value. */
ffd_status ffd_spec_set(json_place *place, json_t *moves, const spec_settings *settings);

#endif
