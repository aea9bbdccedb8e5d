/* precise.h - the volume at one u,v,w in long double, by formulas of its own: what the library's answers are
   held against. */
#ifndef FFD_TESTS_FUZZ_PRECISE_H
#define FFD_TESTS_FUZZ_PRECISE_H

#include "lattice/lattice.h"

typedef struct precise_sample {
    long double point[3];    /* C - centre */
    long double jacobian[9]; /* dC_r / du_a at 3 r + a */
    /* sum |P_r - C_r| |d R / d u_a|: how much C_r can follow u_a, where J may be 0 by chance */
    long double sway[9];
} precise_sample;

/* C of the rest or deformed volume at uvw (in the domain), centre subtracted from the control points. */
void precise_evaluate(const ffd_lattice *lattice, ffd_volume volume, const double uvw[3],
                      const double centre[3], precise_sample *sample);

long double precise_determinant(const long double m[9]);

/* The relative error of one operation: that of doubles where long double is no better (valgrind). */
long double precise_unit(void);

#endif
