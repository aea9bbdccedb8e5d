#include "io/gltf/edit/gltf_grown.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/text/base64.h"
#include "base/text/buffer_binary.h"
#include "io/gltf/edit/gltf_json_insert.h"

static bool extends_bin(const gltf_document *d)
{
    return d->buffer_values.count > 0 && d->buffers[0].kind == BUFFER_BIN;
}

/* Returns the offset in the BIN chunk where the old bytes end and new ones begin. */
static size_t bin_end(const gltf_document *d)
{
    return ffd_gltf_align(d->buffers[0].length);
}

static void write_buffer(gltf_grown *w, byte_buffer *text)
{
    const size_t size = w->bytes.size, length = ffd_base64_length(size);
    ffd_buffer_format(text, "{\"byteLength\":%zu,\"uri\":\"data:application/octet-stream;base64,", size);
    char *encoded = ffd_alloc(length, 1);
    if (!encoded) {
        text->failed = true;
        return;
    }
    ffd_base64_encode((const unsigned char *)w->bytes.data, size, encoded);
    ffd_buffer_append(text, encoded, length);
    ffd_buffer_text(text, "\"}");
    ffd_free(encoded);
}

/* Adds a bufferView of the new bytes: in the BIN chunk if the file has one, else in a new buffer. */
static void add_bytes(gltf_grown *w)
{
    const gltf_document *d = w->document;
    const bool bin = extends_bin(d);
    byte_buffer view = {0}, buffer = {0};
    if (w->bytes.size == 0)
        return;
    ffd_buffer_format(&view, "{\"buffer\":%zu,\"byteOffset\":%zu,\"byteLength\":%zu}",
                      bin ? 0 : d->buffer_values.count, bin ? bin_end(d) : 0, w->bytes.size);
    ffd_gltf_add_elements(d, &d->view_values, "bufferViews", &view, &w->edits);
    if (bin) {
        const uint32_t length = ffd_json_tree_member(&d->tree, d->buffer_values.values[0], "byteLength");
        if (length != JSON_NONE)
            ffd_edits_format(&w->edits, d->tree.values[length].begin, d->tree.values[length].end, "%zu",
                             bin_end(d) + w->bytes.size);
    } else {
        write_buffer(w, &buffer);
        ffd_gltf_add_elements(d, &d->buffer_values, "buffers", &buffer, &w->edits);
    }
    ffd_buffer_free(&view);
    ffd_buffer_free(&buffer);
}

static void pad(byte_buffer *out, const char *with)
{
    while (out->size % 4 && !out->failed)
        ffd_buffer_append(out, with, 1);
}

/* Writes the container around a new JSON text. */
static void write_glb(const gltf_grown *w, byte_buffer *json, byte_buffer *out)
{
    const gltf_document *d = w->document;
    const bool grows = extends_bin(d) && w->bytes.size > 0;
    pad(json, " ");
    ffd_buffer_u32(out, GLB_MAGIC);
    ffd_buffer_u32(out, GLB_VERSION);
    ffd_buffer_u32(out, 0);
    ffd_buffer_u32(out, (uint32_t)json->size);
    ffd_buffer_u32(out, GLB_CHUNK_JSON);
    ffd_buffer_append(out, json->data, json->size);
    if (d->glb.has_bin) {
        const size_t kept = grows ? d->buffers[0].length : d->glb.bin_size;
        ffd_buffer_u32(out, (uint32_t)(grows ? ffd_gltf_align(bin_end(d) + w->bytes.size) : kept));
        ffd_buffer_u32(out, GLB_CHUNK_BIN);
        ffd_buffer_append(out, d->input.data + d->glb.bin_begin, kept);
        if (grows) {
            pad(out, "");
            ffd_buffer_append(out, w->bytes.data, w->bytes.size);
            pad(out, "");
        }
    }
    ffd_buffer_append(out, d->input.data + d->glb.rest_begin, d->glb.end - d->glb.rest_begin);
    if (!out->failed)
        store_u32((unsigned char *)out->data + 8, (uint32_t)out->size);
}

static ffd_status write_file(gltf_grown *w, file_input *made, ffd_error *error)
{
    const gltf_document *d = w->document;
    byte_buffer text = {0}, glb = {0}, *const file = d->binary ? &glb : &text;
    ffd_status status = FFD_OK;
    ffd_edits_sort(&w->edits);
    ffd_edits_apply(&w->edits, d->tree.text, 0, (uint32_t)d->tree.size, &text);
    if (d->binary && !text.failed)
        write_glb(w, &text, &glb);
    if (text.failed || glb.failed || w->bytes.failed)
        status = ffd_fail_memory(error);
    else if (file->size > UINT32_MAX)
        status = ffd_fail_file(error, FFD_E_LIMIT, d->name, "would have more than 4294967295 bytes");
    if (!status) {
        *made =
            (file_input){.data = (const unsigned char *)file->data, .size = file->size, .block = file->data};
        *file = (byte_buffer){0};
    }
    ffd_buffer_free(&text);
    ffd_buffer_free(&glb);
    return status;
}

ffd_status ffd_gltf_grown_write(gltf_grown *w, file_input *made, ffd_error *error)
{
    ffd_gltf_add_elements(w->document, &w->document->accessor_values, "accessors", &w->accessors, &w->edits);
    add_bytes(w);
    return write_file(w, made, error);
}

void ffd_gltf_grown_free(gltf_grown *w)
{
    ffd_buffer_free(&w->accessors);
    ffd_buffer_free(&w->bytes);
    ffd_edits_free(&w->edits);
}
