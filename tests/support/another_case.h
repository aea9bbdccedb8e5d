/* another_case.h - how many cases a property test makes: by time, after a fixed least number, so that a slow
   build makes fewer and ends no later. FFD_CASES=N: exactly N. FFD_SECONDS=N: for N seconds. */
#ifndef FFD_TESTS_ANOTHER_CASE_H
#define FFD_TESTS_ANOTHER_CASE_H

#include <stdbool.h>
#include <stdlib.h>
#include <time.h>

/* A positive number of the environment, else 0. */
static inline double case_setting(const char *name)
{
    const char *const value = getenv(name);
    const double number = value ? strtod(value, NULL) : 0;
    return number > 0 ? number : 0;
}

/* Whether a test that has made so many cases makes another: always the least number, then up to `most` for so
   many seconds of processor time. began is set at the first case. */
static inline bool another_case(long made, double *began, long least, long most, double seconds)
{
    const double now = (double)clock() / CLOCKS_PER_SEC, cases = case_setting("FFD_CASES"),
                 longer = case_setting("FFD_SECONDS");
    if (made == 0)
        *began = now;
    if (cases > 0)
        return (double)made < cases;
    if (made < least)
        return true;
    return longer > 0 ? now - *began < longer : made < most && now - *began < seconds;
}

#endif
