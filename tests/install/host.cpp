/* host.cpp - a program that has allocators of its own and loads libffd: what one of them gave another must
   not take back, or the program ends. It is C++, linked so that it has copies of the streams of the C++
   library.

       host deform|recompute|view|page MESH LATTICE OUTPUT */
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ffd/job.h>
#include <ffd/program.h>
#include <iostream>
#include <new>
#include <sys/mman.h>
#include <unistd.h>

namespace
{

const std::size_t arena_size = std::size_t(1) << 36, header = 16;
const std::uint64_t mark = 0xffd0ffd0ffd0ffd0;

[[noreturn]] void end(const char *what)
{
    const ssize_t written = write(STDOUT_FILENO, what, std::strlen(what));
    _exit(written < 0 ? 8 : 9);
}

/* What malloc gives is never given again. */
char *arena()
{
    static std::atomic<char *> begin;
    char *known = begin.load();
    if (known)
        return known;
    void *const made =
        mmap(nullptr, arena_size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (made == MAP_FAILED)
        end("host: no arena\n");
    return begin.compare_exchange_strong(known, static_cast<char *>(made)) ? static_cast<char *>(made)
                                                                           : known;
}

/* The size stands in front of a block. */
void *take(std::size_t size, std::size_t alignment)
{
    static std::atomic<std::size_t> used;
    if (size > arena_size / 2)
        return nullptr;
    const std::size_t at = used.fetch_add(size + header + alignment), begin = at + header + alignment - 1;
    if (begin + size > arena_size)
        return nullptr;
    char *const block = arena() + begin / alignment * alignment;
    std::memcpy(block - header, &size, sizeof size);
    return block;
}

void check(const void *block, const char *what)
{
    if (static_cast<const char *>(block) < arena() ||
        static_cast<const char *>(block) >= arena() + arena_size)
        end(what);
}

/* A mark stands in front of what operator new gives. */
void *make(std::size_t size, std::size_t alignment = header)
{
    char *const block = static_cast<char *>(take(size + alignment, alignment));
    if (!block)
        return nullptr;
    std::memcpy(block + alignment - header, &mark, sizeof mark);
    return block + alignment;
}

void unmake(void *block)
{
    std::uint64_t found;
    if (!block)
        return;
    check(block, "host: operator delete of another allocator's block\n");
    std::memcpy(&found, static_cast<char *>(block) - header, sizeof found);
    if (found != mark)
        end("host: operator delete of a block that operator new has not made\n");
}

ffd_status run(const char *what, const char *mesh, const char *lattice_path, const char *output,
               ffd_error *error)
{
    ffd_deform_desc desc;
    ffd_view_desc view;
    ffd_job_result result;
    std::memset(&result, 0, sizeof result);
    result.struct_size = sizeof result;
    ffd_deform_desc_init(&desc, sizeof desc);
    ffd_view_desc_init(&view, sizeof view);
    desc.input.path = mesh;
    ffd_lattice_source lattice = {};
    lattice.path = lattice_path;
    desc.lattices = &lattice;
    desc.lattice_count = 1;
    const bool is_picture = std::strcmp(what, "view") == 0;
    if (is_picture || std::strcmp(what, "page") == 0) {
        view.job = &desc;
        view.output = output;
        view.width = is_picture ? 64 : 0;
        view.height = is_picture ? 32 : 0;
        view.color = FFD_VIEW_PLAIN;
        return ffd_view_run(&view, &result, error);
    }
    desc.output = output;
    if (std::strcmp(what, "recompute") == 0)
        desc.normals = FFD_NORMALS_RECOMPUTE;
    return ffd_deform_run(&desc, &result, error);
}

} // namespace

extern "C" {
void *malloc(std::size_t size) noexcept
{
    return take(size, header);
}
void *calloc(std::size_t count, std::size_t size) noexcept
{
    return size && count > arena_size / size ? nullptr
                                             : take(count * size, header); /* zeros, since it is new */
}
void *aligned_alloc(std::size_t alignment, std::size_t size) noexcept
{
    return take(size, alignment < header ? header : alignment);
}
int posix_memalign(void **block, std::size_t alignment, std::size_t size) noexcept
{
    *block = aligned_alloc(alignment, size);
    return *block ? 0 : 12;
}
void free(void *block) noexcept
{
    if (block)
        check(block, "host: free of another allocator's block\n");
}
void *realloc(void *block, std::size_t size) noexcept
{
    std::size_t had = 0;
    void *const larger = take(size, header);
    if (!block || !larger)
        return larger;
    check(block, "host: realloc of another allocator's block\n");
    std::memcpy(&had, static_cast<char *>(block) - header, sizeof had);
    std::memcpy(larger, block, had < size ? had : size);
    return larger;
}
}

void *operator new(std::size_t size)
{
    void *const block = make(size);
    if (!block)
        throw std::bad_alloc();
    return block;
}
void *operator new(std::size_t size, const std::nothrow_t &) noexcept
{
    return make(size);
}
void *operator new(std::size_t size, std::align_val_t alignment)
{
    void *const block = make(size, std::size_t(alignment) < header ? header : std::size_t(alignment));
    if (!block)
        throw std::bad_alloc();
    return block;
}
void operator delete(void *block) noexcept
{
    unmake(block);
}
void operator delete(void *block, std::size_t) noexcept
{
    unmake(block);
}
void operator delete(void *block, std::align_val_t) noexcept
{
    unmake(block);
}
void operator delete(void *block, std::size_t, std::align_val_t) noexcept
{
    unmake(block);
}

/* Notices on the page name options as the program does. */
static void spell(const char *member, const char *, char *text, std::size_t capacity)
{
    std::snprintf(text, capacity, "--%s", member);
}

int main(int count, char **arguments)
{
    ffd_error error;
    ffd_spell_members(spell);
    if (count != 5)
        return 2;
    if (run(arguments[1], arguments[2], arguments[3], arguments[4], &error) == FFD_OK)
        return 0;
    char text[2048];
    ffd_error_format(&error, text, sizeof text);
    std::cerr << text << std::endl;
    return 1;
}
