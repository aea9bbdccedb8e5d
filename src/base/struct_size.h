/* struct_size.h - structs of callers that were compiled with an older header (ffd/ffd.h): members that the
   caller's struct does not have keep their defaults, and nothing is written beyond its end. */
#ifndef FFD_BASE_STRUCT_SIZE_H
#define FFD_BASE_STRUCT_SIZE_H

#include "base/fail.h"
#include <stddef.h>

/* Copies the caller's struct, whose first member is its size, over own, which holds the defaults and has
   own_size bytes. own keeps its own size. name: of the struct, for messages. Errors: FFD_E_ARGUMENT (the size
   is not set, or larger than own_size). */
ffd_status ffd_struct_take(void *own, size_t own_size, const void *callers, const char *name,
                           ffd_error *error);

/* Checks the size of a caller's struct that will be filled later. Errors: FFD_E_ARGUMENT. */
ffd_status ffd_struct_check(size_t own_size, const void *callers, const char *name, ffd_error *error);

/* Copies to the caller's struct, which has size bytes, as much of own as fits; its size member stays. */
void ffd_struct_give(const void *own, size_t own_size, void *callers, size_t size);

#endif
