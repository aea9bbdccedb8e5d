/* bernstein.h - scalar polynomials over [0,1]^3 in tensor Bernstein form: products, halving, values. Points
   of the coefficient grid are stored with u fastest; order is the degree + 1 of each direction. */
#ifndef FFD_FOLD_BERNSTEIN_H
#define FFD_FOLD_BERNSTEIN_H

#include <stddef.h>

/* 4 degrees less 1, of a product of four polynomials of degree 9. */
#define BERNSTEIN_MAX_ORDER 36

/* Coefficients of a polynomial of this order. */
size_t ffd_bernstein_count(const int order[3]);

/* A product's coefficients are convex combinations of products of coefficients: c_k = sum_i C(m,i) C(n,k-i) /
   C(m+n,k) a_i b_{k-i} (Farouki & Rajan, Algorithms for polynomials in Bernstein form, 1988). With every
   coefficient multiplied by its binomials ("weighted") that is plain convolution. */
void ffd_bernstein_weight(const double *from, const int order[3], double *to); /* to may be from */
void ffd_bernstein_unweight(double *coefficients, const int order[3], double factor);

/* product += factor a b, all three weighted; product has order a + b - 1. */
void ffd_bernstein_multiply(const double *a, const int order_a[3], const double *b, const int order_b[3],
                            double factor, double *product);
/* The most products that are summed up in one coefficient of a b. */
double ffd_bernstein_terms(const int order_a[3], const int order_b[3]);

/* The halves across direction a (de Casteljau): lower gets its own coefficients, the upper half stays in
   place. Each adds a rounding of no more than (order[a] - 1) DBL_EPSILON / 2 max |c|. */
void ffd_bernstein_halve(double *coefficients, const int order[3], int a, double *lower);

/* The part lo..hi, a dyadic interval in each direction, in place; scratch is of the same size. */
void ffd_bernstein_restrict(double *coefficients, const int order[3], const double lo[3], const double hi[3],
                            double *scratch);

/* The value at t in [0,1]^3, rounded by no more than 8 (order[0] + order[1] + order[2]) DBL_EPSILON / 2
   max |c|. */
double ffd_bernstein_value(const double *coefficients, const int order[3], const double t[3]);

/* The direction in which the coefficients are farthest from the polynomial's values: that with the greatest
   degree times second difference. */
int ffd_bernstein_direction(const double *coefficients, const int order[3]);

/* The greatest |value| of count coefficients; 0 for none. */
double ffd_bernstein_greatest_size(const double *values, size_t count);

#endif
