/* shape_sample.c - see shape_sample.h. */
#include "shape_sample.h"

#include <math.h>
#include <string.h>

static long double radians(long double degrees)
{
    return degrees / 180 * acosl(-1);
}

void shape_list_axis(sample *s, int a, int n, int degree, const double *knots)
{
    s->axis[a] = (oracle_axis){.n = n, .degree = degree};
    for (int i = 0; i <= n + degree; i++)
        s->axis[a].t[i] = knots[i];
    text_free(&s->knots[a]);
    text_numbers(&s->knots[a], knots, (size_t)(n + degree) + 1);
}

/* Clamped, with steps of unequal length and inner knots of the multiplicity given. */
static void uneven_axis(sample *s, int a, draw *random, int spans, int degree, int multiplicity)
{
    double knots[ORACLE_MAX_KNOTS], at = draw_int(random, -2, 2);
    int count = 0;
    for (int k = 0; k <= spans; k++) {
        const int times = k == 0 || k == spans ? degree + 1 : multiplicity;
        for (int i = 0; i < times; i++)
            knots[count++] = at;
        at += draw_int(random, 40, 88) / 64.0;
    }
    shape_list_axis(s, a, count - degree - 1, degree, knots);
}

static void named(shape *x, sample *s, int part, const char *kind, int n, int degree)
{
    sample_named_axis(s, x->role[part], kind, n, degree);
}

/* A direction that is not closed, with at least so many spans. */
static void any_axis(shape *x, sample *s, draw *random, int part, int spans, int degree)
{
    static const char *const kinds[] = {"clamped", "open", "uniform"};
    const int kind = draw_int(random, 0, 4);
    if (kind < 3)
        named(x, s, part, kinds[kind], spans + degree, degree);
    else
        uneven_axis(s, x->role[part], random, spans, degree, 1);
}

static void short_axis(shape *x, sample *s, draw *random, int part, int most)
{
    any_axis(x, s, random, part, draw_int(random, 1, 2), draw_int(random, 1, most));
}

/* A collapsed face needs an end that lies on its control points. */
static void clamped_axis(shape *x, sample *s, draw *random, int part, int most)
{
    const int degree = draw_int(random, 1, most);
    named(x, s, part, "clamped", degree + draw_int(random, 1, 2), degree);
}

static void closed_axis(shape *x, sample *s, draw *random, int part)
{
    named(x, s, part, "closed", draw_int(random, 6, 8), draw_int(random, 2, 3));
}

static void kinked_axes(sample *s, draw *random)
{
    for (int a = 0; a < 3; a++) {
        const int degree = draw_int(random, 1, 3);
        uneven_axis(s, a, random, draw_int(random, 2, 3), degree, degree);
    }
}

static void make_axes(shape *x, sample *s, draw *random)
{
    const int degree = draw_int(random, 2, 4);
    const bool from_zero = x->kind == SHAPE_CYLINDER || x->kind == SHAPE_SECTOR || x->kind == SHAPE_BALL;
    if (from_zero)
        clamped_axis(x, s, random, 0, 3);
    else
        short_axis(x, s, random, 0, 3);
    short_axis(x, s, random, 2, 2);
    switch (x->kind) {
    case SHAPE_C:
        any_axis(x, s, random, 1, 6, degree);
        break;
    case SHAPE_SPIRAL:
        any_axis(x, s, random, 1, 24, degree);
        break;
    case SHAPE_OVERLAP:
        any_axis(x, s, random, 1, (int)(x->turn / 0.4L), degree);
        break;
    case SHAPE_TWIST:
        short_axis(x, s, random, 1, 3);
        any_axis(x, s, random, 2, 8, degree);
        break;
    case SHAPE_HALF_TORUS:
        closed_axis(x, s, random, 1);
        any_axis(x, s, random, 2, 5, degree);
        break;
    case SHAPE_TORUS:
        closed_axis(x, s, random, 1);
        closed_axis(x, s, random, 2);
        break;
    case SHAPE_FOLD:
        any_axis(x, s, random, 0, 6, degree);
        short_axis(x, s, random, 1, 2);
        break;
    case SHAPE_CYLINDER:
        closed_axis(x, s, random, 1);
        break;
    case SHAPE_SECTOR:
        any_axis(x, s, random, 1, 4, degree);
        break;
    case SHAPE_BALL:
    case SHAPE_SHELL:
        closed_axis(x, s, random, 1);
        named(x, s, 2, "clamped", 4 + degree, degree);
        break;
    default: /* the pyramid and the prism, which end in up = 1 */
        short_axis(x, s, random, 1, 3);
        clamped_axis(x, s, random, 2, 3);
        break;
    }
}

static void map(const shape *x, const long double t[3], long double p[3])
{
    const long double pi = acosl(-1), radius = x->radius + x->across * t[0];
    switch (x->kind) {
    case SHAPE_SPIRAL: {
        const long double outer = radius + 0.9L * x->turn * t[1] / (2 * pi);
        p[0] = outer * cosl(x->turn * t[1]);
        p[1] = outer * sinl(x->turn * t[1]);
        p[2] = t[2];
        break;
    }
    case SHAPE_TWIST: {
        const long double c = cosl(x->turn * t[2]), s = sinl(x->turn * t[2]);
        p[0] = c * (t[0] - 0.5L) - s * (t[1] - 0.5L);
        p[1] = s * (t[0] - 0.5L) + c * (t[1] - 0.5L);
        p[2] = 2 * t[2];
        break;
    }
    case SHAPE_HALF_TORUS:
    case SHAPE_TORUS: {
        const long double far = SHAPE_TORUS_RADIUS + radius * cosl(2 * pi * t[1]);
        p[0] = far * cosl(x->turn * t[2]);
        p[1] = far * sinl(x->turn * t[2]);
        p[2] = radius * sinl(2 * pi * t[1]);
        break;
    }
    case SHAPE_BALL:
    case SHAPE_SHELL: {
        /* The poles exactly: there the circles of latitude are points. */
        const long double flat = t[2] == 0 || t[2] == 1 ? 0 : sinl(pi * t[2]);
        p[0] = radius * flat * cosl(x->turn * t[1]);
        p[1] = radius * flat * sinl(x->turn * t[1]);
        p[2] = -radius * cosl(pi * t[2]);
        break;
    }
    case SHAPE_PYRAMID:
    case SHAPE_PRISM:
        p[0] = (1 - t[2]) * (t[0] - 0.5L);
        p[1] = (x->kind == SHAPE_PRISM ? 1 : 1 - t[2]) * (t[1] - 0.5L);
        p[2] = t[2] + 0.2L * t[1] * (1 - t[2]);
        break;
    case SHAPE_FOLD:
        p[0] = t[0] + 3 * t[1] * sinl(2 * pi * t[0]) / (2 * pi);
        p[1] = t[1] + 0.1L * t[0] * t[0];
        p[2] = t[2] + 0.1L * t[0] * t[1];
        break;
    default: /* bars and cylinders */
        p[0] = radius * cosl(x->turn * t[1]);
        p[1] = radius * sinl(x->turn * t[1]);
        p[2] = t[2] + x->climb * t[1];
        break;
    }
}

static void to_world(const shape *x, const long double local[3], double xyz[3])
{
    for (size_t r = 0; r < 3; r++) {
        long double sum = x->origin[r];
        for (size_t c = 0; c < 3; c++)
            sum += x->frame[3 * r + c] * local[c];
        xyz[r] = (double)sum;
    }
}

static void make_points(const shape *x, sample *s)
{
    int i[3];
    size_t at = 0;
    s->rest = SAMPLE_POINTS;
    s->points = sample_array(3 * sample_count(s));
    for (i[2] = 0; i[2] < s->axis[2].n; i[2]++)
        for (i[1] = 0; i[1] < s->axis[1].n; i[1]++)
            for (i[0] = 0; i[0] < s->axis[0].n; i[0]++, at++) {
                long double t[3], local[3];
                for (int part = 0; part < 3; part++) {
                    const oracle_axis *axis = &s->axis[x->role[part]];
                    t[part] = (oracle_greville(axis, i[x->role[part]]) - oracle_first(axis)) /
                              (oracle_last(axis) - oracle_first(axis));
                }
                map(x, t, local);
                to_world(x, local, s->points + 3 * at);
            }
}

static void make_frame(shape *x, draw *random, const shape_setting *setting)
{
    if (setting->bare) {
        for (int a = 0; a < 3; a++)
            x->frame[4 * a] = 1;
        return;
    }
    const double unit = setting->scale == SCALE_HUGE ? 1e9 : setting->scale == SCALE_TINY ? 1e-6 : 1;
    double side[3], rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    for (int a = 0; a < 3; a++)
        side[a] = unit * draw_between(random, 0.5, 2);
    if (setting->scale == SCALE_THIN)
        side[draw_int(random, 0, 2)] *= 1e-6;
    if (random_chance(random, 0.4))
        side[draw_int(random, 0, 2)] *= -1;
    if (setting->rotated)
        random_rotation(random, rotation);
    for (int r = 0; r < 3; r++) {
        x->origin[r] = unit * (draw_between(random, -1, 1) + (setting->scale == SCALE_FAR ? 1e6 : 0));
        for (int c = 0; c < 3; c++)
            x->frame[3 * r + c] = (long double)rotation[3 * r + c] * side[c];
    }
}

static void make_roles(shape *x, draw *random)
{
    for (int a = 0; a < 3; a++)
        x->role[a] = a;
    for (int a = 2; a > 0; a--) {
        const int b = draw_int(random, 0, a), swap = x->role[a];
        x->role[a] = x->role[b];
        x->role[b] = swap;
    }
}

static void begin(shape *x, sample *s, draw *random, shape_kind kind, const shape_setting *setting)
{
    *x = (shape){
        .kind = kind, .radius = draw_between(random, 0.4, 1), .across = draw_between(random, 0.5, 1.2)};
    make_roles(x, random);
    make_frame(x, random, setting);
    x->turn = radians(360);
    switch (kind) {
    case SHAPE_C:
        x->turn = radians(draw_between(random, 180, 330));
        break;
    case SHAPE_SPIRAL:
        x->turn = radians(720);
        x->across = 0.6L;
        break;
    case SHAPE_TWIST:
        x->turn = radians(270);
        break;
    case SHAPE_HALF_TORUS:
        x->turn = radians(180);
        break;
    case SHAPE_OVERLAP:
        x->turn = radians(draw_between(random, 400, 680));
        x->climb = 3e-10L * draw_int(random, -1, 1);
        break;
    case SHAPE_SECTOR:
        x->turn = radians(draw_between(random, 60, 250));
        x->radius = 0;
        break;
    case SHAPE_CYLINDER:
    case SHAPE_BALL:
        x->radius = 0;
        break;
    default:
        break;
    }
    sample_clear_axes(s);
}

/* The exact torus (P&T 8.5): quarter circles as quadratics with the weights 1, sqrt(1/2), 1; the tube in one
   or in four of them, the ring in one. */
static void make_quarter_torus(shape *x, sample *s, draw *random)
{
    static const long double circle[9][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                                             {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    static const double knots[12] = {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4};
    const long double corner = sqrtl(0.5L);
    int i[3];
    size_t at = 0;
    clamped_axis(x, s, random, 0, 3);
    if (random_chance(random, 0.5))
        shape_list_axis(s, x->role[1], 9, 2, knots);
    else
        named(x, s, 1, "clamped", 3, 2);
    named(x, s, 2, "clamped", 3, 2);
    s->rest = SAMPLE_POINTS;
    s->points = sample_array(3 * sample_count(s));
    s->weights = sample_array(sample_count(s));
    for (i[2] = 0; i[2] < s->axis[2].n; i[2]++)
        for (i[1] = 0; i[1] < s->axis[1].n; i[1]++)
            for (i[0] = 0; i[0] < s->axis[0].n; i[0]++, at++) {
                const int tube = i[x->role[1]], ring = i[x->role[2]];
                const long double radius =
                    x->radius + x->across * oracle_greville(&s->axis[x->role[0]], i[x->role[0]]);
                const long double far = SHAPE_TORUS_RADIUS + radius * circle[tube][0];
                const long double local[3] = {far * circle[ring][0], far * circle[ring][1],
                                              radius * circle[tube][1]};
                to_world(x, local, s->points + 3 * at);
                s->weights[at] = (double)((tube % 2 ? corner : 1) * (ring % 2 ? corner : 1));
            }
}

void shape_make(shape *x, sample *s, draw *random, shape_kind kind, const shape_setting *setting)
{
    begin(x, s, random, kind, setting);
    if (kind == SHAPE_KINKED) {
        kinked_axes(s, random);
        sample_warped(s, random, setting->scale, setting->rotated, draw_between(random, 0.3, 0.9));
    } else if (kind == SHAPE_QUARTER_TORUS) {
        make_quarter_torus(x, s, random);
    } else {
        make_axes(x, s, random);
        make_points(x, s);
    }
}

void shape_make_degree(shape *x, sample *s, draw *random, int degree, const shape_setting *setting)
{
    begin(x, s, random, SHAPE_C, setting);
    x->turn = radians(150);
    short_axis(x, s, random, 0, 2);
    any_axis(x, s, random, 1, degree < 4 ? 5 : 1, degree);
    short_axis(x, s, random, 2, 2);
    make_points(x, s);
}

/* Gives the last layer of control points in direction a the positions of the first. */
static void join_ends(sample *s, int a)
{
    int i[3];
    size_t at = 0;
    for (i[2] = 0; i[2] < s->axis[2].n; i[2]++)
        for (i[1] = 0; i[1] < s->axis[1].n; i[1]++)
            for (i[0] = 0; i[0] < s->axis[0].n; i[0]++, at++) {
                if (i[a] + 1 < s->axis[a].n)
                    continue;
                int first[3] = {i[0], i[1], i[2]};
                first[a] = 0;
                const size_t from =
                    (size_t)first[0] +
                    (size_t)s->axis[0].n * ((size_t)first[1] + (size_t)s->axis[1].n * (size_t)first[2]);
                memcpy(s->points + 3 * at, s->points + 3 * from, 3 * sizeof s->points[0]);
            }
}

void shape_make_seam(shape *x, sample *s, draw *random, shape_kind kind, const shape_setting *setting,
                     bool same_points)
{
    const bool torus = kind == SHAPE_TORUS;
    begin(x, s, random, kind, setting);
    x->turn = radians(360);
    x->climb = 0;
    short_axis(x, s, random, 0, 3);
    short_axis(x, s, random, 2, 2);
    for (int part = 1; part <= (torus ? 2 : 1); part++) {
        const int degree = draw_int(random, 1, 4);
        if (random_chance(random, 0.5))
            named(x, s, part, "clamped", degree + 7, degree);
        else
            uneven_axis(s, x->role[part], random, 7, degree, 1);
    }
    make_points(x, s);
    for (int part = 1; same_points && part <= (torus ? 2 : 1); part++)
        join_ends(s, x->role[part]);
}

/* Sets the parameter of a part to the least one. */
static bool to_least(const shape *x, const sample *s, int part, long double uvw[3])
{
    uvw[x->role[part]] = oracle_first(&s->axis[x->role[part]]);
    return true;
}

bool shape_to_collapsed(const shape *x, const sample *s, draw *random, long double uvw[3])
{
    const int across = x->role[0], up = x->role[2];
    switch (x->kind) {
    case SHAPE_BALL:
        if (random_chance(random, 0.5))
            break;
        /* fall through */
    case SHAPE_SHELL:
        uvw[up] = random_chance(random, 0.5) ? oracle_first(&s->axis[up]) : oracle_last(&s->axis[up]);
        return true;
    case SHAPE_PYRAMID:
    case SHAPE_PRISM:
        uvw[up] = oracle_last(&s->axis[up]);
        return true;
    case SHAPE_CYLINDER:
    case SHAPE_SECTOR:
        break;
    default:
        return false;
    }
    uvw[across] = oracle_first(&s->axis[across]);
    return true;
}

bool shape_collapse(const shape *x, const sample *s, long double uvw[3])
{
    const int across = x->role[0], up = x->role[2];
    const bool inner = uvw[across] == oracle_first(&s->axis[across]);
    const bool low = uvw[up] == oracle_first(&s->axis[up]), high = uvw[up] == oracle_last(&s->axis[up]);
    switch (x->kind) {
    case SHAPE_CYLINDER:
    case SHAPE_SECTOR:
        return inner && to_least(x, s, 1, uvw);
    case SHAPE_BALL:
        if (inner)
            return to_least(x, s, 1, uvw) && to_least(x, s, 2, uvw);
        return (low || high) && to_least(x, s, 1, uvw);
    case SHAPE_SHELL:
        return (low || high) && to_least(x, s, 1, uvw);
    case SHAPE_PYRAMID:
        return high && to_least(x, s, 0, uvw) && to_least(x, s, 1, uvw);
    case SHAPE_PRISM:
        return high && to_least(x, s, 0, uvw);
    default:
        return false;
    }
}
