/* view_splats.c - the Gaussian splats of a scene: their covariances before, and after the deformation. */
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "job/view/view.h"
#include "mesh/splats.h"
#include <math.h>
#include <string.h>

/* Splats that are read at a time. */
#define STEP 256

static bool has_splats(const mesh_document *document)
{
    bool found = false;
    for (size_t i = 0; i < document->part_count; i++)
        found = found || (document->parts[i].has_ellipsoids && !document->parts[i].repeats_positions);
    return found && document->format->splats;
}

static void put(const double covariance[6], float *to)
{
    for (int i = 0; i < 6; i++)
        to[i] = isfinite((float)covariance[i]) ? (float)covariance[i] : 0;
}

/* Reads the splats of a part to the space of the scene. */
static void read_part(const mesh_document *document, size_t index, float *to)
{
    const mesh_part *const part = &document->parts[index];
    splat_ellipsoid splats[STEP];
    double transforms[12];
    for (size_t first = 0; first < part->vertex_count; first += STEP) {
        const size_t count = part->vertex_count - first < STEP ? part->vertex_count - first : STEP;
        document->format->splats->read(document, index, first, count, splats);
        for (size_t i = 0; i < count; i++) {
            double covariance[6];
            ffd_splat_covariance(&splats[i], &part->form, covariance);
            if (part->skinned)
                document->format->read_transforms(document, index, first + i, 1, transforms, NULL);
            if (part->skinned || !part->identity)
                ffd_covariance_carry(part->skinned ? transforms : part->linear, covariance);
            put(covariance, to + 6 * (first + i));
        }
    }
}

/* Reads the splats of a document, in the order of its vertices; all 0 for other vertices. *splats: NULL where
   it has none. */
static ffd_status read_splats(mesh_document *document, float **splats, ffd_error *error)
{
    const size_t count = (size_t)ffd_mesh_vertex_count(document);
    size_t first = 0;
    *splats = NULL;
    if (!has_splats(document))
        return FFD_OK;
    TRY(ffd_budget_take(&document->budget, count, 6 * sizeof **splats, error));
    *splats = ffd_alloc_zero(count, 6 * sizeof **splats);
    if (!*splats)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < document->part_count; i++) {
        const mesh_part *const part = &document->parts[i];
        if (part->repeats_positions)
            continue;
        if (part->has_ellipsoids)
            read_part(document, i, *splats + 6 * first);
        first += part->vertex_count;
    }
    return FFD_OK;
}

/* The splats of the scene's vertices. */
static ffd_status take(const view_scene *scene, int side, const float *splats, memory_budget *budget,
                       float **to, ffd_error *error)
{
    TRY(ffd_budget_take(budget, scene->vertex_count, 6 * sizeof **to, error));
    *to = ffd_alloc(scene->vertex_count, 6 * sizeof **to);
    if (!*to)
        return ffd_fail_memory(error);
    for (size_t v = 0; v < scene->vertex_count; v++)
        memcpy(*to + 6 * v, splats + 6 * ffd_view_vertex_of(scene, side, v), 6 * sizeof **to);
    return FFD_OK;
}

/* Carries a splat by F: a gradient plus 1. */
static void carry(const double *gradient, float *splat)
{
    double f[9], covariance[6];
    for (int i = 0; i < 9; i++)
        f[i] = gradient[i] + (i % 4 == 0 ? 1 : 0);
    for (int i = 0; i < 6; i++)
        covariance[i] = (double)splat[i];
    ffd_covariance_carry(f, covariance);
    if (isfinite(f[0] + f[1] + f[2] + f[3] + f[4] + f[5] + f[6] + f[7] + f[8]))
        put(covariance, splat);
}

ffd_status ffd_view_add_splats(mesh_document *before, mesh_document *after, const double *gradients,
                               view_scene *scene, ffd_error *error)
{
    float *splats[2] = {NULL, NULL};
    ffd_status status;
    TRY_END(read_splats(before, &splats[0], error));
    if (!splats[0])
        return FFD_OK;
    TRY_END(take(scene, 0, splats[0], &before->budget, &scene->splats[0], error));
    if (after)
        TRY_END(read_splats(after, &splats[1], error));
    TRY_END(take(scene, splats[1] ? 1 : 0, splats[1] ? splats[1] : splats[0], &before->budget,
                 &scene->splats[1], error));
    for (size_t v = 0; v < scene->vertex_count && gradients; v++)
        carry(gradients + 9 * ffd_view_vertex_of(scene, 0, v), scene->splats[1] + 6 * v);
end:
    ffd_free(splats[0]);
    ffd_free(splats[1]);
    return status;
}
