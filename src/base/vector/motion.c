#include "base/vector/motion.h"
#include "base/vector/polar.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include <float.h>
#include <string.h>

/* Points are on a line if the second singular value of their product is less than this part of the first. */
#define LINE 1e-7

/* Roundings of coordinates, and of matrices. */
#define ROUNDING (64 * DBL_EPSILON)

/* More than enough: sweeps of Jacobi rotations converge quadratically. */
#define SWEEPS 40

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

void ffd_motion_add(motion_sums *sums, const double x[3], const double y[3])
{
    if (sums->count++ == 0)
        for (int a = 0; a < 3; a++) {
            sums->first[a] = x[a];
            sums->by[a] = y[a] - x[a];
        }
    for (int a = 0; a < 3; a++) {
        const double from = x[a] - sums->first[a], more = (y[a] - x[a]) - sums->by[a];
        sums->moves = sums->moves || y[a] < x[a] || y[a] > x[a];
        sums->x[a] += from;
        sums->d[a] += more;
        sums->reach[0] = larger_of(sums->reach[0], fabs(from));
        sums->reach[1] = larger_of(sums->reach[1], fabs(from + more));
        sums->size = larger_of(sums->size, larger_of(fabs(x[a]), fabs(y[a])));
    }
}

/* The power of 2 that makes a number about 1. */
static double power_for(double number)
{
    int exponent;
    frexp(number, &exponent);
    const int least = -1000, most = 1000;
    return number > 0 ? ldexp(1, -(exponent < least ? least : exponent > most ? most : exponent)) : 1;
}

void ffd_motion_middle(motion_sums *sums)
{
    for (int a = 0; a < 3 && sums->count > 0; a++) {
        sums->x[a] /= (double)sums->count;
        sums->d[a] /= (double)sums->count;
    }
    for (int i = 0; i < 2; i++)
        sums->scale[i] = power_for(sums->reach[i]);
}

void ffd_motion_add_product(motion_sums *sums, const double x[3], const double y[3])
{
    double from[3], to[3];
    for (int a = 0; a < 3; a++) {
        const double off = (x[a] - sums->first[a]) - sums->x[a];
        const double more = ((y[a] - x[a]) - sums->by[a]) - sums->d[a];
        from[a] = off * sums->scale[0];
        to[a] = (off + more) * sums->scale[1];
    }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            sums->product[3 * r + c] += to[r] * from[c];
    sums->square += vec_dot(from, from);
}

/* m = U S V^T: U and V have the vectors in rows, of U each times its singular value. */
typedef struct factors {
    double u[9], v[9], value[3];
} factors;

/* Turns rows p and q of both so that those of u are perpendicular (one-sided Jacobi: Hestenes 1958). Returns
   false if they are. */
static bool turn_rows(factors *f, int p, int q)
{
    double *const a = f->u + 3 * p, *const b = f->u + 3 * q;
    const double along = vec_dot(a, b), aa = vec_dot(a, a), bb = vec_dot(b, b);
    if (fabs(along) <= DBL_EPSILON * sqrt(aa) * sqrt(bb))
        return false;
    const double zeta = (bb - aa) / (2 * along);
    const double t = (zeta >= 0 ? 1 : -1) / (fabs(zeta) + sqrt(1 + zeta * zeta));
    const double c = 1 / sqrt(1 + t * t), s = t * c;
    for (int k = 0; k < 3; k++) {
        double *const rows[] = {f->u, f->v};
        for (int i = 0; i < 2; i++) {
            const double x = rows[i][3 * p + k], y = rows[i][3 * q + k];
            rows[i][3 * p + k] = c * x - s * y;
            rows[i][3 * q + k] = s * x + c * y;
        }
    }
    return true;
}

static void swap_rows(factors *f, int p, int q)
{
    double *const rows[] = {f->u, f->v};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++) {
            const double kept = rows[i][3 * p + k];
            rows[i][3 * p + k] = rows[i][3 * q + k];
            rows[i][3 * q + k] = kept;
        }
    const double kept = f->value[p];
    f->value[p] = f->value[q];
    f->value[q] = kept;
}

static void factor(const double m[9], factors *f)
{
    bool turns = true;
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            f->u[3 * c + r] = m[3 * r + c];
    memcpy(f->v, identity, sizeof f->v);
    for (int sweep = 0; sweep < SWEEPS && turns; sweep++) {
        const bool first = turn_rows(f, 0, 1), second = turn_rows(f, 0, 2), third = turn_rows(f, 1, 2);
        turns = first || second || third;
    }
    for (int i = 0; i < 3; i++)
        f->value[i] = vec_length(f->u + 3 * i);
    for (int i = 0; i < 3; i++)
        if (f->value[i % 2] < f->value[i % 2 + 1])
            swap_rows(f, i % 2, i % 2 + 1);
}

void ffd_singular_values(const double m[9], double values[3])
{
    factors f;
    factor(m, &f);
    memcpy(values, f.value, sizeof f.value);
}

/* Makes the length of a vector 1. */
static void make_unit(double v[3])
{
    const double length = vec_length(v);
    for (int a = 0; a < 3; a++)
        v[a] /= length;
}

/* Fills the second row of a frame with what of v is perpendicular to the first, and the third one so that it
   is right-handed. */
static void complete(const double v[3], double frame[9])
{
    const double along = vec_dot(v, frame);
    for (int a = 0; a < 3; a++)
        frame[3 + a] = v[a] - along * frame[a];
    make_unit(frame + 3);
    vec_cross(frame, frame + 3, frame + 6);
}

/* The rotation that takes the rows of one frame to those of the other. */
static void turn_frame(const double from[9], const double to[9], double rotation[9])
{
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            rotation[3 * r + c] = to[r] * from[c] + to[3 + r] * from[3 + c] + to[6 + r] * from[6 + c];
}

/* The least rotation that takes a unit vector to another one: about what is perpendicular to both; of
   opposite ones, to the axis that the first is farthest from. */
static void turn_least(const double from[3], const double to[3], double rotation[9])
{
    double frames[2][9], across[3] = {0, 0, 0}, normal[3];
    int least = 0;
    for (int a = 1; a < 3; a++)
        if (fabs(from[a]) < fabs(from[least]))
            least = a;
    vec_cross(from, to, normal);
    if (!(vec_length(normal) > 0)) {
        across[least] = 1;
        vec_cross(from, across, normal);
    }
    if (vec_dot(from, to) > 0 && !(vec_length(normal) > DBL_EPSILON)) {
        memcpy(rotation, identity, sizeof identity);
        return;
    }
    memcpy(frames[0], from, 3 * sizeof *from);
    memcpy(frames[1], to, 3 * sizeof *to);
    complete(normal, frames[0]);
    complete(normal, frames[1]);
    turn_frame(frames[0], frames[1], rotation);
}

/* Finds the rotation for which the trace of R^T product is largest (Kabsch 1976; Umeyama 1991). */
static void find_rotation(const motion_sums *sums, double rotation[9])
{
    factors f;
    double frames[2][9];
    memcpy(rotation, identity, sizeof identity);
    factor(sums->product, &f);
    const bool is_point = sums->reach[0] <= ROUNDING * sums->size || sums->reach[1] <= ROUNDING * sums->size;
    if (is_point || !(f.value[0] > 0))
        return;
    memcpy(frames[0], f.v, 3 * sizeof *f.v);
    memcpy(frames[1], f.u, 3 * sizeof *f.u);
    make_unit(frames[0]);
    make_unit(frames[1]);
    if (f.value[1] < LINE * f.value[0]) {
        turn_least(frames[0], frames[1], rotation);
        return;
    }
    /* The third vectors are those of right-handed frames: of a reflection the last sign turns. */
    complete(f.v + 3, frames[0]);
    complete(f.u + 3, frames[1]);
    turn_frame(frames[0], frames[1], rotation);
}

static double find_scale(const motion_sums *sums, const double rotation[9])
{
    double trace = 0;
    for (int i = 0; i < 9; i++)
        trace += rotation[i] * sums->product[i];
    return sums->square > 0 ? trace / sums->square * (sums->scale[0] / sums->scale[1]) : 1;
}

void ffd_motion_find(const motion_sums *sums, bool uniform, rigid_motion *motion)
{
    *motion = (rigid_motion){.scale = 1};
    memcpy(motion->rotation, identity, sizeof identity);
    for (int a = 0; a < 3; a++)
        motion->from[a] = sums->first[a] + sums->x[a];
    if (sums->count == 0 || !sums->moves)
        return;
    const double reach = larger_of(sums->reach[0], sums->reach[1]);
    const double rounding = reach > 0 ? ROUNDING * larger_of(1, sums->size / reach) : 0;
    find_rotation(sums, motion->rotation);
    if (ffd_mat_is_near_identity(motion->rotation, rounding))
        memcpy(motion->rotation, identity, sizeof identity);
    motion->scale = uniform ? find_scale(sums, motion->rotation) : 1;
    if (fabs(motion->scale - 1) <= rounding)
        motion->scale = 1;
    for (int i = 0; i < 9; i++)
        motion->gradient[i] = motion->scale * motion->rotation[i] - identity[i];
    for (int a = 0; a < 3; a++) {
        const double by = sums->by[a] + sums->d[a];
        motion->by[a] = fabs(by) <= DBL_EPSILON * sums->size ? 0 : by;
    }
}

void ffd_motion_displace(const rigid_motion *motion, const double x[3], double delta[3])
{
    const double from[3] = {x[0] - motion->from[0], x[1] - motion->from[1], x[2] - motion->from[2]};
    mat_apply(motion->gradient, from, delta);
    for (int a = 0; a < 3; a++)
        delta[a] += motion->by[a];
}

double ffd_motion_degrees(const rigid_motion *motion)
{
    const double *const r = motion->rotation;
    const double axis[3] = {r[7] - r[5], r[2] - r[6], r[3] - r[1]};
    return fabs(ffd_angle_degrees(vec_length(axis), r[0] + r[4] + r[8] - 1));
}
