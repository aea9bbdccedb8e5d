#include "mesh/model_triangles.h"
#include "base/memory/memory.h"

ffd_status ffd_face_triangles(face_triangles *scratch, const mesh_model *model, size_t face, size_t *count,
                              ffd_error *error)
{
    size_t corner_count;
    const model_corner *corners = model_element(&model->lists[MODEL_FACES], face, &corner_count);
    if (!ffd_grow((void **)&scratch->points, &scratch->points_capacity, corner_count,
                  3 * sizeof *scratch->points) ||
        !ffd_grow((void **)&scratch->triangles, &scratch->triangles_capacity, corner_count,
                  3 * sizeof *scratch->triangles))
        return ffd_fail_memory(error);
    for (size_t c = 0; c < corner_count; c++)
        for (size_t a = 0; a < 3; a++)
            scratch->points[3 * c + a] = model->positions[3 * (size_t)corners[c].position + a];
    *count = corner_count - 2;
    return ffd_polygon_cut(&scratch->cutter, scratch->points, corner_count, scratch->triangles, error);
}

void ffd_face_triangles_free(face_triangles *scratch)
{
    ffd_polygon_cutter_free(&scratch->cutter);
    ffd_free(scratch->points);
    ffd_free(scratch->triangles);
    *scratch = (face_triangles){0};
}
