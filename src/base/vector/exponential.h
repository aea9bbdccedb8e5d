/* exponential.h - e^x and the natural logarithm by additions, multiplications and divisions alone, whose bits
   are the same on every machine: those of the C library are not. */
#ifndef FFD_BASE_VECTOR_EXPONENTIAL_H
#define FFD_BASE_VECTOR_EXPONENTIAL_H

/* x of size 700 at most. The relative error is below 4e-16. */
double ffd_exp(double x);
/* x positive, finite and not subnormal. The error is below 4e-16 of the larger of 1 and the result's size. */
double ffd_log(double x);

#endif
