#include "view/page_splats.h"
#include "base/arithmetic.h"
#include "base/little_endian.h"
#include <math.h>
#include <string.h>

#define STEPS 32767

typedef struct splat_side {
    const page_mesh *mesh;
    const float *covariances; /* of the scene's vertices */
} splat_side;

static void fill(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const splat_side *const side = of;
    for (size_t v = first; v < first + count; v++, bytes += 16) {
        const float *const from = side->covariances + 6 * (size_t)side->mesh->vertices[v];
        float most = 0;
        for (size_t i = 0; i < 6; i++)
            most = fabsf(from[i]) > most ? fabsf(from[i]) : most;
        store_float(bytes, most);
        for (size_t i = 0; i < 6; i++) {
            const double q = most > 0 ? nearest_integer((double)from[i] / (double)most * STEPS) : 0;
            store_u16(bytes + 4 + 2 * i, (uint16_t)(int16_t)q);
        }
    }
}

void ffd_page_splats_write(const page_mesh *mesh, page_writer *w)
{
    const view_scene *const scene = mesh->scene;
    const splat_side before = {mesh, scene->splats[0]}, after = {mesh, scene->splats[1]};
    const size_t size = scene->vertex_count * 6 * sizeof *scene->splats[0];
    if (!scene->splats[0])
        return;
    ffd_page_write_block(w, "data-splat-before", mesh->vertex_count, 16, fill, &before);
    if (scene->splats[1] && memcmp(scene->splats[0], scene->splats[1], size) != 0)
        ffd_page_write_block(w, "data-splat-after", mesh->vertex_count, 16, fill, &after);
}
