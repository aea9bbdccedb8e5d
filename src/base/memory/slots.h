/* slots.h - the slots of a table with open addressing, for keys whose number is known beforehand. */
#ifndef FFD_BASE_MEMORY_SLOTS_H
#define FFD_BASE_MEMORY_SLOTS_H

#include <stddef.h>

/* mask + 1 slots, a power of two, of which `keys` fill at most half. All their bits are set: an unsigned
 * number's largest value marks a free slot. Freed by ffd_free; NULL: no memory. */
void *ffd_slots_make(size_t keys, size_t size, size_t *mask);

#endif
