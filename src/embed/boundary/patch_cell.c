/* patch_cell.c - decides whether a patch and a cell have a point in common, in coordinates in which the cell
   is the cube [-1,1]^3. A plane that separates the cube and the control points proves that they have none; a
   point of the patch in the cube, found by linearisation, proves that they have one. */
#include "base/vector/vec.h"
#include "embed/boundary/patch.h"
#include <string.h>

enum { N = PATCH_COMPONENTS };

/* The most linearisation steps towards a point of the patch in the cell. */
#define CELL_STEPS 4
/* A patch of at most this size, in half sides of the cell, that no plane separates from the cell counts as
   meeting it. */
#define GRAZING 1e-6
/* The most corners of a square that is clipped by six lines. */
#define MOST_CORNERS 10

/* The control points in the coordinates of the cell. */
typedef struct cell_net {
    double at[MAX_ORDER * MAX_ORDER][3];
    size_t count;
} cell_net;

static void make_net(const face_patch *patch, const patch_cell *cell, cell_net *net)
{
    net->count = (size_t)patch->order[0] * (size_t)patch->order[1];
    for (size_t i = 0; i < net->count; i++) {
        const double *const x = patch->points + N * i;
        for (int c = 0; c < 3; c++)
            net->at[i][c] = ((patch->rational ? x[c] / x[3] : x[c]) - cell->centre[c]) / cell->half[c];
    }
}

/* Planes between them */

/* Returns whether a plane with this normal separates the net and the cube. */
static bool is_between(const cell_net *net, const double normal[3])
{
    const double reach = fabs(normal[0]) + fabs(normal[1]) + fabs(normal[2]);
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (size_t i = 0; i < net->count; i++) {
        const double along = vec_dot(normal, net->at[i]);
        least = lesser_of(least, along);
        most = larger_of(most, along);
    }
    return least > reach || most < -reach;
}

/* Computes a chord of the patch along f: the sum of its two edges. */
static void find_chord(const face_patch *patch, const cell_net *net, int f, double chord[3])
{
    const size_t os = (size_t)patch->order[0], corner[4] = {0, os - 1, net->count - os, net->count - 1};
    const size_t second = f == 0 ? 1 : 2, third = 3 - second;
    for (int c = 0; c < 3; c++)
        chord[c] = net->at[corner[second]][c] - net->at[corner[0]][c] +
                   (net->at[corner[3]][c] - net->at[corner[third]][c]);
    const double length = vec_length(chord);
    for (int c = 0; c < 3 && length > 0; c++)
        chord[c] /= length;
}

/* Tests the planes that can separate a cube and a parallelogram (separating axis theorem): parallel to the
   faces of the cube, to the parallelogram, and to an edge of each. */
static bool is_kept_apart(const face_patch *patch, const cell_net *net)
{
    static const double axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    double chord[2][3], normal[3];
    for (int a = 0; a < 3; a++)
        if (is_between(net, axes[a]))
            return true;
    for (int f = 0; f < 2; f++)
        find_chord(patch, net, f, chord[f]);
    vec_cross(chord[0], chord[1], normal);
    if (is_between(net, normal))
        return true;
    for (int f = 0; f < 2; f++)
        for (int a = 0; a < 3; a++) {
            vec_cross(axes[a], chord[f], normal);
            if (is_between(net, normal))
                return true;
        }
    return false;
}

/* A point in both */

typedef struct polygon {
    double corner[MOST_CORNERS][2];
    size_t count;
} polygon;

/* Clips the polygon to slope . t <= end. */
static void cut(polygon *shape, const double slope[2], double end)
{
    polygon rest = {.count = 0};
    for (size_t i = 0; i < shape->count; i++) {
        const double *const a = shape->corner[i], *const b = shape->corner[(i + 1) % shape->count];
        const double at_a = slope[0] * a[0] + slope[1] * a[1] - end;
        const double at_b = slope[0] * b[0] + slope[1] * b[1] - end;
        if (at_a <= 0 && rest.count < MOST_CORNERS)
            memcpy(rest.corner[rest.count++], a, sizeof rest.corner[0]);
        if ((at_a <= 0) != (at_b <= 0) && rest.count < MOST_CORNERS) {
            const double part = at_a / (at_a - at_b);
            for (int f = 0; f < 2; f++)
                rest.corner[rest.count][f] = a[f] + part * (b[f] - a[f]);
            rest.count++;
        }
    }
    *shape = rest;
}

/* Moves t to the middle of the part of [0,1]^2 that the linearisation of the patch at t maps into the cell.
   Returns false if that is empty. */
static bool step_into(const patch_sample *sample, const patch_cell *cell, double t[2])
{
    polygon shape = {{{-t[0], -t[1]}, {1 - t[0], -t[1]}, {1 - t[0], 1 - t[1]}, {-t[0], 1 - t[1]}}, 4};
    for (int c = 0; c < 3; c++) {
        const double off = sample->residual[c] / cell->half[c];
        const double slope[2] = {sample->first[0][c] / cell->half[c], sample->first[1][c] / cell->half[c]};
        const double back[2] = {-slope[0], -slope[1]};
        cut(&shape, slope, 1 - off);
        cut(&shape, back, 1 + off);
    }
    if (shape.count == 0)
        return false;
    for (int f = 0; f < 2; f++) {
        double sum = 0;
        for (size_t i = 0; i < shape.count; i++)
            sum += shape.corner[i][f];
        t[f] = lesser_of(larger_of(t[f] + sum / (double)shape.count, 0), 1);
    }
    return true;
}

static bool is_in_cell(const patch_sample *sample, const patch_cell *cell)
{
    for (int c = 0; c < 3; c++)
        if (!(fabs(sample->residual[c]) <= cell->half[c]))
            return false;
    return true;
}

static bool has_point_in(const face_patch *patch, const patch_cell *cell)
{
    double t[2] = {0.5, 0.5};
    patch_sample sample;
    for (int step = 0; step <= CELL_STEPS; step++) {
        ffd_patch_evaluate(patch, cell->centre, t, &sample);
        if (is_in_cell(&sample, cell))
            return true;
        if (!step_into(&sample, cell, t))
            return false;
    }
    return false;
}

/* Returns the extent of the rows of the net along f, in half sides of the cell. */
static double length_along(const face_patch *patch, const cell_net *net, int f)
{
    const size_t os = (size_t)patch->order[0], step = f == 0 ? 1 : os;
    double most = 0;
    for (size_t i = 0; i + step < net->count; i++)
        for (int c = 0; c < 3 && (f == 1 || (i + 1) % os); c++)
            most = larger_of(most, fabs(net->at[i + step][c] - net->at[i][c]));
    return most * (patch->order[f] - 1);
}

patch_view ffd_patch_view_cell(const face_patch *patch, const patch_cell *cell, int *longer)
{
    cell_net net;
    make_net(patch, cell, &net);
    if (is_kept_apart(patch, &net))
        return PATCH_MISSES;
    if (has_point_in(patch, cell))
        return PATCH_MEETS;
    const double length[2] = {length_along(patch, &net, 0), length_along(patch, &net, 1)};
    *longer = length[1] > length[0];
    return length[0] <= GRAZING && length[1] <= GRAZING ? PATCH_MEETS : PATCH_UNKNOWN;
}
