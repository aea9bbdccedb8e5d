/* vertex_values.h - the normals and texture coordinates of a model, for formats with at most one of each per
   vertex. */
#ifndef FFD_IO_WRITE_VERTEX_VALUES_H
#define FFD_IO_WRITE_VERTEX_VALUES_H

#include "mesh/model.h"

/* Per vertex the number of its value, MODEL_NONE for none. NULL if the model has no values, or a vertex has
   several. */
typedef struct vertex_values {
    uint32_t *normals, *texcoords;
} vertex_values;

/* Finds the values. Free them with ffd_vertex_values_free, after an error too. Errors: FFD_E_MEMORY. */
ffd_status ffd_vertex_values_find(const mesh_model *model, vertex_values *values, ffd_error *error);
/* Frees the arrays. */
void ffd_vertex_values_free(vertex_values *values);

#endif
