/* view_by_hand.h - makes scenes of `ffd view` without files: arrays, parts, a cage, marks. */
#ifndef FFD_TESTS_VIEW_BY_HAND_H
#define FFD_TESTS_VIEW_BY_HAND_H

#include "base/memory/memory.h"
#include "view/view_scene.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Deforms a point. */
typedef void (*hand_map)(const double from[3], double to[3]);

static inline void *hand_array(size_t count, size_t size)
{
    void *const block = ffd_alloc_zero(count, size);
    if (!block)
        abort();
    return block;
}

static inline char *hand_text(const char *text)
{
    char *const copy = hand_array(strlen(text) + 1, 1);
    memcpy(copy, text, strlen(text));
    return copy;
}

/* A scene without parts. The caller fills positions and triangles. */
static inline view_scene hand_scene(size_t vertices, size_t triangles)
{
    view_scene scene = {.vertex_count = vertices, .vertices_all = vertices, .triangle_count = triangles};
    scene.name = hand_text("by hand");
    scene.before = hand_array(vertices, 3 * sizeof(double));
    scene.after = hand_array(vertices, 3 * sizeof(double));
    scene.triangles = hand_array(triangles, 3 * sizeof(uint32_t));
    return scene;
}

static inline void hand_part(view_scene *scene, const char *name, size_t first, size_t count)
{
    scene->parts = ffd_realloc(scene->parts, scene->part_count + 1, sizeof *scene->parts);
    if (!scene->parts)
        abort();
    scene->parts[scene->part_count++] = (view_part){hand_text(name), VIEW_NONE, first, count};
}

/* A grid of side x side cells over the unit square, slightly bent in z. */
static inline view_scene hand_grid(size_t side)
{
    view_scene scene = hand_scene((side + 1) * (side + 1), 2 * side * side);
    uint32_t *to = scene.triangles;
    for (size_t j = 0; j <= side; j++)
        for (size_t i = 0; i <= side; i++) {
            const double x = (double)i / (double)side, y = (double)j / (double)side;
            const double p[3] = {x, y, 0.2 * sin(3 * x) * cos(2 * y)};
            memcpy(scene.before + 3 * (j * (side + 1) + i), p, sizeof p);
        }
    for (size_t j = 0; j < side; j++)
        for (size_t i = 0; i < side; i++) {
            const uint32_t a = (uint32_t)(j * (side + 1) + i), b = a + (uint32_t)side + 1;
            const uint32_t corners[6] = {a, a + 1, b + 1, a, b + 1, b};
            memcpy(to, corners, sizeof corners);
            to += 6;
        }
    memcpy(scene.after, scene.before, 3 * scene.vertex_count * sizeof(double));
    return scene;
}

/* det F of a map, from differences. */
static inline double hand_det(hand_map map, const double at[3])
{
    const double step = 1e-5;
    double d[3][3];
    for (int a = 0; a < 3; a++) {
        double low[3] = {at[0], at[1], at[2]}, high[3] = {at[0], at[1], at[2]}, from[3], to[3];
        low[a] -= step;
        high[a] += step;
        map(low, from);
        map(high, to);
        for (int b = 0; b < 3; b++)
            d[a][b] = (to[b] - from[b]) / (2 * step);
    }
    return d[0][0] * (d[1][1] * d[2][2] - d[1][2] * d[2][1]) -
           d[0][1] * (d[1][0] * d[2][2] - d[1][2] * d[2][0]) +
           d[0][2] * (d[1][0] * d[2][1] - d[1][1] * d[2][0]);
}

/* Deforms the vertices inside a box, and sets statuses and det F. */
static inline void hand_deform(view_scene *scene, const double low[3], const double high[3], hand_map map)
{
    scene->statuses = hand_array(scene->vertex_count, 1);
    scene->dets = hand_array(scene->vertex_count, sizeof(double));
    for (size_t v = 0; v < scene->vertex_count; v++) {
        const double *const p = scene->before + 3 * v;
        bool inside = true;
        for (int a = 0; a < 3; a++)
            inside = inside && p[a] >= low[a] && p[a] <= high[a];
        memcpy(scene->after + 3 * v, p, 3 * sizeof *p);
        scene->statuses[v] = !inside;
        scene->dets[v] = inside ? hand_det(map, p) : 1;
        if (inside)
            map(p, scene->after + 3 * v);
        double length = 0;
        for (int a = 0; a < 3; a++)
            length = hypot(length, scene->after[3 * v + (size_t)a] - p[a]);
        scene->displacement_max = fmax(scene->displacement_max, length);
    }
}

/* Marks edges between moving and staying vertices as torn (at most `most`), and triangles with det F < 0 as
   flipped. */
static inline void hand_judge(view_scene *scene, size_t most, double least_step)
{
    scene->tears = hand_array(most, sizeof *scene->tears);
    scene->flipped = hand_array(scene->triangle_count, 1);
    for (size_t t = 0; t < scene->triangle_count; t++) {
        const uint32_t *const corners = scene->triangles + 3 * t;
        double det = 0;
        for (int c = 0; c < 3; c++) {
            const uint32_t a = corners[c], b = corners[(c + 1) % 3];
            const uint32_t moved = scene->statuses[a] == 0 ? a : b;
            double step = 0;
            for (size_t x = 0; x < 3; x++)
                step =
                    hypot(step, scene->after[3 * (size_t)moved + x] - scene->before[3 * (size_t)moved + x]);
            det += scene->dets[a];
            if (a < b && scene->statuses[a] != scene->statuses[b] && step > least_step) {
                if (scene->tear_count < most)
                    scene->tears[scene->tear_count++] = (view_tear){{a, b}, step};
                scene->tear_edges++;
            }
        }
        scene->flipped[t] = det < 0;
        scene->flipped_faces += det < 0;
    }
}

/* Adds a cage over a box, deformed by the map. */
static inline void hand_cage(view_scene *scene, const char *name, size_t nu, size_t nv, size_t nw,
                             const double low[3], const double high[3], hand_map map)
{
    const size_t count = nu * nv * nw;
    scene->cages = ffd_realloc(scene->cages, scene->cage_count + 1, sizeof *scene->cages);
    if (!scene->cages)
        abort();
    view_cage cage = {.name = hand_text(name), .size = {nu, nv, nw}};
    cage.rest = hand_array(count, 3 * sizeof(double));
    cage.deformed = hand_array(count, 3 * sizeof(double));
    for (size_t p = 0; p < count; p++) {
        const size_t at[3] = {p % nu, p / nu % nv, p / (nu * nv)}, size[3] = {nu, nv, nw};
        for (size_t a = 0; a < 3; a++)
            cage.rest[3 * p + a] = low[a] + (high[a] - low[a]) * (double)at[a] / (double)(size[a] - 1);
        map(cage.rest + 3 * p, cage.deformed + 3 * p);
    }
    scene->cages[scene->cage_count++] = cage;
}

/* A square in two parts. The left one has a flipped triangle in a corner and a torn edge. */
static inline view_scene hand_halves(void)
{
    view_scene scene = hand_grid(100);
    hand_part(&scene, "lower", 0, 10000);
    hand_part(&scene, "upper", 10000, 10000);
    scene.flipped = hand_array(scene.triangle_count, 1);
    memset(scene.flipped, 1, 2000);
    scene.tears = hand_array(1, sizeof *scene.tears);
    scene.tears[0] = (view_tear){{7500, 7501}, 0.1};
    scene.tear_count = 1;
    scene.tear_edges = 1;
    return scene;
}

#endif
