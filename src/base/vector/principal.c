#include "base/vector/principal.h"
#include "base/vector/direction.h"
#include "base/vector/vec.h"

/* More than enough, because Jacobi sweeps converge quadratically. */
#define SWEEPS 30

/* Sums the products of the coordinates relative to their mean. */
static void find_covariance(const double *xyz, size_t count, const double center[3], double length,
                            double covariance[9])
{
    double sum[3] = {0, 0, 0}, product[9] = {0}, finite = 0;
    for (size_t i = 0; i < count; i++) {
        double p[3];
        for (int c = 0; c < 3; c++)
            p[c] = (xyz[3 * i + c] - center[c]) / length;
        if (!vec_is_finite(p))
            continue;
        finite++;
        for (int r = 0; r < 3; r++) {
            sum[r] += p[r];
            for (int c = 0; c < 3; c++)
                product[3 * r + c] += p[r] * p[c];
        }
    }
    for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
            covariance[3 * r + c] = (product[3 * r + c] - sum[r] * sum[c] / finite) / finite;
}

/* A rotation in the plane of axes p and q that makes a[p][q] zero (Golub & Van Loan, Matrix Computations,
   8.5.2). */
static void rotate(double a[9], double vectors[9], int p, int q)
{
    const double off = a[3 * p + q];
    if (off == 0)
        return;
    const double tau = (a[4 * q] - a[4 * p]) / (2 * off);
    const double t = (tau >= 0 ? 1 : -1) / (fabs(tau) + sqrt(1 + tau * tau));
    const double c = 1 / sqrt(1 + t * t), s = t * c;
    for (int k = 0; k < 3; k++) {
        const double x = a[3 * k + p], y = a[3 * k + q];
        a[3 * k + p] = c * x - s * y;
        a[3 * k + q] = s * x + c * y;
    }
    for (int k = 0; k < 3; k++) {
        const double x = a[3 * p + k], y = a[3 * q + k];
        a[3 * p + k] = c * x - s * y;
        a[3 * q + k] = s * x + c * y;
    }
    a[3 * p + q] = a[3 * q + p] = 0;
    for (int k = 0; k < 3; k++) {
        const double x = vectors[3 * p + k], y = vectors[3 * q + k];
        vectors[3 * p + k] = c * x - s * y;
        vectors[3 * q + k] = s * x + c * y;
    }
}

/* Sorts indices by descending value; a stable sort. */
static void sort_falling(const double value[3], int order[3])
{
    for (int i = 0; i < 3; i++) {
        int slot = i;
        for (; slot > 0 && value[order[slot - 1]] < value[i]; slot--)
            order[slot] = order[slot - 1];
        order[slot] = i;
    }
}

static void point_forward(double v[3])
{
    int largest = 0;
    for (int c = 1; c < 3; c++)
        if (fabs(v[c]) > fabs(v[largest]))
            largest = c;
    const double sign = v[largest] < 0 ? -1 : 1;
    for (int c = 0; c < 3; c++)
        v[c] = sign * v[c] + 0.0; /* no -0 */
}

void ffd_principal_axes(const double *xyz, size_t count, const double center[3], double length,
                        double axes[9])
{
    double covariance[9], vectors[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    find_covariance(xyz, count, center, length, covariance);
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int p = 0; p < 2; p++)
            for (int q = p + 1; q < 3; q++)
                rotate(covariance, vectors, p, q);
    const double value[3] = {covariance[0], covariance[4], covariance[8]};
    int order[3];
    sort_falling(value, order);
    for (int r = 0; r < 2; r++) {
        for (int c = 0; c < 3; c++)
            axes[3 * r + c] = vectors[3 * order[r] + c];
        ffd_direction_unit(axes + 3 * r);
        point_forward(axes + 3 * r);
    }
    ffd_direction_perpendicular(axes, axes + 3);
    vec_cross(axes, axes + 3, axes + 6);
    for (int c = 0; c < 3; c++)
        axes[6 + c] += 0.0;
}
