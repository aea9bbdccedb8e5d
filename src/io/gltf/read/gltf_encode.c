#include "io/gltf/read/gltf_encode.h"
#include "base/little_endian.h"
#include "io/gltf/read/gltf_read.h"
#include <math.h>
#include <string.h>

typedef struct number_range {
    double least, largest; /* the integers' range */
} number_range;

static number_range range_of(int component)
{
    switch (component) {
    case GLTF_I8:
        return (number_range){-128, 127};
    case GLTF_U8:
        return (number_range){0, 255};
    case GLTF_I16:
        return (number_range){-32768, 32767};
    default:
        return (number_range){0, 65535};
    }
}

static double scale_of(const gltf_accessor *accessor)
{
    return accessor->normalized ? range_of(accessor->component).largest : 1;
}

double ffd_gltf_step(const gltf_accessor *accessor)
{
    return 1 / scale_of(accessor);
}

float ffd_gltf_round(const gltf_accessor *accessor, double value)
{
    if (accessor->component == GLTF_FLOAT)
        return (float)value;
    const double scale = scale_of(accessor);
    return (float)(rint(value * scale) / scale + 0.0); /* + 0.0: integers have no -0 */
}

/* Returns the integer q that a float encodes. The float nearest to q/s gives q again: its error is 2^-24
   relative, and q is at most 65535. */
static double integer_of(const gltf_accessor *accessor, float value)
{
    return rint((double)value * scale_of(accessor));
}

bool ffd_gltf_fits(const gltf_accessor *accessor, const float *values, size_t count)
{
    if (accessor->component == GLTF_FLOAT)
        return true;
    const number_range range = range_of(accessor->component);
    const double scale = scale_of(accessor);
    for (size_t i = 0; i < count; i++) {
        const double integer = integer_of(accessor, values[i]);
        const float back = (float)(integer / scale);
        if (!(integer >= range.least && integer <= range.largest) || back < values[i] || back > values[i])
            return false;
    }
    return true;
}

static void put_integer(double integer, size_t size, unsigned char *bytes)
{
    const uint32_t bits = (uint32_t)(int32_t)integer;
    for (size_t i = 0; i < size; i++)
        bytes[i] = (unsigned char)(bits >> 8 * i);
}

void ffd_gltf_encode(const gltf_accessor *accessor, int component, const unsigned char *original,
                     const float *values, size_t components, unsigned char *element)
{
    const size_t count = (size_t)accessor->rows, size = ffd_gltf_component_size(accessor->component);
    if (component == accessor->component)
        memcpy(element, original, count * size);
    for (size_t c = 0; c < count; c++) {
        const unsigned char *at = original + c * size;
        const double old = ffd_gltf_read_number(at, accessor->component, accessor->normalized);
        const float wanted = c < components ? values[c] : (float)old;
        if (component == GLTF_FLOAT)
            store_float(element + 4 * c, wanted);
        else if (wanted < (float)old || wanted > (float)old)
            put_integer(integer_of(accessor, wanted), size, element + c * size);
    }
}
