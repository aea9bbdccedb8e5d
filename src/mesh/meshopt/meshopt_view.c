#include "mesh/meshopt/meshopt_view.h"
#include "base/text/words.h"
#include <stdbool.h>

/* The first byte of a stream: its kind in the high four bits, its version in the low four bits. */
#define KIND_MASK 0xf0u
#define VERSION_MASK 0x0fu

/* A stream of attributes has, for each 64 elements, at least one byte for each byte of an element; in version
   1 for each block one byte for four of an element. Then comes one element, in version 1 with a byte for each
   four of it, or ATTRIBUTES_TAIL bytes if that is more. */
#define ELEMENTS_PER_BYTE 64
#define ATTRIBUTES_TAIL_0 32
#define ATTRIBUTES_TAIL_1 24
#define LARGEST_STRIDE 256
#define BLOCK_BYTES 8192
#define TRIANGLES_TAIL 16
#define INDICES_TAIL 4

typedef struct mode_facts {
    const char *name;
    unsigned char kind, newest; /* newest: the newest version that is known */
} mode_facts;

static const mode_facts facts[] = {{"ATTRIBUTES", 0xa0, 1}, {"TRIANGLES", 0xe0, 1}, {"INDICES", 0xd0, 1}};

static bool is_stride(const meshopt_view *view)
{
    if (view->mode == MESHOPT_ATTRIBUTES)
        return view->stride > 0 && view->stride <= LARGEST_STRIDE && view->stride % 4 == 0;
    return view->stride == 2 || view->stride == 4;
}

static bool is_filter(const meshopt_view *view)
{
    switch (view->filter) {
    case MESHOPT_NONE:
        return true;
    case MESHOPT_OCTAHEDRAL:
    case MESHOPT_COLOR:
        return view->mode == MESHOPT_ATTRIBUTES && (view->stride == 4 || view->stride == 8);
    case MESHOPT_QUATERNION:
        return view->mode == MESHOPT_ATTRIBUTES && view->stride == 8;
    default:
        return view->mode == MESHOPT_ATTRIBUTES; /* whose stride is a multiple of 4 */
    }
}

unsigned ffd_meshopt_version(const meshopt_view *view)
{
    return view->bytes[0] & VERSION_MASK;
}

size_t ffd_meshopt_block(size_t stride)
{
    const size_t most = BLOCK_BYTES / stride / MESHOPT_GROUP * MESHOPT_GROUP;
    return most < MESHOPT_BLOCK ? most : MESHOPT_BLOCK;
}

uint64_t ffd_meshopt_tail(const meshopt_view *view)
{
    const bool is_newer = ffd_meshopt_version(view) > 0;
    const uint64_t element = is_newer ? view->stride + view->stride / 4 : view->stride;
    const uint64_t least = is_newer ? ATTRIBUTES_TAIL_1 : ATTRIBUTES_TAIL_0;
    switch (view->mode) {
    case MESHOPT_ATTRIBUTES:
        return element < least ? least : element;
    case MESHOPT_TRIANGLES:
        return TRIANGLES_TAIL;
    default:
        return INDICES_TAIL;
    }
}

/* Returns the least size of the elements of a view. */
static uint64_t least_content(const meshopt_view *view)
{
    switch (view->mode) {
    case MESHOPT_ATTRIBUTES:
        return ffd_meshopt_version(view) == 0
                   ? view->count / ELEMENTS_PER_BYTE * view->stride
                   : view->count / ffd_meshopt_block((size_t)view->stride) * (view->stride / 4);
    case MESHOPT_TRIANGLES:
        return view->count / 3;
    default:
        return view->count;
    }
}

ffd_status ffd_meshopt_check(const meshopt_view *view, ffd_error *error)
{
    const mode_facts *mode = &facts[view->mode];
    if (!is_stride(view))
        return ffd_fail(error, FFD_E_INVALID, "byteStride %llu is not allowed with mode %s",
                        (unsigned long long)view->stride, mode->name);
    if (!is_filter(view))
        return ffd_fail(error, FFD_E_INVALID, "the filter is not allowed with mode %s and byteStride %llu",
                        mode->name, (unsigned long long)view->stride);
    if (view->mode == MESHOPT_TRIANGLES && view->count % 3)
        return ffd_fail(error, FFD_E_INVALID, "count %llu is not a multiple of 3",
                        (unsigned long long)view->count);
    if (view->size == 0 || (view->bytes[0] & KIND_MASK) != mode->kind)
        return ffd_fail(error, FFD_E_INVALID, "the compressed data is not of mode %s", mode->name);
    if (ffd_meshopt_version(view) > mode->newest)
        return ffd_fail(error, FFD_E_UNSUPPORTED,
                        "version %u of the meshopt codec for %s is not known, only up to %u",
                        ffd_meshopt_version(view), mode->name, mode->newest);
    if (1 + least_content(view) + ffd_meshopt_tail(view) > view->size)
        return ffd_fail(error, FFD_E_INVALID, "%zu %s cannot hold %llu %s of mode %s", view->size,
                        ffd_plural(view->size, "byte", "bytes"), (unsigned long long)view->count,
                        ffd_plural(view->count, "element", "elements"), mode->name);
    return FFD_OK;
}

const char *ffd_meshopt_mode_name(meshopt_mode mode)
{
    return facts[mode].name;
}
