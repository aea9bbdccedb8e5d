#include "failing_new.h"
#include <atomic>
#include <cstdlib>
#include <new>

namespace
{

std::atomic<long> remaining{-1}, calls{0};

void *allocate(std::size_t size)
{
    calls++;
    const long left = remaining;
    void *block = nullptr;
    if (left > 0)
        remaining = left - 1;
    if (left != 0)
        block = std::malloc(size ? size : 1);
    if (!block)
        throw std::bad_alloc();
    return block;
}

} // namespace

extern "C" long new_fail_after(long successes)
{
    remaining = successes;
    return calls.exchange(0);
}

/* The other forms of new and delete call these. */
void *operator new(std::size_t size)
{
    return allocate(size);
}

void *operator new[](std::size_t size)
{
    return allocate(size);
}

void operator delete(void *block) noexcept
{
    std::free(block);
}

void operator delete[](void *block) noexcept
{
    std::free(block);
}

void operator delete(void *block, std::size_t) noexcept
{
    std::free(block);
}

void operator delete[](void *block, std::size_t) noexcept
{
    std::free(block);
}
