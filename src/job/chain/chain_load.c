#include "job/chain/chain_load.h"
#include "base/memory/memory.h"
#include "embed/frame/frame.h"
#include "embed/locator.h"
#include "job/chain/job_cache.h"
#include "job/input/embedding_file.h"
#include "lattice/lattice.h"

/* The lattice of a job before, if it is this one. */
static void borrow_lattice(const chain_files *files, lattice_chain *chain, size_t i)
{
    chain_link *const link = &chain->links[i];
    if (!chain->share || files->set_count > 0 || ffd_file_is_stream(files->paths[i]) ||
        !ffd_file_stamp(files->paths[i], &link->stamp))
        return;
    link->path = files->paths[i];
    ffd_cache_lend_lattice(chain->share, link);
}

static ffd_status load_link(const chain_files *files, bool *used, lattice_chain *chain, size_t i,
                            ffd_error *error)
{
    chain_link *link = &chain->links[i];
    ffd_status status = FFD_OK;
    if (!link->lattice)
        status =
            ffd_lattice_load_set(files->paths[i], files->set, files->set_count, used, &link->lattice, error);
    if (!status && !ffd_lattice_needs_bounds(link->lattice))
        status = ffd_chain_prepare(chain, i, error);
    if (status)
        ffd_fail_name_file(error, files->paths[i]);
    return status;
}

static ffd_status refuse_unused(const chain_files *files, const bool *used, ffd_error *error)
{
    for (size_t i = 0; i < files->set_count; i++)
        if (!used[i])
            return ffd_fail_file(error, FFD_E_INVALID, files->paths[0],
                                 "no lattice has the placeholder {\"$\": \"%.60s\"} (--set)",
                                 files->set[i].name);
    return FFD_OK;
}

ffd_status ffd_chain_load(const chain_files *files, const chain_outside *outside, ffd_isa isa,
                          ffd_share *share, lattice_chain *chain, ffd_error *error)
{
    *chain = (lattice_chain){.outside = *outside, .isa = isa, .share = share};
    if (files->count == 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "no lattice is given");
    bool *const used = ffd_alloc_zero(files->set_count, sizeof *used);
    chain->links = ffd_alloc_zero(files->count, sizeof *chain->links);
    ffd_status status = used && chain->links ? FFD_OK : ffd_fail_memory(error);
    chain->count = status ? 0 : files->count;
    for (size_t i = 0; i < chain->count; i++)
        borrow_lattice(files, chain, i);
    ffd_cache_evict_lattices(share);
    for (size_t i = 0; i < chain->count && !status; i++)
        status = load_link(files, used, chain, i, error);
    if (!status)
        status = refuse_unused(files, used, error);
    ffd_free(used);
    if (status)
        ffd_chain_free(chain);
    return status;
}

/* Of the rest volume and of how it is searched: one volume may be known as a box or by its points, with
   weights of 1 or with none, and u,v,w differs in the last bits. */
static hash128 hash_rest(const ffd_lattice *lattice)
{
    const bool is_box = lattice->form == REST_BOX_AFFINE;
    const double way[] = {is_box, lattice->rest_weights != NULL};
    const hash128 parts[] = {ffd_embedding_hash_lattice(lattice), ffd_hash_doubles(way, 2),
                             ffd_hash_doubles(lattice->origin, is_box ? 3 : 0),
                             ffd_hash_doubles(lattice->frame, is_box ? 9 : 0)};
    return ffd_hash(parts, sizeof parts);
}

ffd_status ffd_chain_prepare(lattice_chain *chain, size_t link, ffd_error *error)
{
    chain_link *made = &chain->links[link];
    ffd_status status = FFD_OK;
    if (chain->share) {
        if (!made->lattice_is_lent)
            made->rest = hash_rest(made->lattice);
        ffd_cache_lend_locator(chain->share, chain, made);
    }
    if (!made->locator)
        status = ffd_locator_create_for(made->lattice, chain->isa, &made->locator, error);
    if (status || !chain->outside.extend)
        return status;
    made->falloff = chain->outside.falloff;
    /* Of the lattice that the locator looks at, whose rest volume is the same: both are kept together. */
    return made->border ? FFD_OK : ffd_boundary_create(made->locator->lattice, &made->border, error);
}
