/* process_allocator.h - for modules that are bound to their own libraries first (base/system/module.c): the
   functions that allocate memory, and free it, remain those of the process. A program may have others than
   the C library and the C++ library: those that come first among what it was started with. Memory goes to and
   fro between a module, its libraries and the rest of the process, part of which may be bound to these. Such
   a module therefore defines them all, in process_allocator.c and process_operators.cpp, and passes each call
   on. */
#ifndef FFD_BASE_MEMORY_PROCESS_ALLOCATOR_H
#define FFD_BASE_MEMORY_PROCESS_ALLOCATOR_H

#ifdef __cplusplus
extern "C" {
#endif

/* Finds the function of the process with this symbol or, if it has none, that of the module's libraries. */
void *ffd_find_process_function(const char *symbol);

#ifdef __cplusplus
}
#endif

#endif
