/* info_box.h - boxes in what `ffd info` prints: any bounds, and the box of a lattice's rest volume. */
#ifndef FFD_JOB_INFO_BOX_H
#define FFD_JOB_INFO_BOX_H

#include "json/json_text.h"
#include <ffd/job.h>

/* Appends "key": {"min": [..], "max": [..]}, or null if there are no points. */
void ffd_info_bounds(json_text *json, const char *key, const ffd_bounds *box);

/* Appends the box of a lattice to an open JSON object: the meshes that it goes round, its margin, sides and
   axes. Nothing if the lattice has no box. fits: fit a lattice round named meshes to them. like: options for
   reading meshes. box: filled with the bounds; min > max if unknown (a mesh to come, meshes that cannot be
   read - the text says why - or no box). Errors: FFD_E_MEMORY. */
ffd_status ffd_info_box(ffd_lattice *lattice, const ffd_source *like, bool fits, ffd_bounds *box,
                        json_text *json, ffd_error *error);

#endif
