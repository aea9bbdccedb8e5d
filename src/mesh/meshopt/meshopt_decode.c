/* meshopt_decode.c - decodes with the meshoptimizer library. */
#include "base/little_endian.h"
#include "mesh/meshopt/meshopt_filters.h"
#include "mesh/meshopt/meshopt_view.h"
#include <meshoptimizer.h>

ffd_status ffd_meshopt_ready(ffd_error *error)
{
    (void)error;
    return FFD_OK;
}

static int decode(const meshopt_view *view, size_t count, size_t stride, unsigned char *bytes)
{
    switch (view->mode) {
    case MESHOPT_ATTRIBUTES:
        return meshopt_decodeVertexBuffer(bytes, count, stride, view->bytes, view->size);
    case MESHOPT_TRIANGLES:
        return meshopt_decodeIndexBuffer(bytes, count, stride, view->bytes, view->size);
    default:
        return meshopt_decodeIndexSequence(bytes, count, stride, view->bytes, view->size);
    }
}

/* Finds the exponents before the filter is applied: a number has its exponent in the highest byte, and its
   mantissa in the others (KHR_meshopt_compression, "Filter 3: exponential"). */
static void find_exponents(const meshopt_view *view, size_t count, size_t stride, const unsigned char *bytes)
{
    const size_t columns = stride / 4;
    for (size_t c = 0; c < columns; c++)
        view->exponents[c] = INT8_MAX;
    for (size_t i = 0; i < count * columns; i++) {
        const uint32_t bits = load_u32(bytes + 4 * i);
        const int8_t exponent = (int8_t)(unsigned char)(bits >> 24);
        int8_t *const least = &view->exponents[i % columns];
        if (bits << 8 && exponent < *least)
            *least = exponent;
    }
    for (size_t c = 0; c < columns; c++)
        if (view->exponents[c] == INT8_MAX)
            view->exponents[c] = INT8_MIN;
}

static void apply_filter(const meshopt_view *view, size_t count, size_t stride, unsigned char *bytes)
{
    switch (view->filter) {
    case MESHOPT_OCTAHEDRAL:
        ffd_meshopt_unfold(bytes, count, stride);
        break;
    case MESHOPT_QUATERNION:
        ffd_meshopt_complete_rotations(bytes, count);
        break;
    case MESHOPT_EXPONENTIAL:
        if (view->exponents)
            find_exponents(view, count, stride, bytes);
        meshopt_decodeFilterExp(bytes, count, stride);
        break;
    default:
        break;
    }
}

ffd_status ffd_meshopt_decode(const meshopt_view *view, unsigned char *bytes, ffd_error *error)
{
    const size_t count = (size_t)view->count, stride = (size_t)view->stride;
    const int result = decode(view, count, stride, bytes);
    if (result != 0)
        return ffd_fail(error, FFD_E_INVALID, "the compressed data of mode %s is broken (%d)",
                        ffd_meshopt_mode_name(view->mode), result);
    apply_filter(view, count, stride, bytes);
    return FFD_OK;
}
