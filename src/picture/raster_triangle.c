/* raster_triangle.c - ffd_raster_triangle: draws a triangle of a surface, and clips it if it extends far
   beyond the picture. */
#include "base/vector/vec.h"
#include "picture/raster.h"

/* A triangle clipped by six planes has at most 9 corners; rounding may make it slightly non-convex and add
   some. */
#define MOST_CORNERS 24

typedef struct cut {
    double points[MOST_CORNERS][3];
    int count;
} cut;

/* Clips a polygon to sign * (coordinate `axis`) <= GUARD. */
static void cut_by(const cut *from, int axis, double sign, cut *to)
{
    to->count = 0;
    for (int i = 0; i < from->count && to->count + 2 <= MOST_CORNERS; i++) {
        const double *const p = from->points[i], *const q = from->points[(i + 1) % from->count];
        const double p_in = GUARD - sign * p[axis], q_in = GUARD - sign * q[axis];
        if (p_in >= 0) {
            for (int a = 0; a < 3; a++)
                to->points[to->count][a] = p[a];
            to->count++;
        }
        if ((p_in < 0) != (q_in < 0)) {
            /* Computed from the inner end, so that both triangles at an edge get the same point. */
            const double *const in = p_in < 0 ? q : p, *const out = p_in < 0 ? p : q;
            const double in_step = p_in < 0 ? q_in : p_in, out_step = p_in < 0 ? p_in : q_in;
            const double share = in_step / (in_step - out_step);
            for (int a = 0; a < 3; a++)
                to->points[to->count][a] = in[a] + share * (out[a] - in[a]);
            to->points[to->count][axis] = sign * GUARD;
            to->count++;
        }
    }
}

static raster_corner corner_at(const double point[3])
{
    return (raster_corner){(int32_t)floor_of(point[0] * SUBPIXELS + 0.5),
                           (int32_t)floor_of(point[1] * SUBPIXELS + 0.5), (float)point[2]};
}

/* Draws the part of a triangle within the guard band, if a corner is outside. */
static void draw_clipped(const surface *of, const linear_tables *tables, size_t triangle, samples *into)
{
    cut polygons[2] = {{.count = 3}};
    for (int k = 0; k < 3; k++) {
        const uint32_t origin = surface_origin(of, of->triangles[3 * triangle + (size_t)k]);
        projection_apply(&of->projection, of->mesh->positions + 3 * (size_t)origin, polygons[0].points[k]);
        for (int a = 0; a < 3; a++)
            if (!(fabs(polygons[0].points[k][a]) < 1e150))
                return;
    }
    int now = 0;
    for (int plane = 0; plane < 6; plane++, now = 1 - now)
        cut_by(&polygons[now], plane / 2, plane % 2 ? 1 : -1, &polygons[1 - now]);
    /* With a single colour: at this size its shading is not visible. */
    for (int i = 2; i < polygons[now].count; i++) {
        const raster_corner corners[3] = {corner_at(polygons[now].points[0]),
                                          corner_at(polygons[now].points[i - 1]),
                                          corner_at(polygons[now].points[i])};
        ffd_raster_corners(of, tables, triangle, corners, true, into);
    }
}

void ffd_raster_triangle(const surface *of, const linear_tables *tables, size_t triangle, samples *into)
{
    raster_corner corners[3];
    for (int k = 0; k < 3; k++) {
        const surface_vertex *const v = &of->vertices[of->triangles[3 * triangle + (size_t)k]];
        if (v->x == VERTEX_FAR) {
            draw_clipped(of, tables, triangle, into);
            return;
        }
        corners[k] = (raster_corner){v->x, v->y, v->z};
    }
    ffd_raster_corners(of, tables, triangle, corners, false, into);
}
