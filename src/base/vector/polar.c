#include "base/vector/polar.h"
#include "base/vector/vec.h"
#include <math.h>
#include <string.h>

/* Newton's iteration converges quadratically after a few steps that bring the singular values together. */
#define MOST_STEPS 60
#define CONVERGED 1e-15
/* Tolerance for the entries of a rotation: rounding errors in the gradient of a lattice that does not
   rotate. */
#define ROUNDING 1e-12

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

bool ffd_mat_is_near_identity(const double m[9], double most)
{
    for (int i = 0; i < 9; i++)
        if (!(fabs(m[i] - identity[i]) <= most))
            return false;
    return true;
}

static double square_sum(const double m[9])
{
    double sum = 0;
    for (int i = 0; i < 9; i++)
        sum += m[i] * m[i];
    return sum;
}

/* One step: x = (s x + x^-T / s) / 2, with the scale s that gives both terms the same size. Returns the
   largest change of an entry; negative if x is not invertible. ffd_splat_orthogonalise does the same in the
   order of operations of the splat kernels, and keeps reflections; its last bits nearly always differ, so
   using it here would change outputs. */
static double step(double x[9])
{
    double inverse[9], moved = 0;
    if (!mat_invert(x, inverse))
        return -1;
    const double scale = sqrt(sqrt(square_sum(inverse) / square_sum(x)));
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) {
            const double next = (scale * x[3 * r + c] + inverse[3 * c + r] / scale) / 2;
            moved = larger_of(moved, fabs(next - x[3 * r + c]));
            x[3 * r + c] = next;
        }
    return moved;
}

bool ffd_mat_rotation(const double m[9], double rotation[9])
{
    double x[9], largest = 0, det;
    memcpy(rotation, identity, sizeof identity);
    for (int i = 0; i < 9; i++)
        largest = larger_of(largest, fabs(m[i]));
    if (!(largest > 0) || !isfinite(largest))
        return false;
    for (int i = 0; i < 9; i++)
        x[i] = m[i] / largest;
    if (ffd_mat_is_singular(x, &det) || !(det > 0))
        return false;
    double moved = 1;
    for (int k = 0; k < MOST_STEPS && moved > CONVERGED; k++)
        moved = step(x);
    if (!(moved >= 0 && moved <= sqrt(CONVERGED)) || !isfinite(square_sum(x)))
        return false;
    if (!ffd_mat_is_near_identity(x, ROUNDING))
        memcpy(rotation, x, sizeof x);
    return true;
}

double ffd_cube_root(double value)
{
    int exponent;
    if (value == 0 || !isfinite(value))
        return value;
    const double mantissa = frexp(fabs(value), &exponent);
    const int rest = ((exponent % 3) + 3) % 3;
    const double scaled = ldexp(mantissa, rest); /* [1/2, 4) */
    double root = 1;
    for (int k = 0; k < 12; k++)
        root = (2 * root + scaled / (root * root)) / 3;
    return copysign(ldexp(root, (exponent - rest) / 3), value);
}

/* Divides by the largest component, then by the length. splat.c has a version with the operations of the
   splat kernels, and gltf_pose.c one with those of three.js. They often differ in the last bits, so they
   cannot be merged without changing outputs. */
void ffd_mat_quaternion(const double r[9], double q[4])
{
    /* Four times the square of each component; the divisor is the largest component. */
    const double squares[4] = {1 + r[0] - r[4] - r[8], 1 - r[0] + r[4] - r[8], 1 - r[0] - r[4] + r[8],
                               1 + r[0] + r[4] + r[8]};
    const double products[4][4] = {{0, r[3] + r[1], r[2] + r[6], r[7] - r[5]},
                                   {r[3] + r[1], 0, r[7] + r[5], r[2] - r[6]},
                                   {r[2] + r[6], r[7] + r[5], 0, r[3] - r[1]},
                                   {r[7] - r[5], r[2] - r[6], r[3] - r[1], 0}};
    int most = 3;
    for (int i = 0; i < 3; i++)
        if (squares[i] > squares[most])
            most = i;
    const double twice = sqrt(squares[most]);
    for (int i = 0; i < 4; i++)
        q[i] = i == most ? twice / 2 : products[most][i] / (2 * twice);
    const double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++)
        q[i] = (q[3] < 0 ? -q[i] : q[i]) / length;
}

void ffd_quaternion_multiply(const double a[4], const double b[4], double product[4])
{
    const double x = a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1];
    const double y = a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0];
    const double z = a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3];
    const double w = a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2];
    product[0] = x;
    product[1] = y;
    product[2] = z;
    product[3] = w;
}
