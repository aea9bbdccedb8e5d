/* cell_locator.h - the certified cell search, as the locator uses it.
   Main header of the search for the folders above: declares functions of cells_create.c, search.c,
   search_many.c, point_search.c, brick.c. */
#ifndef FFD_EMBED_CELLS_CELL_LOCATOR_H
#define FFD_EMBED_CELLS_CELL_LOCATOR_H

#include "embed/frame/frame.h"

/* The memory of one thread's searches; NULL at first, made when it is needed. */
typedef struct search_scratch search_scratch;

/* Cuts the lattice into cells: makes locator->cells, which ffd_cells_destroy frees, after a failure too.
   Errors: FFD_E_INVALID where a cell has no volume, FFD_E_MEMORY. */
ffd_status ffd_cells_create(ffd_locator *locator, ffd_error *error);
/* Frees the search and clears the pointer; a pointer to NULL is allowed. */
void ffd_cells_destroy(struct cell_search **cells);
/* Finds p, with the origin subtracted. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_cells_find(const ffd_locator *locator, const double p[3], search_scratch **scratch,
                          ffd_location *location, ffd_error *error);

/* Most points of one call. */
#define CELLS_AT_ONCE ((size_t)1024)
/* The same for count points, to the bit; those whose first coordinate is NaN are left alone. */
ffd_status ffd_cells_find_many(const ffd_locator *locator, const double *p, size_t count,
                               search_scratch **scratch, ffd_location *locations, ffd_error *error);
/* Frees the memory of one thread's searches; NULL is allowed. */
void ffd_search_scratch_free(search_scratch *scratch);

/* Whether the direction's first and last face coincide at rest (ffd_lattice_is_seam). */
bool ffd_cells_have_seam(const struct cell_search *cells, int direction);

/* Whether points so far needed bricks that count against the limit (FFD_E_LIMIT). */
bool ffd_cells_are_strained(const struct cell_search *cells);

#endif
