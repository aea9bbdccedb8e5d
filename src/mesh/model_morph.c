/* model_morph.c - deformations of a model as morph targets. */
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

/* Whether corners name the same normals in both. */
static bool agree(const mesh_model *before, const mesh_model *after)
{
    if (before->normal_count != after->normal_count)
        return false;
    for (int k = 0; k < MODEL_KINDS; k++)
        for (size_t i = 0; i < before->lists[k].corner_count; i++)
            if (before->lists[k].corners[i].normal != after->lists[k].corners[i].normal)
                return false;
    return true;
}

/* Copies the normals of pairs: of each the number of its first or second. */
static double *pick(const double *normals, const intern_table *pairs, int which)
{
    double *const picked = ffd_alloc(pairs->count, 3 * sizeof *picked);
    for (uint32_t i = 0; picked && i < pairs->count; i++) {
        uint32_t pair[2];
        memcpy(pair, ffd_intern_key(pairs, i), sizeof pair);
        copy_vector(normals, pair[which], picked, i);
    }
    return picked;
}

static bool replace(double **normals, const intern_table *pairs, int which)
{
    double *const picked = pick(*normals, pairs, which);
    if (picked) {
        ffd_free(*normals);
        *normals = picked;
    }
    return picked;
}

/* Splits the normals of a model that has targets already, and of the model after, so that each corner names
   both by one number. */
static bool split_normals(mesh_model *before, mesh_model *after)
{
    intern_table pairs = {0};
    bool made = true;
    for (int k = 0; k < MODEL_KINDS; k++)
        for (size_t i = 0; i < before->lists[k].corner_count && made; i++) {
            model_corner *const corner = &before->lists[k].corners[i], *const moved =
                                                                           &after->lists[k].corners[i];
            const uint32_t pair[2] = {corner->normal, moved->normal};
            uint32_t number = MODEL_NONE;
            made = pair[0] == MODEL_NONE || pair[1] == MODEL_NONE ||
                   ffd_intern(&pairs, pair, sizeof pair, &number);
            corner->normal = moved->normal = number;
        }
    made = made && replace(&before->normals, &pairs, 0) && replace(&after->normals, &pairs, 1);
    for (size_t k = 0; k < before->morph_count && made; k++)
        made = replace(&before->morphs[k].normals, &pairs, 0);
    before->normal_count = after->normal_count = pairs.count;
    ffd_intern_free(&pairs);
    return made;
}

ffd_status ffd_model_add_morph(mesh_model *before, mesh_model *after, const char *name, ffd_error *error)
{
    if (!ffd_grow((void **)&before->morphs, &before->morph_capacity, before->morph_count + 1,
                  sizeof *before->morphs))
        return ffd_fail_memory(error);
    if (before->morph_count > 0 && !agree(before, after) && !split_normals(before, after))
        return ffd_fail_memory(error);
    /* What no corner names does not move. */
    double *normals = copy_vectors(after->normals, after->normal_count);
    double *positions = copy_vectors(before->positions, before->position_count);
    if (!normals || !positions) {
        ffd_free(normals);
        ffd_free(positions);
        return ffd_fail_memory(error);
    }
    if (before->morph_count > 0) /* normals that no corner names */
        memcpy(normals, before->normals, 3 * before->normal_count * sizeof *normals);
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
