/* vertex_values.h - the normals and texture coordinates of a model for formats that hold
   one of each per vertex. */
#ifndef FFD_IO_WRITE_VERTEX_VALUES_H
#define FFD_IO_WRITE_VERTEX_VALUES_H

#include "mesh/model.h"

/* Numbers by vertex, MODEL_NONE for one that has none; NULL where the model has none, or several at a vertex.
 */
typedef struct vertex_values {
    uint32_t *normals, *texcoords;
} vertex_values;

/* Must be freed in every case. Errors: FFD_E_MEMORY. */
ffd_status ffd_vertex_values_find(const mesh_model *model, vertex_values *values, ffd_error *error);
/* Frees the arrays. */
void ffd_vertex_values_free(vertex_values *values);

#endif
