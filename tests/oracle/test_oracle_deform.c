/* test_oracle_deform.c - displacement, its gradient, normals and tangents against the oracle. */
#include "volume_sample.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* A move by a vector, which adds to the displacement as it is: the moved points cannot tell it to the last
   digit. It may come after a scaling. */
typedef struct shift_move {
    bool here, scaled;
    int first[3], last[3];
    double by[3];
} shift_move;

static const double scale_factor[3] = {1.5, 0.75, 2.25}, scale_about[3] = {0.5, 0.25, -1};

typedef struct edited {
    trial *t;
    sample *s;
    ffd_lattice *lattice;
    oracle_volume rest, deformed;
    bool weights_moved;
    shift_move shift;
} edited;

static bool open_edited(edited *x, trial *t, sample *s, const shift_move *shift)
{
    sample_write(s);
    *x = (edited){.t = t,
                  .s = s,
                  .lattice = trial_parse(t, s),
                  .weights_moved = s->deformed_weights != NULL,
                  .shift = *shift};
    if (!x->lattice)
        return false;
    x->rest = sample_volume(s, x->lattice, FFD_VOLUME_REST);
    x->deformed = sample_volume(s, x->lattice, FFD_VOLUME_DEFORMED);
    return true;
}

static void close_edited(edited *x)
{
    oracle_free(&x->rest);
    oracle_free(&x->deformed);
    ffd_lattice_destroy(&x->lattice);
}

/* Where a control point is along each axis. */
static void indices_of(const sample *s, size_t point, int i[3])
{
    for (int a = 0; a < 3; a++) {
        const size_t n = (size_t)s->axis[a].n;
        i[a] = (int)(point % n);
        point /= n;
    }
}

static bool is_shifted(const edited *x, size_t point)
{
    int i[3];
    indices_of(x->s, point, i);
    for (int a = 0; a < 3; a++)
        if (i[a] < x->shift.first[a] || i[a] > x->shift.last[a])
            return false;
    return true;
}

/* Coordinate a of a control point's displacement. */
static long double difference_of(const edited *x, size_t point, size_t a)
{
    const long double rest = x->rest.points[3 * point + a];
    const double from = (double)rest;
    if (!x->shift.here)
        return x->deformed.points[3 * point + a] - rest;
    const double scaled = x->shift.scaled ? scale_about[a] + scale_factor[a] * (from - scale_about[a]) : from;
    return (scaled - from) + (is_shifted(x, point) ? x->shift.by[a] : 0);
}

static bool is_weight_moved(const edited *x, size_t point)
{
    return x->rest.weights && x->rest.weights[point] != x->deformed.weights[point];
}

/* What the displacement and its derivative must be, and what their errors are relative to. */
typedef struct expectation {
    long double delta[3], delta_size[3];
    long double rest[9], deformed[9], terms[9]; /* J_P, J_Q, the sizes of the sums that both are */
    long double gradient[9], gradient_size[9];
    bool regular;
} expectation;

/* Unmoved weights: the volume of the differences Q - P. Moved ones: C_Q - C_P, with the size of both. */
static void displacement(const edited *x, const long double uvw[3], expectation *e, long double slope[9],
                         long double slope_size[9])
{
    if (!x->weights_moved) {
        oracle_volume difference = oracle_make(x->s->axis, x->rest.weights != NULL);
        for (size_t i = 0; i < 3 * oracle_count(&difference); i++)
            difference.points[i] = difference_of(x, i / 3, i % 3);
        for (size_t i = 0; difference.weights && i < oracle_count(&difference); i++)
            difference.weights[i] = x->rest.weights[i];
        oracle_evaluate(&difference, uvw, e->delta, slope);
        oracle_magnitude(&difference, uvw, e->delta_size, slope_size);
        oracle_free(&difference);
        return;
    }
    long double point[2][3], jacobian[2][9], size[2][3], steepness[2][9];
    const oracle_volume *const volumes[2] = {&x->rest, &x->deformed};
    for (int k = 0; k < 2; k++) {
        oracle_evaluate(volumes[k], uvw, point[k], jacobian[k]);
        oracle_magnitude(volumes[k], uvw, size[k], steepness[k]);
    }
    for (int a = 0; a < 3; a++) {
        e->delta[a] = point[1][a] - point[0][a];
        e->delta_size[a] = size[0][a] + size[1][a];
    }
    for (int i = 0; i < 9; i++) {
        slope[i] = jacobian[1][i] - jacobian[0][i];
        slope_size[i] = steepness[0][i] + steepness[1][i];
    }
}

/* E = D J_P^-1. An error d of D and j of J_P changes it by d |J^-1| + |E| j |J^-1|. */
static void expect(const edited *x, const long double uvw[3], expectation *e)
{
    long double slope[9], slope_size[9], point[3], inverse[9], size[3], rest_size[9];
    displacement(x, uvw, e, slope, slope_size);
    oracle_evaluate(&x->rest, uvw, point, e->rest);
    oracle_evaluate(&x->deformed, uvw, point, e->deformed);
    oracle_magnitude(&x->deformed, uvw, size, e->terms);
    oracle_magnitude(&x->rest, uvw, size, rest_size);
    for (int i = 0; i < 9; i++)
        e->terms[i] += rest_size[i];
    e->regular = oracle_invert(e->rest, inverse);
    for (int r = 0; e->regular && r < 3; r++) {
        long double row[3];
        for (int c = 0; c < 3; c++) {
            row[c] = 0;
            for (int k = 0; k < 3; k++)
                row[c] += slope[3 * r + k] * inverse[3 * k + c];
            e->gradient[3 * r + c] = row[c];
        }
        for (int c = 0; c < 3; c++) {
            long double size_rc = 0;
            for (int k = 0; k < 3; k++) {
                size_rc += slope_size[3 * r + k] * fabsl(inverse[3 * k + c]);
                for (int l = 0; l < 3; l++)
                    size_rc += fabsl(row[k]) * rest_size[3 * k + l] * fabsl(inverse[3 * l + c]);
            }
            e->gradient_size[3 * r + c] = size_rc;
        }
    }
}

static void check_gradient(const edited *x, const double uvw[3], const double gradient[9],
                           const expectation *e)
{
    for (int i = 0; i < 9; i++)
        trial_check(x->t, x->s, fabsl(gradient[i] - e->gradient[i]) <= 1e-13L * e->gradient_size[i],
                    "at %.17g %.17g %.17g: gradient[%d] = %.17g, expected %.20Lg, off by %.2Lg of its scale",
                    uvw[0], uvw[1], uvw[2], i, gradient[i], e->gradient[i],
                    fabsl(gradient[i] - e->gradient[i]) / e->gradient_size[i]);
    /* F J_P = J_Q, which knows nothing of the differences; the rounding is that of the sums here, and of Q
       where a vector was added to it. */
    const long double slack = x->shift.here ? DBL_EPSILON : 100 * LDBL_EPSILON;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            long double product = e->rest[3 * r + c], allowed = 0;
            long double rounding = e->terms[3 * r + c];
            for (int k = 0; k < 3; k++) {
                const long double term = gradient[3 * r + k] * e->rest[3 * k + c];
                product += term;
                rounding += fabsl(gradient[3 * r + k]) * e->terms[3 * k + c];
                allowed += 1e-13L * e->gradient_size[3 * r + k] * fabsl(e->rest[3 * k + c]);
            }
            const long double off = fabsl(product - e->deformed[3 * r + c]);
            trial_check(x->t, x->s, off <= allowed + slack * rounding,
                        "at %.17g %.17g %.17g: (F J_P)[%d][%d] = %.20Lg, J_Q has %.20Lg", uvw[0], uvw[1],
                        uvw[2], r, c, product, e->deformed[3 * r + c]);
        }
}

/* cof(F) n, as the cross product of the images of two tangents across n. */
static void moved_normal(const double gradient[9], const double normal[3], long double result[3],
                         long double *size)
{
    int least = 0;
    for (int a = 1; a < 3; a++)
        if (fabs(normal[a]) < fabs(normal[least]))
            least = a;
    const int b = (least + 1) % 3, c = (least + 2) % 3;
    long double first[3] = {0, 0, 0}, second[3], image[2][3], length2 = 0;
    first[b] = normal[c];
    first[c] = -(long double)normal[b];
    for (int a = 0; a < 3; a++) { /* second = n x first, so that first x second points along n */
        const int p = (a + 1) % 3, q = (a + 2) % 3;
        second[a] = normal[p] * first[q] - normal[q] * first[p];
        length2 += first[a] * first[a];
    }
    *size = 0;
    for (int r = 0; r < 3; r++) {
        image[0][r] = first[r];
        image[1][r] = second[r];
        for (int k = 0; k < 3; k++) {
            image[0][r] += gradient[3 * r + k] * first[k];
            image[1][r] += gradient[3 * r + k] * second[k];
            *size += (1 + fabsl(gradient[3 * r + k]));
        }
    }
    *size *= *size;
    for (int a = 0; a < 3; a++) {
        const int p = (a + 1) % 3, q = (a + 2) % 3;
        result[a] = (image[0][p] * image[1][q] - image[0][q] * image[1][p]) / length2;
    }
}

static long double length3(const long double v[3])
{
    return sqrtl(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

static void check_unit(trial *t, const sample *s, const char *what, const double found[3],
                       const long double v[3], long double size)
{
    const long double length = length3(v);
    for (int a = 0; a < 3; a++)
        trial_check(t, s, fabsl(found[a] - v[a] / length) <= 1e-13L * (1 + size / length),
                    "%s[%d] = %.17g, expected %.20Lg (collapsed to %.3Lg)", what, a, found[a], v[a] / length,
                    length / size);
}

static void check_directions(trial *t, const sample *s, const double gradient[9], draw *random)
{
    double normal[3], tangent[3], result[3], turned[3], alone[3];
    long double expected[3], size, along = 0, image[3];
    random_direction(random, normal);
    random_direction(random, tangent);
    moved_normal(gradient, normal, expected, &size);
    const ffd_direction_outcome moved = ffd_deform_normal(gradient, normal, result);
    if (length3(expected) < 1e-12L * size)
        return;
    trial_check(t, s, moved == FFD_DIRECTION_CARRIED, "normal: outcome %d", (int)moved);
    check_unit(t, s, "normal", result, expected, size);
    memcpy(turned, normal, sizeof turned);
    ffd_deform_normal(gradient, turned, turned);
    trial_check(t, s, memcmp(turned, result, sizeof turned) == 0, "normal in place differs");

    for (int r = 0; r < 3; r++) {
        image[r] = tangent[r];
        for (int k = 0; k < 3; k++)
            image[r] += (long double)gradient[3 * r + k] * tangent[k];
    }
    const ffd_direction_outcome bent = ffd_deform_tangent(gradient, tangent, NULL, alone);
    trial_check(t, s, bent == FFD_DIRECTION_CARRIED, "tangent: outcome %d", (int)bent);
    check_unit(t, s, "tangent", alone, image, sqrtl(size));
    for (int a = 0; a < 3; a++)
        along += image[a] * result[a];
    for (int a = 0; a < 3; a++)
        image[a] -= along * result[a];
    if (length3(image) < 1e-3L * sqrtl(size))
        return;
    ffd_deform_tangent(gradient, tangent, result, alone);
    check_unit(t, s, "tangent across the normal", alone, image, sqrtl(size));
}

static bool any_bit(const double *values, int count)
{
    for (int i = 0; i < count; i++) {
        const double zero = 0;
        if (memcmp(&values[i], &zero, sizeof zero) != 0)
            return true;
    }
    return false;
}

typedef enum support { SUPPORT_AWAY, SUPPORT_EDGE, SUPPORT_WITHIN } support;

/* Where u is relative to the support of control point i's function: outside, on its end, or with a share of
 * it. */
static support support_of(const oracle_axis *axis, int i, long double u, long double share)
{
    if (share > 0)
        return SUPPORT_WITHIN;
    for (int image = i; image < (axis->closed ? axis->n + axis->degree : axis->n); image += axis->n)
        if (u >= oracle_knot(axis, image) && u <= oracle_knot(axis, image + axis->degree + 1))
            return SUPPORT_EDGE;
    return SUPPORT_AWAY;
}

/* Of a place: where it is relative to the supports of each axis' functions. */
typedef struct supports {
    support side[3][ORACLE_MAX_POINTS];
} supports;

static void find_supports(const sample *s, const long double uvw[3], supports *found)
{
    for (int a = 0; a < 3; a++) {
        long double n[ORACLE_MAX_POINTS];
        oracle_factors(&s->axis[a], uvw[a], n, NULL);
        for (int i = 0; i < s->axis[a].n; i++)
            found->side[a][i] = support_of(&s->axis[a], i, uvw[a], n[i]);
    }
}

/* Where the place is relative to the support of a control point. */
static support support_of_point(const edited *x, const supports *place, size_t point)
{
    support here = SUPPORT_WITHIN;
    int i[3];
    indices_of(x->s, point, i);
    for (int a = 0; a < 3; a++)
        here = place->side[a][i[a]] < here ? place->side[a][i[a]] : here;
    return here;
}

/* The nearest that the place is to a moved control point's support. */
static support nearest_support(const edited *x, const supports *place)
{
    support nearest = SUPPORT_AWAY;
    for (size_t at = 0; at < oracle_count(&x->rest); at++) {
        bool moved = is_weight_moved(x, at);
        for (size_t a = 0; a < 3; a++)
            moved = moved || difference_of(x, at, a) != 0;
        const support here = moved ? support_of_point(x, place, at) : SUPPORT_AWAY;
        nearest = here > nearest ? here : nearest;
    }
    return nearest;
}

/* Whether all control points with a share in the place have one displacement and their weights at rest. */
static bool act_alike(const edited *x, const supports *place, double common[3])
{
    bool any = false;
    for (size_t at = 0; at < oracle_count(&x->rest); at++) {
        if (support_of_point(x, place, at) != SUPPORT_WITHIN)
            continue;
        if (is_weight_moved(x, at))
            return false;
        for (size_t a = 0; a < 3; a++) {
            const double difference = (double)difference_of(x, at, a);
            if (any && difference != common[a])
                return false;
            common[a] = difference;
        }
        any = true;
    }
    return any;
}

static void check_alike(const edited *x, const double uvw[3], const supports *place, const double delta[3])
{
    double common[3] = {0, 0, 0};
    if (!act_alike(x, place, common))
        return;
    trial_check(x->t, x->s, delta[0] == common[0] && delta[1] == common[1] && delta[2] == common[2],
                "at %.17g %.17g %.17g: %.17g %.17g %.17g, but all that acts moves by %.17g %.17g %.17g",
                uvw[0], uvw[1], uvw[2], delta[0], delta[1], delta[2], common[0], common[1], common[2]);
}

static bool any_not_zero(const double *numbers, int count)
{
    for (int i = 0; i < count; i++)
        if (numbers[i] != 0)
            return true;
    return false;
}

static void check_displacement(const edited *x, draw *random)
{
    double uvw[3], delta[3], gradient[9], alone[3];
    long double at[3];
    for (int a = 0; a < 3; a++) {
        const long double first = oracle_first(&x->s->axis[a]), last = oracle_last(&x->s->axis[a]);
        uvw[a] = (double)(first + (last - first) * (long double)draw_unit(random));
        if (random_chance(random, 0.1))
            uvw[a] = (double)(random_chance(random, 0.5) || x->s->axis[a].closed ? first : last);
        at[a] = oracle_wrap(&x->s->axis[a], uvw[a]);
    }
    const int moved = ffd_displacement(x->lattice, uvw, delta, gradient);
    const int moved_alone = ffd_displacement(x->lattice, uvw, alone, NULL);
    trial_check(x->t, x->s, moved == moved_alone && memcmp(delta, alone, sizeof delta) == 0,
                "delta differs with and without the gradient");
    supports place;
    find_supports(x->s, at, &place);
    const support near = nearest_support(x, &place);
    if (near == SUPPORT_AWAY) {
        trial_check(x->t, x->s, moved == 0, "at %.17g %.17g %.17g: returned %d outside every support", uvw[0],
                    uvw[1], uvw[2], moved);
        trial_check(x->t, x->s, !any_bit(delta, 3) && !any_bit(gradient, 9),
                    "at %.17g %.17g %.17g: delta %g %g %g outside every support", uvw[0], uvw[1], uvw[2],
                    delta[0], delta[1], delta[2]);
        return;
    }
    expectation e;
    expect(x, at, &e);
    trial_check(x->t, x->s, moved == 1 || near == SUPPORT_EDGE,
                "at %.17g %.17g %.17g: returned %d in a support", uvw[0], uvw[1], uvw[2], moved);
    for (int r = 0; r < 3; r++)
        trial_check(x->t, x->s, fabsl(delta[r] - e.delta[r]) <= 1e-13L * e.delta_size[r],
                    "at %.17g %.17g %.17g: delta[%d] = %.17g, expected %.20Lg, off by %.2Lg of its size",
                    uvw[0], uvw[1], uvw[2], r, delta[r], e.delta[r],
                    fabsl(delta[r] - e.delta[r]) / e.delta_size[r]);
    check_alike(x, uvw, &place, delta);
    if (e.regular)
        check_gradient(x, uvw, gradient, &e);
    if (near == SUPPORT_WITHIN && any_not_zero(gradient, 9)) /* else directions stay, by their bits */
        check_directions(x->t, x->s, gradient, random);
}

static void random_rest(sample *s, draw *random)
{
    sample_limits limits = {.max_degree = random_chance(random, 0.2) ? 9 : 4, .max_extra = 4};
    const int kind = draw_int(random, 0, 3);
    limits.always_closed[1] = kind == 0;
    limits.max_degree = kind == 0 ? 4 : limits.max_degree;
    sample_axes(s, random, &limits);
    if (kind == 0)
        sample_round_cylinder(s, random, true);
    else if (kind == 1)
        sample_box(s, random, 1, random_chance(random, 0.2) ? 1e6 : 0);
    else
        sample_warped(s, random, (volume_scale)draw_int(random, 0, SCALE_COUNT - 1),
                      random_chance(random, 0.5), draw_between(random, 0, 0.9));
    if (random_chance(random, 0.3))
        sample_weights(s, random, 2);
}

static void add_by(sample *s, const shift_move *shift)
{
    text_add(&s->moves, "{\"at\":[");
    for (int a = 0; a < 3; a++)
        text_add(&s->moves, "%s[%d,%d]", a ? "," : "", shift->first[a], shift->last[a]);
    text_add(&s->moves, "],\"by\":[%.17g,%.17g,%.17g]}", shift->by[0], shift->by[1], shift->by[2]);
}

/* Scales all points, and moves a layer. */
static shift_move scale_and_shift(sample *s)
{
    shift_move made = {.here = true, .scaled = true, .by = {0.5, 0.25, -0.75}};
    made.first[0] = made.last[0] = s->axis[0].n - 1;
    made.last[1] = s->axis[1].n - 1;
    text_add(&s->moves, "{\"scale\":{\"factor\":[%g,%g,%g],\"about\":[%g,%g,%g]}},", scale_factor[0],
             scale_factor[1], scale_factor[2], scale_about[0], scale_about[1], scale_about[2]);
    add_by(s, &made);
    return made;
}

/* Moves a block of points, the whole lattice at times. */
static shift_move shift_some(sample *s, draw *random, double z)
{
    shift_move made = {.here = true, .by = {draw_between(random, -1, 1), draw_between(random, -1, 1), z}};
    const int form = draw_int(random, 0, 3);
    for (int a = 0; a < 3; a++) {
        const int last = s->axis[a].n - 1;
        made.first[a] = form == 0 ? 0 : draw_int(random, 0, last);
        made.last[a] = form == 0 ? last : form == 1 ? draw_int(random, made.first[a], last) : made.first[a];
    }
    add_by(s, &made);
    return made;
}

/* New deformed points, a moved weight, or a move of a few points: some or all of them. */
static shift_move random_edit(sample *s, draw *random)
{
    const size_t count = sample_count(s);
    const int kind = draw_int(random, 0, 3);
    if (kind == 0 || (kind == 1 && !s->weights)) {
        if (s->rest == SAMPLE_POINTS) {
            s->deformed_points = sample_array(3 * count);
            for (size_t i = 0; i < 3 * count; i++)
                s->deformed_points[i] = s->points[i] * draw_between(random, 0.5, 1.5);
        } else
            return scale_and_shift(s);
    } else if (kind == 1) {
        s->deformed_weights = sample_array(count);
        for (size_t i = 0; i < count; i++)
            s->deformed_weights[i] =
                s->weights[i] * (random_chance(random, 0.5) ? 1 : draw_between(random, 0.5, 2));
    } else {
        return shift_some(s, random, kind == 2 ? 0.0 : 0.25);
    }
    return (shift_move){.here = false};
}

static void displacements(void **state)
{
    (void)state;
    trial t = {.name = "displacements"};
    for (long k = 0; trial_next(&t, 300); k++, t.cases++) {
        sample s;
        edited x;
        sample_init(&s, trial_seed() + (uint64_t)k);
        draw random = {s.seed};
        random_rest(&s, &random);
        const shift_move shift = random_edit(&s, &random);
        if (open_edited(&x, &t, &s, &shift)) {
            for (int i = 0; i < 12; i++)
                check_displacement(&x, &random);
            close_edited(&x);
        }
        sample_free(&s);
    }
    trial_end(&t);
}

/* No edit, and one that goes there and back in exact steps: zeros everywhere. */
static void nothing_moved(void **state)
{
    (void)state;
    trial t = {.name = "nothing_moved"};
    for (long k = 0; trial_next(&t, 40); k++, t.cases++) {
        sample s;
        edited x;
        sample_init(&s, trial_seed() + (uint64_t)k);
        draw random = {s.seed};
        random_rest(&s, &random);
        if (open_edited(&x, &t, &s, &(shift_move){.here = false})) {
            for (int i = 0; i < 4; i++)
                check_displacement(&x, &random);
            close_edited(&x);
        }
        sample_free(&s);
    }
    trial_end(&t);
}

/* The normals and tangents of gradients drawn at random, mirrors and strong scalings among them. */
static void directions(void **state)
{
    (void)state;
    trial t = {.name = "directions"};
    for (long k = 0; trial_next(&t, 2000); k++, t.cases++) {
        sample s;
        sample_init(&s, trial_seed() + (uint64_t)k);
        draw random = {s.seed};
        double gradient[9];
        const double size = pow(10, draw_between(&random, -9, 4));
        for (int i = 0; i < 9; i++)
            gradient[i] = draw_between(&random, -size, size);
        if (random_chance(&random, 0.2))
            gradient[4 * draw_int(&random, 0, 2)] -= 2;
        check_directions(&t, &s, gradient, &random);
    }
    trial_end(&t);
}

/* Gradient 0 keeps the bits; F = 0 and F of rank 1 leave no normal, F t = 0 no tangent: kept and said. */
static void kept_directions(void **state)
{
    (void)state;
    const double none[9] = {0, -0.0, 0, 0, 0, 0, 0, 0, 0}, odd[3] = {0.1, -3, -0.0};
    const double collapse[9] = {-1, 0, 0, 0, -1, 0, 0, 0, -1}, line[9] = {0, 0, 0, 0, -1, 0, 0, 0, -1};
    const double flat[9] = {0, 0, 0, 0, 0, 0, 0, 0, -1};
    double result[3];
    assert_int_equal(ffd_deform_normal(none, odd, result), FFD_DIRECTION_KEPT);
    assert_memory_equal(result, odd, sizeof odd);
    assert_int_equal(ffd_deform_tangent(none, odd, NULL, result), FFD_DIRECTION_KEPT);
    assert_memory_equal(result, odd, sizeof odd);
    assert_int_equal(ffd_deform_normal(collapse, odd, result), FFD_DIRECTION_COLLAPSED);
    assert_memory_equal(result, odd, sizeof odd);
    assert_int_equal(ffd_deform_normal(line, odd, result), FFD_DIRECTION_COLLAPSED);
    assert_int_equal(ffd_deform_tangent(collapse, odd, NULL, result), FFD_DIRECTION_COLLAPSED);
    assert_memory_equal(result, odd, sizeof odd);
    /* A flattened body keeps the normal of its plane. */
    const double up[3] = {0, 0, 1};
    assert_int_equal(ffd_deform_normal(flat, up, result), FFD_DIRECTION_CARRIED);
    assert_memory_equal(result, up, sizeof up);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(displacements),
        cmocka_unit_test(nothing_moved),
        cmocka_unit_test(directions),
        cmocka_unit_test(kept_directions),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
