#include "io/gltf/write/gltf_container.h"
#include <string.h>

static gltf_buffer_kind kind_in_glb(const gltf_buffer *buffer, size_t number)
{
    if (buffer->kind == BUFFER_EMPTY)
        return BUFFER_EMPTY;
    return number == 0 ? BUFFER_BIN : BUFFER_DATA;
}

static gltf_buffer_kind kind_in_text(const gltf_buffer *buffer, bool stream)
{
    if (buffer->kind != BUFFER_BIN)
        return buffer->kind;
    return stream ? BUFFER_DATA : BUFFER_FILE;
}

void ffd_gltf_choose_buffer_kinds(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    const bool stream = ffd_output_is_stream(saver->options->path);
    for (size_t b = 0; b < d->buffer_values.count && saver->binary != d->binary; b++)
        saver->buffers[b].kind =
            saver->binary ? kind_in_glb(&d->buffers[b], b) : kind_in_text(&d->buffers[b], stream);
}

void ffd_gltf_add_uri(gltf_saver *saver, size_t buffer, const char *uri)
{
    const gltf_document *d = saver->document;
    const uint32_t end = d->tree.values[d->buffer_values.values[buffer]].end - 1;
    ffd_edits_format(&saver->edits, end, end, ",\"uri\":\"");
    ffd_edits_replace(&saver->edits, end, end, uri, strlen(uri));
    ffd_edits_replace(&saver->edits, end, end, "\"", 1);
}

static const char data_head[] = "data:application/octet-stream;base64,";

static void add_data_uri(gltf_saver *saver, size_t buffer)
{
    const gltf_document *d = saver->document;
    const uint32_t end = d->tree.values[d->buffer_values.values[buffer]].end;
    ffd_edits_format(&saver->edits, end - 1, end - 1, ",\"uri\":\"%s", data_head);
    ffd_edits_buffer(&saver->edits, end - 1, end - 1, (int)buffer);
    ffd_edits_replace(&saver->edits, end - 1, end, "\"}", 2);
}

static void replace_with_data_uri(gltf_saver *saver, size_t buffer, uint32_t value)
{
    const json_value *uri = &saver->document->tree.values[value];
    ffd_edits_replace(&saver->edits, uri->begin + 1, uri->end - 1, data_head, sizeof data_head - 1);
    ffd_edits_buffer(&saver->edits, uri->end - 1, uri->end - 1, (int)buffer);
}

void ffd_gltf_move_buffers(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    for (size_t b = 0; b < d->buffer_values.count; b++) {
        const uint32_t uri = ffd_json_span_member(&d->tree, d->buffer_values.values[b], "uri");
        const gltf_buffer_kind from = d->buffers[b].kind, to = saver->buffers[b].kind;
        if (from == to)
            continue;
        if (to == BUFFER_BIN)
            ffd_edits_remove(&saver->edits, &d->tree, d->buffer_values.values[b], &uri, 1);
        else if (to == BUFFER_DATA && uri == JSON_NONE)
            add_data_uri(saver, b);
        else if (to == BUFFER_DATA)
            replace_with_data_uri(saver, b, uri);
    }
}
