#include "base/file/stream.h"
#include "base/file/input.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include <errno.h>
#include <string.h>

#define BLOCK ((size_t)1 << 16)

struct byte_stream {
    int fd;
    const char *name;
    uint64_t size, read;
    bool ended;
    size_t next, filled; /* positions in the block */
    unsigned char block[BLOCK];
};

ffd_status ffd_stream_open(const char *path, const char *name, byte_stream **stream, ffd_error *error)
{
    struct stat info;
    *stream = ffd_alloc(1, sizeof **stream);
    if (!*stream)
        return ffd_fail_memory(error);
    (*stream)->name = name;
    (*stream)->read = (*stream)->next = (*stream)->filled = 0;
    (*stream)->ended = false;
    const ffd_status status = ffd_file_open(path, &(*stream)->fd, error);
    if (status) {
        ffd_free(*stream);
        *stream = NULL;
        return status;
    }
    const bool is_file = fstat((*stream)->fd, &info) == 0 && S_ISREG(info.st_mode);
    (*stream)->size = is_file ? (uint64_t)info.st_size : 0;
    return FFD_OK;
}

/* Waits at most this many milliseconds; -1: no limit. */
static bool wait_for_bytes(const byte_stream *stream, int most)
{
    struct pollfd ready = {.fd = stream->fd, .events = POLLIN};
    return stream->next < stream->filled || stream->ended || poll(&ready, 1, most) != 0;
}

bool ffd_stream_is_ready(const byte_stream *stream)
{
    return wait_for_bytes(stream, 0);
}

void ffd_stream_wait(const byte_stream *stream)
{
    wait_for_bytes(stream, -1);
}

static ffd_status fill(byte_stream *stream, ffd_error *error)
{
    ssize_t got;
    do
        got = read(stream->fd, stream->block, BLOCK);
    while (got < 0 && errno == EINTR);
    if (got < 0)
        return ffd_fail_file(error, FFD_E_IO, stream->name, "cannot be read: %s", strerror(errno));
    stream->next = 0;
    stream->filled = (size_t)got;
    stream->ended = got == 0;
    return FFD_OK;
}

ffd_status ffd_stream_take(byte_stream *stream, const char **bytes, size_t *size, ffd_error *error)
{
    *size = 0;
    if (stream->next == stream->filled && !stream->ended)
        TRY(fill(stream, error));
    if (stream->ended)
        return FFD_OK;
    const unsigned char *const begin = stream->block + stream->next;
    const size_t left = stream->filled - stream->next;
    const unsigned char *const feed = memchr(begin, '\n', left);
    *bytes = (const char *)begin;
    *size = feed ? (size_t)(feed - begin) + 1 : left;
    stream->next += *size;
    stream->read += *size;
    return FFD_OK;
}

int ffd_stream_descriptor(const byte_stream *stream)
{
    return stream->fd;
}

const char *ffd_stream_name(const byte_stream *stream)
{
    return stream->name;
}

uint64_t ffd_stream_size(const byte_stream *stream)
{
    return stream->size;
}

uint64_t ffd_stream_position(const byte_stream *stream)
{
    return stream->read;
}

void ffd_stream_close(byte_stream **stream)
{
    if (!stream || !*stream)
        return;
    if ((*stream)->fd != STDIN_FILENO)
        close((*stream)->fd);
    ffd_free(*stream);
    *stream = NULL;
}
