#include "view/view_fit.h"
#include "base/vector/vec.h"
#include "mesh/bounds.h"
#include "view/view_cages.h"

/* Lattices widen a picture on each side by at most this many times the largest extent of the mesh, so that
   the mesh still fills a fifth of the picture (1 / (1 + 2 REACH)). */
#define REACH 2.0

static bool is_empty(const ffd_bounds *bounds)
{
    return !(bounds->min[0] <= bounds->max[0]);
}

static void widen_by_mesh(const view_fit *fit, ffd_bounds *seen)
{
    const double *const shapes[] = {fit->scene->before, fit->scene->after};
    const size_t count = fit->scene->vertex_count;
    for (size_t s = 0; s < sizeof shapes / sizeof *shapes; s++) {
        if (!fit->framed)
            ffd_camera_widen(fit->camera, shapes[s], count, seen);
        for (size_t v = 0; v < count && fit->framed; v++)
            if (fit->framed[v])
                ffd_camera_widen(fit->camera, shapes[s] + 3 * v, 1, seen);
    }
    if (fit->ground)
        ffd_camera_widen(fit->camera, fit->ground, GROUND_CORNERS, seen);
}

static void widen_by_lattices(const view_fit *fit, ffd_bounds *seen)
{
    const view_scene *const scene = fit->scene;
    size_t left = fit->most;
    for (size_t i = 0; i < scene->cage_count; i++) {
        size_t count;
        ffd_view_cage_fits(&scene->cages[i], left, &count);
        ffd_camera_widen(fit->camera, scene->cages[i].rest, count, seen);
        ffd_camera_widen(fit->camera, scene->cages[i].deformed, count, seen);
        left -= count;
    }
    if (scene->witness.is_there) {
        ffd_camera_widen(fit->camera, scene->witness.rest, 1, seen);
        ffd_camera_widen(fit->camera, scene->witness.xyz, 1, seen);
    }
}

static bool is_beyond(const view_fit *fit, const ffd_bounds *seen, const double *point)
{
    const double x = vec_dot(fit->camera->right, point), y = vec_dot(fit->camera->up, point);
    return x < seen->min[0] || x > seen->max[0] || y < seen->min[1] || y > seen->max[1];
}

void ffd_view_fit(const view_fit *fit, view_frame *frame)
{
    widen_by_mesh(fit, &frame->mesh);
    widen_by_lattices(fit, &frame->lattices);
}

/* Returns the distance of a point from a box. */
static double distance_from(const ffd_bounds *box, const double *point)
{
    double beside[3];
    for (int a = 0; a < 3; a++)
        beside[a] = larger_of(0, larger_of(box->min[a] - point[a], point[a] - box->max[a]));
    return vec_length(beside);
}

double ffd_view_away(const view_fit *fit)
{
    const view_scene *const scene = fit->scene;
    ffd_bounds rest = ffd_bounds_empty();
    double farthest = 0, sides[3];
    for (size_t v = 0; v < scene->vertex_count; v++)
        if ((!fit->framed || fit->framed[v]) && vec_is_finite(scene->before + 3 * v))
            ffd_bounds_widen(&rest, scene->before + 3 * v);
    if (is_empty(&rest))
        return 0;
    for (size_t v = 0; v < scene->vertex_count; v++)
        if ((!fit->framed || fit->framed[v]) && vec_is_finite(scene->after + 3 * v))
            farthest = larger_of(farthest, distance_from(&rest, scene->after + 3 * v));
    for (int a = 0; a < 3; a++)
        sides[a] = rest.max[a] - rest.min[a];
    const double diagonal = vec_length(sides);
    return diagonal > 0 ? farthest / diagonal : 0;
}

ffd_bounds ffd_view_seen(const view_frame *frame)
{
    const ffd_bounds *const mesh = &frame->mesh;
    ffd_bounds seen = *mesh;
    double reach = 0;
    ffd_bounds_join(&seen, &frame->lattices);
    for (int a = 0; a < 3 && !is_empty(mesh); a++)
        reach = larger_of(reach, REACH * (mesh->max[a] - mesh->min[a]));
    /* A single point has no extent, so no limit applies. */
    for (int a = 0; a < 3 && reach > 0; a++) {
        seen.min[a] = larger_of(seen.min[a], mesh->min[a] - reach);
        seen.max[a] = lesser_of(seen.max[a], mesh->max[a] + reach);
    }
    return seen;
}

void ffd_view_count_beyond(const view_fit *fit, const ffd_bounds *seen, size_t *points, size_t *beyond)
{
    size_t left = fit->most;
    *points = *beyond = 0;
    for (size_t i = 0; i < fit->scene->cage_count; i++) {
        const view_cage *const cage = &fit->scene->cages[i];
        size_t count;
        ffd_view_cage_fits(cage, left, &count);
        for (size_t p = 0; p < count; p++)
            *beyond +=
                is_beyond(fit, seen, cage->rest + 3 * p) || is_beyond(fit, seen, cage->deformed + 3 * p);
        *points += count;
        left -= count;
    }
}
