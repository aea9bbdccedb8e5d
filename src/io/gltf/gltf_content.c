#include "base/memory.h"
#include "io/gltf/gltf_saver.h"
#include <stdlib.h>
#include <string.h>

#define FLOAT_SIZE 4
#define LARGEST_BUFFER ((size_t)1 << 53)

static size_t buffer_of(const gltf_document *d, size_t accessor)
{
    return (size_t)d->model.views[d->model.accessors[accessor].view].buffer;
}

static ffd_status make_room(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    saver->buffers = ffd_alloc_zero(d->buffer_values.count, sizeof *saver->buffers);
    if (!saver->buffers)
        return ffd_fail_memory(error);
    for (size_t a = 0; a < d->model.accessor_count; a++)
        if (saver->plan.in_place[a] != GLTF_NONE)
            saver->buffers[buffer_of(d, a)].overwrite_count++;
    for (size_t i = 0; i < saver->plan.appended_count; i++)
        saver->buffers[buffer_of(d, saver->plan.versions[saver->plan.appended[i]].accessor)].append_count++;
    for (size_t b = 0; b < d->buffer_values.count; b++) {
        gltf_new_buffer *buffer = &saver->buffers[b];
        buffer->length = d->buffers[b].length;
        buffer->changed = buffer->overwrite_count + buffer->append_count > 0;
        buffer->kind = d->buffers[b].kind;
        buffer->overwrites = ffd_alloc(buffer->overwrite_count, sizeof *buffer->overwrites);
        buffer->appends = ffd_alloc(buffer->append_count, sizeof *buffer->appends);
        if (!buffer->overwrites || !buffer->appends)
            return ffd_fail_memory(error);
        buffer->overwrite_count = buffer->append_count = 0;
    }
    return FFD_OK;
}

static int compare_overwrites(const void *a, const void *b)
{
    const gltf_overwrite *x = a, *y = b;
    return (x->begin > y->begin) - (x->begin < y->begin);
}

static void list_overwrites(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    for (size_t a = 0; a < d->model.accessor_count; a++) {
        const size_t version = saver->plan.in_place[a];
        if (version == GLTF_NONE)
            continue;
        const gltf_layout *layout = &d->layouts[a];
        const size_t count = (size_t)d->model.accessors[a].count;
        gltf_new_buffer *buffer = &saver->buffers[buffer_of(d, a)];
        buffer->overwrites[buffer->overwrite_count++] =
            (gltf_overwrite){.begin = layout->begin,
                             .end = layout->begin + (count - 1) * layout->stride + 3 * FLOAT_SIZE,
                             .stride = layout->stride,
                             .values = saver->plan.versions[version].values};
    }
    for (size_t b = 0; b < d->buffer_values.count; b++) {
        gltf_new_buffer *buffer = &saver->buffers[b];
        if (buffer->overwrite_count > 0)
            qsort(buffer->overwrites, buffer->overwrite_count, sizeof *buffer->overwrites,
                  compare_overwrites);
        size_t end = 0;
        for (size_t i = 0; i < buffer->overwrite_count; i++) {
            end = buffer->overwrites[i].end > end ? buffer->overwrites[i].end : end;
            buffer->overwrites[i].end_so_far = end;
        }
    }
}

static ffd_status list_appends(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    for (size_t i = 0; i < saver->plan.appended_count; i++) {
        const size_t version = saver->plan.appended[i], accessor = saver->plan.versions[version].accessor;
        gltf_new_buffer *buffer = &saver->buffers[buffer_of(d, accessor)];
        const size_t offset = (buffer->length + 3) / 4 * 4;
        const size_t size = (size_t)d->model.accessors[accessor].count * d->layouts[accessor].element_size;
        if (size > LARGEST_BUFFER || offset > LARGEST_BUFFER - size)
            return ffd_fail_file(error, FFD_E_LIMIT, saver->options->path,
                                 "a buffer would have more than 2^53 bytes");
        buffer->appends[buffer->append_count++] = (gltf_append){offset, size, version};
        buffer->length = offset + size;
    }
    return FFD_OK;
}

ffd_status ffd_gltf_make_content(gltf_saver *saver, ffd_error *error)
{
    const ffd_status status = make_room(saver, error);
    if (status)
        return status;
    list_overwrites(saver);
    return list_appends(saver, error);
}

void ffd_gltf_free_content(gltf_saver *saver)
{
    for (size_t b = 0; saver->buffers && b < saver->document->buffer_values.count; b++) {
        ffd_free(saver->buffers[b].overwrites);
        ffd_free(saver->buffers[b].appends);
        ffd_free(saver->buffers[b].target);
    }
    ffd_free(saver->buffers);
}

size_t ffd_gltf_content_size(const gltf_saver *saver, size_t buffer)
{
    const gltf_new_buffer *made = &saver->buffers[buffer];
    const gltf_buffer *old = &saver->document->buffers[buffer];
    return made->append_count > 0 || made->kind != old->kind ? made->length : old->size;
}

static void write_floats(const float *values, size_t count, unsigned char *bytes)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, values + i, sizeof bits);
        ffd_glb_write_u32(bytes + FLOAT_SIZE * i, bits);
    }
}

/* Copies what `size` bytes at `at` and the range [offset, offset + length) have in common. */
static void copy_common(const unsigned char *from, size_t at, size_t size, size_t offset, size_t length,
                        unsigned char *bytes)
{
    const size_t begin = at > offset ? at : offset;
    const size_t end = at + size < offset + length ? at + size : offset + length;
    if (begin < end)
        memcpy(bytes + (begin - offset), from + (begin - at), end - begin);
}

static void apply_overwrite(const gltf_overwrite *overwrite, size_t offset, size_t size, unsigned char *bytes)
{
    const size_t element = 3 * FLOAT_SIZE;
    size_t i =
        offset > overwrite->begin + element ? (offset - overwrite->begin - element) / overwrite->stride : 0;
    for (size_t at = overwrite->begin + i * overwrite->stride; at < offset + size && at < overwrite->end;
         i++, at += overwrite->stride) {
        unsigned char encoded[3 * FLOAT_SIZE];
        write_floats(overwrite->values + 3 * i, 3, encoded);
        copy_common(encoded, at, element, offset, size, bytes);
    }
}

static void apply_overwrites(const gltf_new_buffer *buffer, size_t offset, size_t size, unsigned char *bytes)
{
    size_t low = 0, high = buffer->overwrite_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (buffer->overwrites[middle].end_so_far <= offset)
            low = middle + 1;
        else
            high = middle;
    }
    for (size_t i = low; i < buffer->overwrite_count && buffer->overwrites[i].begin < offset + size; i++)
        if (buffer->overwrites[i].end > offset)
            apply_overwrite(&buffer->overwrites[i], offset, size, bytes);
}

/* The new elements stand one behind the other; a tangent keeps its 4th component. */
static void apply_append(const gltf_saver *saver, const gltf_append *append, size_t offset, size_t size,
                         unsigned char *bytes)
{
    const gltf_version *version = &saver->plan.versions[append->version];
    const gltf_layout *layout = &saver->document->layouts[version->accessor];
    const size_t element = layout->element_size;
    size_t i = offset > append->offset ? (offset - append->offset) / element : 0;
    for (; i * element < append->size && append->offset + i * element < offset + size; i++) {
        unsigned char encoded[4 * FLOAT_SIZE];
        memcpy(encoded, layout->data + i * layout->stride, element);
        write_floats(version->values + 3 * i, 3, encoded);
        copy_common(encoded, append->offset + i * element, element, offset, size, bytes);
    }
}

static void apply_appends(const gltf_saver *saver, const gltf_new_buffer *buffer, size_t offset, size_t size,
                          unsigned char *bytes)
{
    size_t low = 0, high = buffer->append_count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (buffer->appends[middle].offset + buffer->appends[middle].size <= offset)
            low = middle + 1;
        else
            high = middle;
    }
    for (size_t i = low; i < buffer->append_count && buffer->appends[i].offset < offset + size; i++)
        apply_append(saver, &buffer->appends[i], offset, size, bytes);
}

void ffd_gltf_content_read(const gltf_saver *saver, size_t b, size_t offset, size_t size,
                           unsigned char *bytes)
{
    const gltf_buffer *old = &saver->document->buffers[b];
    const gltf_new_buffer *made = &saver->buffers[b];
    /* Bytes behind the old byteLength are no content: a buffer that grows does so from there. */
    const size_t kept = made->append_count > 0 ? old->length : old->size;
    memset(bytes, 0, size);
    copy_common(old->data, 0, kept, offset, size, bytes);
    apply_overwrites(made, offset, size, bytes);
    apply_appends(saver, made, offset, size, bytes);
}
