/* model_morph.c - the deformation of a model as a morph target. */
#include "base/memory/memory.h"
#include "mesh/model.h"
#include <string.h>

static void copy_vector(const double *from, uint32_t i, double *to, uint32_t k)
{
    memcpy(to + 3 * (size_t)k, from + 3 * (size_t)i, 3 * sizeof *to);
}

static double *copy_vectors(const double *vectors, size_t count)
{
    double *copy = ffd_alloc(count, 3 * sizeof *copy);
    if (copy && count > 0)
        memcpy(copy, vectors, 3 * count * sizeof *copy);
    return copy;
}

/* Both models have the same corners and the same positions at them, but a normal that several corners shared
   can have become several in the second: normals get the numbers of that one. */
static void join_corners(mesh_model *before, const mesh_model *after, double *normals)
{
    for (int k = 0; k < MODEL_KINDS; k++)
        for (size_t i = 0; i < before->lists[k].corner_count; i++) {
            model_corner *corner = &before->lists[k].corners[i];
            const model_corner *moved = &after->lists[k].corners[i];
            copy_vector(after->positions, corner->position, before->morph_positions, corner->position);
            if (corner->normal != MODEL_NONE)
                copy_vector(before->normals, corner->normal, normals, moved->normal);
            corner->normal = moved->normal;
        }
}

ffd_status ffd_model_add_morph(mesh_model *before, mesh_model *after, const char *name, ffd_error *error)
{
    /* What no corner names does not move. */
    double *normals = copy_vectors(after->normals, after->normal_count);
    before->morph_positions = copy_vectors(before->positions, before->position_count);
    if (!normals || !before->morph_positions) {
        ffd_free(normals);
        return ffd_fail_memory(error);
    }
    join_corners(before, after, normals);
    ffd_free(before->normals);
    before->normals = normals;
    before->normal_count = after->normal_count;
    before->morph_normals = after->normals;
    after->normals = NULL;
    before->morph_name = name;
    ffd_model_free(after);
    return FFD_OK;
}

static bool differ(const double *a, const double *b, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (a[i] < b[i] || a[i] > b[i])
            return true;
    return false;
}

bool ffd_model_morphs(const mesh_model *model)
{
    return model->morph_positions &&
           (differ(model->positions, model->morph_positions, 3 * model->position_count) ||
            differ(model->normals, model->morph_normals, model->morph_normals ? 3 * model->normal_count : 0));
}
