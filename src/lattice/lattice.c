#include "lattice/lattice.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/vector/vec.h"
#include "lattice/spec.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct point_name {
    char text[96];
} point_name;

/* Names a control point for messages: "rest point 1,0,2". */
static point_name name_of(const ffd_lattice *lattice, ffd_volume volume, size_t point)
{
    const size_t row = point / lattice->size[0];
    point_name name;
    snprintf(name.text, sizeof name.text, "%s point %zu,%zu,%zu",
             volume == FFD_VOLUME_REST ? "rest" : "deformed", point % lattice->size[0],
             row % lattice->size[1], row / lattice->size[1]);
    return name;
}

static ffd_status check_point(const ffd_lattice *lattice, ffd_volume volume, size_t point, ffd_error *error)
{
    const double *const p = ffd_lattice_get_points(lattice, volume) + 3 * point;
    const double *const weights = ffd_lattice_get_weights(lattice, volume);
    const double weight = weights ? weights[point] : 1;
    if (!(weight > 0 && isfinite(weight)))
        return ffd_fail(error, FFD_E_INVALID, "the weight of %s is %s, not positive and finite",
                        name_of(lattice, volume, point).text, ffd_number_text(weight).text);
    for (int c = 0; c < 3; c++) {
        if (!isfinite(p[c]))
            return ffd_fail(error, FFD_E_INVALID, "%s: %c is %s, not a finite number",
                            name_of(lattice, volume, point).text, "xyz"[c], ffd_number_text(p[c]).text);
        if (!isfinite(weight * p[c]))
            return ffd_fail(error, FFD_E_INVALID, "%s: weight %s times %c, %s, is not finite",
                            name_of(lattice, volume, point).text, ffd_number_text(weight).text, "xyz"[c],
                            ffd_number_text(p[c]).text);
    }
    return FFD_OK;
}

/* x - x is 0 for finite x, else NaN. Compilers vectorise this loop. */
static bool all_finite(const double *numbers, size_t count)
{
    enum { AT_ONCE = 8 };
    double sum[AT_ONCE] = {0}, all = 0;
    size_t i = 0;
    for (; i + AT_ONCE <= count; i += AT_ONCE)
        for (size_t k = 0; k < AT_ONCE; k++)
            sum[k] += numbers[i + k] - numbers[i + k];
    for (; i < count; i++)
        all += numbers[i] - numbers[i];
    for (size_t k = 0; k < AT_ONCE; k++)
        all += sum[k];
    return all == 0;
}

static ffd_status check_points(const ffd_lattice *lattice, ffd_error *error)
{
    if (!lattice->rest_weights && all_finite(lattice->rest, 3 * lattice->count) &&
        all_finite(lattice->deformed, 3 * lattice->count))
        return FFD_OK;
    for (int volume = FFD_VOLUME_REST; volume <= FFD_VOLUME_DEFORMED; volume++)
        for (size_t i = 0; i < lattice->count; i++)
            TRY(check_point(lattice, (ffd_volume)volume, i, error));
    return FFD_OK;
}

static void find_range(const ffd_lattice *lattice, double min[3], double max[3])
{
    for (int c = 0; c < 3; c++)
        min[c] = max[c] = lattice->rest[c];
    for (size_t i = 1; i < lattice->count; i++)
        for (size_t c = 0; c < 3; c++) {
            const double x = lattice->rest[3 * i + c];
            min[c] = x < min[c] ? x : min[c];
            max[c] = x > max[c] ? x : max[c];
        }
}

static ffd_status make_diagonal(ffd_lattice *lattice, ffd_error *error)
{
    double min[3], max[3];
    int longest = 0;
    find_range(lattice, min, max);
    for (int c = 1; c < 3; c++)
        if (max[c] - min[c] > max[longest] - min[longest])
            longest = c;
    /* Scaled by the longest side, because squares of the sides could overflow or underflow. */
    const double length = max[longest] - min[longest];
    double sum = 0;
    for (int c = 0; c < 3 && length > 0; c++) {
        const double part = (max[c] - min[c]) / length;
        sum += part * part;
    }
    lattice->diagonal = length * sqrt(sum);
    if (isfinite(lattice->diagonal))
        return FFD_OK;
    return ffd_fail(error, FFD_E_INVALID,
                    "the rest points reach from %s to %s in %c, which is too far for a double",
                    ffd_number_text(min[longest]).text, ffd_number_text(max[longest]).text, "xyz"[longest]);
}

/* Raises the largest magnitude of each coordinate of the points. */
static void raise_greatest(const double *points, size_t count, double greatest[3])
{
    double most[3] = {greatest[0], greatest[1], greatest[2]};
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++)
            most[c] = larger_of(most[c], fabs(points[3 * i + c]));
    for (int c = 0; c < 3; c++)
        greatest[c] = most[c];
}

static ffd_status fail_difference(const ffd_lattice *lattice, size_t c, ffd_error *error)
{
    return ffd_fail(error, FFD_E_INVALID, "%s: the distance from %s to %s is too large for a double",
                    name_of(lattice, FFD_VOLUME_DEFORMED, c / 3).text, ffd_number_text(lattice->rest[c]).text,
                    ffd_number_text(lattice->deformed[c]).text);
}

/* Returns the largest magnitude that a coordinate may have so that its products with binomial coefficients do
   not overflow. */
static double largest_number(const ffd_lattice *lattice)
{
    double largest = DBL_MAX;
    for (int a = 0; a < 3; a++) {
        const int degree = lattice->knots[a].degree;
        double binomial = 1; /* the central binomial coefficient */
        for (int i = 0; i < degree / 2; i++)
            binomial = binomial * (degree - i) / (i + 1);
        largest /= binomial;
    }
    return largest;
}

static ffd_status check_difference(const ffd_lattice *lattice, ffd_error *error)
{
    const double *const difference = lattice->difference;
    const double largest = largest_number(lattice);
    for (size_t c = 0; c < 3 * lattice->count; c++) {
        if (!(fabs(difference[c]) <= largest))
            return fail_difference(lattice, c, error);
        if (!lattice->has_uvw_by_p && !(fabs(lattice->rest[c]) <= largest))
            return ffd_fail(error, FFD_E_INVALID, "%s: %s is too large to compute with",
                            name_of(lattice, FFD_VOLUME_REST, c / 3).text,
                            ffd_number_text(lattice->rest[c]).text);
    }
    return FFD_OK;
}

/* Whether the weights move the volume: a common factor of all of them, but for its rounding, does not. */
static bool weights_move(const ffd_lattice *lattice)
{
    const double *const rest = lattice->rest_weights, *const deformed = lattice->deformed_weights;
    if (!rest || memcmp(rest, deformed, lattice->count * sizeof *rest) == 0)
        return false;
    const double factor = deformed[0] / rest[0];
    if (!(factor >= DBL_MIN))
        return true;
    for (size_t i = 1; i < lattice->count; i++)
        if (!(fabs(deformed[i] / rest[i] - factor) <= 4 * DBL_EPSILON * factor))
            return true;
    return false;
}

/* Marks the control points that are moved. */
static void mark_moved(ffd_lattice *lattice)
{
    const double *const difference = lattice->difference;
    for (size_t i = 0; i < lattice->count; i++) {
        const bool moved = difference[3 * i] != 0 || difference[3 * i + 1] != 0 || difference[3 * i + 2] != 0;
        lattice->moved[i] = moved ? POINT_MOVED : 0;
    }
    lattice->weights_moved = weights_move(lattice);
    for (size_t i = 0; i < lattice->count && lattice->weights_moved; i++)
        if (lattice->rest_weights[i] != lattice->deformed_weights[i])
            lattice->moved[i] = POINT_MOVED;
}

bool ffd_lattice_is_still(const ffd_lattice *lattice)
{
    const double *const offsets = lattice->rest ? NULL : lattice->spec->deformed_offsets;
    for (size_t i = 0; lattice->rest && i < lattice->count; i++)
        if (lattice->moved[i] & POINT_MOVED)
            return false;
    for (size_t i = 0; offsets && i < 3 * lattice->count; i++)
        if (offsets[i] != 0)
            return false;
    return true;
}

static bool weight_moved(const ffd_lattice *lattice, size_t point)
{
    return lattice->weights_moved && lattice->rest_weights[point] != lattice->deformed_weights[point];
}

/* Returns whether two control points have the same displacement, other than 0, and unmoved weights. */
static bool moves_like(const ffd_lattice *lattice, size_t a, size_t b)
{
    const double *const x = lattice->difference + 3 * a, *const y = lattice->difference + 3 * b;
    return lattice->moved[a] && x[0] == y[0] && x[1] == y[1] && x[2] == y[2] && !weight_moved(lattice, a) &&
           !weight_moved(lattice, b);
}

/* Marks the control points that have the same displacement as the next one in a direction; in a closed
   direction the first one follows the last. */
static void mark_like_next(ffd_lattice *lattice)
{
    const size_t *const size = lattice->size, step[3] = {1, size[0], size[0] * size[1]};
    for (size_t i = 0; i < lattice->count; i++)
        for (int a = 0; a < 3 && lattice->moved[i]; a++) {
            const size_t at = i / step[a] % size[a];
            const size_t next = at + 1 < size[a] ? i + step[a] : i - at * step[a];
            if (!moves_like(lattice, i, next))
                continue;
            lattice->moved[i] |= (unsigned char)(POINT_LIKE_NEXT_U << a);
            lattice->moves_alike = true;
        }
}

/* Computes d uvw / d p = (d uvw / d t) (d p / d t)^-1. */
static void make_inverse(ffd_lattice *lattice)
{
    lattice->has_uvw_by_p = lattice->form == REST_BOX_AFFINE && !lattice->rest_weights &&
                            mat_invert(lattice->frame, lattice->uvw_by_p);
    for (int a = 0; a < 3 && lattice->has_uvw_by_p; a++) {
        const double side = ffd_knots_last(&lattice->knots[a]) - ffd_knots_first(&lattice->knots[a]);
        for (int c = 0; c < 3; c++)
            lattice->uvw_by_p[3 * a + c] *= side;
    }
}

/* Returns whether d+1 consecutive points in a direction, starting with this one, have equal displacements
   and, for the flags of rows and planes, each begin a row or plane with equal displacements. */
static bool begins_alike(const ffd_lattice *lattice, size_t point, int a, unsigned char begins)
{
    const size_t steps[3] = {1, lattice->size[0], lattice->size[0] * lattice->size[1]};
    const size_t size = lattice->size[a], step = steps[a], at = point / step % size;
    const size_t order = (size_t)lattice->knots[a].degree + 1;
    const bool closed = lattice->knots[a].functions > size;
    if (!closed && at + order > size)
        return false;
    for (size_t s = 0; s < order; s++) {
        const unsigned char bits = lattice->moved[point - at * step + (at + s) % size * step];
        const unsigned char wanted = (unsigned char)(begins | (s + 1 < order ? POINT_LIKE_NEXT_U << a : 0));
        if ((bits & wanted) != wanted)
            return false;
    }
    return true;
}

static void mark_blocks(ffd_lattice *lattice)
{
    for (int a = 0; a < 3 && lattice->moves_alike; a++) {
        const unsigned char begins = a == 0 ? 0 : (unsigned char)(POINT_BEGINS_ROW << (a - 1));
        for (size_t i = 0; i < lattice->count; i++)
            if ((lattice->moved[i] & begins) == begins && begins_alike(lattice, i, a, begins))
                lattice->moved[i] |= (unsigned char)(POINT_BEGINS_ROW << a);
    }
}

ffd_status ffd_lattice_make_difference(ffd_lattice *lattice, ffd_error *error)
{
    if (!lattice->difference)
        lattice->difference = ffd_alloc_whole(lattice->count, 3 * sizeof *lattice->difference);
    if (!lattice->difference)
        return ffd_fail_memory(error);
    for (size_t c = 0; c < 3 * lattice->count; c++)
        lattice->difference[c] = lattice->deformed[c] - lattice->rest[c];
    return FFD_OK;
}

ffd_status ffd_lattice_finish_moved(ffd_lattice *lattice, ffd_error *error)
{
    TRY(check_points(lattice, error));
    TRY(make_diagonal(lattice, error));
    memset(lattice->greatest, 0, sizeof lattice->greatest);
    raise_greatest(lattice->rest, lattice->count, lattice->greatest);
    raise_greatest(lattice->deformed, lattice->count, lattice->greatest);
    if (!lattice->moved)
        lattice->moved = ffd_alloc(lattice->count, sizeof *lattice->moved);
    if (!lattice->moved)
        return ffd_fail_memory(error);
    lattice->moves_alike = false;
    make_inverse(lattice);
    TRY(check_difference(lattice, error));
    mark_moved(lattice);
    mark_like_next(lattice);
    mark_blocks(lattice);
    return FFD_OK;
}

void ffd_lattice_get_size(const ffd_lattice *lattice, size_t size[3])
{
    for (int a = 0; a < 3; a++)
        size[a] = lattice->size[a];
}

void ffd_lattice_get_degree(const ffd_lattice *lattice, int degree[3])
{
    for (int a = 0; a < 3; a++)
        degree[a] = lattice->knots[a].degree;
}

void ffd_lattice_get_domain(const ffd_lattice *lattice, double lo[3], double hi[3])
{
    for (int a = 0; a < 3; a++) {
        lo[a] = ffd_knots_first(&lattice->knots[a]);
        hi[a] = ffd_knots_last(&lattice->knots[a]);
    }
}

const double *ffd_lattice_get_points(const ffd_lattice *lattice, ffd_volume volume)
{
    return volume == FFD_VOLUME_REST ? lattice->rest : lattice->deformed;
}

const double *ffd_lattice_get_weights(const ffd_lattice *lattice, ffd_volume volume)
{
    return volume == FFD_VOLUME_REST ? lattice->rest_weights : lattice->deformed_weights;
}
