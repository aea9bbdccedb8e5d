#define _DEFAULT_SOURCE /* pread */
#include "base/file/record_queue.h"
#include "base/file/unnamed_file.h"
#include "base/posix.h"
#include <errno.h>
#include <string.h>

/* Each record follows its size. */
typedef uint64_t record_size;

static bool write_at(int file, uint64_t at, const void *bytes, size_t size)
{
    for (size_t done = 0; done < size;) {
        const ssize_t count = pwrite(file, (const char *)bytes + done, size - done, (off_t)(at + done));
        if (count < 0 && errno != EINTR)
            return false;
        done += count > 0 ? (size_t)count : 0;
    }
    return true;
}

static ffd_status read_at(int file, uint64_t at, void *bytes, size_t size, ffd_error *error)
{
    for (size_t done = 0; done < size;) {
        const ssize_t count = pread(file, (char *)bytes + done, size - done, (off_t)(at + done));
        if (count == 0 || (count < 0 && errno != EINTR))
            return ffd_fail(error, FFD_E_IO, "a temporary file cannot be read: %s",
                            count ? strerror(errno) : "it has become shorter");
        done += count > 0 ? (size_t)count : 0;
    }
    return FFD_OK;
}

static void open_file(record_queue *queue)
{
    queue->is_tried = true;
    queue->file = ffd_unnamed_file();
    queue->has_file = queue->file >= 0;
}

ffd_status ffd_records_put(record_queue *queue, const byte_buffer *record, ffd_error *error)
{
    const record_size size = record->size;
    byte_buffer *const rest = &queue->rest;
    if (!queue->is_tried)
        open_file(queue);
    if (queue->has_file && rest->size == 0 && write_at(queue->file, queue->written, &size, sizeof size) &&
        write_at(queue->file, queue->written + sizeof size, record->data, record->size)) {
        queue->written += sizeof size + size;
        return FFD_OK;
    }
    ffd_buffer_append(rest, &size, sizeof size);
    ffd_buffer_append(rest, record->data, record->size);
    return rest->failed ? ffd_fail_memory(error) : FFD_OK;
}

static ffd_status take_from_file(record_queue *queue, byte_buffer *record, ffd_error *error)
{
    record_size size;
    TRY(read_at(queue->file, queue->taken, &size, sizeof size, error));
    char *const bytes = ffd_buffer_reserve(record, (size_t)size);
    if (!bytes)
        return ffd_fail_memory(error);
    TRY(read_at(queue->file, queue->taken + sizeof size, bytes, (size_t)size, error));
    record->size = (size_t)size;
    queue->taken += sizeof size + size;
    return FFD_OK;
}

ffd_status ffd_records_take(record_queue *queue, byte_buffer *record, bool *found, ffd_error *error)
{
    record_size size;
    record->size = 0;
    *found = true;
    if (queue->taken < queue->written)
        return take_from_file(queue, record, error);
    *found = queue->rest_taken < queue->rest.size;
    if (!*found)
        return FFD_OK;
    const char *const at = queue->rest.data + queue->rest_taken;
    memcpy(&size, at, sizeof size);
    ffd_buffer_append(record, at + sizeof size, (size_t)size);
    queue->rest_taken += sizeof size + (size_t)size;
    return record->failed ? ffd_fail_memory(error) : FFD_OK;
}

void ffd_records_free(record_queue *queue)
{
    if (queue->has_file)
        close(queue->file);
    ffd_buffer_free(&queue->rest);
    *queue = (record_queue){0};
}
