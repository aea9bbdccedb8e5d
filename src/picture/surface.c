#include "picture/surface.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/vector/vec.h"

#define TILE 4096

/* Lamps fixed to the camera, so that every view has the same lighting. Directions: to the right, up, towards
   the eye. The last lamp is the sky. */
typedef struct lamp {
    double direction[3]; /* unit length */
    double light;
} lamp;

static const lamp lamps[] = {{{-0.48, 0.64, 0.6}, 0.80}, {{0.8, 0, 0.6}, 0.26}, {{0, 1, 0}, 0.12}};
#define LAMPS (sizeof lamps / sizeof *lamps)
#define AMBIENT 0.22
/* Wrapped diffuse lighting: light reaches this cosine beyond the terminator, so that no part is black. */
#define WRAP 0.35
/* Factor of the light on the back of a surface. */
#define BACK_SHARE 0.75

typedef struct vertex_work {
    surface *surface;
    const float *normals;
    double lamps[LAMPS][3]; /* in world space */
} vertex_work;

static void turn_lamps(const camera *from, vertex_work *work)
{
    for (size_t l = 0; l < LAMPS; l++)
        for (int a = 0; a < 3; a++)
            work->lamps[l][a] = lamps[l].direction[0] * from->right[a] + lamps[l].direction[1] * from->up[a] +
                                lamps[l].direction[2] * from->back[a];
}

static double wrapped(double cosine)
{
    const double lit = (cosine + WRAP) / (1 + WRAP);
    return lit > 0 ? lit : 0;
}

static uint16_t in_parts(double light)
{
    return (uint16_t)(light < 1.99 ? light * LIGHT_ONE + 0.5 : 1.99 * LIGHT_ONE);
}

static void light_vertex(const vertex_work *work, const float normal[3], uint16_t light[2])
{
    const double n[3] = {normal[0], normal[1], normal[2]}, square = vec_dot(n, n);
    double front = AMBIENT, back = AMBIENT;
    /* Without a normal, for instance if all faces are slivers, no lamp lights the vertex. */
    const double inverse = square > 0 && square < HUGE_VAL ? 1 / sqrt(square) : 0;
    for (size_t l = 0; l < LAMPS; l++) {
        const double cosine = inverse * vec_dot(n, work->lamps[l]);
        front += lamps[l].light * wrapped(inverse > 0 ? cosine : 0.5);
        back += lamps[l].light * wrapped(inverse > 0 ? -cosine : 0.5);
    }
    light[0] = in_parts(front);
    light[1] = in_parts(BACK_SHARE * back);
}

static void place_vertex(const projection *by, const double point[3], surface_vertex *vertex)
{
    double seen[3];
    projection_apply(by, point, seen);
    vertex->y = 0;
    vertex->z = 0;
    if (!vec_is_finite(seen))
        vertex->x = vec_is_finite(point) ? VERTEX_FAR : VERTEX_NOWHERE;
    else if (!(fabs(seen[0]) < GUARD && fabs(seen[1]) < GUARD && fabs(seen[2]) < GUARD))
        vertex->x = VERTEX_FAR;
    else {
        vertex->x = (int32_t)floor_of(seen[0] * SUBPIXELS + 0.5);
        vertex->y = (int32_t)floor_of(seen[1] * SUBPIXELS + 0.5);
        vertex->z = (float)seen[2];
    }
}

static void make_vertices(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    const vertex_work *const work = context;
    surface *const s = work->surface;
    (void)tile;
    (void)worker;
    for (size_t v = begin; v < end; v++) {
        surface_vertex *const vertex = &s->vertices[v];
        place_vertex(&s->projection, s->mesh->positions + (size_t)3 * surface_origin(s, (uint32_t)v), vertex);
        light_vertex(work, work->normals + 3 * v, vertex->light);
    }
}

ffd_status ffd_surface_make(const picture_mesh *mesh, const projection *by, const band_means *means,
                            surface *result, ffd_error *error)
{
    surface_normals found;
    TRY(ffd_surface_normals(mesh, by->scale, means->budget, &found, error));
    const size_t count = mesh->vertex_count + found.split_count;
    *result = (surface){.mesh = mesh,
                        .projection = *by,
                        .vertices = ffd_alloc_whole(count, sizeof *result->vertices),
                        .vertex_count = count,
                        .origins = found.origins,
                        .triangles = found.triangles ? found.triangles : mesh->triangles,
                        .own_triangles = found.triangles};
    if (result->vertices) {
        vertex_work work = {.surface = result, .normals = found.normals};
        turn_lamps(&by->camera, &work);
        ffd_parallel_tiles(count, TILE, means->threads, make_vertices, &work);
    }
    for (size_t m = 0; m < mesh->material_count; m++)
        result->has_see_through |= mesh->material_list[m].is_see_through;
    ffd_free(found.normals);
    if (result->vertices)
        return FFD_OK;
    ffd_surface_free(result);
    return ffd_fail_memory(error);
}

void ffd_surface_free(surface *of)
{
    ffd_free(of->vertices);
    ffd_free(of->origins);
    ffd_free(of->own_triangles);
    *of = (surface){.mesh = NULL};
}
