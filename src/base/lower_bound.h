/* lower_bound.h - where a key is among sorted elements: the first from it on, the last up to it. */
#ifndef FFD_BASE_LOWER_BOUND_H
#define FFD_BASE_LOWER_BOUND_H

#include <stdbool.h>
#include <stddef.h>

/* Whether an element comes before all that have the key. */
typedef bool is_before(const void *element, const void *key);

/* The first of count elements, of so many bytes each, that does not come before the key; count where all do.
 */
static inline size_t lower_bound(const void *key, const void *elements, size_t count, size_t size,
                                 is_before *before)
{
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (before((const char *)elements + middle * size, key))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Whether an element comes before the key or is at it. */
typedef bool is_up_to(const void *element, const void *key);

/* The last of count elements, of so many bytes each, that is up to the key; 0 where none is. */
static inline size_t last_up_to(const void *key, const void *elements, size_t count, size_t size,
                                is_up_to *up_to)
{
    size_t low = 0, high = count;
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (up_to((const char *)elements + middle * size, key))
            low = middle;
        else
            high = middle;
    }
    return low;
}

#endif
