/* process_operators.cpp - operator new and delete (process_allocator.h). */
#include "base/memory/process_allocator.h"
#include <atomic>
#include <new>

/* As the letter of std::size_t in symbols. */
#if __SIZEOF_SIZE_T__ == 8
#define SIZE "m"
#else
#define SIZE "j"
#endif
#define NOTHROW "RKSt9nothrow_t"
#define ALIGNMENT "St11align_val_t"

namespace
{

/* There is no lock, because a thread that has the loader's lock allocates, too. */
template <typename Function> Function find(std::atomic<Function> &known, const char *symbol)
{
    Function function = known.load(std::memory_order_relaxed);
    if (!function) {
        function = reinterpret_cast<Function>(ffd_find_process_function(symbol));
        known.store(function, std::memory_order_relaxed);
    }
    return function;
}

} // namespace

/* Both operators, for one object and for an array, with the same parameters. */
#define PASS_ON_NEW(symbol, parameters, arguments, exceptions)                                               \
    void *operator new parameters exceptions                                                                 \
    {                                                                                                        \
        static std::atomic<void *(*)parameters> known;                                                       \
        return find(known, "_Znw" SIZE symbol) arguments;                                                    \
    }                                                                                                        \
    void *operator new[] parameters exceptions                                                               \
    {                                                                                                        \
        static std::atomic<void *(*)parameters> known;                                                       \
        return find(known, "_Zna" SIZE symbol) arguments;                                                    \
    }

#define PASS_ON_DELETE(symbol, parameters, arguments)                                                        \
    void operator delete parameters noexcept                                                                 \
    {                                                                                                        \
        static std::atomic<void(*) parameters> known;                                                        \
        find(known, "_ZdlPv" symbol) arguments;                                                              \
    }                                                                                                        \
    void operator delete[] parameters noexcept                                                               \
    {                                                                                                        \
        static std::atomic<void(*) parameters> known;                                                        \
        find(known, "_ZdaPv" symbol) arguments;                                                              \
    }

PASS_ON_NEW("", (std::size_t size), (size), )
PASS_ON_NEW(NOTHROW, (std::size_t size, const std::nothrow_t &tag), (size, tag), noexcept)
PASS_ON_NEW(ALIGNMENT, (std::size_t size, std::align_val_t alignment), (size, alignment), )
PASS_ON_NEW(ALIGNMENT NOTHROW, (std::size_t size, std::align_val_t alignment, const std::nothrow_t &tag),
            (size, alignment, tag), noexcept)

PASS_ON_DELETE("", (void *block), (block))
PASS_ON_DELETE(SIZE, (void *block, std::size_t size), (block, size))
PASS_ON_DELETE(NOTHROW, (void *block, const std::nothrow_t &tag), (block, tag))
PASS_ON_DELETE(ALIGNMENT, (void *block, std::align_val_t alignment), (block, alignment))
PASS_ON_DELETE(SIZE ALIGNMENT, (void *block, std::size_t size, std::align_val_t alignment),
               (block, size, alignment))
PASS_ON_DELETE(ALIGNMENT NOTHROW, (void *block, std::align_val_t alignment, const std::nothrow_t &tag),
               (block, alignment, tag))
