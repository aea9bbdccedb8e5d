#include "splat/splat_iterations.h"
#include "base/vector/vec.h"

void ffd_splat_orthogonalise(double x[9])
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

/* The one-sided Jacobi method (Golub & Van Loan, Matrix Computations, 8.6.3) has a high relative accuracy for
   small singular values next to large ones. */
void ffd_splat_part_columns(double columns[9])
{
    bool any = true;
    for (int sweep = 0; sweep < SWEEPS && any; sweep++) {
        any = rotate(columns, columns + 3);
        any = rotate(columns, columns + 6) || any;
        any = rotate(columns + 3, columns + 6) || any;
    }
}
