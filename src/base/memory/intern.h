/* intern.h - numbers for different keys: the first key is 0, the next other one 1, and so on. */
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

/* The number of the key, which is copied where it is new. False when there is no memory, or the numbers have
   run out. */
bool ffd_intern(intern_table *table, const void *key, size_t size, uint32_t *number);
/* The number of a key that is there already; false for others. */
bool ffd_intern_find(const intern_table *table, const void *key, size_t size, uint32_t *number);
/* A key, ended by 0; lent until the next one is added. */
const char *ffd_intern_key(const intern_table *table, uint32_t number);
/* Frees the keys; the table is empty then. */
void ffd_intern_free(intern_table *table);

#endif
