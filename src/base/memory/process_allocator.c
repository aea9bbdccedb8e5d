#define _GNU_SOURCE /* RTLD_NEXT */
#include "base/memory/process_allocator.h"
#include <dlfcn.h>
#include <ffd/export.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

void *ffd_find_process_function(const char *symbol)
{
    void *const process = dlopen(NULL, RTLD_LAZY);
    void *found = process ? dlsym(process, symbol) : NULL;
    if (process)
        dlclose(process);
    return found ? found : dlsym(RTLD_NEXT, symbol);
}

/* Sets `call` to the function of the process. There is no lock, because a thread that has the loader's lock
   allocates, too. */
#define FIND(name, result, parameters)                                                                       \
    typedef result(*function) parameters;                                                                    \
    static _Atomic(function) known;                                                                          \
    function call = atomic_load_explicit(&known, memory_order_relaxed);                                      \
    if (!call) {                                                                                             \
        void *const found = ffd_find_process_function(#name);                                                \
        memcpy(&call, &found, sizeof call);                                                                  \
        atomic_store_explicit(&known, call, memory_order_relaxed);                                           \
    }

#define PASS_ON(name, result, parameters, arguments)                                                         \
    FFD_API result name parameters                                                                           \
    {                                                                                                        \
        FIND(name, result, parameters)                                                                       \
        return call arguments;                                                                               \
    }

PASS_ON(malloc, void *, (size_t size), (size))
PASS_ON(calloc, void *, (size_t count, size_t size), (count, size))
PASS_ON(realloc, void *, (void *block, size_t size), (block, size))
PASS_ON(aligned_alloc, void *, (size_t alignment, size_t size), (alignment, size))
PASS_ON(posix_memalign, int, (void **block, size_t alignment, size_t size), (block, alignment, size))

FFD_API void free(void *block)
{
    FIND(free, void, (void *block))
    call(block);
}
