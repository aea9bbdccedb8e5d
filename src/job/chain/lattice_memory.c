#include "job/chain/lattice_memory.h"
#include "job/chain/chain.h"
#include "lattice/build.h"
#include "lattice/file/spec_parse.h"

#define MEGABYTE 1000000

static unsigned long long megabytes(uint64_t bytes)
{
    return (unsigned long long)(bytes / MEGABYTE + (bytes % MEGABYTE != 0));
}

static uint64_t bytes_of(const lattice_spec *spec)
{
    return ffd_spec_knot_bytes(spec) + ffd_spec_point_bytes(spec);
}

ffd_status ffd_lattice_memory_take(memory_budget *budget, const lattice_spec *spec, uint64_t file_size,
                                   ffd_error *error)
{
    const uint64_t bytes = bytes_of(spec);
    ffd_budget_add_file(budget, file_size, 0);
    if (ffd_budget_take(budget, bytes, 1, NULL) == FFD_OK)
        return FFD_OK;
    return ffd_fail(error, FFD_E_LIMIT,
                    "a lattice of %zu by %zu by %zu control points needs %llu MB of memory, but %llu MB "
                    "are left of the %llu MB allowed ({input.memory} raises this)",
                    spec->size[0], spec->size[1], spec->size[2], megabytes(bytes),
                    (unsigned long long)(ffd_budget_left(budget) / MEGABYTE),
                    (unsigned long long)(ffd_budget_most(budget) / MEGABYTE));
}

ffd_status ffd_lattice_memory_load(const ffd_lattice_source *source, const spec_settings *settings,
                                   memory_budget *budget, ffd_lattice **lattice, ffd_error *error)
{
    lattice_spec *spec = NULL;
    size_t size = 0;
    *lattice = NULL;
    ffd_status status;
    TRY_END(ffd_spec_load(source, settings, &spec, &size, error));
    TRY_END(ffd_lattice_memory_take(budget, spec, size, error));
    TRY_END(ffd_spec_build(spec, NULL, lattice, error));
end:
    if (status)
        ffd_spec_free(spec);
    return status;
}

ffd_status ffd_lattice_memory_share(const lattice_chain *chain, memory_budget *budget, ffd_error *error)
{
    const memory_budget none = ffd_budget_make(0);
    budget->most += chain->memory.most - none.most; /* the share that sizes of lattice files add */
    return ffd_budget_take(budget, chain->memory.taken - none.taken, 1, error);
}
