/* info_layers.h - where the layers of control points stand. */
#ifndef FFD_JOB_INFO_LAYERS_H
#define FFD_JOB_INFO_LAYERS_H

#include "json/json_text.h"
#include <ffd/job.h>

/* Appends to an open JSON object the place of each layer along u, v and w: of a box the coordinate along its
   axis, or where box is empty, being that of a mesh to come, the fraction of its side; of a cylinder radius,
   degrees, and height from its middle. Layers beyond the box are counted. */
void ffd_info_layers(const ffd_lattice *lattice, const ffd_bounds *box, json_text *json);

#endif
