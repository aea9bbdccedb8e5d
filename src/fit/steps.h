/* steps.h - how much of a fit is done, in multiplications and additions: told to the caller who watches it
   (base/system/deadline.h). */
#ifndef FFD_FIT_STEPS_H
#define FFD_FIT_STEPS_H

typedef struct fit_steps {
    double expected;     /* of all steps */
    double before, step; /* of those that are done, and of the one that runs */
} fit_steps;

/* Begins the next of the steps that are expected. steps: NULL here and below: none are counted. */
void ffd_fit_step_begin(fit_steps *steps, double work);
/* Tells the part of it that is done. */
void ffd_fit_step_done(const fit_steps *steps, double part);

#endif
