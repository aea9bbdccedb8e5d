/* edit.c - lets the caller set deformed control points and weights. */
#include "base/memory/memory.h"
#include "lattice/lattice.h"
#include <string.h>

typedef enum edit_kind { EDIT_POINTS, EDIT_OFFSETS, EDIT_WEIGHTS } edit_kind;

/* Control points to be set, and their previous values. */
typedef struct point_edit {
    edit_kind kind;
    const size_t *index; /* NULL: points 0 to count - 1 */
    size_t count;
    const double *values;
    double *before; /* previous values. EDIT_WEIGHTS: 1 number for each point; else 6, deformed and
                       difference */
} point_edit;

static size_t width_of(const point_edit *edit)
{
    return edit->kind == EDIT_WEIGHTS ? 1 : 3;
}

static size_t point_of(const point_edit *edit, size_t i)
{
    return edit->index ? edit->index[i] : i;
}

static ffd_status check(const ffd_lattice *lattice, const point_edit *edit, ffd_error *error)
{
    if (!lattice->rest)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "the lattice has no control points yet: its box is that of a mesh");
    if (!edit->index && edit->count > lattice->count)
        return ffd_fail(error, FFD_E_ARGUMENT, "%zu values are given for %zu control points", edit->count,
                        lattice->count);
    for (size_t i = 0; edit->index && i < edit->count; i++)
        if (edit->index[i] >= lattice->count)
            return ffd_fail(error, FFD_E_ARGUMENT, "there is no control point %zu: the lattice has %zu",
                            edit->index[i], lattice->count);
    return FFD_OK;
}

/* Adds weights of 1 to a lattice that has none. */
static ffd_status make_weights(ffd_lattice *lattice, ffd_error *error)
{
    if (lattice->rest_weights)
        return FFD_OK;
    double *const rest = ffd_alloc(lattice->count, sizeof *rest);
    double *const deformed = ffd_alloc(lattice->count, sizeof *deformed);
    if (!rest || !deformed) {
        ffd_free(rest);
        ffd_free(deformed);
        return ffd_fail_memory(error);
    }
    for (size_t i = 0; i < lattice->count; i++)
        rest[i] = deformed[i] = 1;
    lattice->rest_weights = rest;
    lattice->deformed_weights = deformed;
    return FFD_OK;
}

/* Sets the values, and saves the previous ones. */
static void set_values(ffd_lattice *lattice, const point_edit *edit)
{
    for (size_t i = 0; i < edit->count; i++) {
        const size_t point = point_of(edit, i);
        double *const p = lattice->deformed + 3 * point, *const d = lattice->difference + 3 * point;
        const double *const value = edit->values + width_of(edit) * i;
        if (edit->kind == EDIT_WEIGHTS) {
            edit->before[i] = lattice->deformed_weights[point];
            lattice->deformed_weights[point] = *value;
            continue;
        }
        memcpy(edit->before + 6 * i, p, 3 * sizeof *p);
        memcpy(edit->before + 6 * i + 3, d, 3 * sizeof *d);
        for (size_t c = 0; c < 3; c++) {
            const double rest = lattice->rest[3 * point + c];
            p[c] = edit->kind == EDIT_POINTS ? value[c] : rest + value[c];
            d[c] = edit->kind == EDIT_POINTS ? value[c] - rest : value[c];
        }
    }
}

/* Restores the previous values, backwards because a point may have been set twice. */
static void restore(ffd_lattice *lattice, const point_edit *edit)
{
    for (size_t i = edit->count; i-- > 0;) {
        const size_t point = point_of(edit, i);
        if (edit->kind == EDIT_WEIGHTS) {
            lattice->deformed_weights[point] = edit->before[i];
            continue;
        }
        memcpy(lattice->deformed + 3 * point, edit->before + 6 * i, 3 * sizeof(double));
        memcpy(lattice->difference + 3 * point, edit->before + 6 * i + 3, 3 * sizeof(double));
    }
}

/* Takes weights away that make_weights has given. */
static void drop_weights(ffd_lattice *lattice)
{
    ffd_free(lattice->rest_weights);
    ffd_free(lattice->deformed_weights);
    lattice->rest_weights = lattice->deformed_weights = NULL;
}

/* Sets the values, which may be lent by the lattice; a failure changes nothing. */
static ffd_status set_or_restore(ffd_lattice *lattice, point_edit *edit, ffd_error *error)
{
    const size_t width = width_of(edit), kept = width == 1 ? 1 : 6;
    edit->before = ffd_alloc(edit->count, (kept + width) * sizeof(double));
    if (!edit->before)
        return ffd_fail_memory(error);
    double *const values = edit->before + kept * edit->count;
    memcpy(values, edit->values, width * edit->count * sizeof *values);
    edit->values = values;
    set_values(lattice, edit);
    const ffd_status status = ffd_lattice_finish_moved(lattice, error);
    if (status)
        restore(lattice, edit);
    ffd_free(edit->before);
    return status;
}

static ffd_status apply(ffd_lattice *lattice, point_edit *edit, ffd_error *error)
{
    const bool had_weights = lattice->rest_weights;
    TRY(check(lattice, edit, error));
    if (edit->count == 0)
        return FFD_OK;
    if (edit->kind == EDIT_WEIGHTS)
        TRY(make_weights(lattice, error));
    const ffd_status status = set_or_restore(lattice, edit, error);
    if (status) {
        if (!had_weights)
            drop_weights(lattice);
        ffd_lattice_finish_moved(lattice, NULL);
    }
    lattice->edited = lattice->edited || !status;
    return status;
}

ffd_status ffd_lattice_set_points(ffd_lattice *lattice, const size_t *index, size_t count, const double *xyz,
                                  ffd_error *error)
{
    return apply(lattice, &(point_edit){EDIT_POINTS, index, count, xyz, NULL}, error);
}

ffd_status ffd_lattice_set_offsets(ffd_lattice *lattice, const size_t *index, size_t count, const double *xyz,
                                   ffd_error *error)
{
    return apply(lattice, &(point_edit){EDIT_OFFSETS, index, count, xyz, NULL}, error);
}

ffd_status ffd_lattice_set_weights(ffd_lattice *lattice, const size_t *index, size_t count,
                                   const double *weights, ffd_error *error)
{
    return apply(lattice, &(point_edit){EDIT_WEIGHTS, index, count, weights, NULL}, error);
}

const double *ffd_lattice_get_offsets(const ffd_lattice *lattice)
{
    return lattice->difference;
}

size_t ffd_lattice_get_knots(const ffd_lattice *lattice, int direction, const double **knots)
{
    const knot_vector *const of = &lattice->knots[direction];
    *knots = of->t;
    return of->functions + (size_t)of->degree + 1;
}
