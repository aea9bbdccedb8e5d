#include "lattice/table/table.h"
#include "base/file/path.h"
#include "base/memory/memory.h"

int ffd_lattice_table_degree(size_t size)
{
    return size > 3 ? 3 : (int)size - 1;
}

static ffd_status check_size(const size_t size[3], const char *name, ffd_error *error)
{
    size_t count = 1;
    for (int a = 0; a < 3; a++) {
        if (size[a] < 2)
            return ffd_fail_file(
                error, FFD_E_INVALID, name,
                "has %zu control point along %c, which has no extent: write it twice, at both "
                "ends, with degree 1",
                size[a], "uvw"[a]);
        if (size[a] > FFD_MAX_CONTROL_POINTS / count)
            return ffd_fail_file(error, FFD_E_LIMIT, name, "has more than %zu control points",
                                 FFD_MAX_CONTROL_POINTS);
        count *= size[a];
    }
    return FFD_OK;
}

ffd_status ffd_lattice_table_begin(const size_t size[3], const char *name, const table_wish *wish,
                                   lattice_spec **spec, ffd_error *error)
{
    *spec = NULL;
    TRY(check_size(size, name, error));
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
        made->degree[a] = wish->degree[a] ? wish->degree[a] : ffd_lattice_table_degree(size[a]);
    }
    if (!made->name || !made->points) {
        ffd_spec_free(made);
        return ffd_fail_memory(error);
    }
    *spec = made;
    return FFD_OK;
}
