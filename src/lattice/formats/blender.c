#include "lattice/formats/blender.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include <math.h>
#include <string.h>

/* Blender's tension of a cardinal spline, and of a Catmull-Rom spline. */
#define CARDINAL 0.71
#define CATMULL_ROM 0.5

static const char *const type_names[] = {"KEY_LINEAR", "KEY_CARDINAL", "KEY_CATMULL_ROM", "KEY_BSPLINE"};

/* A control point along a direction: a sum of two or three of Blender's points, whose indices are held within
   their range. */
typedef struct blend {
    long index[3];
    double weight[3];
} blend;

bool ffd_blender_type(text_word word, blender_type *type)
{
    for (int t = 0; t < 4; t++)
        if (ffd_text_is(word, type_names[t])) {
            *type = (blender_type)t;
            return true;
        }
    return false;
}

bool ffd_blender_turn(const double quaternion[4], double rotation[9])
{
    double q[4], square = 0;
    for (int i = 0; i < 4; i++)
        square += quaternion[i] * quaternion[i];
    if (!(square > 0) || !isfinite(square))
        return false;
    for (int i = 0; i < 4; i++)
        q[i] = quaternion[i] / sqrt(square);
    const double w = q[0], x = q[1], y = q[2], z = q[3];
    const double rows[9] = {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),     2 * (x * z + w * y),
                            2 * (x * y + w * z),     1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
                            2 * (x * z - w * y),     2 * (y * z + w * x),     1 - 2 * (x * x + y * y)};
    memcpy(rotation, rows, sizeof rows);
    return true;
}

static bool is_cardinal(blender_type type)
{
    return type == BLENDER_CARDINAL || type == BLENDER_CATMULL_ROM;
}

/* The number of control points along a direction of n of Blender's. */
static size_t count_points(blender_type type, size_t n)
{
    return n == 1 ? 2 : type == BLENDER_LINEAR ? n : type == BLENDER_BSPLINE ? n + 4 : 2 * n + 4;
}

/* The control point c of a direction as a sum. Of a cardinal spline cell i, from -1 on, has q_i + m_i / 3 and
   q_(i+1) - m_(i+1) / 3, with m_i = tension (q_(i+1) - q_(i-1)). */
static blend find_blend(blender_type type, size_t n, size_t c)
{
    const long at = (long)c;
    if (n == 1)
        return (blend){{0}, {1}};
    if (!is_cardinal(type))
        return (blend){{type == BLENDER_LINEAR ? at : at - 2}, {1}};
    const long last = 2 * (long)n + 3;
    if (at == 0 || at == last)
        return (blend){{at == 0 ? -1 : (long)n}, {1}};
    const long of = at % 2 ? (at - 1) / 2 - 1 : at / 2 - 1; /* 1, 2: -1 and 0; 3, 4: 0 and 1 */
    const double third = (type == BLENDER_CARDINAL ? CARDINAL : CATMULL_ROM) / (at % 2 ? 3 : -3);
    return (blend){{of, of + 1, of - 1}, {1, third, -third}};
}

/* Blends the points along a direction. from: sizes `size`, 3 numbers each; *to gets them with count points
   along d. */
static ffd_status blend_along(const double *from, const size_t size[3], int d, blender_type type,
                              size_t count, double **to, ffd_error *error)
{
    const size_t inner = d == 0 ? 1 : d == 1 ? size[0] : size[0] * size[1];
    const size_t outer = size[0] * size[1] * size[2] / (inner * size[d]);
    *to = ffd_alloc_zero(inner * count * outer, 3 * sizeof **to);
    if (!*to)
        return ffd_fail_memory(error);
    for (size_t o = 0; o < outer; o++)
        for (size_t c = 0; c < count; c++) {
            const blend sum = find_blend(type, size[d], c);
            for (int term = 0; term < 3; term++) {
                const long last = (long)size[d] - 1, index = sum.index[term];
                const size_t held = (size_t)(index < 0 ? 0 : index > last ? last : index);
                const double *const source = from + 3 * (held + o * size[d]) * inner;
                double *const target = *to + 3 * (c + o * count) * inner;
                for (size_t i = 0; i < 3 * inner && sum.weight[term] != 0; i++)
                    target[i] += sum.weight[term] * source[i];
            }
        }
    return FFD_OK;
}

/* Makes the offsets of all control points, in the lattice's own space. */
static ffd_status blend_all(const blender_lattice *from, const size_t size[3], double **offsets,
                            ffd_error *error)
{
    size_t now[3] = {from->size[0], from->size[1], from->size[2]};
    const double *source = from->offsets;
    *offsets = NULL;
    for (int d = 0; d < 3; d++) {
        double *next;
        const ffd_status status = blend_along(source, now, d, from->type[d], size[d], &next, error);
        ffd_free(*offsets);
        *offsets = next;
        TRY(status);
        source = next;
        now[d] = size[d];
    }
    return FFD_OK;
}

/* Gives a cardinal direction its knots: -1 four times, 0 to n - 1 twice each, n four times. */
static ffd_status give_knots(lattice_spec *spec, int d, size_t n, ffd_error *error)
{
    const size_t count = 2 * n + 8;
    double *const list = ffd_alloc(count, sizeof *list);
    if (!list)
        return ffd_fail_memory(error);
    for (size_t k = 0; k < count; k++)
        list[k] = k < 4 ? -1 : k >= count - 4 ? (double)n : (double)((k - 4) / 2);
    spec->kind[d] = KNOTS_LIST;
    spec->list[d] = list;
    spec->list_count[d] = count;
    return FFD_OK;
}

/* Sets the degree and knots of a direction, and its ends in the lattice's own space. */
static ffd_status shape_direction(const blender_lattice *from, int d, lattice_spec *spec, double ends[2],
                                  ffd_error *error)
{
    const size_t n = from->size[d];
    const double last = from->first[d] + (double)(n - 1) * from->step[d];
    const bool is_linear = n == 1 || from->type[d] == BLENDER_LINEAR;
    const double beyond = n == 1 ? 0.5 : is_linear ? 0 : from->step[d];
    ends[0] = from->first[d] - beyond;
    ends[1] = last + beyond;
    spec->degree[d] = is_linear ? 1 : 3;
    spec->kind[d] = is_linear ? KNOTS_CLAMPED : KNOTS_OPEN;
    return n > 1 && is_cardinal(from->type[d]) ? give_knots(spec, d, n, error) : FFD_OK;
}

/* Lays the box. A side that is scaled by a negative number has its axis the other way. */
static void place(const blender_lattice *from, int d, const double ends[2], lattice_spec *spec)
{
    double *const axis = spec->box_axes + 3 * d;
    for (int c = 0; c < 3; c++)
        axis[c] = (from->scale[d] < 0 ? -1 : 1) * from->rotation[3 * c + d];
    const double middle = vec_dot(axis, from->location), scale = fabs(from->scale[d]);
    spec->box_min[d] = middle + scale * ends[0];
    spec->box_max[d] = middle + scale * ends[1];
}

/* Takes offsets to the world. */
static void turn(const blender_lattice *from, double *offsets, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        double scaled[3];
        for (int c = 0; c < 3; c++)
            scaled[c] = from->scale[c] * offsets[3 * i + (size_t)c];
        mat_apply(from->rotation, scaled, offsets + 3 * i);
    }
}

ffd_status ffd_blender_make(const blender_lattice *from, const char *name, const format_wish *wish,
                            lattice_spec **spec, ffd_error *error)
{
    size_t size[3];
    for (int d = 0; d < 3; d++) {
        if (from->scale[d] == 0)
            return ffd_fail_file(error, FFD_E_INVALID, name, "has the scale 0 along %c", "xyz"[d]);
        size[d] = count_points(from->type[d], from->size[d]);
    }
    TRY(ffd_format_begin(size, name, wish, spec, error));
    lattice_spec *const made = *spec;
    ffd_free(made->points);
    made->points = NULL;
    made->rest = SPEC_BOX;
    made->spacing = FFD_SPACING_GREVILLE;
    made->has_axes = true;
    for (int d = 0; d < 3; d++) {
        double ends[2];
        TRY(shape_direction(from, d, made, ends, error));
        place(from, d, ends, made);
    }
    TRY(blend_all(from, size, &made->deformed_offsets, error));
    turn(from, made->deformed_offsets, made->count);
    return FFD_OK;
}
