#include "io/gltf/scene/gltf_detail.h"

uint32_t ffd_gltf_first_detail(const gltf_document *d, size_t node)
{
    return ffd_gltf_first(d, ffd_gltf_extension(d, d->node_values.values[node], "MSFT_lod"), "ids");
}

size_t ffd_gltf_count_stand_ins(const gltf_document *d)
{
    size_t count = 0;
    for (size_t n = 0; n < d->model.node_count; n++)
        count += d->stands_in[n] && d->model.nodes[n].mesh >= 0;
    return count;
}
