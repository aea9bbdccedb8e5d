/* sort.h - sorts very many things, and looks at the deadline while it does. */
#ifndef FFD_BASE_SYSTEM_SORT_H
#define FFD_BASE_SYSTEM_SORT_H

#include "base/fail.h"
#include <stddef.h>

/* As qsort. Errors: FFD_E_MEMORY, those of ffd_deadline_check; then some items may be there twice, and others
   be lost. */
ffd_status ffd_sort(void *items, size_t count, size_t size, int (*compare)(const void *, const void *),
                    ffd_error *error);

#endif
