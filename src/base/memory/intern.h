/* intern.h - a hash table that gives distinct keys the indices 0, 1, 2, ... in the order in which they are
 * added. */
#ifndef FFD_BASE_MEMORY_INTERN_H
#define FFD_BASE_MEMORY_INTERN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* All zeros: an empty table. */
typedef struct intern_table {
    char *pool; /* all keys, each followed by a 0 */
    size_t pool_size, pool_capacity;
    size_t *starts; /* offset of each key in the pool */
    size_t count, capacity;
    uint32_t *slots; /* open addressing: the index of a key, UINT32_MAX in a free slot */
    size_t slot_count;
} intern_table;

/* Looks up the index of a key, and adds a copy of the key if it is new. Returns false if memory or the
   32-bit indices run out. */
bool ffd_intern(intern_table *table, const void *key, size_t size, uint32_t *index);
/* Looks up the index of a key; false if it is not in the table. */
bool ffd_intern_find(const intern_table *table, const void *key, size_t size, uint32_t *index);
/* Returns a key, terminated by 0. It is valid until the next key is added. */
const char *ffd_intern_key(const intern_table *table, uint32_t index);
/* Frees the keys and empties the table. */
void ffd_intern_free(intern_table *table);

#endif
