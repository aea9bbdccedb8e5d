#include "io/gltf/read/gltf_model.h"
#include "base/memory/memory.h"

static void free_mesh(gltf_mesh *mesh)
{
    for (size_t i = 0; mesh->primitives && i < mesh->primitive_count; i++) {
        ffd_free(mesh->primitives[i].attributes);
        ffd_free(mesh->primitives[i].targets);
        ffd_free(mesh->primitives[i].target_accessors);
        ffd_free(mesh->primitives[i].splat_accessors);
        ffd_free(mesh->primitives[i].influences);
        ffd_free(mesh->primitives[i].drawn);
    }
    ffd_free(mesh->primitives);
}

void ffd_gltf_free_model(gltf_model *model)
{
    for (size_t i = 0; model->meshes && i < model->mesh_count; i++)
        free_mesh(&model->meshes[i]);
    for (size_t i = 0; model->nodes && i < model->node_count; i++)
        ffd_free(model->nodes[i].children);
    for (size_t i = 0; model->scenes && i < model->scene_count; i++)
        ffd_free(model->scenes[i].nodes);
    ffd_free(model->views);
    ffd_free(model->accessors);
    ffd_free(model->meshes);
    ffd_free(model->nodes);
    ffd_free(model->scenes);
    *model = (gltf_model){0};
}
