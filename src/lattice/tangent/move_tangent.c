#include "lattice/tangent/move_tangent.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include "lattice/noise.h"

#define RADIANS (3.14159265358979323846 / 180)

static dual3 vector_of(const double v[3], const double d[3])
{
    return (dual3){{{v[0], d[0]}, {v[1], d[1]}, {v[2], d[2]}}};
}

/* m x, for a constant row-major matrix. */
static dual3 apply(const double m[9], dual3 x)
{
    dual3 out;
    for (int r = 0; r < 3; r++)
        out.c[r] = dual_add(dual_add(dual_scale(x.c[0], m[3 * r]), dual_scale(x.c[1], m[3 * r + 1])),
                            dual_scale(x.c[2], m[3 * r + 2]));
    return out;
}

static dual3 to_world(const move_step *step, dual3 x)
{
    const double *const o = step->region->origin;
    const double none[3] = {0, 0, 0};
    return step->inverse ? dual3_add(apply(step->region->frame, x), vector_of(o, none)) : x;
}

/* Makes v perpendicular to a unit vector, and normalises it. */
static dual3 perpendicular(dual3 axis, dual3 v)
{
    const dual3 unit = dual3_unit(v);
    return dual3_unit(dual3_sub(unit, dual3_scale(axis, dual3_dot(axis, unit))));
}

/* Converts a matrix that acts on fractions of the region: B M B^-1. */
static void matrix_to_world(const move_step *step, const lattice_move *d, dual_move *made)
{
    const double none[3] = {0, 0, 0};
    const dual3 start = vector_of(step->region->origin, none);
    dual3 columns[3], offset;
    for (int c = 0; c < 3; c++) {
        /* The image of the unit vector c of world space. */
        double e[3] = {c == 0, c == 1, c == 2}, x[3];
        mat_apply(step->inverse, e, x);
        for (int r = 0; r < 3; r++) {
            columns[c].c[r] = dual_of(0);
            for (int k = 0; k < 3; k++)
                columns[c].c[r] =
                    dual_add(columns[c].c[r],
                             dual_scale((dual){step->move->matrix[4 * r + k], d->matrix[4 * r + k]}, x[k]));
        }
        columns[c] = apply(step->region->frame, columns[c]);
    }
    for (int r = 0; r < 3; r++)
        offset.c[r] = (dual){step->move->matrix[4 * r + 3], d->matrix[4 * r + 3]};
    offset = to_world(step, offset);
    for (int c = 0; c < 3; c++)
        offset = dual3_sub(offset, dual3_scale(columns[c], start.c[c]));
    for (int r = 0; r < 3; r++) {
        made->matrix[4 * r + 3] = offset.c[r];
        for (int c = 0; c < 3; c++)
            made->matrix[4 * r + c] = columns[c].c[r];
    }
}

/* Converts directions and lengths from the units of the file to world units. */
static void make_numbers(const move_step *step, const lattice_move *d, dual_move *made)
{
    const lattice_move *const m = step->move;
    made->amount = (dual){m->amount, d->amount};
    made->weight = (dual){m->weight, d->weight};
    for (int i = 0; i < 16; i++)
        made->matrix[i] = (dual){m->matrix[i], d->matrix[i]};
    made->vector = vector_of(m->vector, d->vector);
    if (m->action == MOVE_TO)
        made->vector = to_world(step, made->vector);
    else if ((m->action == MOVE_BY || m->action == MOVE_PULL) && step->inverse)
        made->vector = apply(step->region->frame, made->vector);
    else if (m->action == MOVE_MATRIX && step->inverse)
        matrix_to_world(step, d, made);
    made->point = vector_of(m->point, d->point);
    made->radius = (dual){m->radius, d->radius};
    made->center = vector_of(m->falloff.center, d->falloff.center);
    made->ball = (dual){m->falloff.radius, d->falloff.radius};
    made->from = (dual){m->falloff.from, d->falloff.from};
    made->to = (dual){m->falloff.to, d->falloff.to};
}

static bool is_axial(move_action action)
{
    return action == MOVE_ROTATE || ffd_move_has_extent(action);
}

static void make_directions(const move_step *step, const lattice_move *d, dual_move *made)
{
    const lattice_move *const m = step->move;
    const double none[3] = {0, 0, 0};
    made->axis = made->toward = vector_of(none, none);
    if (is_axial(m->action))
        made->axis = dual3_unit(vector_of(m->raw_axis, d->raw_axis));
    if (m->action == MOVE_BEND)
        made->toward = perpendicular(made->axis, vector_of(m->raw_toward, d->raw_toward));
    if (m->falloff.kind == FALLOFF_AXIS)
        made->falloff_axis = dual3_unit(vector_of(m->falloff.raw_axis, d->falloff.raw_axis));
}

/* Returns a control point, reflected in the plane of the step. */
static dual3 seen(const dual_move *move, size_t point, const double derivative[3])
{
    const double *const q = move->step->lattice->deformed + 3 * point;
    const mirror_plane *const plane = move->step->plane;
    double image[3], image_derivative[3];
    if (!plane)
        return vector_of(q, derivative);
    ffd_mirror_point(plane, q, image);
    ffd_mirror_vector(plane, derivative, image_derivative);
    return vector_of(image, image_derivative);
}

static dual along(const dual_move *move, dual3 p)
{
    return dual3_dot(move->axis, dual3_sub(p, move->about));
}

dual ffd_dual_move_along(const dual_move *move, size_t point, const double derivative[3])
{
    return along(move, seen(move, point, derivative));
}

static void find_centroid(const double *points, dual_move *made)
{
    const move_step *const step = made->step;
    double sum[3] = {0, 0, 0};
    size_t count = 0;
    for (size_t i = 0; i < step->lattice->count; i++)
        for (int c = 0; c < 3 && step->selected[i]; c++) {
            sum[c] += points[3 * i + (size_t)c];
            count += c == 0;
        }
    for (int c = 0; c < 3; c++)
        made->about.c[c] = (dual){step->ready->move.about[c], sum[c] / (double)count};
}

/* Uses the first lowest and the first highest point. */
static void find_extent(const double *points, dual_move *made)
{
    const move_step *const step = made->step;
    dual first = {INFINITY, 0}, last = {-INFINITY, 0};
    for (size_t i = 0; i < step->lattice->count; i++) {
        if (!step->selected[i])
            continue;
        const dual s = ffd_dual_move_along(made, i, points + 3 * i);
        first = s.v < first.v ? s : first;
        last = s.v > last.v ? s : last;
    }
    made->first = first;
    made->length = dual_sub(last, first);
}

void ffd_dual_move_make(const move_step *step, const lattice_move *derivatives, const double *points,
                        dual_move *made)
{
    *made = (dual_move){.step = step};
    make_numbers(step, derivatives, made);
    make_directions(step, derivatives, made);
    if (step->move->has_about)
        made->about = to_world(step, vector_of(step->move->about, derivatives->about));
    else if (ffd_move_has_centre(step->move->action))
        find_centroid(points, made);
    if (ffd_move_has_extent(step->move->action))
        find_extent(points, made);
}

/* f = (s - s0)/(s1 - s0). */
static dual fraction(const dual_move *move, dual3 p)
{
    return move->length.v > 0 ? dual_div(dual_sub(along(move, p), move->first), move->length) : dual_of(0);
}

static void sincos_of(dual degrees, dual *sine, dual *cosine)
{
    double s, c;
    ffd_sincos_degrees(degrees.v, &s, &c);
    *sine = (dual){s, c * RADIANS * degrees.d};
    *cosine = (dual){c, -s * RADIANS * degrees.d};
}

/* p + (cos - 1) e + sin f (move_action.c). */
static dual3 rotate(const dual_move *move, dual degrees, dual3 p)
{
    dual sine, cosine;
    const dual3 f = dual3_cross(move->axis, dual3_sub(p, move->about)), e = dual3_cross(f, move->axis);
    sincos_of(degrees, &sine, &cosine);
    return dual3_add(dual3_add(p, dual3_scale(e, dual_sub(cosine, dual_of(1)))), dual3_scale(f, sine));
}

static dual3 taper(const dual_move *move, dual3 p)
{
    const dual3 f = dual3_cross(move->axis, dual3_sub(p, move->about)), e = dual3_cross(f, move->axis);
    return dual3_add(p, dual3_scale(e, dual_mul(dual_sub(move->amount, dual_of(1)), fraction(move, p))));
}

/* Applies the chain rule for a function with this value and derivative at x. */
static dual chain(dual x, double value, double derivative)
{
    return (dual){value, derivative * x.d};
}

/* Below this the quotients are computed from their series, with an error below 1e-17. */
#define SERIES 0.5

/* Has the same bits on every processor, unlike sin. */
static double sine_of(double radians)
{
    double sine, cosine;
    ffd_sincos_degrees(radians / RADIANS, &sine, &cosine);
    return sine;
}

static double cosine_of(double radians)
{
    double sine, cosine;
    ffd_sincos_degrees(radians / RADIANS, &sine, &cosine);
    return cosine;
}

/* sin x / x. */
static dual sine_quotient(dual x)
{
    const double v = x.v, s = v * v;
    if (fabs(v) < SERIES)
        return chain(x,
                     1 - s / 6 * (1 - s / 20 * (1 - s / 42 * (1 - s / 72 * (1 - s / 110 * (1 - s / 156))))),
                     -v / 3 * (1 - s / 10 * (1 - s / 28 * (1 - s / 54 * (1 - s / 88 * (1 - s / 130))))));
    return chain(x, sine_of(v) / v, (cosine_of(v) - sine_of(v) / v) / v);
}

/* (1 - cos x) / x^2. */
static dual cosine_quotient(dual x)
{
    const double v = x.v, s = v * v, half = sine_of(0.5 * v);
    if (fabs(v) < SERIES)
        return chain(x, 0.5 * (1 - s / 12 * (1 - s / 30 * (1 - s / 56 * (1 - s / 90 * (1 - s / 132))))),
                     -v / 12 *
                         (1 - s / 15 * (1 - s / 37.333333333333333 * (1 - s / 67.5 * (1 - s / 105.6)))));
    const double lost = 2 * half * half;
    return chain(x, lost / s, (sine_of(v) - 2 * lost / v) / s);
}

/* As ffd_move_bend, in terms of the whole angle a in radians, so that the radius R = length/a may be
   infinite. For the point's angle x = a g, R sin x = length g S(x) and R (1 - cos x) = length a g^2 C(x),
   with S(x) = sin x / x and C(x) = (1 - cos x) / x^2. For an exact bend m = more, R m = length a h^2 C(a
   h)/cos(a h), with h half the arc's part of the whole angle. */
static dual3 bend(const dual_move *move, dual3 p, dual part, const dual *half)
{
    const dual3 from = dual3_sub(p, move->about);
    const dual t = dual3_dot(move->toward, from), s = dual_sub(dual3_dot(move->axis, from), move->first);
    const dual angle = dual_scale(move->amount, RADIANS), x = dual_mul(angle, part);
    const dual across = dual_mul(t, angle); /* t a: (R - t)/R = 1 - t a / length */
    const dual left = dual_sub(dual_of(1), dual_div(across, move->length));
    const dual cosine = chain(x, cosine_of(x.v), -sine_of(x.v));
    const dual way = dual_mul(dual_mul(move->length, part), sine_quotient(x)); /* R sin x */
    dual lost = dual_mul(dual_mul(dual_mul(move->length, angle), dual_mul(part, part)), cosine_quotient(x));
    dual grown = dual_of(1);
    if (half) {
        const dual h = dual_mul(angle, *half), cosine_of_half = chain(h, cosine_of(h.v), -sine_of(h.v));
        const dual more = dual_div(
            dual_mul(dual_mul(dual_mul(move->length, angle), dual_mul(*half, *half)), cosine_quotient(h)),
            cosine_of_half); /* R m */
        grown = dual_div(dual_of(1), cosine_of_half);
        lost = dual_sub(lost, dual_mul(more, cosine));
    }
    const dual by_s = dual_sub(dual_mul(dual_mul(left, grown), way), s), by_t = dual_mul(left, lost);
    return dual3_add(p, dual3_add(dual3_scale(move->axis, by_s), dual3_scale(move->toward, by_t)));
}

static dual3 act(const dual_move *move, dual3 p, const dual *part, const dual *half)
{
    dual3 out = p;
    switch (move->step->move->action) {
    case MOVE_BY:
    case MOVE_PULL:
        return dual3_add(p, move->vector);
    case MOVE_TO:
        return move->vector;
    case MOVE_SCALE:
        for (int c = 0; c < 3; c++)
            out.c[c] =
                dual_add(move->about.c[c], dual_mul(move->vector.c[c], dual_sub(p.c[c], move->about.c[c])));
        return out;
    case MOVE_ROTATE:
        return rotate(move, move->amount, p);
    case MOVE_MATRIX:
        for (int r = 0; r < 3; r++) {
            out.c[r] = move->matrix[4 * r + 3];
            for (int c = 0; c < 3; c++)
                out.c[r] = dual_add(out.c[r], dual_mul(move->matrix[4 * r + c], p.c[c]));
        }
        return out;
    case MOVE_TWIST:
        return rotate(move, dual_mul(move->amount, fraction(move, p)), p);
    case MOVE_TAPER:
        return taper(move, p);
    case MOVE_BEND:
        return move->length.v > 0 ? bend(move, p, part ? *part : fraction(move, p), half) : p;
    case MOVE_DRAG:
    case MOVE_JITTER:
        break;
    }
    return out;
}

/* |place - center|^2 / radius^2. */
static dual square_radii(const double place[3], dual3 center, dual radius)
{
    const double none[3] = {0, 0, 0};
    const dual3 away = dual3_sub(vector_of(place, none), center);
    return dual_div(dual3_dot(away, away), dual_mul(radius, radius));
}

/* Position along the falloff's axis, between `from` (0) and `to` (1). */
static dual way_along(const dual_move *move, const double rest[3])
{
    const move_step *const step = move->step;
    const double none[3] = {0, 0, 0};
    double from_origin[3];
    dual extent = dual_of(step->inverse ? 0 : 1);
    for (int c = 0; c < 3; c++)
        from_origin[c] = step->inverse ? rest[c] - step->region->origin[c] : rest[c];
    for (int a = 0; a < 3 && step->inverse; a++) {
        const double *const frame = step->region->frame, side[3] = {frame[a], frame[3 + a], frame[6 + a]};
        const dual part = dual3_dot(move->falloff_axis, vector_of(side, none));
        extent = dual_add(extent, part.v < 0 ? dual_scale(part, -1) : part);
    }
    const dual s = dual_div(dual3_dot(move->falloff_axis, vector_of(from_origin, none)), extent);
    return dual_div(dual_sub(s, move->from), dual_sub(move->to, move->from));
}

/* 1 - (3x^2 - 2x^3) between 0 and 1. */
static dual fade(dual x)
{
    if (!(x.v > 0))
        return dual_of(1);
    if (!(x.v < 1))
        return dual_of(0);
    return chain(x, 1 - x.v * x.v * (3 - 2 * x.v), -6 * x.v * (1 - x.v));
}

static dual weight_at(const dual_move *move, size_t point)
{
    const move_step *const step = move->step;
    double rest[3], place[3];
    for (int c = 0; c < 3; c++)
        rest[c] = step->lattice->rest[3 * point + (size_t)c];
    if (step->plane)
        ffd_mirror_point(step->plane, step->lattice->rest + 3 * point, rest);
    for (int c = 0; c < 3; c++)
        place[c] = step->inverse ? rest[c] - step->region->origin[c] : rest[c];
    if (step->inverse)
        mat_apply(step->inverse, place, place);
    dual weight = move->weight;
    if (step->move->falloff.kind == FALLOFF_AXIS)
        weight = dual_mul(weight, fade(way_along(move, rest)));
    else if (step->move->falloff.kind == FALLOFF_BALL)
        weight = dual_mul(weight, fade(dual_sqrt(square_radii(place, move->center, move->ball))));
    if (step->move->action == MOVE_PULL) {
        const dual square = square_radii(place, move->point, move->radius);
        const dual left = dual_sub(dual_of(1), square);
        weight = dual_mul(weight, square.v < 1 ? dual_mul(left, left) : dual_of(0));
    }
    return weight;
}

/* A point with its noise added, which is linear in sigma. */
static dual3 jitter(const dual_move *move, size_t point, dual3 p)
{
    const move_step *const step = move->step;
    dual3 by;
    for (int c = 0; c < 3; c++)
        by.c[c] = dual_mul(move->vector.c[c], dual_of(noise_at((uint64_t)step->move->seed, point, c)));
    return dual3_add(p, step->inverse ? apply(step->region->frame, by) : by);
}

void ffd_dual_move_point(const dual_move *move, size_t point, const dual *part, const dual *half,
                         double derivative[3])
{
    const dual3 p = seen(move, point, derivative);
    const dual3 to =
        move->step->move->action == MOVE_JITTER ? jitter(move, point, p) : act(move, p, part, half);
    const dual weight = weight_at(move, point);
    const dual3 moved = dual3_add(p, dual3_scale(dual3_sub(to, p), weight));
    for (int c = 0; c < 3; c++)
        derivative[c] = moved.c[c].d;
    if (move->step->plane)
        ffd_mirror_vector(move->step->plane, derivative, derivative);
}
