/* slots.h - the slots of a hash table with open addressing, if the number of keys is known in advance. */
#ifndef FFD_BASE_MEMORY_SLOTS_H
#define FFD_BASE_MEMORY_SLOTS_H

#include <stddef.h>

/* Allocates mask + 1 slots of size bytes: a power of two, at least twice the number of keys. All bits are
   set, so the largest value of an unsigned type marks a free slot. Free with ffd_free. Returns NULL if memory
   runs out. */
void *ffd_slots_make(size_t keys, size_t size, size_t *mask);

#endif
