#include "lattice/move_action.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include <math.h>

bool ffd_move_has_centre(move_action action)
{
    return action != MOVE_BY && action != MOVE_TO && action != MOVE_MATRIX && action != MOVE_PULL &&
           action != MOVE_DRAG && action != MOVE_JITTER;
}

bool ffd_move_has_extent(move_action action)
{
    return action == MOVE_TWIST || action == MOVE_TAPER || action == MOVE_BEND;
}

double ffd_move_along(const lattice_move *move, const double p[3])
{
    const double from[3] = {p[0] - move->about[0], p[1] - move->about[1], p[2] - move->about[2]};
    return vec_dot(move->axis, from);
}

/* Returns f = (s - s0)/(s1 - s0); 0 if the points have no extent. */
static double fraction_of(const ready_move *ready, const double p[3])
{
    return ready->length > 0 ? (ffd_move_along(&ready->move, p) - ready->first) / ready->length : 0;
}

static void scale(const lattice_move *move, double p[3])
{
    for (int c = 0; c < 3; c++)
        if (move->vector[c] != 1)
            p[c] = move->about[c] + move->vector[c] * (p[c] - move->about[c]);
}

/* Computes the components perpendicular to the axis k: e = d - k (k.d) = -k x (k x d) and f = k x d, with d =
   p - about. */
static void across_axis(const lattice_move *move, const double p[3], double e[3], double f[3])
{
    const double d[3] = {p[0] - move->about[0], p[1] - move->about[1], p[2] - move->about[2]};
    vec_cross(move->axis, d, f);
    vec_cross(f, move->axis, e);
}

/* Rodrigues' rotation, p + (cos - 1) e + sin f. In this form coordinates that do not change keep their bits
   (the one along the axis x, y or z; all of them for full turns), and a rotation by 90 degrees about the
   origin is exact. */
static void rotate(ready_move *ready, double degrees, double p[3])
{
    double e[3], f[3];
    across_axis(&ready->move, p, e, f);
    if (degrees != ready->degrees) {
        ffd_sincos_degrees(degrees, &ready->sine, &ready->cosine);
        ready->degrees = degrees;
    }
    for (int c = 0; c < 3; c++)
        p[c] = (p[c] + (ready->cosine - 1) * e[c]) + ready->sine * f[c];
}

static void apply_matrix(const double m[16], double p[3])
{
    const double x = p[0], y = p[1], z = p[2];
    for (int r = 0; r < 3; r++)
        p[r] = m[4 * r] * x + m[4 * r + 1] * y + m[4 * r + 2] * z + m[4 * r + 3];
}

/* p + (g - 1) e with g = 1 + (k-1) f. */
static void taper(const ready_move *ready, double p[3])
{
    double e[3], f[3];
    const double more = (ready->move.amount - 1) * fraction_of(ready, p);
    across_axis(&ready->move, p, e, f);
    for (int c = 0; c < 3; c++)
        p[c] += more * e[c];
}

/* s' = s0 + (R-t)(1+m) sin a, t' = R - (R-t)(1+m) cos a, m = more. Computed as changes of s and t, which are
   0 at the low end and do not lose digits if the angle is small and R large: t' - t = (R-t)((1 - cos a) - m
   cos a). */
void ffd_move_bend(const ready_move *ready, double degrees, double more, double p[3])
{
    static const double pi = 3.14159265358979323846;
    const lattice_move *const move = &ready->move;
    const double from[3] = {p[0] - move->about[0], p[1] - move->about[1], p[2] - move->about[2]};
    const double t = vec_dot(move->vector, from), s = vec_dot(move->axis, from) - ready->first;
    const double radius = ready->length * 180 / (pi * move->amount);
    double sine, cosine, half_sine, half_cosine;
    ffd_sincos_degrees(degrees, &sine, &cosine);
    ffd_sincos_degrees(0.5 * degrees, &half_sine, &half_cosine);
    const double lost = cosine > 0.5 ? 2 * half_sine * half_sine : 1 - cosine;
    const double by_s = (radius - t) * (1 + more) * sine - s, by_t = (radius - t) * (lost - more * cosine);
    for (int c = 0; c < 3; c++)
        p[c] += by_s * move->axis[c] + by_t * move->vector[c];
}

/* The angle is (s-s0)/R = degrees f. */
static void bend(const ready_move *ready, double p[3])
{
    if (ready->move.amount != 0 && ready->length > 0)
        ffd_move_bend(ready, ready->move.amount * fraction_of(ready, p), 0, p);
}

void ffd_move_act(ready_move *ready, double p[3])
{
    const lattice_move *const move = &ready->move;
    switch (move->action) {
    case MOVE_BY:
    case MOVE_PULL:
        for (int c = 0; c < 3; c++)
            p[c] += move->vector[c];
        break;
    case MOVE_TO:
        for (int c = 0; c < 3; c++)
            p[c] = move->vector[c];
        break;
    case MOVE_SCALE:
        scale(move, p);
        break;
    case MOVE_ROTATE:
        rotate(ready, move->amount, p);
        break;
    case MOVE_MATRIX:
        apply_matrix(move->matrix, p);
        break;
    case MOVE_TWIST:
        rotate(ready, move->amount * fraction_of(ready, p), p);
        break;
    case MOVE_TAPER:
        taper(ready, p);
        break;
    case MOVE_BEND:
        bend(ready, p);
        break;
    case MOVE_DRAG:   /* acts on all points at once (drag.h) */
    case MOVE_JITTER: /* differs from point to point (noise.h) */
        break;
    }
}
