#include "io/write/vertex_values.h"
#include "base/memory/memory.h"

ffd_status ffd_vertex_values_find(const mesh_model *model, vertex_values *values, ffd_error *error)
{
    const uint32_t has = model->features;
    *values = (vertex_values){NULL, NULL};
    if (has & MODEL_HAS_NORMALS && !(has & MODEL_HAS_CORNER_NORMALS)) {
        values->normals = ffd_alloc(model->position_count, sizeof *values->normals);
        if (!values->normals)
            return ffd_fail_memory(error);
        ffd_model_normals_by_position(model, values->normals);
    }
    if (has & MODEL_HAS_TEXCOORDS && !(has & MODEL_HAS_CORNER_TEXCOORDS)) {
        values->texcoords = ffd_alloc(model->position_count, sizeof *values->texcoords);
        if (!values->texcoords)
            return ffd_fail_memory(error);
        ffd_model_texcoords_by_position(model, values->texcoords);
    }
    return FFD_OK;
}

void ffd_vertex_values_free(vertex_values *values)
{
    ffd_free(values->normals);
    ffd_free(values->texcoords);
    *values = (vertex_values){NULL, NULL};
}
