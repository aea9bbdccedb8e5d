#include "io/gltf/edit/gltf_json_insert.h"

/* Returns where the elements of a top-level list end; if the list is missing, where the members of the
   top-level object end. */
static uint32_t find_end(const gltf_document *d, const gltf_values *list, uint32_t array)
{
    const json_tree *tree = &d->tree;
    if (list->count > 0)
        return tree->values[list->values[list->count - 1]].end;
    if (array != JSON_NONE)
        return tree->values[array].begin + 1;
    uint32_t last = JSON_NONE; /* "asset" always exists */
    for (uint32_t v = ffd_json_tree_first(tree, 0); v != JSON_NONE; v = ffd_json_tree_after(tree, v))
        last = v;
    return tree->values[last].end;
}

/* A list that gets elements. The text inserted between begin_list and end_list goes to `at`. */
typedef struct open_list {
    uint32_t at;
    bool is_new;
} open_list;

static open_list begin_list(const gltf_document *d, const gltf_values *list, const char *key,
                            json_edits *edits)
{
    const uint32_t array = ffd_json_tree_member(&d->tree, 0, key);
    const open_list opened = {find_end(d, list, array), array == JSON_NONE};
    if (opened.is_new)
        ffd_edits_format(edits, opened.at, opened.at, ",\"%s\":[", key);
    else if (list->count > 0)
        ffd_edits_format(edits, opened.at, opened.at, ",");
    return opened;
}

static void end_list(const open_list *opened, json_edits *edits)
{
    if (opened->is_new)
        ffd_edits_format(edits, opened->at, opened->at, "]");
}

void ffd_gltf_add_elements(const gltf_document *d, const gltf_values *list, const char *key,
                           const byte_buffer *text, json_edits *edits)
{
    edits->failed = edits->failed || text->failed;
    if (text->size == 0 || text->failed)
        return;
    const open_list opened = begin_list(d, list, key, edits);
    ffd_edits_replace(edits, opened.at, opened.at, text->data, text->size);
    end_list(&opened, edits);
}

void ffd_gltf_add_buffer(const gltf_document *d, size_t length, bool is_data, json_edits *edits)
{
    const open_list opened = begin_list(d, &d->buffer_values, "buffers", edits);
    ffd_edits_format(edits, opened.at, opened.at, "{\"byteLength\":%zu", length);
    if (is_data) {
        ffd_edits_format(edits, opened.at, opened.at, ",\"uri\":\"data:application/octet-stream;base64,");
        ffd_edits_buffer(edits, opened.at, opened.at, (int)d->buffer_values.count);
        ffd_edits_format(edits, opened.at, opened.at, "\"");
    }
    ffd_edits_format(edits, opened.at, opened.at, "}");
    end_list(&opened, edits);
}

void ffd_gltf_insert_last(const gltf_document *d, uint32_t container, const byte_buffer *text,
                          json_edits *edits)
{
    const json_tree *tree = &d->tree;
    uint32_t last = JSON_NONE;
    for (uint32_t v = ffd_json_tree_first(tree, container); v != JSON_NONE; v = ffd_json_tree_after(tree, v))
        last = v;
    const uint32_t at = last == JSON_NONE ? tree->values[container].begin + 1 : tree->values[last].end;
    edits->failed = edits->failed || text->failed;
    if (text->failed)
        return;
    if (last != JSON_NONE)
        ffd_edits_format(edits, at, at, ",");
    ffd_edits_replace(edits, at, at, text->data, text->size);
}
