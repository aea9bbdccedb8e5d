#include "io/gltf/read/gltf_model.h"
#include "base/memory/memory.h"

static void free_primitive(gltf_primitive *primitive)
{
    ffd_free(primitive->attributes);
    ffd_free(primitive->targets);
    ffd_free(primitive->target_accessors);
    ffd_free(primitive->splat_accessors);
    ffd_free(primitive->influences);
    ffd_free(primitive->drawn);
}

void ffd_gltf_free_model(gltf_model *model)
{
    for (size_t i = 0; model->primitives && i < model->primitive_count; i++)
        free_primitive(&model->primitives[i]);
    for (size_t i = 0; model->nodes && i < model->node_count; i++)
        ffd_free(model->nodes[i].children);
    for (size_t i = 0; model->scenes && i < model->scene_count; i++)
        ffd_free(model->scenes[i].nodes);
    ffd_free(model->views);
    ffd_free(model->accessors);
    ffd_free(model->meshes);
    ffd_free(model->primitives);
    ffd_free(model->nodes);
    ffd_free(model->scenes);
    *model = (gltf_model){0};
}
