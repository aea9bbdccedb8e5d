/* test_contraction.c - the contraction bound of a box holds at samples, halves are parts of the box, and each
   instruction set of this processor gives the same bits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/repetitions.h"
#include "base/vector/isa.h"
#include "base/vector/vec.h"
#include "embed/cells/contraction_kernel.h"
#include <string.h>

#define MOST (4 * MAX_ORDER * MAX_ORDER * MAX_ORDER)

#define ROW(ISA, set, lanes) [FFD_ISA_##ISA] = &ffd_contraction_kernel_##set,
static const contraction_kernel *const kernels[] = {[FFD_ISA_SCALAR] = &ffd_contraction_kernel_scalar,
                                                    FOR_EACH_SIMD(ROW)};

/* A bent brick: the identity map, times weights, with every number perturbed. */
static void random_box(draw *d, bezier_box *box, double bend)
{
    double *c = box->coefficients;
    for (int a = 0; a < 3; a++) {
        box->order[a] = draw_int(d, 2, 10);
        box->lo[a] = 0;
        box->hi[a] = 1;
    }
    box->rational = draw_int(d, 0, 1);
    for (int k = 0; k < box->order[2]; k++)
        for (int j = 0; j < box->order[1]; j++)
            for (int i = 0; i < box->order[0]; i++, c += 4) {
                const double at[3] = {(double)i / (box->order[0] - 1), (double)j / (box->order[1] - 1),
                                      (double)k / (box->order[2] - 1)};
                c[3] = box->rational ? draw_between(d, 0.8, 1.25) : 1;
                for (int a = 0; a < 3; a++)
                    c[a] = c[3] * (at[a] + draw_between(d, -bend, bend));
            }
}

/* Evaluates all degree+1 Bernstein polynomials and their derivatives. */
static void bernstein(int degree, double t, double *value, double *slope)
{
    for (int i = 0; i <= degree; i++) {
        double binomial = 1;
        for (int x = 0; x < i; x++)
            binomial = binomial * (degree - x) / (x + 1);
        value[i] = binomial * pow(t, i) * pow(1 - t, degree - i);
        slope[i] = binomial * ((i > 0 ? i * pow(t, i - 1) * pow(1 - t, degree - i) : 0) -
                               (i < degree ? (degree - i) * pow(t, i) * pow(1 - t, degree - i - 1) : 0));
    }
}

/* Evaluates A - p W (3 numbers) and its derivatives by t, row-major (9). */
static void evaluate(const bezier_box *box, const double t[3], const double p[3], double f[3],
                     double jacobian[9])
{
    double value[3][MAX_ORDER], slope[3][MAX_ORDER];
    const double *c = box->coefficients;
    memset(f, 0, 3 * sizeof *f);
    memset(jacobian, 0, 9 * sizeof *jacobian);
    for (int a = 0; a < 3; a++)
        bernstein(box->order[a] - 1, t[a], value[a], slope[a]);
    for (int k = 0; k < box->order[2]; k++)
        for (int j = 0; j < box->order[1]; j++)
            for (int i = 0; i < box->order[0]; i++, c += 4)
                for (int r = 0; r < 3; r++) {
                    const double number = c[r] - p[r] * c[3];
                    f[r] += number * value[0][i] * value[1][j] * value[2][k];
                    jacobian[3 * r] += number * slope[0][i] * value[1][j] * value[2][k];
                    jacobian[3 * r + 1] += number * value[0][i] * slope[1][j] * value[2][k];
                    jacobian[3 * r + 2] += number * value[0][i] * value[1][j] * slope[2][k];
                }
}

/* Samples the box, including its corners and its middle. */
static void check_bound(draw *d, const bezier_box *box, const double middle[3], const double reach[3],
                        const contraction_bound *found)
{
    for (int n = 0; n < 40; n++) {
        double t[3], p[3], f[3], jacobian[9], product[9];
        for (int a = 0; a < 3; a++) {
            t[a] = n < 8 ? n >> a & 1 : n == 8 ? 0.5 : draw_unit(d);
            p[a] = middle[a] + reach[a] * (n % 3 == 0 ? 1 : draw_between(d, -1, 1));
        }
        evaluate(box, t, p, f, jacobian);
        mat_multiply(found->inverse, jacobian, product);
        for (int r = 0; r < 3; r++) {
            double sum = 0;
            for (int c = 0; c < 3; c++)
                sum += fabs((r == c) - product[3 * r + c]);
            if (!(sum <= found->bound * (1 + 1e-12) + 1e-12))
                fail_msg("the bound is %g, at %g,%g,%g it is %g", found->bound, t[0], t[1], t[2], sum);
            if (n == 8 && reach[0] == 0 && sum > 1e-9)
                fail_msg("in the middle Y J_F is off by %g", sum);
        }
    }
}

static void check_kernels(const bezier_box *box, const double middle[3], const double reach[3],
                          const contraction_bound *found, const double *columns, int halving)
{
    static double others[3 * MOST];
    const size_t size = 3 * ffd_bezier_size(box->order);
    for (ffd_isa isa = FFD_ISA_SCALAR; isa <= FFD_ISA_NEON; isa++) {
        contraction_bound other;
        if (!ffd_isa_available(isa))
            continue;
        memset(others, 0, sizeof others);
        kernels[isa]->find_bound(box, middle, reach, others, &other);
        assert_int_equal(other.regular, found->regular);
        assert_memory_equal(other.inverse, found->inverse, sizeof other.inverse);
        assert_memory_equal(&other.bound, &found->bound, sizeof other.bound);
        assert_memory_equal(others, columns, size * sizeof *others);
        assert_int_equal(kernels[isa]->find_halving(box, &other, others), halving);
    }
}

static void bounds_hold_and_kernels_agree(void **state)
{
    static double numbers[MOST], columns[3 * MOST];
    draw d = {draw_seed()};
    for (int round = 0; round < repetitions(300); round++) {
        bezier_box box = {.coefficients = numbers};
        contraction_bound found;
        double middle[3], reach[3];
        random_box(&d, &box, draw_between(&d, 0, 0.15));
        for (int a = 0; a < 3; a++) {
            middle[a] = draw_unit(&d);
            reach[a] = round % 2 ? draw_unit(&d) : 0;
        }
        memset(columns, 0, sizeof columns);
        ffd_contraction_kernel_scalar.find_bound(&box, middle, reach, columns, &found);
        assert_true(found.regular);
        check_bound(&d, &box, middle, reach, &found);
        check_kernels(&box, middle, reach, &found, columns,
                      ffd_contraction_kernel_scalar.find_halving(&box, &found, columns));
    }
    (void)state;
}

static void what_has_no_bound_gets_none(void **state)
{
    static const double zero[3] = {0, 0, 0};
    double numbers[4 * 8], columns[3 * 4 * 8];
    bezier_box box = {.order = {2, 2, 2}, .hi = {1, 1, 1}, .coefficients = numbers};
    contraction_bound found;
    /* So thin that computing the inverse overflows on the way. */
    for (int n = 0; n < 8; n++) {
        const double i = n & 1, j = n >> 1 & 1, k = n >> 2;
        const double point[4] = {i * 2.42e-308 + (1 - j) * 1.9, (1 - j) * 1.9, k, 1};
        memcpy(numbers + 4 * n, point, sizeof point);
    }
    for (ffd_isa isa = FFD_ISA_SCALAR; isa <= FFD_ISA_NEON; isa++) {
        if (!ffd_isa_available(isa))
            continue;
        kernels[isa]->find_bound(&box, zero, zero, columns, &found);
        assert_true(!found.regular || found.bound == HUGE_VAL);
    }
    /* Flat, and longest along v. */
    for (int n = 0; n < 8; n++) {
        const double point[4] = {n & 1, 2 * (n >> 1 & 1), 0, 1};
        memcpy(numbers + 4 * n, point, sizeof point);
    }
    ffd_contraction_kernel_scalar.find_bound(&box, zero, zero, columns, &found);
    assert_false(found.regular);
    assert_int_equal(ffd_contraction_kernel_scalar.find_halving(&box, &found, columns), 1);
    (void)state;
}

/* The lower half at t is the box at t/2, the upper half is the box at (1+t)/2. */
static void halves_are_parts(void **state)
{
    static double numbers[MOST], low_numbers[MOST], high_numbers[MOST];
    static const double origin[3] = {0, 0, 0};
    draw d = {draw_seed()};
    for (int round = 0; round < 100; round++) {
        bezier_box box = {.coefficients = numbers},
                   half[2] = {{.coefficients = low_numbers}, {.coefficients = high_numbers}};
        const int a = draw_int(&d, 0, 2);
        random_box(&d, &box, 0.1);
        ffd_bezier_halve(&box, a, &half[0], &half[1]);
        for (int h = 0; h < 2; h++) {
            double t[3] = {draw_unit(&d), draw_unit(&d), draw_unit(&d)}, of_half[3], of_box[3], jacobian[9];
            evaluate(&half[h], t, origin, of_half, jacobian);
            t[a] = (h + t[a]) / 2;
            evaluate(&box, t, origin, of_box, jacobian);
            for (int r = 0; r < 3; r++)
                assert_true(fabs(of_half[r] - of_box[r]) <= 1e-14);
            assert_true(half[h].lo[a] == 0.5 * h && half[h].hi[a] == 0.5 * (h + 1));
        }
    }
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_hold_and_kernels_agree),
        cmocka_unit_test(what_has_no_bound_gets_none),
        cmocka_unit_test(halves_are_parts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
