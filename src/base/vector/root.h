/* root.h - roots of numbers, with the same bits on every processor. */
#ifndef FFD_BASE_VECTOR_ROOT_H
#define FFD_BASE_VECTOR_ROOT_H

/* Returns the n-th root of x, within about 1 ulp (+ - * / only). x is finite and positive, n from 2. */
double ffd_root(double x, int n);

#endif
