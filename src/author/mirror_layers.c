/* mirror_layers.c - ffd_lattice_mirror, ffd_lattice_symmetrize: the layers of a direction change places, and
   displacements are reflected, where the lattice at rest is symmetric. */
#include "author/mirror_layers.h"
#include "author/made.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "lattice/lattice.h"
#include <ffd/author.h>
#include <math.h>
#include <string.h>

/* How far the mirror image of a control point may be from one, as a part of the diagonal; a weight from that
   one's, as a part of the largest; a knot from its image, as a part of their range. */
#define PLACE_TOLERANCE 1e-9
#define WEIGHT_TOLERANCE 1e-12
#define KNOT_TOLERANCE 1e-12
/* A component of the normal of less is 0: across a coordinate axis a reflection then changes a sign only. */
#define NORMAL_TOLERANCE 1e-12

static size_t point_of(const layer_reflection *by, size_t before, size_t layer, size_t behind)
{
    return before + by->before * (layer + by->layers * behind);
}

/* The mean of a layer. */
static void mean_of_layer(const ffd_lattice *lattice, const layer_reflection *by, size_t layer,
                          double mean[3])
{
    const double count = (double)(by->before * by->behind);
    mean[0] = mean[1] = mean[2] = 0;
    for (size_t b = 0; b < by->behind; b++)
        for (size_t a = 0; a < by->before; a++)
            for (size_t c = 0; c < 3; c++)
                mean[c] += lattice->rest[3 * point_of(by, a, layer, b) + c] / count;
}

/* Returns the index of the only component that is not 0; -1: there are several. */
static int axis_of(const double normal[3])
{
    int axis = -1, count = 0;
    for (int c = 0; c < 3; c++)
        if (normal[c] != 0) {
            axis = c;
            count++;
        }
    return count == 1 ? axis : -1;
}

static ffd_status find_plane(const ffd_lattice *lattice, layer_reflection *by, ffd_error *error)
{
    double first[3], last[3];
    mean_of_layer(lattice, by, 0, first);
    mean_of_layer(lattice, by, by->layers - 1, last);
    for (int c = 0; c < 3; c++) {
        by->normal[c] = last[c] - first[c];
        by->middle[c] = 0.5 * first[c] + 0.5 * last[c];
    }
    const double length = vec_length(by->normal);
    if (!(length > 0))
        return ffd_fail(error, FFD_E_INVALID, "the first and the last layer of %c have the same middle",
                        "uvw"[by->direction]);
    for (int c = 0; c < 3; c++)
        by->normal[c] = fabs(by->normal[c]) < NORMAL_TOLERANCE * length ? 0 : by->normal[c] / length;
    if (axis_of(by->normal) >= 0)
        by->normal[axis_of(by->normal)] = 1; /* its sign does not matter */
    return FFD_OK;
}

void ffd_reflect_vector(const layer_reflection *by, const double from[3], double to[3])
{
    const int axis = axis_of(by->normal);
    const double twice = 2 * vec_dot(from, by->normal);
    for (int c = 0; c < 3; c++)
        to[c] = axis == c ? 0 - from[c] : axis >= 0 ? from[c] : from[c] - twice * by->normal[c];
}

void ffd_reflect_place(const layer_reflection *by, const double from[3], double to[3])
{
    double off[3];
    for (int c = 0; c < 3; c++)
        off[c] = from[c] - by->middle[c];
    ffd_reflect_vector(by, off, to);
    for (int c = 0; c < 3; c++)
        to[c] += by->middle[c];
}

static ffd_status check_knots(const knot_vector *knots, char direction, ffd_error *error)
{
    const size_t last = knots->functions + (size_t)knots->degree;
    const double *const t = knots->t, sum = t[0] + t[last], range = t[last] - t[0];
    if (ffd_knots_closed(knots))
        return ffd_fail(error, FFD_E_INVALID, "direction %c is closed: it has no two ends to be mirrored",
                        direction);
    for (size_t i = 0; i <= last; i++)
        if (!(fabs(t[i] + t[last - i] - sum) <= KNOT_TOLERANCE * range))
            return ffd_fail(error, FFD_E_INVALID,
                            "the knots along %c are not symmetric: %.9g and %.9g are at different distances "
                            "from the ends",
                            direction, t[i], t[last - i]);
    return FFD_OK;
}

static ffd_status check_points(const ffd_lattice *lattice, const layer_reflection *by, ffd_error *error)
{
    double farthest = 0, greatest = 0, weight = 0;
    for (size_t b = 0; b < by->behind; b++)
        for (size_t l = 0; l < by->layers; l++)
            for (size_t a = 0; a < by->before; a++) {
                const size_t i = point_of(by, a, l, b), j = point_of(by, a, by->layers - 1 - l, b);
                double from[3], image[3];
                for (size_t c = 0; c < 3; c++)
                    from[c] = lattice->rest[3 * i + c] - by->middle[c];
                ffd_reflect_vector(by, from, image);
                for (size_t c = 0; c < 3; c++)
                    farthest =
                        maximum_number(farthest, fabs(image[c] - (lattice->rest[3 * j + c] - by->middle[c])));
                if (lattice->rest_weights) {
                    greatest = maximum_number(greatest, lattice->rest_weights[i]);
                    weight =
                        maximum_number(weight, fabs(lattice->rest_weights[i] - lattice->rest_weights[j]));
                }
            }
    if (!(farthest <= PLACE_TOLERANCE * lattice->diagonal))
        return ffd_fail(
            error, FFD_E_INVALID,
            "the lattice at rest is not symmetric along %c: a control point is %.3g from the mirror "
            "image of the one opposite",
            "uvw"[by->direction], farthest);
    if (!(weight <= WEIGHT_TOLERANCE * greatest))
        return ffd_fail(error, FFD_E_INVALID,
                        "the weights at rest are not symmetric along %c: two opposite ones differ by %.3g",
                        "uvw"[by->direction], weight);
    return FFD_OK;
}

ffd_status ffd_layer_reflection_make(const ffd_lattice *lattice, int direction, layer_reflection *by,
                                     ffd_error *error)
{
    if (direction < 0 || direction > 2)
        return ffd_fail(error, FFD_E_ARGUMENT, "the direction %d is not 0 to 2", direction);
    const size_t *const size = lattice->size;
    *by = (layer_reflection){.direction = direction,
                             .layers = size[direction],
                             .before = direction == 0   ? 1
                                       : direction == 1 ? size[0]
                                                        : size[0] * size[1],
                             .behind = direction == 2   ? 1
                                       : direction == 1 ? size[2]
                                                        : size[1] * size[2]};
    if (!lattice->rest)
        return ffd_fail(error, FFD_E_INVALID,
                        "the box of the lattice is that of a mesh, and a mirror image needs positions "
                        "({meshes})");
    TRY(check_knots(&lattice->knots[direction], "uvw"[direction], error));
    TRY(find_plane(lattice, by, error));
    return check_points(lattice, by, error);
}

/* Gives a control point what the one opposite has. */
static void take_image(made_lattice *made, const layer_reflection *by, size_t to, size_t from)
{
    ffd_reflect_vector(by, made->from->difference + 3 * from, made->offsets + 3 * to);
    if (made->moved_weights)
        made->moved_weights[to] = made->from->deformed_weights[from];
}

/* Of a point on the plane what moves it off the plane becomes 0. */
static void flatten(const layer_reflection *by, double offset[3])
{
    const double along = vec_dot(offset, by->normal);
    const int axis = axis_of(by->normal);
    for (int c = 0; c < 3; c++)
        offset[c] = axis == c ? 0 : axis >= 0 ? offset[c] : offset[c] - along * by->normal[c];
}

/* Which half of the layers stays. */
typedef enum kept_half { KEEP_NONE, KEEP_FIRST, KEEP_LAST } kept_half;

static void mirror_layer(made_lattice *made, const layer_reflection *by, size_t layer, kept_half kept)
{
    const size_t opposite = by->layers - 1 - layer;
    const bool is_first = layer < opposite, is_middle = layer == opposite;
    if (!is_middle && (kept == KEEP_FIRST ? is_first : kept == KEEP_LAST && !is_first))
        return;
    for (size_t b = 0; b < by->behind; b++)
        for (size_t a = 0; a < by->before; a++) {
            const size_t i = point_of(by, a, layer, b);
            if (is_middle && kept != KEEP_NONE)
                flatten(by, made->offsets + 3 * i);
            else
                take_image(made, by, i, point_of(by, a, opposite, b));
        }
}

static ffd_status mirror(const ffd_lattice *lattice, int direction, kept_half kept, ffd_lattice **result,
                         ffd_error *error)
{
    made_lattice made = {0};
    layer_reflection by;
    ffd_status status;
    *result = NULL;
    TRY_END(ffd_layer_reflection_make(lattice, direction, &by, error));
    TRY_END(ffd_made_begin_same(lattice, &made, error));
    for (size_t layer = 0; layer < by.layers; layer++)
        mirror_layer(&made, &by, layer, kept);
    TRY_END(ffd_made_finish(&made, result, error));
end:
    ffd_made_free(&made);
    return status;
}

ffd_status ffd_lattice_mirror(const ffd_lattice *lattice, int direction, ffd_lattice **result,
                              ffd_error *error)
{
    return mirror(lattice, direction, KEEP_NONE, result, error);
}

ffd_status ffd_lattice_symmetrize(const ffd_lattice *lattice, int direction, bool keep_last,
                                  ffd_lattice **result, ffd_error *error)
{
    return mirror(lattice, direction, keep_last ? KEEP_LAST : KEEP_FIRST, result, error);
}
