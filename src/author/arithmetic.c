/* arithmetic.c - ffd_lattice_strength, ffd_lattice_blend, ffd_lattice_add: sums of what lattices of one rest
   do. A sum of the form x + 0 y is x to the bit. */
#include "author/made.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include <ffd/author.h>
#include <math.h>
#include <string.h>

/* Refuses weights that a volume cannot have. */
static ffd_status check_weights(const made_lattice *made, ffd_error *error)
{
    for (size_t i = 0; made->moved_weights && i < made->from->count; i++)
        if (!(made->moved_weights[i] > 0))
            return ffd_fail(error, FFD_E_INVALID,
                            "the weight of control point %zu would become %g, but weights are positive", i,
                            made->moved_weights[i]);
    return FFD_OK;
}

static ffd_status check_number(double number, const char *what, ffd_error *error)
{
    return isfinite(number) ? FFD_OK : ffd_fail(error, FFD_E_ARGUMENT, "%s is not finite", what);
}

/* No zero gets a sign. */
static ffd_status scale(made_lattice *made, double strength, ffd_error *error)
{
    for (size_t i = 0; i < 3 * made->from->count; i++)
        made->offsets[i] = strength < 0 ? 0 - -strength * made->offsets[i] : strength * made->offsets[i];
    for (size_t i = 0; made->weights && i < made->from->count; i++)
        made->moved_weights[i] = (1 - strength) * made->weights[i] + strength * made->moved_weights[i];
    return check_weights(made, error);
}

ffd_status ffd_lattice_strength(const ffd_lattice *lattice, double strength, ffd_lattice **result,
                                ffd_error *error)
{
    made_lattice made = {0};
    ffd_status status;
    *result = NULL;
    TRY(check_number(strength, "the strength", error));
    TRY_END(ffd_made_begin_same(lattice, &made, error));
    TRY_END(scale(&made, strength, error));
    TRY_END(ffd_made_finish(&made, result, error));
end:
    ffd_made_free(&made);
    return status;
}

static bool is_same(const double *a, const double *b, size_t count)
{
    return (!a && !b) || (a && b && memcmp(a, b, count * sizeof *a) == 0);
}

/* Whether a box that is still to be laid round a mesh is another one. */
static bool has_other_box(const ffd_lattice *a, const ffd_lattice *b)
{
    const lattice_spec *const x = a->spec, *const y = b->spec;
    return x->spacing != y->spacing || !is_same(x->margin, y->margin, 3) ||
           !is_same(x->box_axes, y->box_axes, 9);
}

static bool has_other_knots(const ffd_lattice *a, const ffd_lattice *b)
{
    for (int d = 0; d < 3; d++) {
        const knot_vector *const x = &a->knots[d], *const y = &b->knots[d];
        if (ffd_knots_closed(x) != ffd_knots_closed(y) ||
            !is_same(x->t, y->t, x->functions + (size_t)x->degree + 1))
            return true;
    }
    return false;
}

/* Lattices whose numbers are added have one rest, to the bit. */
static ffd_status check_same_rest(const ffd_lattice *a, const ffd_lattice *b, ffd_error *error)
{
    const char *what = NULL;
    for (int d = 0; d < 3 && !what; d++)
        what = a->size[d] != b->size[d] ? "size" : a->knots[d].degree != b->knots[d].degree ? "degree" : NULL;
    if (!what && has_other_knots(a, b))
        what = "knots";
    if (!what && (!is_same(a->rest, b->rest, 3 * a->count) || (!a->rest && has_other_box(a, b))))
        what = "rest";
    if (!what && a->rest_weights && b->rest_weights && !is_same(a->rest_weights, b->rest_weights, a->count))
        what = "weights at rest";
    return what ? ffd_fail(error, FFD_E_INVALID,
                           "the two lattices differ in %s: refine one of them, or give both the same rest",
                           what)
                : FFD_OK;
}

/* Weights at rest of a lattice that has none are 1. */
static ffd_status check_ones(const double *weights, size_t count, ffd_error *error)
{
    for (size_t i = 0; i < count; i++)
        if (weights[i] != 1)
            return ffd_fail(error, FFD_E_INVALID, "the two lattices differ in weights at rest");
    return FFD_OK;
}

/* Gives both weights if one has them. */
static ffd_status match_weights(made_lattice *made, const ffd_lattice *other, ffd_error *error)
{
    const bool has_own = made->weights;
    if (has_own && !other->rest_weights)
        return check_ones(made->weights, other->count, error);
    if (has_own || !other->rest_weights)
        return FFD_OK;
    TRY(check_ones(other->rest_weights, other->count, error));
    return ffd_made_give_weights(made, error);
}

/* D <- own D + other D_other, and so the moved weights; or of these their difference from those at rest. */
typedef struct lattice_sum {
    double own, other;
    bool by_difference;
} lattice_sum;

static ffd_status sum(made_lattice *made, const ffd_lattice *other, const lattice_sum *by, ffd_error *error)
{
    const double *const offsets = other->rest ? other->difference : other->spec->deformed_offsets;
    TRY(match_weights(made, other, error));
    for (size_t i = 0; i < 3 * other->count; i++)
        made->offsets[i] = by->own * made->offsets[i] + by->other * (offsets ? offsets[i] : 0);
    for (size_t i = 0; made->weights && i < other->count; i++) {
        const double h = made->weights[i], q = other->deformed_weights ? other->deformed_weights[i] : 1;
        made->moved_weights[i] =
            by->own * made->moved_weights[i] + by->other * (by->by_difference ? q - h : q);
    }
    return check_weights(made, error);
}

static ffd_status join(const ffd_lattice *lattice, const ffd_lattice *other, const lattice_sum *by,
                       ffd_lattice **result, ffd_error *error)
{
    made_lattice made = {0}, check = {0};
    ffd_status status;
    *result = NULL;
    TRY_END(ffd_made_begin(other, &check, error)); /* it too needs positions for its moves */
    TRY_END(ffd_made_begin_same(lattice, &made, error));
    TRY_END(check_same_rest(lattice, other, error));
    TRY_END(sum(&made, other, by, error));
    TRY_END(ffd_made_finish(&made, result, error));
end:
    ffd_made_free(&made);
    return status;
}

ffd_status ffd_lattice_blend(const ffd_lattice *lattice, const ffd_lattice *other, double t,
                             ffd_lattice **result, ffd_error *error)
{
    const lattice_sum by = {1 - t, t, false};
    *result = NULL;
    TRY(check_number(t, "the share of the other lattice", error));
    return join(lattice, other, &by, result, error);
}

ffd_status ffd_lattice_add(const ffd_lattice *lattice, const ffd_lattice *other, ffd_lattice **result,
                           ffd_error *error)
{
    const lattice_sum by = {1, 1, true};
    return join(lattice, other, &by, result, error);
}
