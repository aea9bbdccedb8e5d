/* failing_new.cpp - replaces the global operator new by one that can fail on request. */
#include "failing_new.h"
#include <atomic>
#include <cstdlib>
#include <new>

namespace
{

std::atomic<long> remaining{-1}, calls{0};

/* Returns NULL on failure. */
void *allocate(std::size_t size)
{
    calls++;
    const long left = remaining;
    if (left > 0)
        remaining = left - 1;
    return left != 0 ? std::malloc(size ? size : 1) : nullptr;
}

void *allocate_or_throw(std::size_t size)
{
    void *const block = allocate(size);
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

/* All forms except the aligned ones. A sanitizer's own forms would not call these. */
void *operator new(std::size_t size)
{
    return allocate_or_throw(size);
}

void *operator new[](std::size_t size)
{
    return allocate_or_throw(size);
}

void *operator new(std::size_t size, const std::nothrow_t &) noexcept
{
    return allocate(size);
}

void *operator new[](std::size_t size, const std::nothrow_t &) noexcept
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

void operator delete(void *block, const std::nothrow_t &) noexcept
{
    std::free(block);
}

void operator delete[](void *block, const std::nothrow_t &) noexcept
{
    std::free(block);
}
