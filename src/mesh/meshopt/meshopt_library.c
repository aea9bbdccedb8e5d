#include "mesh/meshopt/meshopt_library.h"
#include <meshoptimizer.h>

ffd_status ffd_meshopt_library_ready(ffd_error *error)
{
    (void)error;
    return FFD_OK;
}

static int decode(const meshopt_view *view, unsigned char *bytes)
{
    const size_t count = (size_t)view->count, stride = (size_t)view->stride;
    switch (view->mode) {
    case MESHOPT_ATTRIBUTES:
        return meshopt_decodeVertexBuffer(bytes, count, stride, view->bytes, view->size);
    case MESHOPT_TRIANGLES:
        return meshopt_decodeIndexBuffer(bytes, count, stride, view->bytes, view->size);
    default:
        return meshopt_decodeIndexSequence(bytes, count, stride, view->bytes, view->size);
    }
}

ffd_status ffd_meshopt_library_decode(const meshopt_view *view, unsigned char *bytes, ffd_error *error)
{
    const int result = decode(view, bytes);
    return result ? ffd_fail(error, FFD_E_INVALID, "the compressed data of mode %s is broken (%d)",
                             ffd_meshopt_mode_name(view->mode), result)
                  : FFD_OK;
}
