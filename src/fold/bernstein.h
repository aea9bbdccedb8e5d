/* bernstein.h - scalar polynomials over [0,1]^3 in tensor-product Bernstein form: products, halving, values.
   Coefficients are stored with u fastest; order[a] is the degree + 1 in direction a. */
#ifndef FFD_FOLD_BERNSTEIN_H
#define FFD_FOLD_BERNSTEIN_H

#include <stddef.h>

/* Degree 4 * 14 - 1, of a determinant of four rows with degree 14. Its binomials are the last that a double
   holds exactly: C(55, 27) is 3.8e15, which the bounds of rounding rely on. */
#define BERNSTEIN_MAX_ORDER 56

/* Returns the number of coefficients of a polynomial of this order. */
size_t ffd_bernstein_count(const int order[3]);

/* Multiplies every coefficient by its binomials ("weighted" coefficients). The coefficients of a product are
   convex combinations of products of coefficients: c_k = sum_i C(m,i) C(n,k-i) / C(m+n,k) a_i b_{k-i}
   (Farouki & Rajan, Algorithms for polynomials in Bernstein form, 1988); with weighted coefficients that is a
   convolution. */
void ffd_bernstein_weight(const double *from, const int order[3], double *to); /* to may be from */
void ffd_bernstein_unweight(double *coefficients, const int order[3], double factor);

/* product += factor * a * b, all three weighted; product has the order order_a + order_b - 1. */
void ffd_bernstein_multiply(const double *a, const int order_a[3], const double *b, const int order_b[3],
                            double factor, double *product);
/* The derivative of that: slope += factor * the derivative, by the coefficients of a, of a function of the
   product whose derivative by the product's weighted coefficients is `of_product`. */
void ffd_bernstein_multiply_back(const double *of_product, const int order_a[3], const double *b,
                                 const int order_b[3], double factor, double *slope);
/* Returns the greatest number of products in a coefficient of a * b. */
double ffd_bernstein_terms(const int order_a[3], const int order_b[3]);

/* Splits in direction a (de Casteljau): lower receives the lower half, the upper half replaces coefficients.
   The rounding error is at most (order[a] - 1) DBL_EPSILON / 2 max |c|. */
void ffd_bernstein_halve(double *coefficients, const int order[3], int a, double *lower);

/* Restricts the polynomial to lo..hi, a dyadic interval in each direction, in place. scratch has the same
   size. */
void ffd_bernstein_restrict(double *coefficients, const int order[3], const double lo[3], const double hi[3],
                            double *scratch);

/* Returns the value at t in [0,1]^3, with a rounding error of at most 8 (order[0] + order[1] + order[2])
   DBL_EPSILON / 2 max |c|. */
double ffd_bernstein_value(const double *coefficients, const int order[3], const double t[3]);

/* Returns the direction in which the coefficients deviate most from the values of the polynomial: the one
   with the greatest product of degree and second difference. */
int ffd_bernstein_direction(const double *coefficients, const int order[3]);

/* Returns the greatest magnitude of count values; 0 if count is 0. */
double ffd_bernstein_greatest_size(const double *values, size_t count);

#endif
