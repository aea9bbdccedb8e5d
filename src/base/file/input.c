#define _XOPEN_SOURCE 700 /* realpath, pread */
#define _DEFAULT_SOURCE   /* madvise */
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include "base/system/deadline.h"
#include <errno.h>
#include <stdint.h>
#include <string.h>

/* The most bytes that are read from a stream, which may be endless. */
#define LONGEST_STREAM (SIZE_MAX > UINT32_MAX ? (size_t)UINT32_MAX + 1 : SIZE_MAX / 2)
/* Size of the pieces in which two files are compared: a multiple of any page size. */
#define COMPARED ((size_t)1 << 22)

/* Smaller files are read instead of mapped, which is faster: a mapped page costs a page fault, and unmapping
   it interrupts every processor that the program runs on (TLB shootdown). Under some hypervisors each of
   these takes as long as reading a hundred kilobytes. */
#define SMALL ((size_t)1 << 18)

/* The alignment that borrowed bytes must have. */
#define ALIGNED 8

/* Smaller ranges are not prefaulted. */
#define LEAST_PREFAULT ((size_t)1 << 16)

/* How many bytes are released at a time while a file is read sequentially: a multiple of any page size. */
#define RELEASE_UNIT ((size_t)1 << 23)

static const unsigned char nothing[1] = {0};

/* An offset that stands for the descriptor's current position. */
#define FROM_HERE ((off_t)-1)

/* Waits until a stream has bytes or ends, or until the deadline. */
static ffd_status wait_for_bytes(int fd, ffd_error *error)
{
    struct pollfd ready = {.fd = fd, .events = POLLIN};
    while (poll(&ready, 1, ffd_deadline_left()) <= 0)
        TRY(ffd_deadline_check(error));
    return FFD_OK;
}

/* Reads as many bytes as a single call returns; waits for them where the descriptor does not. *got is 0 at
   the end. */
static ffd_status read_piece(int fd, const char *name, off_t offset, void *to, size_t size, size_t *got,
                             ffd_error *error)
{
    ssize_t count;
    do {
        count = offset == FROM_HERE ? read(fd, to, size) : pread(fd, to, size, offset);
        if (count < 0 && errno == EAGAIN)
            TRY(wait_for_bytes(fd, error));
    } while (count < 0 && (errno == EINTR || errno == EAGAIN));
    if (count < 0)
        return ffd_fail_file(error, FFD_E_IO, name, "cannot be read: %s", strerror(errno));
    *got = (size_t)count;
    return FFD_OK;
}

/* Whether to wait before bytes are read: there is a deadline, and reading would not look at it; or nobody has
   written to a pipe yet, which looks like its end. Once it had bytes its end is its end, even if the writer
   had gone before it was opened. */
static bool waits_first(int fd, bool has_bytes)
{
    return ffd_deadline_left() >= 0 && !(has_bytes && (fcntl(fd, F_GETFL) & O_NONBLOCK));
}

/* Reads files that have no size and cannot be mapped: pipes, terminals, /dev/stdin, files of /proc. */
static ffd_status read_stream(int fd, const char *name, file_input *input, ffd_error *error)
{
    unsigned char *block = NULL;
    size_t capacity = 0, size = 0, got = 0;
    ffd_status status = FFD_OK;
    do {
        size += got;
        if (size >= LONGEST_STREAM)
            TRY_END(ffd_fail_file(error, FFD_E_LIMIT, name,
                                  "has more than %zu bytes, the most that is read from a stream", size));
        else if (!ffd_grow((void **)&block, &capacity, size + 65536, 1))
            TRY_END(ffd_fail_file(error, FFD_E_MEMORY, name, "out of memory after %zu bytes", size));
        else
            TRY_END(waits_first(fd, size > 0) ? wait_for_bytes(fd, error) : FFD_OK);
        TRY_END(read_piece(fd, name, FROM_HERE, block + size, capacity - size, &got, error));
    } while (got > 0);
end:
    if (status)
        ffd_free(block);
    else
        *input = (file_input){.data = block, .size = size, .block = block};
    return status;
}

static ffd_status fail_memory(const char *name, size_t size, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_MEMORY, name, "out of memory for %zu bytes", size);
}

/* Reads what a memory mapping would give: the whole file from its start, whatever the descriptor's position,
   without bytes that are appended meanwhile. */
static ffd_status read_file(int fd, const char *name, size_t size, file_input *input, ffd_error *error)
{
    unsigned char *const block = ffd_alloc(size, 1);
    if (!block)
        return fail_memory(name, size, error);
    size_t done = 0, got = 0;
    ffd_status status = FFD_OK;
    do {
        TRY_END(read_piece(fd, name, (off_t)done, block + done, size - done, &got, error));
        done += got;
    } while (got > 0 && done < size);
    if (done < size)
        TRY_END(ffd_fail_file(error, FFD_E_IO, name, "became shorter while it was read"));
end:
    if (status)
        ffd_free(block);
    else
        *input = (file_input){.data = block, .size = done, .block = block};
    return status;
}

static ffd_status map_file(int fd, const char *name, const struct stat *info, file_input *input,
                           ffd_error *error)
{
    const size_t size = (size_t)info->st_size;
    const uint64_t identity[2] = {(uint64_t)info->st_dev, (uint64_t)info->st_ino};
    void *block = mmap(NULL, size, PROT_READ, MAP_PRIVATE, fd, 0);
    if (block == MAP_FAILED)
        return errno == ENOMEM ? fail_memory(name, size, error) : read_stream(fd, name, input, error);
    file_mapping *const mapping = ffd_mapping_note(block, size, name, fd == STDIN_FILENO ? NULL : identity);
    if (!mapping) {
        munmap(block, size);
        return ffd_fail_memory(error);
    }
    *input = (file_input){.data = block, .size = size, .block = block, .mapped = true, .mapping = mapping};
    return FFD_OK;
}

bool ffd_file_stamp(const char *path, file_stamp *stamp)
{
    struct stat info;
    if (stat(path, &info) != 0 || !S_ISREG(info.st_mode))
        return false;
    *stamp = (file_stamp){
        .device = (uint64_t)info.st_dev,
        .inode = (uint64_t)info.st_ino,
        .size = (uint64_t)info.st_size,
        .written = {(int64_t)info.st_mtim.tv_sec, (int64_t)info.st_mtim.tv_nsec},
        .changed = {(int64_t)info.st_ctim.tv_sec, (int64_t)info.st_ctim.tv_nsec},
    };
    return true;
}

bool ffd_file_reads_once(const char *path)
{
    struct stat info;
    return ffd_file_is_stream(path) ||
           (stat(path, &info) == 0 && !S_ISREG(info.st_mode) && !S_ISDIR(info.st_mode));
}

_Static_assert(sizeof(file_stamp) == 7 * sizeof(uint64_t), "bytes that are compared have no padding");

bool ffd_stamp_equal(const file_stamp *a, const file_stamp *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

bool ffd_stamps_hold(char *const *paths, const file_stamp *stamps, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        file_stamp now;
        if (!ffd_file_stamp(paths[i], &now) || !ffd_stamp_equal(&now, &stamps[i]))
            return false;
    }
    return true;
}

bool ffd_file_is_stream(const char *path)
{
    static const char *const names[] = {"/dev/stdin", "/dev/fd/", "/proc/self/fd/", "/dev/null"};
    if (strcmp(path, "-") == 0)
        return true;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strncmp(path, names[i], strlen(names[i])) == 0)
            return true;
    return false;
}

const char *ffd_file_display_name(const char *path)
{
    return strcmp(path, "-") == 0 ? "standard input" : path;
}

/* Refuses folders, and pipes and devices, which may block forever or never end. */
static ffd_status refuse_special(int fd, const char *path, ffd_error *error)
{
    struct stat info;
    if (fstat(fd, &info) != 0 || S_ISREG(info.st_mode))
        return FFD_OK;
    if (S_ISDIR(info.st_mode))
        return ffd_fail_file(error, FFD_E_IO, path, "is a folder");
    if (ffd_file_is_stream(path))
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_IO, path, "is a %s, not a file (- reads standard input)",
                         S_ISFIFO(info.st_mode) ? "pipe" : "device");
}

static ffd_status load_descriptor(int fd, const char *name, size_t least_mapped, file_input *input,
                                  ffd_error *error)
{
    struct stat info;
    if (fstat(fd, &info) != 0)
        return ffd_fail_file(error, FFD_E_IO, name, "cannot be read: %s", strerror(errno));
    if (S_ISDIR(info.st_mode))
        return ffd_fail_file(error, FFD_E_IO, name, "is a folder");
    if (!S_ISREG(info.st_mode) || info.st_size <= 0)
        return read_stream(fd, name, input, error);
    if ((uint64_t)info.st_size > SIZE_MAX)
        return ffd_fail_file(
            error, FFD_E_LIMIT, name,
            "has %lld bytes, more than the %zu that a program with addresses of 32 bits holds",
            (long long)info.st_size, SIZE_MAX);
    const size_t size = (size_t)info.st_size;
    const ffd_status status = size < least_mapped ? read_file(fd, name, size, input, error)
                                                  : map_file(fd, name, &info, input, error);
    input->identity[0] = (uint64_t)info.st_dev;
    input->identity[1] = (uint64_t)info.st_ino;
    return status;
}

static ffd_status fail_open(const char *path, int reason, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_IO, path, "cannot be opened: %s", strerror(reason));
}

/* Readers rely on numbers being aligned in memory if they are aligned in the file, so unaligned bytes are
   copied. */
ffd_status ffd_file_lend(ffd_bytes bytes, const char *name, file_input *input, ffd_error *error)
{
    unsigned char *copy = NULL;
    *input = (file_input){.data = nothing};
    if (bytes.size > 0 && (uintptr_t)bytes.data % ALIGNED != 0) {
        copy = ffd_alloc(bytes.size, 1);
        if (!copy)
            return fail_memory(name, bytes.size, error);
        memcpy(copy, bytes.data, bytes.size);
    }
    *input = (file_input){.data = copy             ? copy
                                  : bytes.size > 0 ? bytes.data
                                                   : nothing,
                          .size = bytes.size,
                          .block = copy};
    return FFD_OK;
}

/* Opening a pipe does not block with O_NONBLOCK: one that is not a stream is refused later, and at one of a
   name like /dev/stdin, to which nobody writes yet, wait_for_bytes looks at the deadline. Without need not
   for inherited descriptors, whose flags must not change. */
static int open_flags(const char *path)
{
    struct stat info;
    if (!ffd_file_is_stream(path))
        return O_NONBLOCK | O_NOCTTY;
    return ffd_deadline_left() >= 0 && stat(path, &info) == 0 && S_ISFIFO(info.st_mode) ? O_NONBLOCK : 0;
}

ffd_status ffd_file_open(const char *path, int *fd, ffd_error *error)
{
    *fd = STDIN_FILENO;
    if (strcmp(path, "-") == 0)
        return FFD_OK;
    *fd = open(path, O_RDONLY | O_CLOEXEC | open_flags(path));
    if (*fd < 0)
        return fail_open(path, errno, error);
    const ffd_status status = refuse_special(*fd, path, error);
    if (status)
        close(*fd);
    return status;
}

static ffd_status load(const char *path, size_t least_mapped, file_input *input, ffd_error *error)
{
    int fd;
    *input = (file_input){.data = nothing};
    TRY(ffd_file_open(path, &fd, error));
    ffd_status status = load_descriptor(fd, ffd_file_display_name(path), least_mapped, input, error);
    if (fd != STDIN_FILENO)
        close(fd);
    return status;
}

ffd_status ffd_file_load(const char *path, file_input *input, ffd_error *error)
{
    return load(path, SMALL, input, error);
}

ffd_status ffd_file_take(const char *path, ffd_bytes bytes, file_input *input, ffd_error *error)
{
    return bytes.data ? ffd_file_lend(bytes, path, input, error) : ffd_file_load(path, input, error);
}

ffd_status ffd_file_map(const char *path, file_input *input, ffd_error *error)
{
    return load(path, 1, input, error);
}

ffd_status ffd_file_load_within(const char *folder, const char *relative, const char *named_by, size_t *most,
                                file_input *input, ffd_error *error)
{
    *input = (file_input){.data = nothing};
    char *joined = ffd_path_join(folder, relative);
    char *root = realpath(folder, NULL), *path = joined ? realpath(joined, NULL) : NULL;
    const int reason = errno;
    struct stat info;
    ffd_status status = FFD_OK;
    if (!joined)
        TRY_END(ffd_fail_memory(error));
    else if (ffd_path_flaw(relative))
        TRY_END(ffd_fail_file(error, FFD_E_IO, named_by, "\"%s\" %s", relative, ffd_path_flaw(relative)));
    else if (ffd_path_is_absolute(relative))
        TRY_END(ffd_fail_file(error, FFD_E_IO, named_by, "the file \"%s\" is outside the model's folder",
                              relative));
    else if (!root || !path)
        TRY_END(ffd_fail_file(error, FFD_E_IO, named_by, "the file \"%s\" cannot be opened: %s", relative,
                              strerror(reason)));
    else if (!ffd_path_is_inside(root, path))
        TRY_END(ffd_fail_file(error, FFD_E_IO, named_by, "the file \"%s\" is outside the model's folder",
                              relative));
    else if (stat(path, &info) != 0 || !S_ISREG(info.st_mode))
        TRY_END(ffd_fail_file(error, FFD_E_IO, named_by, "\"%s\" is not a file", relative));
    else
        TRY_END(load(path, *most < SMALL ? *most + 1 : SMALL, input, error));
    if (!input->mapped)
        *most -= input->size < *most ? input->size : *most;
end:
    free(root);
    free(path);
    ffd_free(joined);
    return status;
}

void ffd_file_unload(file_input *input)
{
    if (input->mapped) {
        ffd_mapping_forget(input->mapping);
        munmap(input->block, input->size);
    } else {
        ffd_free(input->block);
    }
    *input = (file_input){.data = nothing};
}

void ffd_file_release_pages(const file_input *input, const void *bytes, size_t size)
{
    const size_t page = (size_t)sysconf(_SC_PAGESIZE);
    const size_t begin = (size_t)((const unsigned char *)bytes - input->data);
    const size_t first = (begin + page - 1) / page * page;
    const size_t last = begin + size == input->size ? input->size : (begin + size) / page * page;
    if (input->mapped && first < last) /* a mapping begins at a page boundary */
        madvise((unsigned char *)input->block + first, last - first, MADV_DONTNEED);
}

void ffd_file_release_until(const file_input *input, const void *end, size_t *released)
{
    const size_t until = (size_t)((const unsigned char *)end - input->data) / RELEASE_UNIT * RELEASE_UNIT;
    if (until <= *released)
        return;
    ffd_file_release_pages(input, input->data + *released, until - *released);
    *released = until;
}

void ffd_file_prefault(const void *bytes, size_t size)
{
#ifdef MADV_POPULATE_READ
    const uintptr_t page = (uintptr_t)sysconf(_SC_PAGESIZE), first = (uintptr_t)bytes / page * page;
    if (size >= LEAST_PREFAULT)
        madvise((void *)first, (uintptr_t)bytes + size - first, MADV_POPULATE_READ); /* only advice: a failure
                                                                                        does no harm */
#else
    (void)bytes;
    (void)size;
#endif
}

ffd_status ffd_file_compare(const char *path, const file_input *bytes, bool *same, ffd_error *error)
{
    file_input there;
    TRY(ffd_file_load(path, &there, error));
    *same = there.size == bytes->size;
    for (size_t at = 0, piece; at < bytes->size && *same; at += piece) {
        piece = bytes->size - at < COMPARED ? bytes->size - at : COMPARED;
        *same = memcmp(there.data + at, bytes->data + at, piece) == 0;
        ffd_file_release_pages(&there, there.data + at, piece);
        ffd_file_release_pages(bytes, bytes->data + at, piece);
    }
    ffd_file_unload(&there);
    return FFD_OK;
}

bool ffd_file_exists(const char *path)
{
    struct stat info;
    return stat(path, &info) == 0;
}

bool ffd_file_same(const char *a, const char *b)
{
    struct stat x, y;
    return stat(a, &x) == 0 && stat(b, &y) == 0 && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}
