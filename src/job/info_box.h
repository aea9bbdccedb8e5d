/* info_box.h - boxes in what `ffd info` says: any bounds, and what the rest volume of a lattice covers. */
#ifndef FFD_JOB_INFO_BOX_H
#define FFD_JOB_INFO_BOX_H

#include "json/json_text.h"
#include <ffd/job.h>

/* Appends "key": {"min": [..], "max": [..]}, or null if there are no points. */
void ffd_info_bounds(json_text *json, const char *key, const ffd_bounds *box);

/* Appends to an open JSON object the box of a lattice that has one: the meshes that it goes round, its
   margin, its sides, its axes. A lattice round meshes that are named is fitted to them where fits. Finds box,
   min > max where it is not known: the mesh is yet to come, the meshes cannot be read (the text says why), or
   it is no box. like: how meshes are read. Errors: FFD_E_MEMORY. */
ffd_status ffd_info_box(ffd_lattice *lattice, const ffd_source *like, bool fits, ffd_bounds *box,
                        json_text *json, ffd_error *error);

#endif
