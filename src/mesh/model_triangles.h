/* model_triangles.h - triangulates the faces of a model, one at a time. */
#ifndef FFD_MESH_MODEL_TRIANGLES_H
#define FFD_MESH_MODEL_TRIANGLES_H

#include "mesh/model.h"
#include "mesh/polygon_cut.h"

/* Scratch memory, which grows with the largest face. All zeros: empty. */
typedef struct face_triangles {
    polygon_cutter cutter;
    double *points;
    uint32_t *triangles;
    size_t points_capacity, triangles_capacity;
} face_triangles;

/* Returns the number of triangles of all faces together. */
static inline size_t model_triangle_count(const mesh_model *model)
{
    const model_list *faces = &model->lists[MODEL_FACES];
    return faces->corner_count - 2 * faces->count; /* polygons have at least three corners */
}

/* Triangulates a face into *count triangles: scratch->triangles has 3 corner indices of the face for each. */
ffd_status ffd_face_triangles(face_triangles *scratch, const mesh_model *model, size_t face, size_t *count,
                              ffd_error *error);
/* Frees the scratch memory. */
void ffd_face_triangles_free(face_triangles *scratch);

#endif
