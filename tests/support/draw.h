/* draw.h - random numbers for property tests. The same seed gives the same sequence on every machine. */
#ifndef FFD_TESTS_DRAW_H
#define FFD_TESTS_DRAW_H

#include <errno.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

typedef struct draw {
    uint64_t state;
} draw;

/* Takes the seed from FFD_SEED if set, else from the time, and prints it, so that a failure can be
   repeated. */
static inline uint64_t draw_seed(void)
{
    const char *const text = getenv("FFD_SEED");
    uint64_t seed = (uint64_t)time(NULL);
    if (text && *text) {
        char *end;
        errno = 0;
        seed = strtoull(text, &end, 10);
        if (*end || errno) {
            fprintf(stderr, "FFD_SEED=%s is not a whole number\n", text);
            exit(2);
        }
    }
    printf("FFD_SEED=%llu\n", (unsigned long long)seed);
    fflush(stdout);
    return seed;
}

/* SplitMix64 (Steele, Lea, Flood 2014). */
static inline uint64_t draw_bits(draw *d)
{
    uint64_t z = d->state += UINT64_C(0x9E3779B97F4A7C15);
    z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
    return z ^ (z >> 31);
}

/* Returns 0 to 2^31 - 1. */
static inline uint32_t draw_number(draw *d)
{
    return (uint32_t)(draw_bits(d) >> 33);
}

/* Returns a number in [0, 1). */
static inline double draw_unit(draw *d)
{
    return (double)(draw_bits(d) >> 11) / 9007199254740992.0;
}

static inline double draw_between(draw *d, double low, double high)
{
    return low + (high - low) * draw_unit(d);
}

/* Returns low to high, inclusive. */
static inline int draw_int(draw *d, int low, int high)
{
    return low + (int)(draw_bits(d) % (uint64_t)(high - low + 1));
}

#endif
