/* volume_sample.c - see volume_sample.h. */
#include "volume_sample.h"

#include <math.h>
#include <stdlib.h>

static size_t index_of(const sample *s, const int i[3])
{
    return (size_t)i[0] + (size_t)s->axis[0].n * ((size_t)i[1] + (size_t)s->axis[1].n * (size_t)i[2]);
}

static bool next_point(const sample *s, int i[3])
{
    for (int a = 0; a < 3; a++) {
        if (++i[a] < s->axis[a].n)
            return true;
        i[a] = 0;
    }
    return false;
}

static long double unit_greville(const oracle_axis *axis, int i)
{
    return (oracle_greville(axis, i) - oracle_first(axis)) / (oracle_last(axis) - oracle_first(axis));
}

/* The largest slope of component r in direction c over the unit cube, by the derivative's control points. */
static long double slope_bound(const sample *s, const double *field, int r, int c)
{
    const oracle_axis *axis = &s->axis[c];
    const long double length = oracle_last(axis) - oracle_first(axis);
    long double bound = 0;
    int i[3] = {0, 0, 0};
    do {
        if (i[c] + 1 == axis->n)
            continue;
        int next[3] = {i[0], i[1], i[2]};
        next[c]++;
        const long double rise =
            field[3 * index_of(s, next) + (size_t)r] - field[3 * index_of(s, i) + (size_t)r];
        const long double gap = oracle_knot(axis, i[c] + axis->degree + 1) - oracle_knot(axis, i[c] + 1);
        bound = fmaxl(bound, fabsl(rise) * axis->degree * length / gap);
    } while (next_point(s, i));
    return bound;
}

/* A random displacement of the control points, scaled so that its slopes' row sums stay below strength. */
static double *displacement(const sample *s, draw *random, double strength)
{
    double *field = sample_array(3 * sample_count(s));
    long double most = 0;
    for (size_t i = 0; i < 3 * sample_count(s); i++)
        field[i] = draw_between(random, -1, 1);
    for (int r = 0; r < 3; r++) {
        long double sum = 0;
        for (int c = 0; c < 3; c++)
            sum += slope_bound(s, field, r, c);
        most = fmaxl(most, sum);
    }
    for (size_t i = 0; i < 3 * sample_count(s); i++)
        field[i] = (double)(field[i] * strength / most);
    return field;
}

/* The frame of a lattice: columns of m are its sides. */
static void random_frame(draw *random, volume_scale scale, bool rotated, long double origin[3],
                         long double m[9])
{
    double side[3], rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    double unit = scale == SCALE_HUGE ? 1e9 : scale == SCALE_TINY ? 1e-6 : 1;
    for (int a = 0; a < 3; a++)
        side[a] = unit * draw_between(random, 0.5, 2);
    if (scale == SCALE_THIN)
        side[draw_int(random, 0, 2)] *= 1e-6;
    if (rotated)
        random_rotation(random, rotation);
    if (random_chance(random, 0.3))
        side[draw_int(random, 0, 2)] *= -1;
    for (int r = 0; r < 3; r++) {
        origin[r] = unit * (draw_between(random, -1, 1) + (scale == SCALE_FAR ? 1e6 : 0));
        for (int c = 0; c < 3; c++)
            m[3 * r + c] = (long double)rotation[3 * r + c] * side[c];
    }
}

void sample_warped(sample *s, draw *random, volume_scale scale, bool rotated, double strength)
{
    long double origin[3], m[9];
    double *field = displacement(s, random, strength);
    int i[3] = {0, 0, 0};
    random_frame(random, scale, rotated, origin, m);
    s->rest = SAMPLE_POINTS;
    s->points = sample_array(3 * sample_count(s));
    do {
        const size_t at = index_of(s, i);
        for (size_t r = 0; r < 3; r++) {
            long double x = origin[r];
            for (size_t c = 0; c < 3; c++)
                x += m[3 * r + c] * (unit_greville(&s->axis[c], i[c]) + field[3 * at + c]);
            s->points[3 * at + r] = (double)x;
        }
    } while (next_point(s, i));
    free(field);
}

void sample_separable(sample *s, draw *random, volume_scale scale)
{
    long double origin[3], m[9];
    double grid[3][ORACLE_MAX_POINTS];
    int i[3] = {0, 0, 0};
    random_frame(random, scale, false, origin, m);
    for (int a = 0; a < 3; a++) {
        const int n = s->axis[a].n;
        long double x = origin[a];
        for (int k = 0; k < n; k++) {
            grid[a][k] = (double)x;
            x += m[4 * a] * draw_between(random, 0.3, 1.7) / (n - 1);
        }
    }
    s->rest = SAMPLE_POINTS;
    s->points = sample_array(3 * sample_count(s));
    do {
        for (size_t a = 0; a < 3; a++)
            s->points[3 * index_of(s, i) + a] = grid[a][i[a]];
    } while (next_point(s, i));
}

void sample_arc(sample *s, draw *random, double degrees)
{
    const long double pi = acosl(-1);
    const int across = draw_int(random, 1, 3);
    const int along = draw_int(random, 2, 4);
    int i[3] = {0, 0, 0};
    sample_named_axis(s, 0, "clamped", across + 1 + draw_int(random, 0, 1), across);
    sample_named_axis(s, 1, "clamped", (int)(degrees / 22) + along, along);
    sample_named_axis(s, 2, "clamped", 2 + draw_int(random, 0, 1), 1);
    s->rest = SAMPLE_POINTS;
    s->points = sample_array(3 * sample_count(s));
    do {
        double *point = s->points + 3 * index_of(s, i);
        const long double turn = degrees / 180 * pi * oracle_greville(&s->axis[1], i[1]);
        const long double radius = 1 + oracle_greville(&s->axis[0], i[0]);
        point[0] = (double)(radius * cosl(turn));
        point[1] = (double)(radius * sinl(turn));
        point[2] = (double)oracle_greville(&s->axis[2], i[2]);
    } while (next_point(s, i));
}

void sample_ring(sample *s, draw *random)
{
    const long double pi = acosl(-1);
    const double phase = draw_unit(random), odd = draw_between(random, 0, 0.03),
                 mirror = draw_int(random, 0, 1);
    double rotation[9];
    int i[3] = {0, 0, 0};
    random_rotation(random, rotation);
    s->rest = SAMPLE_POINTS;
    s->points = sample_array(3 * sample_count(s));
    do {
        const long double turn = 2 * pi * (i[1] + phase) / s->axis[1].n;
        const long double radius = 1 + unit_greville(&s->axis[0], i[0]);
        long double local[3] = {radius * cosl(turn), radius * sinl(turn), unit_greville(&s->axis[2], i[2])};
        local[2] = mirror > 0 ? -local[2] : local[2];
        for (int a = 0; a < 3; a++)
            local[a] += odd * draw_between(random, -1, 1);
        for (int r = 0; r < 3; r++)
            for (int c = 0; c < 3; c++)
                s->points[3 * index_of(s, i) + (size_t)r] += (double)(rotation[3 * r + c] * local[c]);
    } while (next_point(s, i));
}

void sample_parameters(const sample *s, draw *random, long double uvw[3])
{
    const bool special = random_chance(random, 0.5);
    for (int a = 0; a < 3; a++) {
        const oracle_axis *axis = &s->axis[a];
        const long double first = oracle_first(axis), last = oracle_last(axis);
        const int kind = special ? draw_int(random, 0, 3) : 0;
        if (kind == 0)
            uvw[a] = first + (last - first) * (long double)draw_unit(random);
        else if (kind == 1)
            uvw[a] = oracle_knot(axis, axis->degree +
                                           draw_int(random, 0, axis->n - (axis->closed ? 0 : axis->degree)));
        else
            uvw[a] = kind == 2 ? first : last;
        uvw[a] = oracle_wrap(axis, uvw[a]);
    }
}

bool volume_has_one_sign(const oracle_volume *volume)
{
    int steps[3], i[3], sign = 0;
    for (int a = 0; a < 3; a++)
        steps[a] = 4 * (volume->axis[a].n - (volume->axis[a].closed ? 0 : volume->axis[a].degree));
    for (i[2] = 0; i[2] <= steps[2]; i[2]++)
        for (i[1] = 0; i[1] <= steps[1]; i[1]++)
            for (i[0] = 0; i[0] <= steps[0]; i[0]++) {
                long double uvw[3], point[3], jacobian[9];
                for (int a = 0; a < 3; a++) {
                    const oracle_axis *axis = &volume->axis[a];
                    const long double length = oracle_last(axis) - oracle_first(axis);
                    uvw[a] = oracle_wrap(axis, oracle_first(axis) + length * i[a] / steps[a]);
                }
                oracle_evaluate(volume, uvw, point, jacobian);
                const long double det = oracle_determinant(jacobian);
                const int here = det > 0 ? 1 : det < 0 ? -1 : 0;
                if (here == 0 || here * sign < 0)
                    return false;
                sign = here;
            }
    return true;
}
