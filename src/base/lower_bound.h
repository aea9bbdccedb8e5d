/* lower_bound.h - binary search in a sorted array. */
#ifndef FFD_BASE_LOWER_BOUND_H
#define FFD_BASE_LOWER_BOUND_H

#include <stdbool.h>
#include <stddef.h>

/* Returns whether an element is less than the key. */
typedef bool is_before(const void *element, const void *key);

/* Returns the index of the first element that is not less than the key; count if all are less. size: bytes of
   an element. */
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

/* Returns whether an element is less than or equal to the key. */
typedef bool is_up_to(const void *element, const void *key);

/* Returns the index of the last element that is less than or equal to the key; 0 if there is none. size:
   bytes of an element. */
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
