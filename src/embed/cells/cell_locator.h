/* cell_locator.h - the interface of the certified cell search for the locator: declares functions of
   cells_create.c, search.c, search_many.c, point_search.c, brick.c. */
#ifndef FFD_EMBED_CELLS_CELL_LOCATOR_H
#define FFD_EMBED_CELLS_CELL_LOCATOR_H

#include "embed/frame/frame.h"

/* The scratch memory for the searches of one thread; NULL at first, allocated on demand. */
typedef struct search_scratch search_scratch;

/* Prepares the search: makes locator->cells, which must be destroyed with ffd_cells_destroy, also after a
   failure. Errors: FFD_E_INVALID (a cell without volume), FFD_E_MEMORY. */
ffd_status ffd_cells_create(ffd_locator *locator, ffd_error *error);
/* Destroys the search and sets *cells to NULL; *cells may be NULL. */
void ffd_cells_destroy(struct cell_search **cells);
/* Finds u,v,w of p, which is relative to the origin. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_cells_find(const ffd_locator *locator, const double p[3], search_scratch **scratch,
                          ffd_location *location, ffd_error *error);

/* The most points of a call of ffd_cells_find_many. */
#define CELLS_AT_ONCE ((size_t)1024)
/* The same for count points, with the same bits. Points whose first coordinate is NaN are skipped. */
ffd_status ffd_cells_find_many(const ffd_locator *locator, const double *p, size_t count,
                               search_scratch **scratch, ffd_location *locations, ffd_error *error);
/* Frees scratch memory; NULL is allowed. */
void ffd_search_scratch_free(search_scratch *scratch);

/* Returns whether the first and the last face of a direction coincide at rest (ffd_lattice_is_seam). */
bool ffd_cells_have_seam(const struct cell_search *cells, int direction);

/* Returns whether the searches so far needed bricks that count against the limit (FFD_E_LIMIT). */
bool ffd_cells_are_strained(const struct cell_search *cells);

#endif
