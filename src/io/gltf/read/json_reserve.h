/* json_reserve.h - nlohmann's JSON with a memory reserve for its destructor. The destructor moves the values
   of an array or object to a vector, and would terminate the program if memory ran out. Here such vectors are
   allocated from a reserve when no other memory is left. C++; for gltf_tinygltf.cpp only. */
#ifndef FFD_IO_GLTF_READ_JSON_RESERVE_H
#define FFD_IO_GLTF_READ_JSON_RESERVE_H

#include "base/memory/memory.h"
#include "base/system/thread_local.h"
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <new>
#include <type_traits>
#include <utility>

/* Renamed, because the library has another std::allocator only here. */
#define nlohmann ffd_nlohmann
#include <nlohmann/json_fwd.hpp>

/* A memory reserve that vectors of JSON values in the calling thread use as a fallback during the object's
   lifetime. Its blocks are not reused. */
class json_reserve
{
  public:
    explicit json_reserve(size_t bytes)
        : first(static_cast<char *>(ffd_alloc(bytes, 1))), block(first), size(bytes), left(bytes)
    {
        if (!first)
            throw std::bad_alloc();
        current() = this;
    }
    ~json_reserve()
    {
        current() = nullptr;
        ffd_free(first);
    }
    json_reserve(const json_reserve &) = delete;
    json_reserve &operator=(const json_reserve &) = delete;

    static void *allocate(size_t bytes)
    {
        void *const usual = ::operator new(bytes, std::nothrow);
        void *const found = usual || !current() ? usual : current()->take(bytes);
        if (!found)
            throw std::bad_alloc();
        return found;
    }
    static void deallocate(void *taken) noexcept
    {
        if (!current() || !current()->holds(taken))
            ::operator delete(taken);
    }

  private:
    static json_reserve *&current()
    {
        static thread_local json_reserve *reserve FFD_ALLOCATED_WITH_THREAD = nullptr;
        return reserve;
    }
    void *take(size_t bytes)
    {
        const size_t whole = (bytes + alignof(std::max_align_t) - 1) / alignof(std::max_align_t);
        if (whole > left / alignof(std::max_align_t))
            return nullptr;
        void *const taken = block;
        block += whole * alignof(std::max_align_t);
        left -= whole * alignof(std::max_align_t);
        return taken;
    }
    bool holds(const void *taken) const
    {
        return std::greater_equal<const void *>()(taken, first) &&
               std::less<const void *>()(taken, first + size);
    }

    char *const first;
    char *block; /* its unused rest */
    const size_t size;
    size_t left;
};

/* std::allocator as in the standard, except for the source of its memory. */
template <> class std::allocator<nlohmann::json>
{
  public:
    using value_type = nlohmann::json;
    using size_type = size_t;
    using difference_type = ptrdiff_t;
    using propagate_on_container_move_assignment = std::true_type;
    using is_always_equal = std::true_type;

    allocator() noexcept = default;
    template <typename T> allocator(const allocator<T> &) noexcept {}
    value_type *allocate(size_t count);
    void deallocate(value_type *values, size_t) noexcept { json_reserve::deallocate(values); }
    size_t max_size() const noexcept;
    template <typename T, typename... Arguments> void construct(T *at, Arguments &&...arguments)
    {
        ::new (static_cast<void *>(at)) T(std::forward<Arguments>(arguments)...);
    }
    template <typename T> void destroy(T *at) { at->~T(); }
    friend bool operator==(const allocator &, const allocator &) noexcept { return true; }
    friend bool operator!=(const allocator &, const allocator &) noexcept { return false; }
};

#include <nlohmann/json.hpp>

inline size_t std::allocator<nlohmann::json>::max_size() const noexcept
{
    return PTRDIFF_MAX / sizeof(value_type);
}

inline nlohmann::json *std::allocator<nlohmann::json>::allocate(size_t count)
{
    if (count > max_size())
        throw std::bad_alloc();
    return static_cast<value_type *>(json_reserve::allocate(count * sizeof(value_type)));
}

#endif
