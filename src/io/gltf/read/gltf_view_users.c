#include "io/gltf/read/gltf_view_users.h"

/* Whether the key of a value makes it the index of a bufferView: in images, sparse and compressed data, and
   in property tables of EXT_structural_metadata. */
static bool names_view(const json_span *tree, uint32_t value)
{
    static const char *const keys[] = {"bufferView", "values", "arrayOffsets", "stringOffsets"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        if (ffd_json_span_key_is(tree, value, keys[i]))
            return true;
    return false;
}

/* Whether the value is a member of an accessor, or of its sparse indices or values. */
static bool is_of_accessor(const json_span *tree, uint32_t value, uint32_t accessors)
{
    const uint32_t above = tree->values[tree->values[value].parent].parent;
    if (above == accessors)
        return true;
    return above != JSON_NONE && ffd_json_span_key_is(tree, above, "sparse") &&
           tree->values[tree->values[above].parent].parent == accessors;
}

void ffd_gltf_mark_other_views(const gltf_document *d, bool *used)
{
    const json_span *const tree = &d->tree;
    const uint32_t accessors = ffd_json_span_member(tree, 0, "accessors");
    for (uint32_t v = 1; v < tree->count; v++) {
        double view;
        if (tree->values[v].kind != JSON_NUMBER || !names_view(tree, v) || is_of_accessor(tree, v, accessors))
            continue;
        if (ffd_json_span_number(tree, v, &view) && view >= 0 && view < (double)d->model.view_count)
            used[(size_t)view] = true;
    }
}
