/* repetitions.h - reduces repetitions in memory-checked builds, which are up to thirty times as slow.
   Repeating the same code with other numbers finds no further memory errors. */
#ifndef FFD_TESTS_REPETITIONS_H
#define FFD_TESTS_REPETITIONS_H

#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#if defined(__SANITIZE_ADDRESS__)
#define FFD_SANITIZED true
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define FFD_SANITIZED true
#endif
#endif
#ifndef FFD_SANITIZED
#define FFD_SANITIZED false
#endif

static inline bool is_under_valgrind(void)
{
    const char *loaded = getenv("LD_PRELOAD");
    return loaded && strstr(loaded, "vgpreload");
}

static inline bool is_memory_checked(void)
{
    return is_under_valgrind() || FFD_SANITIZED;
}

/* Returns how many of `count` repetitions to make. */
static inline int repetitions(int count)
{
    return is_memory_checked() ? (count + 19) / 20 : count;
}

/* Returns the step through an enumeration: 1 normally, this many under valgrind, the slowest, and half as
   many with a sanitizer. */
static inline int stride(int under_valgrind)
{
    return is_under_valgrind() ? under_valgrind : FFD_SANITIZED ? (under_valgrind + 1) / 2 : 1;
}

#endif
