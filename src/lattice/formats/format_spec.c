#include "lattice/formats/format_spec.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include <inttypes.h>

int ffd_format_degree(size_t size)
{
    return size > 3 ? 3 : (int)size - 1;
}

/* Of a control point of a lattice at least: at rest, deformed, their difference and what is moved, and what
   is read (ffd_spec_point_bytes). */
#define POINT_BYTES (12 * sizeof(double) + 1)
#define MEGABYTE 1000000

ffd_status ffd_format_check_memory(const size_t size[3], const char *name, const format_wish *wish,
                                   ffd_error *error)
{
    const uint64_t bytes = (uint64_t)size[0] * size[1] * size[2] * POINT_BYTES;
    if (!wish->allowed || bytes <= wish->memory)
        return FFD_OK;
    return ffd_fail_file(
        error, FFD_E_LIMIT, name,
        "a lattice of %zu by %zu by %zu control points needs %" PRIu64 " MB of memory, but %" PRIu64
        " MB are left of the %" PRIu64 " MB allowed ({input.memory} raises this)",
        size[0], size[1], size[2], bytes / MEGABYTE + 1, wish->memory / MEGABYTE, wish->allowed / MEGABYTE);
}

ffd_status ffd_format_check_size(const size_t size[3], const char *name, const format_wish *wish,
                                 ffd_error *error)
{
    size_t count = 1;
    for (int a = 0; a < 3; a++) {
        if (size[a] < 2)
            return ffd_fail_file(
                error, FFD_E_INVALID, name,
                "has %zu control point%s along %c, which has no extent: write %s, with degree 1", size[a],
                size[a] ? "" : "s", "uvw"[a], size[a] ? "it twice, at both ends" : "two at least");
        if (size[a] > FFD_MAX_CONTROL_POINTS / count)
            return ffd_fail_file(error, FFD_E_LIMIT, name, "has more than %zu control points",
                                 FFD_MAX_CONTROL_POINTS);
        count *= size[a];
    }
    return ffd_format_check_memory(size, name, wish, error);
}

ffd_status ffd_format_begin(const size_t size[3], const char *name, const format_wish *wish,
                            lattice_spec **spec, ffd_error *error)
{
    *spec = NULL;
    TRY(ffd_format_check_size(size, name, wish, error));
    for (int a = 0; a < 3; a++)
        if (wish->degree[a] > 0 && (size_t)wish->degree[a] >= size[a])
            return ffd_fail_file(error, FFD_E_INVALID, name,
                                 "{degree} %d along %c needs at least %d control points, not %zu",
                                 wish->degree[a], "uvw"[a], wish -> degree[a] + 1, size[a]);
    lattice_spec *const made = ffd_alloc_zero(1, sizeof *made);
    if (!made)
        return ffd_fail_memory(error);
    made->count = size[0] * size[1] * size[2];
    made->rest = SPEC_POINTS;
    made->name = ffd_text_copy(name);
    made->points = ffd_alloc_zero(made->count, 3 * sizeof *made->points);
    for (int a = 0; a < 3; a++) {
        made->size[a] = size[a];
        made->kind[a] = KNOTS_CLAMPED;
        made->degree[a] = wish->degree[a] ? wish->degree[a] : ffd_format_degree(size[a]);
    }
    if (!made->name || !made->points) {
        ffd_spec_free(made);
        return ffd_fail_memory(error);
    }
    *spec = made;
    return FFD_OK;
}

ffd_status ffd_format_begin_of(const size_t size[3], const char *name, const format_wish *wish,
                               double **points, lattice_spec **spec, ffd_error *error)
{
    TRY(ffd_format_begin(size, name, wish, spec, error));
    ffd_free((*spec)->points);
    (*spec)->points = *points;
    *points = NULL;
    return FFD_OK;
}
