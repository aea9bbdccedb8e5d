/* model_morph.c - converts the deformation of a model to a morph target. */
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

/* Both models have the same corners with the same positions, but a normal that several corners shared can be
   split in the second model. Normals get the indices of the second model. A document splits them in the same
   way for each target of a job. */
static void join_corners(mesh_model *before, const mesh_model *after, double *positions, double *normals)
{
    for (int k = 0; k < MODEL_KINDS; k++)
        for (size_t i = 0; i < before->lists[k].corner_count; i++) {
            model_corner *corner = &before->lists[k].corners[i];
            const model_corner *moved = &after->lists[k].corners[i];
            copy_vector(after->positions, corner->position, positions, corner->position);
            if (corner->normal != MODEL_NONE)
                copy_vector(before->normals, corner->normal, normals, moved->normal);
            corner->normal = moved->normal;
        }
}

ffd_status ffd_model_add_morph(mesh_model *before, mesh_model *after, const char *name, ffd_error *error)
{
    if (!ffd_grow((void **)&before->morphs, &before->morph_capacity, before->morph_count + 1,
                  sizeof *before->morphs))
        return ffd_fail_memory(error);
    /* Values that no corner refers to do not move. */
    double *normals = copy_vectors(after->normals, after->normal_count);
    double *positions = copy_vectors(before->positions, before->position_count);
    if (!normals || !positions) {
        ffd_free(normals);
        ffd_free(positions);
        return ffd_fail_memory(error);
    }
    join_corners(before, after, positions, normals);
    ffd_free(before->normals);
    before->normals = normals;
    before->normal_count = after->normal_count;
    before->morphs[before->morph_count++] = (model_morph){positions, after->normals, name};
    after->normals = NULL;
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

bool ffd_model_morphs(const mesh_model *model, size_t morph)
{
    const model_morph *const target = &model->morphs[morph];
    return differ(model->positions, target->positions, 3 * model->position_count) ||
           differ(model->normals, target->normals, target->normals ? 3 * model->normal_count : 0);
}
