/* under_valgrind.h - memcheck looks for values that were never set, and takes thirty times the time: the same
   code with other numbers finds it nothing new. */
#ifndef FFD_TEST_UNDER_VALGRIND_H
#define FFD_TEST_UNDER_VALGRIND_H

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static inline bool is_under_valgrind(void)
{
    const char *loaded = getenv("LD_PRELOAD");
    return loaded && strstr(loaded, "vgpreload");
}

/* Of so many repetitions, those that are worth their time. */
static inline int repetitions(int count)
{
    return is_under_valgrind() ? (count + 19) / 20 : count;
}

#endif
