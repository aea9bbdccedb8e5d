#define _DEFAULT_SOURCE /* madvise */
#include "base/file/spill.h"
#include "base/file/unnamed_file.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include <errno.h>
#include <string.h>

/* Bytes that are copied at a time: a multiple of any page size. */
#define COPIED ((size_t)1 << 22)

/* Maps the first `size` bytes of the file after allocating them on the disk: writing to a mapped page without
   disk space would raise SIGBUS. Returns NULL if there is not enough disk space or memory. */
static void *map_bytes(int file, size_t size)
{
    int failure = (size_t)(off_t)size == size ? EINTR : EFBIG;
    while (failure == EINTR)
        failure = posix_fallocate(file, 0, (off_t)size);
    if (failure)
        return NULL;
    void *data = mmap(NULL, size, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    return data == MAP_FAILED ? NULL : data;
}

static bool grow_mapped(spill_array *array, size_t size)
{
    void *data = map_bytes(array->file, size);
    if (!data)
        return false;
    munmap(array->data, array->size);
    array->data = data;
    array->size = size;
    return true;
}

/* Moves the array back to memory because the disk is full. */
static bool leave_file(spill_array *array, size_t size)
{
    void *data = ffd_alloc(size, 1);
    if (!data)
        return false;
    memcpy(data, array->data, array->size);
    ffd_spill_free(array);
    *array = (spill_array){.data = data, .size = size};
    return true;
}

/* Moves the array into a file. Returns false if that is not possible. */
static bool move_to_file(spill_array *array, size_t size)
{
    const int file = ffd_unnamed_file();
    spill_array moved = {
        .data = file < 0 ? NULL : map_bytes(file, size), .size = size, .file = file, .is_mapped = true};
    if (!moved.data) {
        if (file >= 0)
            close(file);
        return false;
    }
    for (size_t at = 0, piece; at < array->size; at += piece) {
        piece = array->size - at < COPIED ? array->size - at : COPIED;
        memcpy((char *)moved.data + at, (const char *)array->data + at, piece);
        ffd_spill_release_pages(&moved, at, piece);
    }
    ffd_free(array->data);
    *array = moved;
    return true;
}

bool ffd_spill_grow(spill_array *array, size_t needed)
{
    if (array->data && needed <= array->size)
        return true;
    size_t size = array->size + array->size / 2;
    if (size < needed)
        size = needed;
    if (array->is_mapped)
        return grow_mapped(array, size) || grow_mapped(array, needed) || leave_file(array, needed);
    if (needed >= SPILL_FROM && move_to_file(array, size))
        return true;
    void *data = array->data ? ffd_realloc(array->data, size, 1) : ffd_alloc_whole(size, 1);
    if (!data)
        return false;
    array->data = data;
    array->size = size;
    return true;
}

void ffd_spill_release_pages(const spill_array *array, size_t offset, size_t size)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    const size_t first = (offset + page - 1) / page * page, last = (offset + size) / page * page;
    if (array->is_mapped && first < last)
        madvise((unsigned char *)array->data + first, last - first, MADV_DONTNEED);
}

void ffd_spill_free(spill_array *array)
{
    if (array->is_mapped) {
        munmap(array->data, array->size);
        close(array->file);
    } else {
        ffd_free(array->data);
    }
    *array = (spill_array){0};
}
