#include "io/gltf/read/draco_floats.h"
#include <math.h>
#include <stdbool.h>

void ffd_draco_dequantize(const draco_quantization *quantization, const int32_t *integers, size_t count,
                          float *floats)
{
    const size_t components = (size_t)quantization->components;
    const float step = quantization->range / (float)(((int32_t)1 << quantization->bits) - 1);
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < components; c++) {
            const float offset = (float)integers[components * i + c] * step;
            floats[components * i + c] = offset + quantization->least[c];
        }
}

static void unfold(float y, float z, float normal[3])
{
    const float x = 1.0f - fabsf(y) - fabsf(z);
    /* The half with x < 0 is folded outward: its points are mirrored at the edges of the other half. */
    const float outside = -x < 0 ? 0 : -x;
    y += y < 0 ? outside : -outside;
    z += z < 0 ? outside : -outside;
    const float square = x * x + y * y + z * z;
    const bool is_null = (double)square < 1e-6;
    const float scale = 1.0f / sqrtf(square);
    normal[0] = is_null ? 0 : x * scale;
    normal[1] = is_null ? 0 : y * scale;
    normal[2] = is_null ? 0 : z * scale;
}

void ffd_draco_unfold_normals(int bits, const int32_t *places, size_t count, float *normals)
{
    const float step = 2.0f / (float)(((int32_t)1 << bits) - 2);
    for (size_t i = 0; i < count; i++)
        unfold((float)places[2 * i] * step - 1.0f, (float)places[2 * i + 1] * step - 1.0f, normals + 3 * i);
}
