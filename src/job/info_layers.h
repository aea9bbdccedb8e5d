/* info_layers.h - positions of the layers of control points. */
#ifndef FFD_JOB_INFO_LAYERS_H
#define FFD_JOB_INFO_LAYERS_H

#include "json/json_text.h"
#include <ffd/job.h>

/* Appends the position of each layer along u, v and w to an open JSON object. Of a box: the coordinate along
   its axis, or the fraction of its side if box is empty (a mesh to come). Of a cylinder: radius, angle in
   degrees, height from the middle. Layers beyond the box are counted. */
void ffd_info_layers(const ffd_lattice *lattice, const ffd_bounds *box, json_text *json);

#endif
