#include "lattice/move_exact.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include <stdio.h>
#include <string.h>

/* Tolerance for straight rows and flat layers, relative to the coordinates: the rounding of earlier moves. */
#define STRAIGHT 1e-13

/* The selected layers along one direction. */
typedef struct arcs {
    const exact_bend *bend;
    int direction;
    size_t step;        /* index difference of consecutive points in the direction */
    size_t first, last; /* layers; both are joints between arcs */
    double *along;      /* the coordinate s of each layer */
    double slack;
    ffd_error *error;
} arcs;

static ffd_status refuse(const arcs *a, const char *reason)
{
    return ffd_fail_at(a->error, FFD_E_INVALID, a->bend->file, a->bend->ready->move.line,
                       a->bend->ready->move.pointer, "the bend cannot be exact: %s", reason);
}

/* Returns a control point, reflected if the step is a mirror image. */
static void point_of(const exact_bend *bend, size_t point, double p[3])
{
    const double *const q = bend->lattice->deformed + 3 * point;
    for (int c = 0; c < 3; c++)
        p[c] = q[c];
    if (bend->plane)
        ffd_mirror_point(bend->plane, q, p);
}

static double along_of(const exact_bend *bend, size_t point)
{
    double p[3];
    point_of(bend, point, p);
    return ffd_move_along(&bend->ready->move, p);
}

/* Finds the range of the selected points in each direction. Returns whether all points in it are selected. */
static bool find_block(const exact_bend *bend, size_t first[3], size_t last[3])
{
    const size_t *const size = bend->lattice->size;
    size_t count = 0;
    for (int d = 0; d < 3; d++) {
        first[d] = size[d];
        last[d] = 0;
    }
    for (size_t i = 0; i < bend->lattice->count; i++) {
        const size_t at[3] = {i % size[0], i / size[0] % size[1], i / size[0] / size[1]};
        for (int d = 0; d < 3 && bend->selected[i]; d++) {
            first[d] = at[d] < first[d] ? at[d] : first[d];
            last[d] = at[d] > last[d] ? at[d] : last[d];
        }
        count += bend->selected[i];
    }
    return count == (last[0] - first[0] + 1) * (last[1] - first[1] + 1) * (last[2] - first[2] + 1);
}

/* Finds the lattice direction that extends farthest along the axis, from the first point. */
static void find_direction(arcs *a, const size_t first[3], const size_t last[3])
{
    const size_t *const size = a->bend->lattice->size, steps[3] = {1, size[0], size[0] * size[1]};
    const size_t corner = first[0] + first[1] * steps[1] + first[2] * steps[2];
    const double start = along_of(a->bend, corner);
    double farthest = -1;
    for (int d = 0; d < 3; d++) {
        const double way = fabs(along_of(a->bend, corner + (last[d] - first[d]) * steps[d]) - start);
        if (way > farthest) {
            farthest = way;
            a->direction = d;
        }
    }
    a->step = steps[a->direction];
    a->first = first[a->direction];
    a->last = last[a->direction];
}

/* Requires degree 2 and double knots, so that each arc is the Bezier form of its three layers. */
static ffd_status check_knots(const arcs *a)
{
    const knot_vector *const knots = &a->bend->lattice->knots[a->direction];
    char reason[120];
    bool doubled = !ffd_knots_closed(knots) && knots->points % 2 == 1;
    if (knots->degree != 2) {
        snprintf(reason, sizeof reason, "along the axis, %c, it needs degree 2, not %d", "uvw"[a->direction],
                 knots -> degree);
        return refuse(a, reason);
    }
    for (size_t k = 1; k <= knots->points && doubled; k += 2)
        doubled = knots->t[k] == knots->t[k + 1];
    if (doubled)
        return FFD_OK;
    snprintf(reason, sizeof reason,
             "along the axis, %c, it needs clamped knots with each inner one twice, as 0 0 0 1 1 2 2 2",
             "uvw"[a->direction]);
    return refuse(a, reason);
}

static ffd_status check_layers(const arcs *a, const size_t first[3], const size_t last[3])
{
    const size_t *const size = a->bend->lattice->size;
    for (int d = 0; d < 3; d++)
        if (d != a->direction && (first[d] != 0 || last[d] != size[d] - 1))
            return refuse(a, "it needs all points of a layer, not a part of them");
    if (a->first % 2 == 0 && a->last % 2 == 0)
        return FFD_OK;
    return refuse(a, "its layers begin and end at even indices, where its arcs meet");
}

static size_t layer_of(const arcs *a, size_t point)
{
    return point / a->step % a->bend->lattice->size[a->direction];
}

/* Records s of the layers in the row of the first point, and the rounding tolerance. */
static void find_layers(arcs *a)
{
    double size = a->bend->ready->length;
    for (size_t i = 0; i < a->bend->lattice->count; i++)
        for (int c = 0; c < 3 && a->bend->selected[i]; c++)
            size = larger_of(size, fabs(a->bend->lattice->deformed[3 * i + (size_t)c]));
    a->slack = STRAIGHT * size;
    for (size_t layer = a->first; layer <= a->last; layer++)
        a->along[layer] = along_of(a->bend, layer * a->step);
}

/* Checks that a point is in the plane of its layer, and that its row is parallel to the axis and has equal
   weights. */
static ffd_status check_place(const arcs *a, size_t point)
{
    const exact_bend *const bend = a->bend;
    const double *const weights = bend->lattice->deformed_weights;
    const double *const axis = bend->ready->move.axis;
    const size_t layer = layer_of(a, point), begin = point - (layer - a->first) * a->step;
    double p[3], start[3], away[3];
    point_of(bend, point, p);
    point_of(bend, begin, start);
    for (int c = 0; c < 3; c++)
        away[c] = p[c] - start[c];
    const double along = vec_dot(axis, away);
    for (int c = 0; c < 3; c++)
        away[c] -= along * axis[c];
    if (!(vec_length(away) <= a->slack))
        return refuse(a, "the rows of its points do not run along the axis");
    if (!(fabs(ffd_move_along(&bend->ready->move, p) - a->along[layer]) <= a->slack))
        return refuse(a, "the layers of its points do not stand across the axis");
    if (weights && weights[point] != weights[begin])
        return refuse(a, "the weights of its points differ along the axis");
    return FFD_OK;
}

static double degrees_to(const arcs *a, double along)
{
    const ready_move *const ready = a->bend->ready;
    return ready->move.amount * ((along - ready->first) / ready->length);
}

/* Returns half the angle of the arc of a middle layer. */
static double half_of(const arcs *a, size_t layer)
{
    return 0.5 * degrees_to(a, a->along[layer + 1]) - 0.5 * degrees_to(a, a->along[layer - 1]);
}

static ffd_status check_arcs(const arcs *a)
{
    for (size_t layer = a->first + 1; layer < a->last; layer += 2) {
        const double degrees = 2 * fabs(half_of(a, layer));
        char reason[120];
        if (degrees < 180)
            continue;
        snprintf(reason, sizeof reason, "an arc has less than 180 degrees, not %s; it needs more knots",
                 ffd_number_text(degrees).text);
        return refuse(a, reason);
    }
    return FFD_OK;
}

static ffd_status check(arcs *a)
{
    find_layers(a);
    for (size_t i = 0; i < a->bend->lattice->count; i++)
        if (a->bend->selected[i])
            TRY(check_place(a, i));
    return check_arcs(a);
}

static ffd_status make_weights(ffd_lattice *lattice, ffd_error *error)
{
    if (lattice->deformed_weights)
        return FFD_OK;
    lattice->rest_weights = ffd_alloc(lattice->count, sizeof *lattice->rest_weights);
    lattice->deformed_weights = ffd_alloc(lattice->count, sizeof *lattice->deformed_weights);
    if (!lattice->rest_weights || !lattice->deformed_weights)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < lattice->count; i++)
        lattice->rest_weights[i] = lattice->deformed_weights[i] = 1;
    return FFD_OK;
}

/* Moves a point. A joint goes to its place on the circle. A middle point goes to the intersection of the
   tangents of its arc of angle 2h: at the middle angle, at radius / cos h, with its weight multiplied by cos
   h. */
static void bend_point(const arcs *a, size_t point)
{
    ffd_lattice *const lattice = a->bend->lattice;
    const size_t layer = layer_of(a, point);
    double *const p = lattice->deformed + 3 * point;
    double from[3], to[3], moved[3], more = 0, degrees = degrees_to(a, a->along[layer]);
    if ((layer - a->first) % 2 == 1) {
        const double half = half_of(a, layer);
        double sine, cosine, cosine_of_half;
        ffd_sincos_degrees(half, &sine, &cosine_of_half);
        ffd_sincos_degrees(0.5 * half, &sine, &cosine);
        more = 2 * sine * sine / cosine_of_half;
        degrees = degrees_to(a, a->along[layer - 1]) + half;
        lattice->deformed_weights[point] *= cosine_of_half;
    }
    point_of(a->bend, point, from);
    for (int c = 0; c < 3; c++)
        to[c] = from[c];
    ffd_move_bend(a->bend->ready, degrees, more, to);
    memcpy(moved, to, sizeof moved);
    if (a->bend->plane)
        ffd_mirror_back(a->bend->plane, p, from, to, moved);
    for (int c = 0; c < 3; c++)
        ffd_move_put(moved[c], lattice->rest[3 * point + (size_t)c], &p[c],
                     &lattice->difference[3 * point + (size_t)c]);
}

static ffd_status bend_arcs(arcs *a)
{
    const ready_move *const ready = a->bend->ready;
    ffd_lattice *const lattice = a->bend->lattice;
    a->along = ffd_alloc(lattice->size[a->direction], sizeof *a->along);
    ffd_status status;
    TRY_END(a->along ? FFD_OK : ffd_fail_memory(a->error));
    TRY_END(check(a));
    if (ready->move.amount != 0) {
        TRY_END(make_weights(lattice, a->error));
        for (size_t i = 0; i < lattice->count; i++)
            if (a->bend->selected[i])
                bend_point(a, i);
    }
end:
    ffd_free(a->along);
    return status;
}

ffd_status ffd_move_bend_exactly(const exact_bend *bend, ffd_error *error)
{
    size_t first[3], last[3];
    arcs a = {.bend = bend, .error = error};
    if (!(bend->ready->length > 0))
        return FFD_OK;
    if (!find_block(bend, first, last))
        return refuse(&a, "it needs all points of a layer, not a part of them");
    find_direction(&a, first, last);
    TRY(check_knots(&a));
    TRY(check_layers(&a, first, last));
    return bend_arcs(&a);
}

exact_layers ffd_move_exact_layers(const exact_bend *bend)
{
    size_t first[3], last[3];
    arcs a = {.bend = bend};
    find_block(bend, first, last);
    find_direction(&a, first, last);
    return (exact_layers){a.direction, a.step, a.first, a.last};
}
