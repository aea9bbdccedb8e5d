/* meshopt_decode.c - a view by the decoder that reads it, then its filter. */
#include "base/text/words.h"
#include "mesh/meshopt/meshopt_filters.h"
#include "mesh/meshopt/meshopt_library.h"
#include "mesh/meshopt/meshopt_stream.h"
#include <stdbool.h>

ffd_status ffd_meshopt_ready(const meshopt_view *view, ffd_error *error)
{
    /* Version 0 of indices is older than the extensions, which do not describe it. */
    const bool is_ours = view->mode == MESHOPT_ATTRIBUTES || ffd_meshopt_version(view) > 0;
    return is_ours ? FFD_OK : ffd_meshopt_library_ready(error);
}

static ffd_status read_stream(const meshopt_view *view, meshopt_stream *from, unsigned char *bytes,
                              ffd_error *error)
{
    switch (view->mode) {
    case MESHOPT_ATTRIBUTES:
        return ffd_meshopt_read_attributes(view, from, bytes, error);
    case MESHOPT_TRIANGLES:
        return ffd_meshopt_read_triangles(view, from, bytes, error);
    default:
        return ffd_meshopt_read_indices(view, from, bytes, error);
    }
}

ffd_status ffd_meshopt_read(const meshopt_view *view, unsigned char *bytes, ffd_error *error)
{
    meshopt_stream from = {view->bytes + 1, view->bytes + view->size - ffd_meshopt_tail(view)};
    TRY(read_stream(view, &from, bytes, error));
    if (from.at < from.end)
        return ffd_fail(error, FFD_E_INVALID, "the compressed data of mode %s has %zu %s too many",
                        ffd_meshopt_mode_name(view->mode), (size_t)(from.end - from.at),
                        ffd_plural((uint64_t)(from.end - from.at), "byte", "bytes"));
    return FFD_OK;
}

static void apply_filter(const meshopt_view *view, unsigned char *bytes)
{
    const size_t count = (size_t)view->count, stride = (size_t)view->stride;
    switch (view->filter) {
    case MESHOPT_OCTAHEDRAL:
        ffd_meshopt_unfold(bytes, count, stride);
        break;
    case MESHOPT_QUATERNION:
        ffd_meshopt_complete_rotations(bytes, count);
        break;
    case MESHOPT_EXPONENTIAL:
        if (view->exponents)
            ffd_meshopt_find_exponents(bytes, count, stride, view->exponents);
        ffd_meshopt_scale(bytes, count, stride);
        break;
    case MESHOPT_COLOR:
        ffd_meshopt_mix_colors(bytes, count, stride);
        break;
    default:
        break;
    }
}

ffd_status ffd_meshopt_decode(const meshopt_view *view, unsigned char *bytes, ffd_error *error)
{
    /* The library is quicker, and all its versions know version 0. */
    const bool is_older = ffd_meshopt_version(view) == 0 && ffd_meshopt_library_ready(NULL) == FFD_OK;
    TRY(is_older ? ffd_meshopt_library_decode(view, bytes, error) : ffd_meshopt_read(view, bytes, error));
    apply_filter(view, bytes);
    return FFD_OK;
}
