#include "view/view_cages.h"
#include "base/memory/memory.h"
#include "view/view_dots.h"
#include "view/view_palette.h"
#include <string.h>

/* Beside the lattices: the ground, the mesh's segments, torn edges, the witness of a fold. */
#define OTHERS 4
/* The most arrays that one picture_cage owns. */
#define ARRAYS 2

static const uint8_t cage_color[3] = {29, 91, 208}, ground_color[3] = {128, 134, 143};

static void *own(view_cages *c, size_t count, size_t size)
{
    void *const block = ffd_alloc(count, size);
    if (block)
        c->owned[c->owned_count++] = block;
    return block;
}

bool ffd_view_cage_fits(const view_cage *cage, size_t left, size_t *count)
{
    const size_t *const size = cage->size;
    const bool fits = ffd_multiply_size(size[0], size[1], count) &&
                      ffd_multiply_size(*count, size[2], count) && *count <= left;
    if (!fits)
        *count = 0;
    return fits;
}

/* Joins each control point with its neighbours along u, v and w. Returns the number of segments. */
static size_t join(const view_cage *from, uint32_t *segments)
{
    const size_t *const n = from->size, steps[3] = {1, n[0], n[0] * n[1]};
    size_t count = 0;
    for (size_t p = 0; p < n[0] * n[1] * n[2]; p++)
        for (int a = 0; a < 3; a++) {
            const size_t at = p / steps[a] % n[a], last = at + 1 == n[a];
            if (last && !from->closed[a])
                continue;
            segments[2 * count] = (uint32_t)p;
            segments[2 * count++ + 1] = (uint32_t)(last ? p - at * steps[a] : p + steps[a]);
        }
    return count;
}

static ffd_status add_lattice(const view_cage *from, double share, view_cages *c, ffd_error *error)
{
    const size_t count = from->size[0] * from->size[1] * from->size[2];
    double *const points = own(c, count, 3 * sizeof *points);
    uint32_t *const segments = points ? own(c, 3 * count, 2 * sizeof *segments) : NULL;
    if (!segments)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < 3 * count; i++)
        points[i] =
            share >= 1 ? from->deformed[i] : from->rest[i] + share * (from->deformed[i] - from->rest[i]);
    picture_cage *const to = &c->list[c->count++];
    *to = (picture_cage){.points = points, .point_count = count, .segments = segments};
    to->segment_count = join(from, segments);
    memcpy(to->color, cage_color, sizeof cage_color);
    return FFD_OK;
}

static picture_cage *add(view_cages *c, const uint8_t color[3], double radius)
{
    picture_cage *const to = &c->list[c->count++];
    *to = (picture_cage){.radius = radius};
    memcpy(to->color, color, sizeof to->color);
    return to;
}

static void add_lines(const view_cages_desc *of, view_cages *c)
{
    picture_cage *const to = add(c, ffd_view_line_color, -1);
    to->points = of->positions;
    to->point_count = of->scene->vertex_count;
    to->segments = of->scene->segments;
    to->segment_count = of->scene->segment_count;
    to->colors = of->colors;
    to->width = 1 + of->height / 900.0;
}

/* The rectangle round the mesh at rest, as high as its lowest point: what stands on it before still does so
   after, or does not. */
static ffd_status add_ground(const view_cages_desc *of, view_cages *c, ffd_error *error)
{
    double *const points = own(c, GROUND_CORNERS, 3 * sizeof *points);
    uint32_t *const segments = points ? own(c, GROUND_CORNERS, 2 * sizeof *segments) : NULL;
    if (!segments)
        return ffd_fail_memory(error);
    memcpy(points, of->ground, 3 * GROUND_CORNERS * sizeof *points);
    for (uint32_t i = 0; i < GROUND_CORNERS; i++) {
        segments[2 * i] = i;
        segments[2 * i + 1] = (i + 1) % GROUND_CORNERS;
    }
    picture_cage *const to = add(c, ground_color, -1);
    to->points = points;
    to->point_count = to->segment_count = GROUND_CORNERS;
    to->segments = segments;
    to->width = 0.7 + of->height / 1800.0;
    to->is_covered = true;
    return FFD_OK;
}

static picture_cage *add_striped(view_cages *c, const uint8_t colors[2][3], picture_stripes stripes,
                                 double radius)
{
    picture_cage *const to = add(c, colors[0], radius);
    memcpy(to->second, colors[1], sizeof to->second);
    to->stripes = stripes;
    return to;
}

static ffd_status add_tears(const view_scene *scene, const double *positions, uint32_t height, view_cages *c,
                            ffd_error *error)
{
    uint32_t *const segments = own(c, scene->tear_count, 2 * sizeof *segments);
    if (!segments)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < scene->tear_count; i++)
        memcpy(segments + 2 * i, scene->tears[i].vertices, 2 * sizeof *segments);
    picture_cage *const to = add_striped(c, ffd_view_torn, STRIPES_RISING, -1);
    to->points = positions;
    to->point_count = scene->vertex_count;
    to->segments = segments;
    to->segment_count = scene->tear_count;
    to->width = 1.5 + height / 360.0;
    return FFD_OK;
}

static ffd_status add_marks(const view_scene *scene, double share, const double *positions, uint32_t height,
                            view_cages *c, ffd_error *error)
{
    ffd_status status = FFD_OK;
    if (scene->tear_count)
        status = add_tears(scene, positions, height, c, error);
    if (status || !scene->witness.is_there)
        return status;
    double *const point = own(c, 1, 3 * sizeof *point);
    if (!point)
        return ffd_fail_memory(error);
    for (int a = 0; a < 3; a++)
        point[a] = scene->witness.rest[a] + share * (scene->witness.xyz[a] - scene->witness.rest[a]);
    picture_cage *const to = add_striped(c, ffd_view_folded, STRIPES_FALLING, height / 80.0);
    to->points = point;
    to->point_count = 1;
    return FFD_OK;
}

ffd_status ffd_view_cages_make(const view_cages_desc *of, view_cages *c, ffd_error *error)
{
    const view_scene *const scene = of->scene;
    size_t left = of->most;
    c->list = ffd_alloc(scene->cage_count + OTHERS, sizeof *c->list);
    c->owned = ffd_alloc(ARRAYS * (scene->cage_count + OTHERS), sizeof *c->owned);
    if (!c->list || !c->owned)
        return ffd_fail_memory(error);
    if (of->ground)
        TRY(add_ground(of, c, error));
    for (size_t i = 0; i < scene->cage_count; i++) {
        size_t points;
        const bool fits = ffd_view_cage_fits(&scene->cages[i], left, &points);
        if (fits)
            TRY(add_lattice(&scene->cages[i], of->share, c, error));
        left -= points;
        c->left_out += !fits;
    }
    if (scene->segment_count)
        add_lines(of, c);
    return of->share > 0 ? add_marks(scene, of->share, of->positions, of->height, c, error) : FFD_OK;
}

void ffd_view_cages_free(view_cages *c)
{
    for (size_t i = 0; i < c->owned_count; i++)
        ffd_free(c->owned[i]);
    ffd_free(c->owned);
    ffd_free(c->list);
    *c = (view_cages){0};
}
