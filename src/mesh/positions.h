/* positions.h - a hash table of vertices by position; twins.c finds all that share one. */
#ifndef FFD_MESH_POSITIONS_H
#define FFD_MESH_POSITIONS_H

#include "base/fail.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct position_table {
    const double *positions; /* 3 for each vertex; borrowed */
    uint32_t *slots;         /* open addressing: a vertex, UINT32_MAX in a free slot */
    size_t mask;
} position_table;

/* The most bytes of a table for each vertex of its capacity. */
#define POSITION_TABLE_BYTES (4 * sizeof(uint32_t))

/* Makes a table for at most `most` vertices. Errors: FFD_E_MEMORY; the table is empty then. */
ffd_status ffd_positions_begin(position_table *table, const double *positions, size_t most, ffd_error *error);
/* Adds a vertex. Returns the first vertex that was added at its position: the vertex itself if the position
   is new. 0 and -0 are equal. */
uint32_t ffd_positions_add(position_table *table, uint32_t vertex);
/* Looks up the vertex that was added at the position of this one. Returns false if there is none. */
bool ffd_positions_find(const position_table *table, uint32_t vertex, uint32_t *found);
/* Returns the slot of the vertex at a position; it contains UINT32_MAX if there is none. The caller may store
   another vertex at that position in it. */
uint32_t *ffd_positions_at(const position_table *table, const double position[3]);
/* Frees the table. */
void ffd_positions_end(position_table *table);

#endif
