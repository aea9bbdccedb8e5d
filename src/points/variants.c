#include "points/variants.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "points/weights.h"
#include <math.h>
#include <string.h>

void ffd_variants_init(ffd_variants *variants, size_t size)
{
    const ffd_variants defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, variants, size);
}

/* Copies numbers of control points between the library's order, u fastest, and one with these steps. */
static void reorder(const ffd_lattice *lattice, size_t components, const double *from,
                    const size_t from_step[3], double *to, const size_t to_step[3])
{
    for (size_t i = 0; i < lattice->size[0]; i++)
        for (size_t j = 0; j < lattice->size[1]; j++)
            for (size_t k = 0; k < lattice->size[2]; k++) {
                const size_t at = i * from_step[0] + j * from_step[1] + k * from_step[2];
                const size_t place = i * to_step[0] + j * to_step[1] + k * to_step[2];
                memcpy(to + components * place, from + components * at, components * sizeof *to);
            }
}

static void find_steps(const ffd_lattice *lattice, bool w_fastest, size_t step[3])
{
    const size_t *const size = lattice->size;
    step[0] = w_fastest ? size[1] * size[2] : 1;
    step[1] = w_fastest ? size[2] : size[0];
    step[2] = w_fastest ? 1 : size[0] * size[1];
}

ffd_status ffd_variants_origin(const variant_set *all, const double **origin, double **room, ffd_error *error)
{
    size_t step[3];
    *room = NULL;
    *origin = all->of.are_points ? all->rest->rest : NULL;
    if (!all->of.are_points || !all->of.w_fastest)
        return FFD_OK;
    *room = ffd_alloc(all->rest->count, 3 * sizeof **room);
    if (!*room)
        return ffd_fail_memory(error);
    find_steps(all->rest, false, step);
    reorder(all->rest, 3, all->rest->rest, step, *room, all->step);
    *origin = *room;
    return FFD_OK;
}

/* Makes the tables of where control points are. */
static ffd_status find_places(variant_set *made, ffd_error *error)
{
    const knot_vector *const knots = made->rest->knots;
    size_t total = 0, step[3];
    for (int a = 0; a < 3; a++)
        total += 2 * knots[a].span_count * ((size_t)knots[a].degree + 1);
    size_t *next = made->places = ffd_alloc(total, sizeof *next);
    if (!next)
        return ffd_fail_memory(error);
    find_steps(made->rest, false, step);
    for (int a = 0; a < 3; a++) {
        const size_t order = (size_t)knots[a].degree + 1, count = knots[a].span_count * order;
        made->at[a] = next;
        made->rest_at[a] = next + count;
        next += 2 * count;
        for (size_t s = 0; s < count; s++) {
            const size_t first = (size_t)knots[a].spans[s / order] - (order - 1);
            const size_t point = ffd_knots_point(&knots[a], first + s % order);
            made->at[a][s] = 3 * made->step[a] * point;
            made->rest_at[a][s] = 3 * step[a] * point;
        }
    }
    return FFD_OK;
}

void ffd_variants_end(variant_set *made)
{
    ffd_free(made->places);
}

ffd_status ffd_variants_begin(const ffd_embedding *embedding, const ffd_variants *wanted, variant_set *made,
                              ffd_error *error)
{
    *made = (variant_set){.embedding = embedding, .rest = embedding->rest};
    ffd_variants_init(&made->of, sizeof made->of);
    TRY(ffd_struct_take(&made->of, sizeof made->of, wanted, "ffd_variants", error));
    const ffd_lattice *const rest = made->rest;
    if (!made->of.values && made->of.count > 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "the variants have no values");
    if (made->of.count > SIZE_MAX / sizeof(double) / 3 / rest->count)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "%zu variants of %zu control points are more than memory can hold", made->of.count,
                        rest->count);
    TRY(made->of.weights ? ffd_weights_check(made->of.weights, NULL, embedding->count, error) : FFD_OK);
    find_steps(rest, made->of.w_fastest, made->step);
    made->is_rational = rest->rest_weights || made->of.control_weights;
    for (int c = 0; c < 3; c++)
        made->is_large = made->is_large || !(rest->greatest[c] <= VARIANT_MOST);
    return find_places(made, error);
}

/* The control points of a cell: where their values are along each direction, and where they are at rest. */
typedef struct cell_places {
    size_t count[3];
    const size_t *at[3], *rest[3];
} cell_places;

/* Copies displacements, which are the values. last: the place of the last vector. */
static void copy_offsets(const cell_places *of, const double *values, size_t last, double *numbers)
{
    for (size_t k = 0; k < of->count[2]; k++)
        for (size_t j = 0; j < of->count[1]; j++) {
            const size_t row = of->at[1][j] + of->at[2][k];
            for (size_t i = 0; i < of->count[0]; i++, numbers += 3) {
                const size_t place = row + of->at[0][i];
                if (place == last)
                    memcpy(numbers, values + place, 3 * sizeof *numbers);
                else /* a vector and one number after it, in one move */
                    memcpy(numbers, values + place, 4 * sizeof *numbers);
            }
        }
}

/* Computes displacements of deformed control points. last: as above. */
static void subtract_rest(const cell_places *of, const double *values, const double *rest, size_t last,
                          double *numbers)
{
    for (size_t k = 0; k < of->count[2]; k++)
        for (size_t j = 0; j < of->count[1]; j++) {
            const size_t row = of->at[1][j] + of->at[2][k], row_rest = of->rest[1][j] + of->rest[2][k];
            for (size_t i = 0; i < of->count[0]; i++, numbers += 3) {
                const size_t place = row + of->at[0][i];
                const double *const a = values + place, *const b = rest + row_rest + of->rest[0][i];
                numbers[0] = a[0] - b[0];
                numbers[1] = a[1] - b[1];
                numbers[2] = a[2] - b[2];
                if (place != last) /* by pairs; the next vector replaces it */
                    numbers[3] = a[3] - b[3];
            }
        }
}

void ffd_variant_cell(const variant_set *all, size_t variant, const size_t index[3], double *numbers)
{
    const double *const values = ffd_variant_values(all, variant);
    const size_t last = 3 * (all->rest->count - 1); /* is the same control point in each order */
    cell_places of;
    for (int a = 0; a < 3; a++) {
        const size_t order = (size_t)all->rest->knots[a].degree + 1;
        of.count[a] = order;
        of.at[a] = all->at[a] + index[a] * order;
        of.rest[a] = all->rest_at[a] + index[a] * order;
    }
    if (all->of.are_points)
        subtract_rest(&of, values, all->rest->rest, last, numbers);
    else
        copy_offsets(&of, values, last, numbers);
}

bool ffd_variant_source(const variant_set *all, size_t variant, const size_t index[3], variant_source *source)
{
    *source = (variant_source){.values = ffd_variant_values(all, variant),
                               .rest = all->of.are_points ? all->rest->rest : NULL,
                               .last = 3 * (all->rest->count - 1)};
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &all->rest->knots[a];
        if (knots->degree != 3)
            return false;
        source->extraction[a] = knots->extractions + 16 * index[a];
        source->at[a] = all->at[a] + 4 * index[a];
        source->rest_at[a] = all->rest_at[a] + 4 * index[a];
    }
    return true;
}

static ffd_status set_values(const variant_set *all, ffd_lattice *lattice, const double *values,
                             ffd_error *error)
{
    return all->of.are_points ? ffd_lattice_set_points(lattice, NULL, lattice->count, values, error)
                              : ffd_lattice_set_offsets(lattice, NULL, lattice->count, values, error);
}

static ffd_status set_weights(const variant_set *all, ffd_lattice *lattice, double *room, ffd_error *error)
{
    size_t step[3];
    find_steps(lattice, false, step);
    if (all->of.control_weights)
        reorder(lattice, 1, all->of.control_weights, all->step, room, step);
    const double *const weights = all->of.control_weights ? room : lattice->rest_weights;
    return weights ? ffd_lattice_set_weights(lattice, NULL, lattice->count, weights, error) : FFD_OK;
}

ffd_status ffd_variant_lattice(const variant_set *all, size_t variant, ffd_lattice **made, ffd_error *error)
{
    size_t step[3];
    ffd_status status;
    double *const room = ffd_alloc(all->rest->count, 3 * sizeof *room);
    *made = NULL;
    TRY_END(room ? ffd_lattice_copy(all->rest, made, error) : ffd_fail_memory(error));
    find_steps(all->rest, false, step);
    reorder(all->rest, 3, ffd_variant_values(all, variant), all->step, room, step);
    TRY_END(set_values(all, *made, room, error));
    TRY_END(set_weights(all, *made, room, error));
end:
    ffd_free(room);
    if (status)
        ffd_lattice_destroy(made);
    return status;
}
