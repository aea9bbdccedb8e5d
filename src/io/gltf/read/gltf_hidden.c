#include "io/gltf/read/gltf_hidden.h"
#include <math.h>
#include <string.h>

/* The members of the file that hold its geometry. tinygltf gets no others: it would spend time on them, and
   refuse the file because of them. */
static const char *const shown[] = {"asset", "bufferViews", "accessors", "meshes",
                                    "nodes", "scenes",      "scene"};

/* Members that elements of these lists have for us only. We read all of them from the file's own JSON. */
static const struct {
    const char *list, *member;
} hidden[] = {
    {"bufferViews", "byteStride"}, /* refused if it is not a multiple of 4, which is a flaw for us */
    {"primitives", "mode"},        /* a number that is not an integer is not seen, others are not checked */
    {"primitives", "indices"}, /* not all versions take an accessor without a bufferView, which is right for
                                  compressed and sparse ones */
    {"nodes", "extensions"},   /* 2.9 refuses those that it knows and that lack a member */
    {"scenes", "extensions"},  /* likewise */
};

void ffd_gltf_show_integer(const json_tree *tree, uint32_t value, double number, json_edits *edits)
{
    const json_value *const v = &tree->values[value];
    for (uint32_t i = v->begin; i < v->end; i++)
        if (tree->text[i] < '0' || tree->text[i] > '9') {
            ffd_edits_format(edits, v->begin, v->end, "%.0f", fabs(number)); /* -0 too */
            return;
        }
}

/* Hides a member of each element of an array, which may be JSON_NONE: it loses its name. */
static void hide_member(const json_tree *tree, uint32_t array, const char *key, json_edits *edits)
{
    for (uint32_t v = ffd_json_tree_first(tree, array); v != JSON_NONE; v = ffd_json_tree_after(tree, v)) {
        const uint32_t member = ffd_json_tree_member(tree, v, key);
        if (member != JSON_NONE)
            ffd_edits_format(edits, tree->values[member].key_begin, tree->values[member].key_end, "\"\"");
    }
}

static void hide_members(const gltf_document *d, json_edits *edits)
{
    for (size_t i = 0; i < sizeof hidden / sizeof *hidden; i++)
        if (strcmp(hidden[i].list, "primitives") != 0)
            hide_member(&d->tree, ffd_json_tree_member(&d->tree, 0, hidden[i].list), hidden[i].member, edits);
        else
            for (size_t m = 0; m < d->mesh_values.count; m++)
                hide_member(&d->tree,
                            ffd_json_tree_member(&d->tree, d->mesh_values.values[m], hidden[i].list),
                            hidden[i].member, edits);
}

/* Hides numbers beyond the range of double, which it refuses. Those that we read have been refused: what is
   left is of extras, extensions and unknown members. */
static void hide_infinite(const json_tree *tree, json_edits *edits)
{
    for (uint32_t v = 0; v < tree->count; v++) {
        double number;
        if (ffd_json_tree_number(tree, v, &number) && !isfinite(number))
            ffd_edits_format(edits, tree->values[v].begin, tree->values[v].end, "0");
    }
}

/* Replaces U+0000 in keys by its symbol, U+2400: tinygltf takes a key for one that ends there. */
static void hide_nuls(const json_tree *tree, json_edits *edits)
{
    static const char nul[] = "\\u0000";
    const uint32_t size = sizeof nul - 1;
    for (size_t v = 0; v < tree->count; v++) {
        const uint32_t end = tree->values[v].key_end;
        for (uint32_t at = tree->values[v].key_begin; at + size < end;) {
            const char *const escape = memchr(tree->text + at, '\\', end - at);
            if (!escape)
                break;
            at = (uint32_t)(escape - tree->text);
            if (at + size < end && memcmp(escape, nul, size) == 0)
                ffd_edits_format(edits, at, at + size, "\\u2400");
            at += 2; /* past a backslash that is escaped */
        }
    }
}

bool ffd_gltf_write_shown(const gltf_document *d, json_edits *edits, byte_buffer *text)
{
    hide_members(d, edits);
    hide_infinite(&d->tree, edits);
    hide_nuls(&d->tree, edits);
    ffd_edits_sort(edits);
    /* In place of buffers stubs: tinygltf opens no file and decodes no data. */
    ffd_buffer_text(text, "{\"buffers\":[");
    for (size_t i = 0; i < d->buffer_values.count; i++)
        ffd_buffer_format(text, "%s{\"byteLength\":1,\"uri\":\"data:application/octet-stream;base64,AA==\"}",
                          i ? "," : "");
    ffd_buffer_text(text, "]");
    for (size_t i = 0; i < sizeof shown / sizeof *shown; i++) {
        const uint32_t member = ffd_json_tree_member(&d->tree, 0, shown[i]);
        if (member == JSON_NONE)
            continue;
        ffd_buffer_format(text, ",\"%s\":", shown[i]);
        ffd_edits_apply(edits, d->tree.text, d->tree.values[member].begin, d->tree.values[member].end, text);
    }
    ffd_buffer_text(text, "}");
    return !ffd_edits_failed(edits) && !text->failed;
}
