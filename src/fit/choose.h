/* choose.h - how smooth a fit is: the choice of S. */
#ifndef FFD_FIT_CHOOSE_H
#define FFD_FIT_CHOOSE_H

#include "fit/system.h"

/* What is taken where the places do not tell, and the least that is chosen: what is on a body does not tell
   of the space round it. */
#define FIT_DEFAULT_SMOOTH 0.01

/* Returns 10^(half / 2). */
double ffd_half_power(int half);

/* Chooses S by generalised cross-validation (Craven & Wahba 1979), of the soft rows; of a system with more
   than 1,000 unknowns on a coarser lattice with the same domain, for S has no unit. lengths: of the lattice's
   lines (gram.h). *gcv: the least value; NaN where it does not tell, and S is the default. Errors: those of
   ffd_system_solve. */
ffd_status ffd_smooth_choose(const fit_system *system, const double lengths[3], double *smooth, double *gcv,
                             ffd_error *error);
/* Returns the multiplications and additions of that for so many places, exact ones among them or not,
 * roughly.
 */
double ffd_smooth_choose_work(const fit_unknowns *unknowns, size_t places, bool has_exact);

#endif
