#include "fold/regular.h"
#include "base/vector/vec.h"
#include "fold/bernstein.h"

#define UNIT (0.5 * DBL_EPSILON)

/* Evaluates a component of a row at the centre. */
static double middle_of(const cell_form *form, int b, int r)
{
    static const double centre[3] = {0.5, 0.5, 0.5};
    return ffd_bernstein_value(form->row[b][r], form->order[b], centre);
}

/* off[r] = max |delta_rb - (Y J)_rb| over the cell for column b, including rounding. */
static void column_distance(const cell_form *form, int b, const double inverse[9], double off[3])
{
    const size_t count = ffd_bernstein_count(form->order[b]);
    const double *const *row = (const double *const *)form->row[b];
    const bool rational = form->rows == 4;
    double least[3] = {DBL_MAX, DBL_MAX, DBL_MAX}, greatest[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    for (size_t i = 0; i < count; i++) {
        double f[3] = {row[0][i], row[1][i], row[2][i]};
        for (int r = 0; rational && r < 3; r++)
            f[r] -= form->hull_middle[r] * row[3][i];
        for (int r = 0; r < 3; r++) {
            const double *y = inverse + 3 * r, value = y[0] * f[0] + y[1] * f[1] + y[2] * f[2];
            least[r] = value < least[r] ? value : least[r];
            greatest[r] = value > greatest[r] ? value : greatest[r];
        }
    }
    const double weight = rational ? form->greatest.at[b][3] : 0,
                 weight_error = rational ? form->rounding.at[b][3] : 0;
    for (int r = 0; r < 3; r++) {
        const double one = r == b ? 1 : 0;
        off[r] = maximum_number(fabs(one - least[r]), fabs(one - greatest[r])) * (1 + 4 * UNIT) + UNIT;
        for (int k = 0; k < 3; k++) {
            const double size = form->greatest.at[b][k] + fabs(form->hull_middle[k]) * weight;
            double doubt = form->rounding.at[b][k] + 8 * UNIT * size;
            if (rational)
                doubt +=
                    fabs(form->hull_middle[k]) * weight_error + form->hull_reach[k] * (weight + weight_error);
            off[r] += fabs(inverse[3 * r + k]) * doubt;
        }
    }
}

/* Returns the determinant of the matrix with 1 - off_ii on the diagonal and -off_ij elsewhere, if its leading
   minors are positive; else 0. */
static double comparison_determinant(const double off[3][3])
{
    const double a = 1 - off[0][0], b = 1 - off[1][1], c = 1 - off[2][2];
    const double minor = a * b - off[0][1] * off[1][0];
    if (!(a > 0 && b > 0 && c > 0 && minor > 8 * UNIT))
        return 0;
    const double det = minor * c - a * off[1][2] * off[2][1] - b * off[0][2] * off[2][0] -
                       off[0][1] * off[1][2] * off[2][0] - off[0][2] * off[1][0] * off[2][1];
    return det > 32 * UNIT ? det - 32 * UNIT : 0;
}

/* Returns det Y, and a bound of its rounding error. */
static double inverse_determinant(const double y[9], double *rounding)
{
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        sum += fabs(y[i]) * (fabs(y[3 + j] * y[6 + k]) + fabs(y[3 + k] * y[6 + j]));
    }
    *rounding = 16 * UNIT * sum;
    return mat_determinant(y);
}

void ffd_cell_regularity(const cell_form *form, regularity *result)
{
    double jacobian[9], inverse[9], off[3][3];
    result->proven = false;
    for (int b = 0; b < 3; b++)
        for (int r = 0; r < 3; r++) {
            jacobian[3 * r + b] = middle_of(form, b, r);
            if (form->rows == 4)
                jacobian[3 * r + b] -= form->hull_middle[r] * middle_of(form, b, 3);
        }
    if (!mat_invert(jacobian, inverse))
        return;
    for (int i = 0; i < 9; i++)
        if (!(fabs(inverse[i]) < 1e150)) /* so that products do not overflow */
            return;
    for (int b = 0; b < 3; b++) {
        double column[3];
        column_distance(form, b, inverse, column);
        for (int r = 0; r < 3; r++)
            off[r][b] = column[r];
    }
    double rounding;
    const double least = comparison_determinant((const double(*)[3])off);
    const double det = inverse_determinant(inverse, &rounding);
    if (!(least > 0) || !(fabs(det) > 2 * rounding))
        return;
    const double weight = form->greatest_weight;
    result->proven = true;
    result->negative = det < 0;
    /* 1e-12 covers the rounding of the weights and of the product. */
    result->least = least / (fabs(det) + rounding) / weight / weight / weight * (1 - 1e-12);
}
