/* intern.h - a hash table that numbers different keys: the first key is 0, the next new one 1, and so on. */
#ifndef FFD_BASE_MEMORY_INTERN_H
#define FFD_BASE_MEMORY_INTERN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Zeroed: the empty table. */
typedef struct intern_table {
    char *pool; /* the keys in a row, each followed by a 0 */
    size_t pool_size, pool_capacity;
    size_t *starts; /* of each key in the pool */
    size_t count, capacity;
    uint32_t *slots; /* open addressing: a key's number, UINT32_MAX where free */
    size_t slot_count;
} intern_table;

/* Looks up the number of a key, which is copied and added if it is new. Returns false if memory
   or the numbers run out. */
bool ffd_intern(intern_table *table, const void *key, size_t size, uint32_t *number);
/* Looks up the number of a key; false if it is not in the table. */
bool ffd_intern_find(const intern_table *table, const void *key, size_t size, uint32_t *number);
/* A key, ended by 0; lent until the next one is added. */
const char *ffd_intern_key(const intern_table *table, uint32_t number);
/* Frees the keys; the table is empty then. */
void ffd_intern_free(intern_table *table);

#endif
