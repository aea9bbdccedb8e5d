#include "io/gltf/model/gltf_visibility.h"
#include "base/memory/memory.h"

static bool is_invisible(const gltf_document *d, size_t node)
{
    const uint32_t value = ffd_gltf_extension(d, d->node_values.values[node], "KHR_node_visibility");
    const uint32_t visible =
        value == JSON_NONE ? JSON_NONE : ffd_json_span_member(&d->tree, value, "visible");
    return visible != JSON_NONE && d->tree.values[visible].kind == JSON_FALSE;
}

ffd_status ffd_gltf_find_hidden(gltf_document *d, const size_t *parents, const size_t *order,
                                ffd_error *error)
{
    for (size_t i = 0; i < d->model.node_count; i++) {
        const size_t n = order[i], parent = parents[n];
        if (!ffd_gltf_is_hidden(d, parent) && !is_invisible(d, n))
            continue;
        if (!d->hidden)
            d->hidden = ffd_alloc_zero(d->model.node_count, sizeof *d->hidden);
        if (!d->hidden)
            return ffd_fail_memory(error);
        d->hidden[n] = true;
    }
    return FFD_OK;
}
