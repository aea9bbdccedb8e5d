/* exponential_terms.h - the constants of exponential.c and exponential_lanes.h. */
#ifndef FFD_BASE_VECTOR_EXPONENTIAL_TERMS_H
#define FFD_BASE_VECTOR_EXPONENTIAL_TERMS_H

/* ln 2 as a sum of two parts; products of LN2_HIGH with exponents of doubles are exact. */
#define LN2_HIGH 6.93147180369123816490e-01
#define LN2_LOW 1.90821492927058770002e-10
#define LOG2_E 1.44269504088896338700

/* The position and the bias of the exponent in a double. */
#define EXPONENT_AT 52
#define EXPONENT_BIAS 1023

/* 1/i!. The first omitted term of the Taylor series is below 4e-18 for |r| <= ln 2 / 2. */
#define EXP_TERMS 13
static const double inverse_factorials[EXP_TERMS + 1] = {1.0,
                                                         1.0,
                                                         0.5,
                                                         0.16666666666666666,
                                                         0.041666666666666664,
                                                         0.008333333333333333,
                                                         0.001388888888888889,
                                                         0.0001984126984126984,
                                                         2.48015873015873e-05,
                                                         2.7557319223985893e-06,
                                                         2.755731922398589e-07,
                                                         2.505210838544172e-08,
                                                         2.08767569878681e-09,
                                                         1.6059043836821613e-10};

/* The logarithm is computed for mantissas in [sqrt(2)/2, sqrt(2)). */
#define ROOT_2 1.41421356237309504880

/* log m = 2 artanh z with z = (m - 1)/(m + 1), and |z| < 0.172 for m from sqrt(1/2) to sqrt(2): the
   coefficients of z^3, z^5 and so on. */
#define ARTANH_TERMS 10
static const double artanh[ARTANH_TERMS] = {0.3333333333333333,  0.2,
                                            0.14285714285714285, 0.1111111111111111,
                                            0.09090909090909091, 0.07692307692307693,
                                            0.06666666666666667, 0.058823529411764705,
                                            0.05263157894736842, 0.047619047619047616};

#endif
