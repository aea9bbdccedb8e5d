#include "mesh/material.h"
#include "base/memory/memory.h"
#include <string.h>

mesh_texture ffd_texture_none(void)
{
    return (mesh_texture){.image = MATERIAL_NONE, .scale = {1, 1}};
}

ffd_status ffd_materials_add(mesh_materials *materials, char *name, memory_budget *budget, ffd_error *error)
{
    ffd_status status;
    TRY_END(name ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_budget_take(budget, 1, sizeof *materials->list + strlen(name) + 1, error));
    if (!ffd_grow((void **)&materials->list, &materials->capacity, materials->count + 1,
                  sizeof *materials->list))
        TRY_END(ffd_fail_memory(error));
    materials->list[materials->count++] = (mesh_material){.name = name,
                                                          .color = {1, 1, 1, 1},
                                                          .base = ffd_texture_none(),
                                                          .glow = ffd_texture_none(),
                                                          .opacity = ffd_texture_none()};
end:
    if (status)
        ffd_free(name);
    return status;
}

void ffd_materials_free(mesh_materials *materials)
{
    for (size_t i = 0; i < materials->count; i++)
        ffd_free(materials->list[i].name);
    for (size_t i = 0; i < materials->image_count; i++) {
        ffd_free(materials->images[i].name);
        ffd_free(materials->images[i].bytes);
    }
    ffd_free(materials->list);
    ffd_free(materials->images);
    *materials = (mesh_materials){0};
}
