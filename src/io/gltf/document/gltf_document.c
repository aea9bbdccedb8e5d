#include "io/gltf/document/gltf_document.h"

const char *const ffd_gltf_semantic_names[GLTF_DEFORMED] = {"POSITION", "NORMAL", "TANGENT"};

uint32_t ffd_gltf_primitive_value(const gltf_document *d, size_t mesh, size_t primitive)
{
    return d->primitive_values.values[d->first_primitive[mesh] + primitive];
}

uint32_t ffd_gltf_extension(const gltf_document *d, uint32_t value, const char *extension)
{
    return ffd_json_span_member(&d->tree, ffd_json_span_member(&d->tree, value, "extensions"), extension);
}

bool ffd_gltf_has_extension(const gltf_document *d, uint32_t value, const char *extension)
{
    return ffd_gltf_extension(d, value, extension) != JSON_NONE;
}

void ffd_gltf_forget(const gltf_document *d)
{
    ffd_file_release_pages(&d->input, d->input.data, d->input.size);
    for (size_t i = 0; i < d->buffer_values.count; i++)
        if (d->buffers[i].kind == BUFFER_FILE)
            ffd_file_release_pages(&d->buffers[i].file, d->buffers[i].file.data, d->buffers[i].file.size);
}

void ffd_gltf_forget_bytes(const gltf_document *d, const gltf_buffer *buffer, size_t offset, size_t size)
{
    const file_input *input = buffer->kind == BUFFER_FILE ? &buffer->file : &d->input;
    const bool in_file = buffer->kind == BUFFER_FILE || buffer->kind == BUFFER_BIN;
    if (in_file && offset < buffer->size)
        ffd_file_release_pages(input, buffer->data + offset,
                               size < buffer->size - offset ? size : buffer->size - offset);
}
