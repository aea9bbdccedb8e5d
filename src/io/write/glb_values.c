#include "io/write/glb_values.h"
#include "base/vector/vec.h"
#include <float.h>
#include <math.h>

static float finite_float(double value)
{
    return fabs(value) <= (double)FLT_MAX ? (float)value + 0.0f : 0.0f; /* + 0.0f: no -0 */
}

void ffd_glb_texcoord(const mesh_model *model, uint32_t index, float values[2])
{
    values[0] = finite_float(model->texcoords[2 * (size_t)index]);
    values[1] = finite_float(1 - model->texcoords[2 * (size_t)index + 1]); /* in glTF v points downwards */
}

static bool direction(const double *normal, float values[3])
{
    const double length = vec_length(normal);
    if (!(length > 0) || !isfinite(length))
        return false;
    for (int a = 0; a < 3; a++)
        values[a] = finite_float(normal[a] / length);
    return true;
}

bool ffd_glb_normal(const mesh_model *model, uint32_t index, float values[3])
{
    return direction(model->normals + 3 * (size_t)index, values);
}

void ffd_glb_position(const mesh_model *model, const double origin[3], uint32_t index, float values[3])
{
    for (size_t a = 0; a < 3; a++)
        values[a] = (float)(model->positions[3 * (size_t)index + a] - origin[a]);
}

void ffd_glb_position_offset(const mesh_model *model, size_t morph, uint32_t index, float values[3])
{
    for (size_t a = 0; a < 3; a++) {
        const size_t i = 3 * (size_t)index + a;
        values[a] = finite_float(model->morphs[morph].positions[i] - model->positions[i]);
    }
}

void ffd_glb_normal_offset(const mesh_model *model, size_t morph, uint32_t index, float values[3])
{
    float base[3] = {0, 0, 0}, moved[3] = {0, 0, 0};
    const bool both = ffd_glb_normal(model, index, base) &&
                      direction(model->morphs[morph].normals + 3 * (size_t)index, moved);
    for (size_t a = 0; a < 3; a++)
        values[a] = both ? moved[a] - base[a] : 0;
}
