/* picture_shapes.h - meshes and cages for pictures, computed with + - * / and square roots only, so that they
   are the same on every machine. */
#ifndef FFD_TESTS_PICTURE_SHAPES_H
#define FFD_TESTS_PICTURE_SHAPES_H

#include "base/vector/trig.h"
#include "picture/picture.h"
#include <stdlib.h>
#include <string.h>

/* The camera of a named side; of "iso" too. */
static inline camera shape_camera(const char *side)
{
    double direction[3];
    camera made = ffd_camera_iso(FFD_UP_Y);
    if (strcmp(side, "iso") != 0 &&
        !(ffd_camera_side(side, FFD_UP_Y, direction) && ffd_camera_from(direction, FFD_UP_Y, &made)))
        abort();
    return made;
}

typedef struct shape {
    double *positions;
    uint32_t *triangles;
    float *texcoords;
    uint8_t *colors;
    picture_mesh mesh;
} shape;

static inline shape shape_of(size_t vertices, size_t triangles)
{
    shape s = {malloc(vertices * 3 * sizeof(double)),
               malloc(triangles * 3 * sizeof(uint32_t)),
               malloc(triangles * 6 * sizeof(float)),
               calloc(vertices, 4),
               {0}};
    if (!s.positions || !s.triangles || !s.texcoords || !s.colors)
        abort();
    s.mesh = (picture_mesh){.positions = s.positions,
                            .vertex_count = vertices,
                            .triangles = s.triangles,
                            .triangle_count = triangles};
    return s;
}

static inline void shape_free(shape *s)
{
    free(s->positions);
    free(s->triangles);
    free(s->texcoords);
    free(s->colors);
}

static inline void shape_corner(shape *s, size_t corner, size_t vertex, double u, double v)
{
    s->triangles[corner] = (uint32_t)vertex;
    s->texcoords[2 * corner] = (float)u;
    s->texcoords[2 * corner + 1] = (float)v;
}

/* Makes two triangles for each cell of a grid of columns x rows vertices. They are counter-clockwise if
   columns run to the right and rows upwards. */
static inline void shape_weave(shape *s, size_t columns, size_t rows)
{
    size_t corner = 0;
    for (size_t r = 0; r + 1 < rows; r++)
        for (size_t c = 0; c + 1 < columns; c++) {
            static const int steps[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};
            for (int k = 0; k < 6; k++) {
                const size_t x = c + (size_t)steps[k][0], y = r + (size_t)steps[k][1];
                shape_corner(s, corner++, y * columns + x, (double)x / (double)(columns - 1),
                             (double)y / (double)(rows - 1));
            }
        }
}

/* A ball with a wavy radius. waves: number of waves around it; height: their amplitude. */
static inline shape shape_ball(size_t columns, size_t rows, int waves, double height)
{
    shape s = shape_of(columns * rows, 2 * (columns - 1) * (rows - 1));
    for (size_t r = 0; r < rows; r++)
        for (size_t c = 0; c < columns; c++) {
            const double turn = 360.0 * (double)(c % (columns - 1)) / (double)(columns - 1),
                         tilt = 180.0 * (double)r / (double)(rows - 1) - 90;
            double st, ct, sp, cp, sw, cw;
            ffd_sincos_degrees(turn, &st, &ct);
            ffd_sincos_degrees(tilt, &sp, &cp);
            ffd_sincos_degrees(waves * turn, &sw, &cw);
            const double radius = 1 + height * sw * cp * cp;
            double *const p = s.positions + 3 * (r * columns + c);
            p[0] = radius * cp * st;
            p[1] = radius * sp;
            p[2] = radius * cp * ct;
        }
    shape_weave(&s, columns, rows);
    return s;
}

/* A cube from -1 to 1 with eight vertices. */
static inline shape shape_cube(void)
{
    static const int faces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                    {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    static const int fan[6] = {0, 1, 2, 0, 2, 3};
    static const double uv[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    shape s = shape_of(8, 12);
    for (int v = 0; v < 8; v++)
        for (int a = 0; a < 3; a++)
            s.positions[3 * v + a] = v >> a & 1 ? 1 : -1;
    for (size_t c = 0; c < 36; c++)
        shape_corner(&s, c, (size_t)faces[c / 6][fan[c % 6]], uv[fan[c % 6]][0], uv[fan[c % 6]][1]);
    return s;
}

/* The cage of a box with this many control points a side, with segments between all neighbours. */
typedef struct shape_cage {
    double *points;
    uint32_t *segments;
    picture_cage cage;
} shape_cage;

static inline shape_cage shape_box_cage(size_t side, double size)
{
    const size_t count = side * side * side;
    shape_cage made = {malloc(count * 3 * sizeof(double)), malloc(count * 6 * sizeof(uint32_t)), {0}};
    if (!made.points || !made.segments)
        abort();
    size_t segments = 0;
    for (size_t i = 0; i < count; i++) {
        const size_t at[3] = {i % side, i / side % side, i / side / side}, steps[3] = {1, side, side * side};
        for (int a = 0; a < 3; a++) {
            made.points[3 * i + (size_t)a] = size * (2.0 * (double)at[a] / (double)(side - 1) - 1);
            if (at[a] + 1 < side) {
                made.segments[2 * segments] = (uint32_t)i;
                made.segments[2 * segments++ + 1] = (uint32_t)(i + steps[a]);
            }
        }
    }
    made.cage = (picture_cage){.points = made.points,
                               .point_count = count,
                               .segments = made.segments,
                               .segment_count = segments,
                               .color = {214, 120, 30}};
    return made;
}

static inline void shape_cage_free(shape_cage *of)
{
    free(of->points);
    free(of->segments);
}

#endif
