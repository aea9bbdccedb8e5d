#include "mesh/meshopt/meshopt_view.h"
#include "base/text/words.h"
#include <stdbool.h>

/* The first byte of a stream: its kind in the high four bits, its version in the low four bits. */
#define KIND_MASK 0xf0u
#define VERSION_MASK 0x0fu

/* A stream of attributes has, for each 64 elements, at least one byte for each byte of an element; then one
   element, or ATTRIBUTES_TAIL bytes if that is more. */
#define ELEMENTS_PER_BYTE 64
#define ATTRIBUTES_TAIL 32
#define LARGEST_STRIDE 256
#define TRIANGLES_TAIL 16
#define INDICES_TAIL 4

typedef struct mode_facts {
    const char *name;
    unsigned char kind, newest; /* newest: the newest version that the library can read */
} mode_facts;

static const mode_facts facts[] = {{"ATTRIBUTES", 0xa0, 0}, {"TRIANGLES", 0xe0, 1}, {"INDICES", 0xd0, 1}};

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
        return view->mode == MESHOPT_ATTRIBUTES && (view->stride == 4 || view->stride == 8);
    case MESHOPT_QUATERNION:
        return view->mode == MESHOPT_ATTRIBUTES && view->stride == 8;
    default:
        return view->mode == MESHOPT_ATTRIBUTES; /* whose stride is a multiple of 4 */
    }
}

/* Returns the least size of a stream with the elements of the view. */
static uint64_t least_size(const meshopt_view *view)
{
    switch (view->mode) {
    case MESHOPT_ATTRIBUTES:
        return 1 + view->count / ELEMENTS_PER_BYTE * view->stride +
               (view->stride < ATTRIBUTES_TAIL ? ATTRIBUTES_TAIL : view->stride);
    case MESHOPT_TRIANGLES:
        return 1 + view->count / 3 + TRIANGLES_TAIL;
    default:
        return 1 + view->count + INDICES_TAIL;
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
    if ((view->bytes[0] & VERSION_MASK) > mode->newest)
        return ffd_fail(error, FFD_E_UNSUPPORTED,
                        "version %u of the meshopt codec for %s is not known, only up to %u",
                        view->bytes[0] & VERSION_MASK, mode->name, mode->newest);
    if (least_size(view) > view->size)
        return ffd_fail(error, FFD_E_INVALID, "%zu %s cannot hold %llu %s of mode %s", view->size,
                        ffd_plural(view->size, "byte", "bytes"), (unsigned long long)view->count,
                        ffd_plural(view->count, "element", "elements"), mode->name);
    return FFD_OK;
}

const char *ffd_meshopt_mode_name(meshopt_mode mode)
{
    return facts[mode].name;
}
