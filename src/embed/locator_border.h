/* locator_border.h - the border of a locator's rest volume, made on first use and shared. */
#ifndef FFD_EMBED_LOCATOR_BORDER_H
#define FFD_EMBED_LOCATOR_BORDER_H

#include "embed/boundary/boundary.h"
#include "embed/frame/frame.h"

/* The holder of a locator's border. */
typedef struct locator_border locator_border;

/* Creates an empty holder. Returns NULL if memory runs out. */
locator_border *ffd_locator_border_create(void);
/* Destroys the holder and its border; NULL is allowed. */
void ffd_locator_border_destroy(locator_border *kept);

/* Gets the border of the locator's rest volume, and makes it on first use. It belongs to the locator.
   Thread-safe. Errors: FFD_E_MEMORY. */
ffd_status ffd_locator_border(const ffd_locator *locator, const boundary **border, ffd_error *error);

#endif
