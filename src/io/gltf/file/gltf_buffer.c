#include "io/gltf/file/gltf_buffer.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/gltf/file/base64.h"
#include "io/gltf/file/uri.h"
#include <string.h>

typedef struct loader {
    const json_span *tree;
    uint32_t value, uri; /* of the JSON: the buffer, its uri */
    const char *model;   /* its path */
    const char *name;    /* for messages */
    ffd_error *error;
} loader;

size_t ffd_data_uri_payload(const char *uri, size_t size, bool *base64)
{
    static const char marker[] = ";base64";
    const size_t marker_size = sizeof marker - 1;
    const char *comma = memchr(uri, ',', size);
    if (!comma)
        return SIZE_MAX;
    const size_t head = (size_t)(comma - uri);
    *base64 = head >= marker_size && memcmp(comma - marker_size, marker, marker_size) == 0;
    return head + 1;
}

static ffd_status load_data_uri(const loader *l, char *uri, size_t size, gltf_buffer *buffer)
{
    bool base64 = false;
    const size_t head = ffd_data_uri_payload(uri, size, &base64);
    if (head == SIZE_MAX)
        return ffd_json_span_fail(l->tree, l->uri, l->name, FFD_E_INVALID, l->error,
                                  "the data URI has no comma");
    size = ffd_uri_decode(uri + head, size - head);
    buffer->kind = BUFFER_DATA;
    buffer->decoded = ffd_alloc(base64 ? ffd_base64_capacity(size) : size, 1);
    buffer->data = buffer->decoded;
    if (!buffer->decoded)
        return ffd_fail_memory(l->error);
    if (!base64) {
        memcpy(buffer->decoded, uri + head, size);
        buffer->size = size;
    } else if (!ffd_base64_decode(uri + head, size, buffer->decoded, &buffer->size)) {
        return ffd_json_span_fail(l->tree, l->uri, l->name, FFD_E_INVALID, l->error,
                                  "the data URI is not valid base64");
    }
    return FFD_OK;
}

static ffd_status load_file(const loader *l, char *uri, size_t size, gltf_buffer *buffer)
{
    if (ffd_file_is_stream(l->model))
        return ffd_json_span_fail(l->tree, l->uri, l->name, FFD_E_IO, l->error,
                                  "the buffer is the file \"%s\", and standard input has no folder", uri);
    if (ffd_uri_is_absolute(uri))
        return ffd_json_span_fail(l->tree, l->uri, l->name, FFD_E_IO, l->error,
                                  "the buffer \"%s\" is outside the model's folder", uri);
    size = ffd_uri_decode(uri, size);
    uri[size] = 0;
    if (memchr(uri, 0, size))
        return ffd_json_span_fail(l->tree, l->uri, l->name, FFD_E_INVALID, l->error,
                                  "the buffer's name holds a NUL character");
    buffer->path = ffd_text_copy(uri);
    char *folder = ffd_path_folder(l->model);
    ffd_status status = buffer->path && folder ? FFD_OK : ffd_fail_memory(l->error);
    if (status == FFD_OK)
        status = ffd_file_load_within(folder, buffer->path, l->name, &buffer->file, l->error);
    ffd_free(folder);
    if (status)
        return status;
    buffer->kind = BUFFER_FILE;
    buffer->data = buffer->file.data;
    buffer->size = buffer->file.size;
    return FFD_OK;
}

static ffd_status load_uri(const loader *l, gltf_buffer *buffer)
{
    size_t size;
    char *uri = ffd_json_span_string(l->tree, l->uri, &size);
    if (!uri)
        return ffd_fail_memory(l->error);
    const ffd_status status =
        ffd_uri_is_data(uri) ? load_data_uri(l, uri, size, buffer) : load_file(l, uri, size, buffer);
    ffd_free(uri);
    return status;
}

ffd_status ffd_gltf_load_buffer(const json_span *tree, uint32_t value, const unsigned char *bin,
                                size_t bin_size, const char *model, const char *name, gltf_buffer *buffer,
                                ffd_error *error)
{
    *buffer = (gltf_buffer){.kind = BUFFER_EMPTY};
    const loader l = {tree, value, ffd_json_span_member(tree, value, "uri"), model, name, error};
    double length = 0;
    ffd_json_span_number(tree, ffd_json_span_member(tree, value, "byteLength"), &length);
    buffer->length = (size_t)length;
    ffd_status status = FFD_OK;
    if (l.uri != JSON_NONE) {
        status = load_uri(&l, buffer);
    } else if (bin) {
        buffer->kind = BUFFER_BIN;
        buffer->data = bin;
        buffer->size = bin_size;
    }
    if (status == FFD_OK && buffer->kind != BUFFER_EMPTY && buffer->size < buffer->length)
        status = ffd_json_span_fail(tree, value, name, FFD_E_INVALID, error,
                                    "the buffer has %zu bytes, less than its byteLength %zu", buffer->size,
                                    buffer->length);
    if (status)
        ffd_gltf_free_buffer(buffer);
    return status;
}

void ffd_gltf_free_buffer(gltf_buffer *buffer)
{
    ffd_free(buffer->decoded);
    ffd_free(buffer->path);
    if (buffer->file.data)
        ffd_file_unload(&buffer->file);
    *buffer = (gltf_buffer){0};
}
