/* picture.c - how long a picture of a large mesh takes on one core, beside a copy of the bytes that it is
   made of: into memory that is new, as that of a picture is, and into the same memory again and again.

       picture RUNS TRIANGLES WIDTH HEIGHT
   Prints a line for each: median, least and greatest of the seconds of RUNS runs. */
#include "../support/picture_shapes.h"
#include "base/memory/memory.h"
#include "base/system/clock.h"
#include <malloc.h>
#include <stdio.h>
#include <string.h>

#define MOST_RUNS 101

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void report(const char *what, double *seconds, int runs)
{
    qsort(seconds, (size_t)runs, sizeof *seconds, compare);
    printf("%s %.6f (%.6f to %.6f)\n", what, seconds[runs / 2], seconds[0], seconds[runs - 1]);
}

static void copy_all(const shape *s, size_t pixels, uint8_t *to, const uint8_t *from)
{
    memcpy(to, s->positions, s->mesh.vertex_count * 3 * sizeof(double));
    to += s->mesh.vertex_count * 3 * sizeof(double);
    memcpy(to, s->triangles, s->mesh.triangle_count * 3 * sizeof(uint32_t));
    to += s->mesh.triangle_count * 3 * sizeof(uint32_t);
    memcpy(to, s->colors, s->mesh.vertex_count * 4);
    memcpy(to + s->mesh.vertex_count * 4, from, pixels * 3);
}

int main(int argc, char **argv)
{
    if (argc != 5)
        return 2;
    /* The C library would keep what is freed, and with it the pages. */
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
    const int runs = atoi(argv[1]) < MOST_RUNS ? atoi(argv[1]) : MOST_RUNS;
    size_t side = 2;
    while (2 * side * side < (size_t)atol(argv[2]))
        side++;
    shape s = shape_ball(side + 1, side + 1, 5, 0.2);
    for (size_t v = 0; v < s.mesh.vertex_count; v++)
        memcpy(s.colors + 4 * v, (uint8_t[]){(uint8_t)(v % 200), (uint8_t)(v / side % 256), 180, 255}, 4);
    s.mesh.colors = s.colors;
    const picture_panel panel = {.meshes = &s.mesh, .mesh_count = 1};
    picture p = {.width = (uint32_t)atol(argv[3]),
                 .height = (uint32_t)atol(argv[4]),
                 .panels = &panel,
                 .panel_count = 1,
                 .threads = 1};
    p.camera = shape_camera("iso");
    const size_t pixels = (size_t)p.width * p.height;
    const size_t size = s.mesh.vertex_count * 28 + s.mesh.triangle_count * 12 + pixels * 3;
    uint8_t *const again = malloc(size), *const from = calloc(pixels, 3);
    double drawn[MOST_RUNS], copied[MOST_RUNS], copied_again[MOST_RUNS];
    ffd_error error;
    for (int i = 0; again && from && i < runs; i++) {
        uint8_t *drawing, *to;
        const double begin = ffd_clock_seconds();
        if (ffd_picture_draw(&p, NULL, &drawing, &error))
            return 1;
        const double middle = ffd_clock_seconds();
        to = malloc(size);
        if (!to)
            return 1;
        copy_all(&s, pixels, to, from);
        free(to);
        const double copied_once = ffd_clock_seconds();
        copy_all(&s, pixels, again, from);
        copied_again[i] = ffd_clock_seconds() - copied_once;
        copied[i] = copied_once - middle;
        drawn[i] = middle - begin;
        ffd_free(drawing);
    }
    report("copy", copied, runs);
    report("copy-again", copied_again, runs);
    report("picture", drawn, runs);
    free(again);
    free(from);
    shape_free(&s);
    return 0;
}
