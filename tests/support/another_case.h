/* another_case.h - limits the number of cases of a property test: a fixed minimum, then by time, so that slow
   builds make fewer cases and end as early. FFD_CASES=N: exactly N cases. FFD_SECONDS=N: for N seconds. */
#ifndef FFD_TESTS_ANOTHER_CASE_H
#define FFD_TESTS_ANOTHER_CASE_H

#include <stdbool.h>
#include <stdlib.h>
#include <time.h>

/* Returns a positive number from an environment variable, else 0. */
static inline double case_setting(const char *name)
{
    const char *const value = getenv(name);
    const double number = value ? strtod(value, NULL) : 0;
    return number > 0 ? number : 0;
}

/* Whether to make another case after `made` ones: up to `least` always, then until `most`, or for this many
   seconds of processor time. *began: set at the first case. */
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
