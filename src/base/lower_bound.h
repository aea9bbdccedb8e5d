/* lower_bound.h - the place of a key among elements that are sorted. */
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

#endif
