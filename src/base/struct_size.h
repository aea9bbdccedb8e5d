/* struct_size.h - structs whose size the caller sets: members that a caller's header did not have yet keep
   their defaults, and none is written beyond its end. */
#ifndef FFD_BASE_STRUCT_SIZE_H
#define FFD_BASE_STRUCT_SIZE_H

#include "base/fail.h"
#include <stddef.h>

/* Copies a struct that begins with its size from its caller: own, of own_size bytes and holding the defaults,
   gets the members that the caller has, and its own size. name: of the struct, in messages. Errors:
   FFD_E_ARGUMENT for a size that is none, or that of a later library. */
ffd_status ffd_struct_take(void *own, size_t own_size, const void *callers, const char *name,
                           ffd_error *error);

/* Whether a struct that will be filled begins with a size that this library knows. Errors: FFD_E_ARGUMENT. */
ffd_status ffd_struct_check(size_t own_size, const void *callers, const char *name, ffd_error *error);

/* Fills the caller's struct of size bytes with as much of own as it has room for; its size is the caller's.
 */
void ffd_struct_give(const void *own, size_t own_size, void *callers, size_t size);

#endif
