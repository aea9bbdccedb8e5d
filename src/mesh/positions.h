/* positions.h - a hash table of vertices by their positions. */
#ifndef FFD_MESH_POSITIONS_H
#define FFD_MESH_POSITIONS_H

#include "base/fail.h"
#include <stdbool.h>
#include <stdint.h>

typedef struct position_table {
    const double *positions; /* 3 a vertex; lent */
    uint32_t *slots;         /* open addressing: a vertex, UINT32_MAX where free */
    size_t mask;
} position_table;

/* Bytes of the table for each vertex that it is made for, at the most. */
#define POSITION_TABLE_BYTES (4 * sizeof(uint32_t))

/* Makes a table for `most` vertices. Errors: FFD_E_MEMORY; the table is empty then. */
ffd_status ffd_positions_begin(position_table *table, const double *positions, size_t most, ffd_error *error);
/* Returns the vertex that was the first to be added at this one's position: itself where it is new. 0 and -0
   are equal. */
uint32_t ffd_positions_add(position_table *table, uint32_t vertex);
/* Looks up the vertex that was added at this one's position; false if there is none. */
bool ffd_positions_find(const position_table *table, uint32_t vertex, uint32_t *found);
/* The place in the table of the vertex that was added at this position; UINT32_MAX is there if there is none.
   Another vertex at the position may take its place. */
uint32_t *ffd_positions_at(const position_table *table, const double position[3]);
/* Frees the table. */
void ffd_positions_end(position_table *table);

/* Fills twins, one a vertex: the first vertex whose three coordinates are the same. Errors: FFD_E_MEMORY. */
ffd_status ffd_positions_twins(const double *positions, size_t count, uint32_t *twins, ffd_error *error);

#endif
