/* locator_border.h - the border of a locator's rest volume: one for all who need it, made when it is first
   asked for. */
#ifndef FFD_EMBED_LOCATOR_BORDER_H
#define FFD_EMBED_LOCATOR_BORDER_H

#include "embed/boundary/boundary.h"
#include "embed/frame/frame.h"

/* Where a locator keeps its border. */
typedef struct locator_border locator_border;

/* Makes an empty place for the border; NULL if memory runs out. */
locator_border *ffd_locator_border_create(void);
/* Frees it with the border; NULL is allowed. */
void ffd_locator_border_destroy(locator_border *kept);

/* The border of the locator's rest volume, made when it is first asked for; the locator keeps it.
   Thread-safe. Errors: FFD_E_MEMORY. */
ffd_status ffd_locator_border(const ffd_locator *locator, const boundary **border, ffd_error *error);

#endif
