#include "io/gltf/model/gltf_detail.h"
#include "io/gltf/model/gltf_references.h"

gltf_stand_ins ffd_gltf_stand_ins(const gltf_document *d, size_t node)
{
    const uint32_t levels = ffd_gltf_extension(d, d->node_values.values[node], "MSFT_lod");
    return (gltf_stand_ins){.document = d, .node = node, .detail = ffd_gltf_first(d, levels, "ids")};
}

size_t ffd_gltf_next_stand_in(gltf_stand_ins *walk)
{
    static const gltf_reference shapes[] = {GLTF_COLLIDER_NODE, GLTF_TRIGGER_NODE};
    const gltf_document *const d = walk->document;
    while (walk->detail != JSON_NONE) {
        const size_t found = ffd_gltf_node(d, walk->detail);
        walk->detail = ffd_json_span_after(&d->tree, walk->detail);
        if (found != GLTF_NONE)
            return found;
    }
    walk->collides = true;
    while (walk->shapes < 2) {
        const uint32_t value = ffd_gltf_reference(d, walk->node, shapes[walk->shapes++]);
        const size_t found = value == JSON_NONE ? GLTF_NONE : ffd_gltf_node(d, value);
        if (found != GLTF_NONE)
            return found;
    }
    return GLTF_NONE;
}

size_t ffd_gltf_count_stand_ins(const gltf_document *d, bool collide)
{
    size_t count = 0;
    for (size_t n = 0; n < d->model.node_count; n++)
        count += d->stands_in[n] && d->collides[n] == collide && d->model.nodes[n].mesh >= 0;
    return count;
}
