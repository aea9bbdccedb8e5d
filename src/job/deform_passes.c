#include "job/deform_passes.h"
#include "base/memory/memory.h"
#include "job/chain/chain_load.h"
#include "job/chain/job_cache.h"
#include "job/chain/pace.h"
#include "job/input/deform_desc.h"
#include "job/pass/pass.h"
#include "job/pass/recompute.h"
#include <string.h>

/* The gate of folds also checks det F at extended vertices. */
static bool wants_determinants(const deform_job *job)
{
    return ffd_figures_wanted(job) ||
           (job->desc->fail_on & FFD_GATE_FOLDS && job->desc->outside == FFD_OUTSIDE_EXTEND);
}

/* Hashes all that determines the locations of a mesh's vertices in a link: also each setting that changes
   them, since the next job may have another value. */
static hash128 located_in(const chain_link *link)
{
    const hash128 parts[] = {link->rest, ffd_hash_doubles(&link->snap, 1)};
    return ffd_hash(parts, sizeof parts);
}

/* Describes a pass that deforms everything, without output arrays. */
static mesh_pass describe(const deform_job *job, mesh_state state, chain_pace *pace)
{
    return (mesh_pass){.document = job->document,
                       .state = state,
                       .only_base = ffd_job_adds_target(job),
                       .is_converted = job->converts,
                       .chain = &job->chain,
                       .links = job->chain.count,
                       .weights = ffd_job_weights(job),
                       .rigid = ffd_job_rigid(job),
                       .threads = job->threads,
                       .pace = pace,
                       .write = true,
                       .attributes = job->desc->normals != FFD_NORMALS_KEEP,
                       .only_offsets = job->desc->normals == FFD_NORMALS_RECOMPUTE};
}

/* Lets the pass fill what the figures need. */
static void fill_figures(const deform_job *job, const figure_arrays *figures, mesh_pass *pass)
{
    pass->deformed = figures->deformed;
    pass->gradients = figures->gradients;
    pass->collapsed = figures->collapsed;
    pass->stretches = job->turned.stretches;
    pass->turned = job->turned.nodes;
    pass->statuses = job->details ? job->details->statuses : NULL;
    pass->determinants = wants_determinants(job);
    /* A mesh that is written must not turn inside out without a word. */
    pass->inversions = ffd_deform_desc_writes(job->desc);
    pass->kept = job->kept;
    pass->kept_stride = (size_t)ffd_mesh_vertex_count(job->document);
}

static ffd_status recompute(deform_job *job, mesh_state state, const figure_arrays *arrays,
                            recompute_counts *counts, ffd_error *error)
{
    if (!job->recomputes)
        return FFD_OK;
    return ffd_recompute_normals(job->document, state, &arrays->faces, arrays->deformed, arrays->gradients,
                                 counts, error);
}

/* Allocates the locations that the job keeps itself; leaves NULL where memory does not suffice. */
static void make_locations(deform_job *job)
{
    const uint64_t count = ffd_mesh_vertex_count(job->document);
    if (!ffd_budget_check(&job->document->budget, count, sizeof *job->locations, NULL))
        job->locations = ffd_alloc_whole((size_t)count, sizeof *job->locations);
}

void ffd_pass_take_locations(deform_job *job, bool for_later, mesh_pass *pass)
{
    ffd_job_cache *const cache = job->desc->cache;
    const chain_link *const link = &job->chain.links[0];
    pass->locations = NULL;
    pass->is_located = false;
    if (job->desc->embedding.path)
        return;
    if (job->chain.count == 1 && !job->forgets_locations && ffd_job_cache_holds_meshes(cache)) {
        const hash128 rest = located_in(link);
        pass->locations =
            ffd_job_cache_locations(cache, job->document, job->document_is_cached, &rest, &pass->is_located);
    } else if (job->chain.count == 1 && !job->forgets_locations) {
        if (for_later && !job->locations && ffd_link_searches(link))
            make_locations(job);
        pass->locations = job->locations;
        pass->is_located = job->locations && job->is_located;
    }
    if (!pass->is_located)
        ffd_job_cache_count_search(cache);
}

void ffd_pass_keep_locations(deform_job *job, const mesh_pass *pass)
{
    if (!pass->locations || pass->is_located)
        return;
    if (pass->locations == job->locations) {
        job->is_located = true;
        return;
    }
    ffd_job_cache_locations_filled(job->desc->cache);
    job->document_is_cached = true; /* a later pass of this job knows them, too */
}

/* Runs a pass over the shapes that the file stores, whose locations an embedding or an earlier pass may know.
   It also gives the positions to the caller. */
static ffd_status pass_over_stored(deform_job *job, mesh_pass *pass, pass_totals *totals, ffd_error *error)
{
    pass->embedding = job->desc->embedding.path ? &job->embedding : NULL;
    pass->deformed = pass->deformed ? pass->deformed : job->positions;
    ffd_pass_take_locations(job, false, pass);
    TRY(ffd_pass_over_mesh(pass, totals, error));
    ffd_pass_keep_locations(job, pass);
    if (job->positions && pass->deformed != job->positions)
        memcpy(job->positions, pass->deformed,
               (size_t)ffd_mesh_vertex_count(job->document) * 3 * sizeof *job->positions);
    return FFD_OK;
}

/* Deforms base and targets, or only counts them if nothing needs their results; then the shape with default
   weights, of which all figures are. */
static ffd_status pass_over_both(deform_job *job, const figure_arrays *figures, const figure_arrays *stored,
                                 chain_pace *pace, recompute_counts *counts, ffd_error *error)
{
    const bool writes_shown = ffd_job_written(job) == MESH_SHOWN;
    pass_totals of_stored;
    mesh_pass pass = describe(job, MESH_STORED, pace), shown = describe(job, MESH_SHOWN, pace);
    pass.deformed = stored->deformed;
    pass.gradients = stored->gradients;
    pass.write = !writes_shown;
    pass.attributes = pass.attributes && pass.write;
    pass.counts_shapes = true;
    TRY(pass_over_stored(job, &pass, &of_stored, error));
    if (!writes_shown && of_stored.moved)
        TRY(recompute(job, MESH_STORED, stored, counts, error));
    fill_figures(job, figures, &shown);
    shown.discards = !writes_shown;
    ffd_status status;
    TRY_END(ffd_pass_over_mesh(&shown, &job->totals, error));
    if (writes_shown && job->totals.moved)
        TRY_END(recompute(job, MESH_SHOWN, figures, counts, error));
end:
    ffd_totals_add_stored(&of_stored, pass.write, &job->totals);
    return status;
}

ffd_status ffd_deform_passes(deform_job *job, const figure_arrays *figures, const figure_arrays *stored,
                             ffd_error *error)
{
    recompute_counts counts = {0};
    chain_pace pace = {.points = (double)ffd_mesh_vertex_count(job->document),
                       .threads = job->threads,
                       .links = job->chain.links,
                       .lattices = job->desc->lattices,
                       .more = figures->has_faces ? ", and edges longer (see {timeout})" : " (see {timeout})",
                       .log = job->log};
    ffd_status status = FFD_OK;
    if (ffd_job_judged(job) == MESH_SHOWN) {
        TRY_END(pass_over_both(job, figures, stored, &pace, &counts, error));
    } else {
        mesh_pass pass = describe(job, MESH_STORED, &pace);
        fill_figures(job, figures, &pass);
        TRY_END(pass_over_stored(job, &pass, &job->totals, error));
        if (job->totals.moved)
            TRY_END(recompute(job, MESH_STORED, figures, &counts, error));
    }
end:
    job->totals.normals_collapsed += counts.collapsed;
    job->totals.normals_carried = counts.carried;
    return status;
}
