#include "splat/splat.h"
#include "base/vector/direction.h"
#include "base/vector/exponential.h"
#include "base/vector/vec.h"
#include "splat/splat_kernel.h"
#include <float.h>
#include <string.h>

typedef double number;
#include "splat/quaternion_matrix.h"

static bool is_usable(const double gradient[9])
{
    for (int r = 0; r < 9; r += 3)
        if (!vec_is_finite(gradient + r))
            return false;
    return mat_largest_entry(gradient) <= LARGEST_F;
}

/* Returns whether the least singular value (the determinant divided by the product of the others) is
   negligible compared with the largest. */
static bool is_flattening(const double f[9], const double cofactor[9])
{
    return !(fabs(vec_dot(f, cofactor)) > NOTHING * mat_largest_entry(f) * sqrt(mat_square_sum(cofactor)));
}

void ffd_splat_matrix(const double q[4], double m[9])
{
    find_matrix(q, m);
}

/* Computes the unit quaternion of a rotation, starting with its largest component (Shepperd, Quaternion from
   rotation matrix, 1978). */
static void find_quaternion(const double m[9], double q[4])
{
    const double trace = m[0] + m[4] + m[8];
    const double size[4] = {trace, m[0], m[4],
                            m[8]}; /* the square of component i is (1 + 2 size[i] - trace)/4 */
    int largest = 0;
    for (int i = 1; i < 4; i++)
        largest = size[i] > size[largest] ? i : largest;
    const double w = m[7] - m[5], x = m[2] - m[6], y = m[3] - m[1];
    switch (largest) {
    case 0:
        q[0] = 1 + trace, q[1] = w, q[2] = x, q[3] = y;
        break;
    case 1:
        q[0] = w, q[1] = 1 + m[0] - m[4] - m[8], q[2] = m[1] + m[3], q[3] = m[2] + m[6];
        break;
    case 2:
        q[0] = x, q[1] = m[1] + m[3], q[2] = 1 - m[0] + m[4] - m[8], q[3] = m[5] + m[7];
        break;
    default:
        q[0] = y, q[1] = m[2] + m[6], q[2] = m[5] + m[7], q[3] = 1 - m[0] - m[4] + m[8];
    }
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++)
        q[i] /= length;
}

/* Computes the quaternion with w >= 0. */
static void find_turn_quaternion(const double rotation[9], double q[4])
{
    find_quaternion(rotation, q);
    for (int i = 1; i < 4 && q[0] < 0; i++)
        q[i] = -q[i];
    q[0] = fabs(q[0]);
}

/* Replaces an invertible matrix by the orthogonal factor of its polar decomposition (src/maths.md 9.6). */
static void orthogonalise(double x[9])
{
    bool is_near = false;
    for (int step = 0; step < NEWTON_STEPS; step++) {
        double cofactor[9], change = 0;
        mat_cofactor(x, cofactor);
        const double determinant = vec_dot(x, cofactor);
        const double inverse_sum = mat_square_sum(cofactor) / (determinant * determinant);
        const double scale = is_near ? 1 : sqrt(sqrt(inverse_sum / mat_square_sum(x)));
        const double back = 1 / (determinant * scale);
        for (int i = 0; i < 9; i++) {
            const double next = 0.5 * (scale * x[i] + cofactor[i] * back);
            change += (next - x[i]) * (next - x[i]);
            x[i] = next;
        }
        is_near = is_near || change < NEWTON_NEAR;
        if (change < NEWTON_ENOUGH)
            return;
    }
}

/* Makes two columns perpendicular by a rotation. Returns false if they are perpendicular already. */
static bool rotate(double p[3], double q[3])
{
    const double a = vec_dot(p, p), b = vec_dot(q, q), off = vec_dot(p, q);
    if (!(off * off > RIGHT * RIGHT * a * b))
        return false;
    const double tau = (b - a) / (2 * off);
    const double t = (tau >= 0 ? 1 : -1) / (fabs(tau) + sqrt(1 + tau * tau));
    const double c = 1 / sqrt(1 + t * t), s = t * c;
    for (int k = 0; k < 3; k++) {
        const double x = p[k], y = q[k];
        p[k] = c * x - s * y;
        q[k] = s * x + c * y;
    }
    return true;
}

/* Makes the columns of a matrix, stored one after the other, perpendicular (src/maths.md 9.6). The one-sided
   Jacobi method (Golub & Van Loan, Matrix Computations, 8.6.3) has a high relative accuracy for small
   singular values next to large ones. */
static void part_columns(double columns[9])
{
    bool any = true;
    for (int sweep = 0; sweep < SWEEPS && any; sweep++) {
        any = rotate(columns, columns + 3);
        any = rotate(columns, columns + 6) || any;
        any = rotate(columns + 3, columns + 6) || any;
    }
}

/* Finds an invertible matrix with the same rotation as F. Returns false if there is no rotation to be
   found. */
static bool prepare_turn(const double gradient[9], splat_turn *turn, double f[9])
{
    double cofactor[9];
    *turn = (splat_turn){.quaternion = {1, 0, 0, 0}};
    if (!is_usable(gradient) || mat_largest_entry(gradient) <= STILL)
        return false;
    mat_add_identity(gradient, f);
    if (mat_largest_entry(f) < LEAST_F)
        return false;
    mat_cofactor(f, cofactor);
    if (is_flattening(f, cofactor)) {
        /* The cofactor matrix has the same directions as F, and is not 0 perpendicular to the image plane of
           F. */
        const double size = sqrt(mat_square_sum(f));
        for (int i = 0; i < 9; i++)
            f[i] += cofactor[i] / size;
        mat_cofactor(f, cofactor);
        if (is_flattening(f, cofactor))
            return false; /* the image of F is a line or a point */
    }
    turn->is_mirrored = vec_dot(f, cofactor) < 0;
    return true;
}

static void finish_turn(double f[9], splat_turn *turn)
{
    for (int i = 0; i < 9 && turn->is_mirrored; i++)
        f[i] = -f[i];
    find_turn_quaternion(f, turn->quaternion);
    for (int i = 1; i < 4; i++)
        turn->is_turn = turn->is_turn || fabs(turn->quaternion[i]) > NO_TURN;
    turn->is_turn = turn->is_turn || turn->is_mirrored;
    if (!turn->is_turn)
        *turn = (splat_turn){.quaternion = {1, 0, 0, 0}};
}

static void find_turn(const double gradient[9], splat_turn *turn)
{
    double f[9];
    if (!prepare_turn(gradient, turn, f))
        return;
    orthogonalise(f);
    finish_turn(f, turn);
}

typedef struct splat_way {
    turn_kernel *turn;
    ellipsoid_kernel *ellipsoid; /* NULL: the scalar functions */
} splat_way;

#define ROW(ISA, set, lanes) [FFD_ISA_##ISA] = {ffd_turn_kernel_##set, ffd_ellipsoid_kernel_##set},
static const splat_way ways[] = {[FFD_ISA_SCALAR] = {NULL, NULL}, FOR_EACH_SIMD(ROW)};

/* Number of splats in a call of a kernel. */
#define RUN ((size_t)256)

void ffd_splats_find_turns(ffd_isa isa, const double *gradients, size_t count, splat_turn *turns)
{
    turn_kernel *const kernel = ways[ffd_isa_resolve(isa)].turn;
    for (size_t first = 0; first < count; first += RUN) {
        const size_t some = count - first < RUN ? count - first : RUN;
        uint8_t open[RUN];
        memset(open, 1, some);
        if (kernel)
            kernel(gradients + 9 * first, some, turns + first, open);
        for (size_t i = 0; i < some; i++)
            if (open[i])
                find_turn(gradients + 9 * (first + i), &turns[first + i]);
    }
}

void ffd_splat_turn_to_file(const double frame[9], splat_turn *turn)
{
    double axes[9], rotation[9], product[9], turned[9];
    if (!turn->is_turn)
        return;
    /* A reflection in the frame cancels, because the frame is applied twice. */
    const double largest = mat_largest_entry(frame);
    for (int i = 0; i < 9; i++)
        axes[i] = frame[i] / largest;
    orthogonalise(axes);
    ffd_splat_matrix(turn->quaternion, rotation);
    mat_multiply(rotation, axes, product);
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            turned[3 * r + c] =
                axes[r] * product[c] + axes[3 + r] * product[3 + c] + axes[6 + r] * product[6 + c];
    find_turn_quaternion(turned, turn->quaternion);
}

/* Computes the scales relative to the largest. Returns false if a scale is not finite. */
static bool find_parts(const splat_form *form, const double scale[3], double parts[3])
{
    const int count = form->is_flat ? 2 : 3;
    double largest = scale[0];
    for (int i = 0; i < count; i++) {
        if (isnan(scale[i]) || scale[i] > DBL_MAX || (!form->is_logarithmic && !(scale[i] >= 0)))
            return false;
        largest = scale[i] > largest ? scale[i] : largest;
    }
    parts[2] = LEAST_PART;
    for (int i = 0; i < count; i++)
        if (form->is_logarithmic)
            parts[i] = largest < -DBL_MAX ? 1 : ffd_exp(larger_of(scale[i] - largest, LEAST_LOG));
        else
            parts[i] = largest > 0 ? larger_of(scale[i] / largest, LEAST_PART) : 1;
    return true;
}

/* Normalises a quaternion. Returns false if it is 0 or not finite. */
static bool find_unit(const double q[4], double unit[4])
{
    double largest = 0, sum = 0;
    for (int i = 0; i < 4; i++) {
        if (!(fabs(q[i]) <= DBL_MAX))
            return false;
        largest = fabs(q[i]) > largest ? fabs(q[i]) : largest;
    }
    if (largest == 0)
        return false;
    for (int i = 0; i < 4; i++) {
        unit[i] = q[i] / largest;
        sum += unit[i] * unit[i];
    }
    for (int i = 0; i < 4; i++)
        unit[i] /= sqrt(sum);
    return true;
}

/* Normalises the columns, with lengths of at least `least`. Columns that are shorter get a direction
   perpendicular to the others. */
static void unit_columns(double columns[3][3], const double least[3], double lengths[3])
{
    bool is_there[3];
    int there = 0, one = 0;
    for (int j = 0; j < 3; j++) {
        lengths[j] = vec_length(columns[j]);
        is_there[j] = lengths[j] > least[j];
        for (int k = 0; k < 3 && is_there[j]; k++)
            columns[j][k] /= lengths[j];
        if (!is_there[j])
            lengths[j] = least[j];
        there += is_there[j];
        one = is_there[j] ? j : one;
    }
    if (there == 3)
        return;
    if (there == 0)
        memcpy(columns[0], (double[3]){1, 0, 0}, sizeof columns[0]);
    if (there <= 1)
        ffd_direction_default_zero(columns[one], columns[(one + 1) % 3]);
    for (int j = 0; j < 3; j++)
        if (there <= 1 ? j == (one + 2) % 3 : !is_there[j])
            vec_cross(columns[(j + 1) % 3], columns[(j + 2) % 3], columns[j]);
}

/* Returns how well columns, in an order, match three axes as a right-handed frame: the sum of cosines. signs:
   those of the columns. */
static double fit(const double axes[9], const double columns[3][3], const int order[3], bool is_right,
                  double signs[3])
{
    double sum = 0, least = HUGE_VAL;
    int weakest = 0;
    for (int i = 0; i < 3; i++) {
        const double *const u = columns[order[i]];
        const double cosine = axes[i] * u[0] + axes[3 + i] * u[1] + axes[6 + i] * u[2];
        signs[i] = cosine < 0 ? -1 : 1;
        is_right = is_right == (cosine >= 0);
        sum += fabs(cosine);
        if (fabs(cosine) < least) {
            least = fabs(cosine);
            weakest = i;
        }
    }
    if (is_right)
        return sum;
    signs[weakest] = -signs[weakest];
    return sum - 2 * least;
}

/* Assigns the columns to axes, in the order and with the signs nearest to the old axes. */
static void choose_axes(const double axes[9], const double columns[3][3], bool is_flat, int order[3],
                        double rotation[9])
{
    double across[3], best = -HUGE_VAL, best_signs[3] = {1, 1, 1};
    vec_cross(columns[0], columns[1], across);
    const bool is_right = vec_dot(across, columns[2]) > 0;
    int chosen = 0;
    for (int o = 0; o < (is_flat ? 2 : 6); o++) {
        double signs[3];
        const double sum = fit(axes, columns, splat_orders[o], is_right == (o % 2 == 0), signs);
        if (sum > best) {
            best = sum;
            chosen = o;
            memcpy(best_signs, signs, sizeof signs);
        }
    }
    memcpy(order, splat_orders[chosen], sizeof splat_orders[chosen]);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++)
            rotation[3 * k + i] = best_signs[i] * columns[order[i]][k];
}

/* Replaces q by the quaternion of a rotation, with the length of q, and the sign nearer to the rotated q. */
static void replace_rotation(const double rotation[9], const double turn[4], const double unit[4],
                             double q[4])
{
    const double turned[4] = {turn[0] * unit[0] - turn[1] * unit[1] - turn[2] * unit[2] - turn[3] * unit[3],
                              turn[0] * unit[1] + turn[1] * unit[0] + turn[2] * unit[3] - turn[3] * unit[2],
                              turn[0] * unit[2] - turn[1] * unit[3] + turn[2] * unit[0] + turn[3] * unit[1],
                              turn[0] * unit[3] + turn[1] * unit[2] - turn[2] * unit[1] + turn[3] * unit[0]};
    double made[4], along = 0, length = 0;
    find_quaternion(rotation, made);
    for (int i = 0; i < 4; i++) {
        along += made[i] * turned[i];
        length += q[i] * unit[i]; /* unit is q / |q| */
    }
    for (int i = 0; i < 4; i++)
        q[i] = (along < 0 ? -length : length) * made[i];
}

/* A splat before its iteration. */
typedef struct ellipsoid_work {
    double unit[4], old[9], parts[3]; /* the unit quaternion, its matrix, the relative scales */
    double largest;                   /* largest entry of F */
    bool is_flattened;
} ellipsoid_work;

/* Computes the columns of F R S. Returns false, with the outcome, if there is nothing to do. */
static bool prepare_ellipsoid(const double gradient[9], const splat_form *form, const splat_ellipsoid *splat,
                              ellipsoid_work *work, double columns[9], uint8_t *outcome)
{
    double f[9], cofactor[9], product[9];
    *outcome = SPLAT_BROKEN;
    if (!is_usable(gradient) || !find_unit(splat->rotation, work->unit) ||
        !find_parts(form, splat->scale, work->parts))
        return false;
    *outcome = SPLAT_KEPT;
    if (mat_largest_entry(gradient) <= STILL)
        return false;
    mat_add_identity(gradient, f);
    mat_cofactor(f, cofactor);
    work->is_flattened = is_flattening(f, cofactor);
    work->largest = larger_of(mat_largest_entry(f), LEAST_F);
    ffd_splat_matrix(work->unit, work->old);
    mat_multiply(f, work->old, product);
    for (int j = 0; j < 3; j++)
        for (int k = 0; k < 3; k++)
            columns[3 * j + k] = product[3 * k + j] * work->parts[j];
    *outcome = work->is_flattened ? SPLAT_FLATTENED : SPLAT_CARRIED;
    return true;
}

static void finish_ellipsoid(const ellipsoid_work *work, double columns[3][3], const splat_turn *turn,
                             const splat_form *form, splat_ellipsoid *splat)
{
    double turning[9], axes[9], least[3], lengths[3], made[9];
    int order[3];
    ffd_splat_matrix(turn->quaternion, turning);
    mat_multiply(turning, work->old, axes);
    for (int j = 0; j < 3; j++)
        least[j] = NOTHING * work->largest * work->parts[j];
    unit_columns(columns, least, lengths);
    choose_axes(axes, (const double(*)[3])columns, form->is_flat, order, made);
    replace_rotation(made, turn->quaternion, work->unit, splat->rotation);
    const double scale[3] = {splat->scale[0], splat->scale[1], splat->scale[2]};
    for (int i = 0; i < (form->is_flat ? 2 : 3); i++) {
        const double ratio = lengths[order[i]] / work->parts[order[i]], from = scale[order[i]];
        splat->scale[i] = form->is_logarithmic ? from + ffd_log(ratio) : from * ratio;
    }
}

static void deform(const double gradient[9], const splat_turn *turn, const splat_form *form,
                   splat_ellipsoid *splat, uint8_t *outcome)
{
    ellipsoid_work work;
    double nine[9], columns[3][3];
    if (!prepare_ellipsoid(gradient, form, splat, &work, nine, outcome))
        return;
    part_columns(nine);
    memcpy(columns, nine, sizeof columns);
    finish_ellipsoid(&work, columns, turn, form, splat);
}

void ffd_splats_deform(ffd_isa isa, const double *gradients, const splat_turn *turns, const splat_form *form,
                       size_t count, splat_ellipsoid *splats, uint8_t *outcomes)
{
    ellipsoid_kernel *const kernel = ways[ffd_isa_resolve(isa)].ellipsoid;
    memset(outcomes, SPLAT_OPEN, count);
    if (kernel)
        kernel(gradients, turns, form, count, splats, outcomes);
    for (size_t i = 0; i < count; i++)
        if (outcomes[i] == SPLAT_OPEN)
            deform(gradients + 9 * i, &turns[i], form, &splats[i], &outcomes[i]);
}
