#include "author/made.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "lattice/build.h"
#include "lattice/shapes.h"
#include <string.h>

/* what: needs positions, "its moves". */
static ffd_status fail_without_positions(const char *what, ffd_error *error)
{
    return ffd_fail(error, FFD_E_INVALID,
                    "the box of the lattice is that of a mesh, and %s needs positions ({meshes})", what);
}

ffd_status ffd_made_begin(const ffd_lattice *from, made_lattice *made, ffd_error *error)
{
    const lattice_spec *const spec = from->spec;
    *made = (made_lattice){.from = from};
    if (!from->rest && spec->keys.kind == KEYS_POINTS)
        return ffd_fail(error, FFD_E_INVALID,
                        "the box of the lattice is that of a mesh, and its keys need positions ({meshes})");
    if (!from->rest &&
        (spec->move_count > 0 || spec->weights || spec->deformed_weights || spec->deformed_points))
        return ffd_fail(error, FFD_E_INVALID,
                        "the box of the lattice is that of a mesh, and its %s need positions ({meshes})",
                        spec->move_count > 0    ? "moves"
                        : spec->deformed_points ? "deformed points"
                                                : "weights");
    return FFD_OK;
}

/* Copies the offsets: zeros where nothing has moved yet. */
static ffd_status copy_offsets(made_lattice *made, ffd_error *error)
{
    const ffd_lattice *const from = made->from;
    const double *const offsets = from->rest ? from->difference : from->spec->deformed_offsets;
    made->offsets = offsets ? NULL : ffd_alloc_zero(from->count, 3 * sizeof *made->offsets);
    if (offsets)
        return ffd_made_copy(offsets, 3 * from->count, &made->offsets, error);
    return made->offsets ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_made_begin_same(const ffd_lattice *from, made_lattice *made, ffd_error *error)
{
    TRY(ffd_made_begin(from, made, error));
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &from->knots[a];
        const bool is_closed = ffd_knots_closed(knots);
        TRY(ffd_made_set_knots(made, a, knots->degree, knots->points, is_closed,
                               knots->t + (is_closed ? knots->degree : 0), error));
    }
    TRY(copy_offsets(made, error));
    if (!from->rest_weights)
        return FFD_OK;
    TRY(ffd_made_copy(from->rest_weights, from->count, &made->weights, error));
    return ffd_made_copy(from->deformed_weights, from->count, &made->moved_weights, error);
}

ffd_status ffd_made_give_weights(made_lattice *made, ffd_error *error)
{
    const size_t count = made->from->count;
    if (made->weights)
        return FFD_OK;
    made->weights = ffd_alloc_whole(count, sizeof *made->weights);
    made->moved_weights = ffd_alloc_whole(count, sizeof *made->moved_weights);
    if (!made->weights || !made->moved_weights)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < count; i++)
        made->weights[i] = made->moved_weights[i] = 1;
    return FFD_OK;
}

ffd_status ffd_made_take_points(made_lattice *made, ffd_error *error)
{
    if (!made->from->rest)
        return fail_without_positions("this", error);
    return made->points ? FFD_OK
                        : ffd_made_copy(made->from->rest, 3 * made->from->count, &made->points, error);
}

void ffd_made_free(made_lattice *made)
{
    for (int a = 0; a < 3; a++)
        ffd_free(made->knots[a]);
    ffd_free(made->points);
    ffd_free(made->offsets);
    ffd_free(made->weights);
    ffd_free(made->moved_weights);
    *made = (made_lattice){0};
}

ffd_status ffd_made_copy(const double *numbers, size_t count, double **copy, ffd_error *error)
{
    *copy = ffd_alloc_whole(count, sizeof **copy);
    if (!*copy)
        return ffd_fail_memory(error);
    memcpy(*copy, numbers, count * sizeof **copy);
    return FFD_OK;
}

static size_t knot_count(const made_lattice *made, int a)
{
    return made->closed[a] ? made->size[a] + 1 : made->size[a] + (size_t)made->degree[a] + 1;
}

ffd_status ffd_made_set_knots(made_lattice *made, int a, int degree, size_t size, bool closed,
                              const double *knots, ffd_error *error)
{
    made->degree[a] = degree;
    made->size[a] = size;
    made->closed[a] = closed;
    return ffd_made_copy(knots, knot_count(made, a), &made->knots[a], error);
}

bool ffd_made_is_box(const made_lattice *made)
{
    const lattice_spec *const spec = made->from->spec;
    return (spec->rest == SPEC_BOX || spec->rest == SPEC_BOX_MESH) && spec->spacing == FFD_SPACING_GREVILLE &&
           !made->from->rest_weights;
}

ffd_status ffd_made_allocate(made_lattice *made, bool moved_weights, ffd_error *error)
{
    const size_t count = made->size[0] * made->size[1] * made->size[2];
    made->points = ffd_alloc_whole(count, 3 * sizeof *made->points);
    made->offsets = ffd_alloc_whole(count, 3 * sizeof *made->offsets);
    made->weights = ffd_alloc_whole(count, sizeof *made->weights);
    made->moved_weights = moved_weights ? ffd_alloc_whole(count, sizeof *made->moved_weights) : NULL;
    return made->points && made->offsets && made->weights && (made->moved_weights || !moved_weights)
               ? FFD_OK
               : ffd_fail_memory(error);
}

/* Returns whether the knots of a preset are those of the direction, to the bit. */
static bool is_preset(const made_lattice *made, int a, knot_kind kind)
{
    knot_vector preset;
    if (ffd_knots_make(kind, made->degree[a], made->size[a], NULL, 0, "uvw"[a], &preset, NULL))
        return false;
    const double *const first = preset.t + (made->closed[a] ? made->degree[a] : 0);
    const bool same = memcmp(first, made->knots[a], knot_count(made, a) * sizeof *first) == 0;
    ffd_knots_free(&preset);
    return same;
}

static void set_knots(made_lattice *made, int a, lattice_spec *spec)
{
    static const knot_kind presets[] = {KNOTS_CLAMPED, KNOTS_OPEN, KNOTS_UNIFORM};
    spec->kind[a] = made->closed[a] ? KNOTS_CLOSED_LIST : KNOTS_LIST;
    for (size_t i = 0; i < sizeof presets / sizeof *presets && !made->closed[a]; i++)
        if (is_preset(made, a, presets[i])) {
            spec->kind[a] = presets[i];
            return;
        }
    if (made->closed[a] && is_preset(made, a, KNOTS_CLOSED)) {
        spec->kind[a] = KNOTS_CLOSED;
        return;
    }
    spec->list[a] = made->knots[a];
    spec->list_count[a] = knot_count(made, a);
    made->knots[a] = NULL;
}

/* Keeps the meshes that the box is still to be laid round, and the file beside which they are. */
static ffd_status copy_meshes(const lattice_spec *from, lattice_spec *spec, ffd_error *error)
{
    if (from->mesh_count == 0)
        return FFD_OK;
    ffd_free(spec->name);
    spec->name = ffd_text_copy(from->name);
    spec->meshes = ffd_alloc_zero(from->mesh_count, sizeof *spec->meshes);
    if (!spec->name || !spec->meshes)
        return ffd_fail_memory(error);
    for (; spec->mesh_count < from->mesh_count; spec->mesh_count++) {
        spec->meshes[spec->mesh_count] = ffd_text_copy(from->meshes[spec->mesh_count]);
        if (!spec->meshes[spec->mesh_count])
            return ffd_fail_memory(error);
    }
    return FFD_OK;
}

ffd_status ffd_made_find_box(const made_lattice *made, made_box *box, ffd_error *error)
{
    const ffd_lattice *const from = made->from;
    memcpy(box->axes, from->spec->box_axes, sizeof box->axes);
    memcpy(box->min, from->spec->box_min, sizeof box->min);
    memcpy(box->max, from->spec->box_max, sizeof box->max);
    if (from->spec->rest != SPEC_BOX_MESH)
        return FFD_OK;
    return from->rest ? ffd_shape_grow_box(from->fitted.min, from->fitted.max, from->spec->margin, box->min,
                                           box->max, error)
                      : fail_without_positions("this", error);
}

/* Sets the rest as a box: that of the file, as it was laid round a mesh, or placed elsewhere; or still to be
   laid. */
static ffd_status set_box(const made_lattice *made, lattice_spec *spec, ffd_error *error)
{
    static const double along[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const lattice_spec *const from = made->from->spec;
    made_box box = made->box;
    memcpy(spec->margin, from->margin, sizeof spec->margin);
    spec->spacing = from->spacing;
    spec->rest = made->has_box || made->from->rest ? SPEC_BOX : from->rest;
    if (!made->has_box && spec->rest == SPEC_BOX)
        TRY(ffd_made_find_box(made, &box, error));
    memcpy(spec->box_axes, spec->rest == SPEC_BOX ? box.axes : from->box_axes, sizeof spec->box_axes);
    memcpy(spec->box_min, box.min, sizeof spec->box_min);
    memcpy(spec->box_max, box.max, sizeof spec->box_max);
    spec->has_axes = made->has_box ? memcmp(box.axes, along, sizeof along) != 0 : from->has_axes;
    return spec->rest == SPEC_BOX ? FFD_OK : copy_meshes(from, spec, error);
}

/* Sets the rest as it is. */
static ffd_status set_same(const made_lattice *made, lattice_spec *spec, ffd_error *error)
{
    const lattice_spec *const from = made->from->spec;
    if (from->rest == SPEC_BOX || from->rest == SPEC_BOX_MESH)
        return set_box(made, spec, error);
    spec->rest = from->rest;
    if (from->rest == SPEC_POINTS)
        return ffd_made_copy(from->points, 3 * from->count, &spec->points, error);
    memcpy(spec->center, from->center, sizeof spec->center);
    memcpy(spec->radius, from->radius, sizeof spec->radius);
    memcpy(spec->angle, from->angle, sizeof spec->angle);
    memcpy(spec->axis, from->axis, sizeof spec->axis);
    memcpy(spec->zero, from->zero, sizeof spec->zero);
    spec->height = from->height;
    return FFD_OK;
}

static bool move_anything(const made_lattice *made, size_t count)
{
    for (size_t i = 0; made->offsets && i < 3 * count; i++)
        if (made->offsets[i] != 0)
            return true;
    return false;
}

static bool move_weights(const made_lattice *made, size_t count)
{
    return made->moved_weights &&
           memcmp(made->weights, made->moved_weights, count * sizeof *made->weights) != 0;
}

/* Whether all weights are 1, which none need to be written for. */
static bool are_ones(const double *weights, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (weights[i] != 1)
            return false;
    return true;
}

/* Moves an array into the spec. */
static void take(double **from, double **to)
{
    *to = *from;
    *from = NULL;
}

static ffd_status fill(made_lattice *made, lattice_spec *spec, ffd_error *error)
{
    spec->count = made->size[0] * made->size[1] * made->size[2];
    for (int a = 0; a < 3; a++) {
        spec->size[a] = made->size[a];
        spec->degree[a] = made->degree[a];
        set_knots(made, a, spec);
    }
    if (!(spec->name = ffd_text_copy("")))
        return ffd_fail_memory(error);
    if (move_anything(made, spec->count))
        take(&made->offsets, &spec->deformed_offsets);
    if (move_weights(made, spec->count))
        take(&made->moved_weights, &spec->deformed_weights);
    if (made->weights && (spec->deformed_weights || !are_ones(made->weights, spec->count)))
        take(&made->weights, &spec->weights);
    if (!made->points)
        return set_same(made, spec, error);
    spec->rest = SPEC_POINTS;
    take(&made->points, &spec->points);
    return FFD_OK;
}

ffd_status ffd_made_finish(made_lattice *made, ffd_lattice **lattice, ffd_error *error)
{
    lattice_spec *const spec = ffd_alloc_zero(1, sizeof *spec);
    ffd_status status;
    TRY_END(spec ? FFD_OK : ffd_fail_memory(error));
    TRY_END(fill(made, spec, error));
    TRY_END(ffd_spec_build(spec, NULL, lattice, error));
end:
    if (status)
        ffd_spec_free(spec);
    return status;
}
