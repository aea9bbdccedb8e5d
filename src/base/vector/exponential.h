/* exponential.h - e^x and the natural logarithm with additions, multiplications and divisions only, so that
   the result has the same bits on every machine, which the C library does not promise. */
#ifndef FFD_BASE_VECTOR_EXPONENTIAL_H
#define FFD_BASE_VECTOR_EXPONENTIAL_H

/* e^x for |x| <= 700, with a relative error below 4e-16. */
double ffd_exp(double x);
/* ln x for positive, finite, normal x. The error is below 4e-16 max(1, |ln x|). */
double ffd_log(double x);

#endif
