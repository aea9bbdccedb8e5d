#include "io/gltf/save/gltf_json_insert.h"

/* Returns where the elements of a top-level list end; if the list is missing, where the members of the
   top-level object end. */
static uint32_t find_end(const gltf_document *d, const gltf_values *list, uint32_t array)
{
    const json_span *tree = &d->tree;
    if (list->count > 0)
        return tree->values[list->values[list->count - 1]].end;
    if (array != JSON_NONE)
        return tree->values[array].begin + 1;
    uint32_t last = JSON_NONE; /* "asset" always exists */
    for (uint32_t v = ffd_json_span_first(tree, 0); v != JSON_NONE; v = ffd_json_span_after(tree, v))
        last = v;
    return tree->values[last].end;
}

/* A list that gets elements. The text inserted between begin_list and end_list goes to `at`. */
typedef struct open_list {
    uint32_t at;
    bool is_new;
} open_list;

static open_list begin_list(gltf_saver *saver, const gltf_values *list, const char *key)
{
    const gltf_document *d = saver->document;
    const uint32_t array = ffd_json_span_member(&d->tree, 0, key);
    const open_list opened = {find_end(d, list, array), array == JSON_NONE};
    if (opened.is_new)
        ffd_edits_format(&saver->edits, opened.at, opened.at, ",\"%s\":[", key);
    else if (list->count > 0)
        ffd_edits_format(&saver->edits, opened.at, opened.at, ",");
    return opened;
}

static void end_list(gltf_saver *saver, const open_list *opened)
{
    if (opened->is_new)
        ffd_edits_format(&saver->edits, opened->at, opened->at, "]");
}

void ffd_gltf_add_elements(gltf_saver *saver, const gltf_values *list, const char *key,
                           const byte_buffer *text)
{
    saver->edits.failed = saver->edits.failed || text->failed;
    if (text->size == 0 || text->failed)
        return;
    const open_list opened = begin_list(saver, list, key);
    ffd_edits_replace(&saver->edits, opened.at, opened.at, text->data, text->size);
    end_list(saver, &opened);
}

void ffd_gltf_add_buffer(gltf_saver *saver)
{
    const size_t number = saver->document->buffer_values.count;
    if (saver->buffer_count == number)
        return;
    const open_list opened = begin_list(saver, &saver->document->buffer_values, "buffers");
    ffd_edits_format(&saver->edits, opened.at, opened.at, "{\"byteLength\":%zu",
                     saver->buffers[number].length);
    if (saver->buffers[number].kind == BUFFER_DATA) {
        ffd_edits_format(&saver->edits, opened.at, opened.at,
                         ",\"uri\":\"data:application/octet-stream;base64,");
        ffd_edits_buffer(&saver->edits, opened.at, opened.at, (int)number);
        ffd_edits_format(&saver->edits, opened.at, opened.at, "\"");
    }
    ffd_edits_format(&saver->edits, opened.at, opened.at, "}");
    end_list(saver, &opened);
}

void ffd_gltf_insert_last(gltf_saver *saver, uint32_t container, const byte_buffer *text)
{
    const json_span *tree = &saver->document->tree;
    uint32_t last = JSON_NONE;
    for (uint32_t v = ffd_json_span_first(tree, container); v != JSON_NONE; v = ffd_json_span_after(tree, v))
        last = v;
    const uint32_t at = last == JSON_NONE ? tree->values[container].begin + 1 : tree->values[last].end;
    saver->edits.failed = saver->edits.failed || text->failed;
    if (text->failed)
        return;
    if (last != JSON_NONE)
        ffd_edits_format(&saver->edits, at, at, ",");
    ffd_edits_replace(&saver->edits, at, at, text->data, text->size);
}
