#include "mesh/material.h"
#include "base/memory/memory.h"

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
