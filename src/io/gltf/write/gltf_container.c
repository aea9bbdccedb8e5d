/* gltf_container.c - decides how the output stores each buffer, and in which file. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/gltf/file/glb.h"
#include "io/gltf/file/gltf_buffer.h"
#include "io/gltf/file/gltf_uri.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/write/gltf_saver.h"
#include "mesh/resource/sidecar.h"
#include <string.h>

static gltf_buffer_kind kind_in_glb(const gltf_buffer *buffer, size_t index)
{
    if (buffer->kind == BUFFER_EMPTY)
        return BUFFER_EMPTY;
    return index == 0 ? BUFFER_BIN : BUFFER_DATA;
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

/* Adds the member "uri" to the JSON of a buffer. */
static void add_uri(gltf_saver *saver, size_t buffer, const char *uri)
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
        const uint32_t uri = ffd_json_tree_member(&d->tree, d->buffer_values.values[b], "uri");
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

/* Refuses to replace a file of the input by the output. */
static ffd_status refuse_own_file(const gltf_saver *saver, const char *target, ffd_error *error)
{
    const gltf_document *d = saver->document;
    if (!ffd_file_is_stream(d->path) && strcmp(target, saver->options->path) != 0 &&
        ffd_save_meets(saver->options, d->path, target))
        return ffd_fail_file(error, FFD_E_EXISTS, target, "is the input and is not overwritten by a buffer");
    for (size_t i = 0; i < d->buffer_values.count; i++) {
        if (d->buffers[i].kind != BUFFER_FILE)
            continue;
        char *own = ffd_path_sibling(d->path, d->buffers[i].path);
        const bool same = own && ffd_save_meets(saver->options, own, target), failed = !own;
        ffd_free(own);
        if (failed)
            return ffd_fail_memory(error);
        if (same)
            return ffd_fail_file(error, FFD_E_EXISTS, target,
                                 "is a buffer of the input %s and is not overwritten", d->name);
    }
    return FFD_OK;
}

static ffd_status set_uri(gltf_saver *saver, size_t b, const char *name, ffd_error *error)
{
    const gltf_document *d = saver->document;
    const uint32_t uri = ffd_json_tree_member(&d->tree, d->buffer_values.values[b], "uri");
    if (d->buffers[b].path && strcmp(d->buffers[b].path, name) == 0)
        return FFD_OK;
    char *encoded = ffd_uri_encode(name);
    if (!encoded)
        return ffd_fail_memory(error);
    if (uri == JSON_NONE)
        add_uri(saver, b, encoded);
    else
        ffd_edits_replace(&saver->edits, d->tree.values[uri].begin + 1, d->tree.values[uri].end - 1, encoded,
                          strlen(encoded));
    ffd_free(encoded);
    return ffd_edits_failed(&saver->edits) ? ffd_fail_memory(error) : FFD_OK;
}

/* A buffer of the document, whose file is asked for. */
typedef struct named_buffer {
    const gltf_document *document;
    size_t index;
} named_buffer;

/* Whether the file belongs to the buffer and to no other buffer of the model. */
static bool is_own_file(const void *context, const char *target)
{
    const named_buffer *const of = context;
    const gltf_document *const d = of->document;
    bool own = false;
    for (size_t i = 0; i < d->buffer_values.count; i++) {
        if (d->buffers[i].kind != BUFFER_FILE)
            continue;
        char *const file = ffd_path_sibling(d->path, d->buffers[i].path);
        const bool same = file && ffd_file_same(file, target), is_known = file;
        ffd_free(file);
        if (!is_known || (same && i != of->index)) /* without memory it is not replaced */
            return false;
        own = own || same;
    }
    return own;
}

static ffd_status give_name(gltf_saver *saver, size_t b, sidecar_names *names, ffd_error *error)
{
    const named_buffer of = {saver->document, b};
    const gltf_buffer *const buffer = &saver->document->buffers[b];
    const bool has_old = saver->in_place && buffer->kind == BUFFER_FILE;
    char *const old = has_old ? ffd_path_sibling(saver->document->path, buffer->path) : NULL;
    char *target = NULL;
    names->old = old;
    const ffd_status status =
        old || !has_old ? ffd_sidecar_next(names, is_own_file, &of, &target, error) : ffd_fail_memory(error);
    names->old = NULL;
    ffd_free(old);
    TRY(status);
    saver->buffers[b].target = target;
    if (!saver->in_place)
        TRY(refuse_own_file(saver, target, error));
    if (!saver->in_place && !saver->options->to_sink)
        TRY(ffd_output_check(target, saver->options->force, error));
    return set_uri(saver, b, ffd_path_name(target), error);
}

/* If the output replaces the input, an unchanged buffer keeps its file. A changed buffer gets a new name
   after the output, because other models may use the old file; the only existing file that it may replace is
   its own. */
ffd_status ffd_gltf_name_buffers(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    const bool stream = ffd_output_is_stream(saver->options->path);
    sidecar_names names = {.options = saver->options, .log = saver->log, .in_place = saver->in_place};
    if (!stream && !saver->in_place)
        TRY(refuse_own_file(saver, saver->options->path, error));
    for (size_t b = 0; b < d->buffer_values.count; b++) {
        if (saver->buffers[b].kind != BUFFER_FILE || (saver->in_place && !saver->buffers[b].changed))
            continue;
        if (stream)
            return ffd_json_tree_fail(
                &d->tree, d->buffer_values.values[b], d->name, FFD_E_ARGUMENT, error,
                "the buffer is a file of its own, which standard output cannot hold: give a file "
                "name as output");
        TRY(give_name(saver, b, &names, error));
    }
    return FFD_OK;
}

/* Counts the buffers as gltf_container.c places them if the model keeps its format, else as a converted model
   has them. */
size_t ffd_gltf_count_sidecars(const file_input *bytes, ffd_format from, ffd_format to)
{
    const bool is_model = from == FFD_FORMAT_GLTF || from == FFD_FORMAT_GLB, to_text = to == FFD_FORMAT_GLTF;
    glb_layout layout;
    if (!is_model)
        return to_text;
    const char *const data = (const char *)bytes->data;
    if (!ffd_glb_is(bytes->data, bytes->size))
        return to_text ? ffd_gltf_count_buffer_files(data, bytes->size) : 0;
    if (ffd_glb_parse(bytes->data, bytes->size, "", &layout, NULL))
        return 0;
    return ffd_gltf_count_buffer_files(data + layout.json_begin, layout.json_size) +
           (to_text && layout.has_bin);
}
