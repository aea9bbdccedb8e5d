/* moves_sample.c - see moves_sample.h. */
#include "moves_sample.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef enum action {
    ACT_BY,
    ACT_TO,
    ACT_SCALE,
    ACT_ROTATE,
    ACT_MATRIX,
    ACT_PULL,
    ACT_TWIST,
    ACT_TAPER,
    ACT_BEND,
    ACT_COUNT
} action;

/* One move in world units. */
typedef struct move {
    action kind;
    long double weight, about[3], vector[3], axis[3], amount, matrix[12];
    long double low, high; /* the extent along the axis */
    /* In the file's units. */
    bool falls, falls_along;
    double place[3], radius;                  /* of a pull */
    double fall_place[3], fall_from, fall_to; /* the axis, or the centre with 0 and the radius */
} move;

moved_points moved_start(const sample *s, const double *rest, const double *deformed)
{
    moved_points m = {.s = s, .rest = rest, .count = sample_count(s)};
    m.points = calloc(3 * m.count, sizeof *m.points);
    m.selected = calloc(m.count, sizeof *m.selected);
    if (!m.points || !m.selected)
        abort();
    for (size_t i = 0; i < 3 * m.count; i++) {
        m.points[i] = deformed[i];
        m.size = fmaxl(m.size, fabsl(m.points[i]));
    }
    return m;
}

void moved_free(moved_points *m)
{
    free(m->points);
    free(m->selected);
    *m = (moved_points){.count = 0};
}

static long double dot(const long double a[3], const long double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void unit(long double v[3])
{
    const long double length = sqrtl(dot(v, v));
    for (int a = 0; a < 3; a++)
        v[a] /= length;
}

static void cross(const long double a[3], const long double b[3], long double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Fractions of the rest box's sides, along its own directions, to world units. */
static void to_world(const sample *s, const double given[3], bool position, long double out[3])
{
    if (!s->box_units) {
        for (int a = 0; a < 3; a++)
            out[a] = given[a];
        return;
    }
    for (int r = 0; r < 3; r++)
        out[r] = 0;
    for (int a = 0; a < 3; a++) {
        const long double side = (long double)s->box_max[a] - s->box_min[a];
        const long double x = side * given[a] + (position ? s->box_min[a] : 0);
        for (int r = 0; r < 3; r++)
            out[r] += x * (s->has_axes ? s->box_axes[3 * a + r] : a == r);
    }
}

/* Rodrigues' formula. */
static void turn(const long double axis[3], long double degrees, const long double about[3], long double p[3])
{
    const long double angle = degrees * acosl(-1) / 180, c = cosl(angle), s = sinl(angle);
    long double v[3], w[3];
    for (int a = 0; a < 3; a++)
        v[a] = p[a] - about[a];
    cross(axis, v, w);
    const long double along = dot(axis, v) * (1 - c);
    for (int a = 0; a < 3; a++)
        p[a] = about[a] + c * v[a] + s * w[a] + along * axis[a];
}

static void taper(const move *m, long double f, const long double v[3], long double p[3])
{
    const long double along = dot(v, m->axis), factor = 1 + (m->amount - 1) * f;
    for (int a = 0; a < 3; a++)
        p[a] = m->about[a] + along * m->axis[a] + factor * (v[a] - along * m->axis[a]);
}

/* The formula of data/schema/lattice.md 8.3, with t' = t cos + R (1 - cos) and 1 - cos = 2 sin^2 of the half:
 * no loss where R is large. */
static void bend(const move *m, const long double v[3], long double p[3])
{
    const long double angle = m->amount * acosl(-1) / 180, length = m->high - m->low;
    long double toward[3], side[3];
    const long double lean = dot(m->vector, m->axis);
    for (int a = 0; a < 3; a++)
        toward[a] = m->vector[a] - lean * m->axis[a];
    unit(toward);
    cross(m->axis, toward, side);
    const long double s = dot(v, m->axis), t = dot(v, toward), q = dot(v, side);
    if (angle == 0)
        return;
    const long double radius = length / angle, phi = (s - m->low) / radius, half = sinl(phi / 2);
    const long double moved_s = m->low + (radius - t) * sinl(phi);
    const long double moved_t = t * cosl(phi) + radius * 2 * half * half;
    for (int a = 0; a < 3; a++)
        p[a] = m->about[a] + moved_s * m->axis[a] + moved_t * toward[a] + q * side[a];
}

static void act(const move *m, long double p[3])
{
    long double v[3];
    for (int a = 0; a < 3; a++)
        v[a] = p[a] - m->about[a];
    const long double f = m->kind >= ACT_TWIST ? (dot(v, m->axis) - m->low) / (m->high - m->low) : 0;
    switch (m->kind) {
    case ACT_BY:
    case ACT_TO:
    case ACT_PULL:
        for (int a = 0; a < 3; a++)
            p[a] = m->vector[a] + (m->kind == ACT_TO ? 0 : p[a]);
        break;
    case ACT_SCALE:
        for (int a = 0; a < 3; a++)
            p[a] = m->about[a] + m->vector[a] * v[a];
        break;
    case ACT_ROTATE:
        turn(m->axis, m->amount, m->about, p);
        break;
    case ACT_MATRIX:
        memcpy(v, p, sizeof v);
        for (int a = 0; a < 3; a++)
            p[a] = dot(m->matrix + 4 * a, v) + m->matrix[4 * a + 3];
        break;
    case ACT_TWIST:
        turn(m->axis, m->amount * f, m->about, p);
        break;
    case ACT_TAPER:
        taper(m, f, v, p);
        break;
    default:
        bend(m, v, p);
        break;
    }
}

/* A rest position in the file's units. */
static void to_file(const sample *s, const double rest[3], long double out[3])
{
    for (int a = 0; a < 3; a++) {
        out[a] = 0;
        for (int r = 0; r < 3; r++)
            out[a] += (long double)rest[r] * (s->box_units && s->has_axes ? s->box_axes[3 * a + r] : a == r);
        if (s->box_units)
            out[a] = (out[a] - s->box_min[a]) / ((long double)s->box_max[a] - s->box_min[a]);
    }
}

static long double distance(const long double x[3], const double place[3])
{
    const long double away[3] = {x[0] - place[0], x[1] - place[1], x[2] - place[2]};
    return sqrtl(dot(away, away));
}

/* Weight, falloff and pull at a rest position: data/schema/lattice.md 8.2 and 8.3. */
static long double weight_at(const moved_points *all, const move *m, const double rest[3])
{
    long double x[3], weight = m->weight;
    to_file(all->s, rest, x);
    if (m->kind == ACT_PULL) {
        const long double radii = fminl(distance(x, m->place) / m->radius, 1);
        weight *= powl(1 - radii * radii, 2);
    }
    if (m->falls) {
        const long double axis[3] = {m->fall_place[0], m->fall_place[1], m->fall_place[2]};
        const long double at =
            m->falls_along ? dot(axis, x) / sqrtl(dot(axis, axis)) : distance(x, m->fall_place);
        const long double way =
            fmaxl(fminl((at - m->fall_from) / ((long double)m->fall_to - m->fall_from), 1), 0);
        weight *= 1 - (3 * way * way - 2 * way * way * way);
    }
    return weight;
}

static void apply(moved_points *all, const move *m)
{
    for (size_t i = 0; i < all->count; i++) {
        long double p[3], *point = all->points + 3 * i;
        if (!all->selected[i])
            continue;
        memcpy(p, point, sizeof p);
        act(m, p);
        const long double weight = weight_at(all, m, all->rest + 3 * i);
        for (int a = 0; a < 3; a++) {
            all->size = fmaxl(all->size, fmaxl(fabsl(p[a]), fabsl(m->about[a])));
            point[a] += weight * (p[a] - point[a]);
        }
    }
}

/* One entry of "at": an index, a range or all, negative ones counted from the end. */
static void select_indices(text *out, draw *random, int n, int *first, int *last)
{
    const int kind = draw_int(random, 0, 3);
    *first = draw_int(random, 0, n - 1);
    *last = *first;
    if (kind == 0) {
        *first = 0;
        *last = n - 1;
        text_add(out, "\"all\"");
    } else if (kind == 1) {
        text_add(out, "%d", random_chance(random, 0.5) ? *first : *first - n);
    } else {
        *last = draw_int(random, *first, n - 1);
        text_add(out, "[%d,%d]", random_chance(random, 0.5) ? *first : *first - n,
                 random_chance(random, 0.5) ? *last : *last - n);
    }
}

static void select_at(moved_points *m, text *out, draw *random)
{
    int first[3], last[3];
    text_add(out, "\"at\":[");
    for (int a = 0; a < 3; a++) {
        text_add(out, "%s", a == 0 ? "" : ",");
        select_indices(out, random, m->s->axis[a].n, &first[a], &last[a]);
    }
    text_add(out, "],");
    size_t at = 0;
    for (int k = 0; k < m->s->axis[2].n; k++)
        for (int j = 0; j < m->s->axis[1].n; j++)
            for (int i = 0; i < m->s->axis[0].n; i++, at++)
                m->selected[at] = i >= first[0] && i <= last[0] && j >= first[1] && j <= last[1] &&
                                  k >= first[2] && k <= last[2];
}

/* A box round some rest points; in box units (only without axes) by fractions. */
static void select_within(moved_points *m, text *out, draw *random)
{
    double lo[3] = {INFINITY, INFINITY, INFINITY}, hi[3] = {-INFINITY, -INFINITY, -INFINITY}, bounds[2][3];
    for (size_t i = 0; i < m->count; i++)
        for (size_t a = 0; a < 3; a++) {
            lo[a] = fmin(lo[a], m->rest[3 * i + a]);
            hi[a] = fmax(hi[a], m->rest[3 * i + a]);
        }
    for (int a = 0; a < 3; a++) {
        double from = 0, side = 1;
        if (m->s->box_units) {
            from = m->s->box_min[a];
            side = m->s->box_max[a] - from;
        }
        const double ends[2] = {lo[a] + (hi[a] - lo[a]) * draw_between(random, -0.1, 0.45),
                                lo[a] + (hi[a] - lo[a]) * draw_between(random, 0.55, 1.1)};
        for (int end = 0; end < 2; end++)
            bounds[end][a] = (ends[end] - from) / side;
        lo[a] = ends[0];
        hi[a] = ends[1];
    }
    text_add(out, "\"within\":{\"min\":");
    text_numbers(out, bounds[0], 3);
    text_add(out, ",\"max\":");
    text_numbers(out, bounds[1], 3);
    text_add(out, "},");
    for (size_t i = 0; i < m->count; i++) {
        m->selected[i] = true;
        for (size_t a = 0; a < 3; a++)
            m->selected[i] = m->selected[i] && m->rest[3 * i + a] >= lo[a] && m->rest[3 * i + a] <= hi[a];
    }
}

static void select_points(moved_points *m, text *out, draw *random)
{
    const int kind = draw_int(random, 0, 2);
    for (size_t i = 0; i < m->count; i++)
        m->selected[i] = true;
    if (kind == 0)
        select_at(m, out, random);
    else if (kind == 1 && !(m->s->box_units && m->s->has_axes))
        select_within(m, out, random);
    m->selected_count = 0;
    for (size_t i = 0; i < m->count; i++)
        m->selected_count += m->selected[i];
}

static void choose_axis(move *m, text *out, draw *random)
{
    double axis[3];
    if (random_chance(random, 0.4)) {
        const int a = draw_int(random, 0, 2);
        for (int r = 0; r < 3; r++)
            m->axis[r] = r == a;
        text_add(out, "\"axis\":\"%c\"", "xyz"[a]);
        return;
    }
    random_direction(random, axis);
    const double length = draw_between(random, 0.1, 10);
    for (int r = 0; r < 3; r++)
        m->axis[r] = axis[r] = axis[r] * length;
    unit(m->axis);
    text_add(out, "\"axis\":");
    text_numbers(out, axis, 3);
}

static void choose_about(const moved_points *all, move *m, text *out, draw *random)
{
    if (random_chance(random, 0.5)) {
        double about[3];
        for (int a = 0; a < 3; a++)
            about[a] = draw_between(random, -1, 1);
        to_world(all->s, about, true, m->about);
        text_add(out, ",\"about\":");
        text_numbers(out, about, 3);
        return;
    }
    for (int a = 0; a < 3; a++) {
        m->about[a] = 0;
        for (size_t i = 0; i < all->count; i++)
            m->about[a] += all->selected[i] ? all->points[3 * i + (size_t)a] / all->selected_count : 0;
    }
}

static double choose_degrees(draw *random)
{
    const int kind = draw_int(random, 0, 7);
    if (kind == 0)
        return 90 * draw_int(random, -5, 5);
    if (kind == 1)
        return draw_between(random, -2000, 2000);
    if (kind == 2)
        return draw_between(random, -1e-4, 1e-4);
    return draw_between(random, -180, 180);
}

/* The extent of the selected points along the axis; false where there is none to speak of. */
static bool choose_extent(const moved_points *all, move *m)
{
    m->low = INFINITY;
    m->high = -INFINITY;
    for (size_t i = 0; i < all->count; i++) {
        long double v[3];
        if (!all->selected[i])
            continue;
        for (size_t a = 0; a < 3; a++)
            v[a] = all->points[3 * i + a] - m->about[a];
        m->low = fminl(m->low, dot(v, m->axis));
        m->high = fmaxl(m->high, dot(v, m->axis));
    }
    return m->high - m->low > 1e-2L * all->size;
}

static void write_vector(const moved_points *all, move *m, text *out, draw *random)
{
    double vector[3];
    for (int a = 0; a < 3; a++)
        vector[a] = draw_between(random, -1, 1);
    to_world(all->s, vector, m->kind == ACT_TO, m->vector);
    text_add(out, m->kind == ACT_TO ? "\"to\":" : "\"by\":");
    text_numbers(out, vector, 3);
}

static void write_scale(const moved_points *all, move *m, text *out, draw *random)
{
    double factors[3];
    const bool even = random_chance(random, 0.5);
    for (int a = 0; a < 3; a++)
        m->vector[a] = factors[a] = even && a > 0 ? factors[0] : draw_between(random, -1.5, 2);
    text_add(out, "\"scale\":{\"factor\":");
    if (even)
        text_add(out, "%.17g", factors[0]);
    else
        text_numbers(out, factors, 3);
    choose_about(all, m, out, random);
    text_add(out, "}");
}

static void write_matrix(move *m, text *out, draw *random)
{
    double matrix[16] = {0};
    for (int i = 0; i < 12; i++)
        m->matrix[i] = matrix[i] = draw_between(random, -1, 1);
    matrix[15] = 1;
    text_add(out, "\"matrix\":");
    text_numbers(out, matrix, 16);
}

/* rotate, twist, taper, bend. */
static bool write_about_axis(const moved_points *all, move *m, text *out, draw *random)
{
    static const char *const names[ACT_COUNT] = {
        [ACT_ROTATE] = "rotate", [ACT_TWIST] = "twist", [ACT_TAPER] = "taper", [ACT_BEND] = "bend"};
    double toward[3], amount;
    text_add(out, "\"%s\":{", names[m->kind]);
    choose_axis(m, out, random);
    if (m->kind == ACT_BEND) {
        random_direction(random, toward);
        for (int a = 0; a < 3; a++)
            m->vector[a] = toward[a];
        if (fabsl(dot(m->vector, m->axis)) > 0.9L)
            return false;
        text_add(out, ",\"toward\":");
        text_numbers(out, toward, 3);
    }
    amount = m->kind == ACT_TAPER ? draw_between(random, -0.5, 2) : choose_degrees(random);
    m->amount = amount;
    text_add(out, ",\"%s\":%.17g", m->kind == ACT_TAPER ? "factor" : "degrees", amount);
    choose_about(all, m, out, random);
    text_add(out, "}");
    return m->kind == ACT_ROTATE || choose_extent(all, m);
}

static void choose_place(double place[3], draw *random)
{
    for (int a = 0; a < 3; a++)
        place[a] = draw_between(random, -1, 1);
}

static void write_pull(const moved_points *all, move *m, text *out, draw *random)
{
    double by[3];
    choose_place(m->place, random);
    choose_place(by, random);
    m->radius = draw_between(random, 0.2, 3);
    to_world(all->s, by, false, m->vector);
    text_add(out, "\"pull\":{\"point\":");
    text_numbers(out, m->place, 3);
    text_add(out, ",\"by\":");
    text_numbers(out, by, 3);
    text_add(out, ",\"radius\":%.17g}", m->radius);
}

/* Along an axis of another length, in world units; or round a place. */
static void write_falloff(const moved_points *all, move *m, text *out, draw *random)
{
    m->falls = true;
    m->falls_along = !all->s->box_units && random_chance(random, 0.5);
    choose_place(m->fall_place, random);
    m->fall_to = draw_between(random, 0.2, 3);
    text_add(out, m->falls_along ? "\"falloff\":{\"axis\":" : "\"falloff\":{\"center\":");
    text_numbers(out, m->fall_place, 3);
    if (m->falls_along) {
        m->fall_from = m->fall_to + (random_chance(random, 0.5) ? 1 : -1) * draw_between(random, 0.2, 3);
        text_add(out, ",\"from\":%.17g,\"to\":%.17g},", m->fall_from, m->fall_to);
    } else {
        text_add(out, ",\"radius\":%.17g},", m->fall_to);
    }
}

static bool write_move(moved_points *all, move *m, text *out, draw *random)
{
    text_add(out, "{");
    select_points(all, out, random);
    if (random_chance(random, 0.4)) {
        const double weight = random_chance(random, 0.2) ? draw_int(random, 0, 1) : draw_unit(random);
        m->weight = weight;
        text_add(out, "\"weight\":%.17g,", weight);
    }
    if (random_chance(random, 0.4))
        write_falloff(all, m, out, random);
    bool usable = all->selected_count > 0;
    if (m->kind == ACT_PULL)
        write_pull(all, m, out, random);
    else if (m->kind == ACT_BY || m->kind == ACT_TO)
        write_vector(all, m, out, random);
    else if (m->kind == ACT_SCALE)
        write_scale(all, m, out, random);
    else if (m->kind == ACT_MATRIX)
        write_matrix(m, out, random);
    else
        usable = write_about_axis(all, m, out, random) && usable;
    text_add(out, "}");
    return usable;
}

void moved_random(moved_points *all, sample *s, draw *random)
{
    for (;;) {
        text out = {NULL, 0, 0};
        move m = {.kind = (action)draw_int(random, 0, ACT_COUNT - 1), .weight = 1};
        /* In box units a matrix has no agreed meaning. */
        const bool usable = !(m.kind == ACT_MATRIX && s->box_units) && write_move(all, &m, &out, random);
        if (usable) {
            text_add(&s->moves, "%s%s", s->moves.length > 0 ? ",\n" : "", out.data);
            apply(all, &m);
        }
        text_free(&out);
        if (usable)
            return;
    }
}
