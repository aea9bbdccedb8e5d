#include "fit/steps.h"
#include "base/system/deadline.h"
#include <stddef.h>

void ffd_fit_step_begin(fit_steps *steps, double work)
{
    if (!steps)
        return;
    steps->before += steps->step;
    steps->step = work;
    ffd_fit_step_done(steps, 0);
}

void ffd_fit_step_done(const fit_steps *steps, double part)
{
    const double done = steps ? steps->before + part * steps->step : 0;
    if (steps && done < steps->expected)
        ffd_deadline_done(done / steps->expected);
}
