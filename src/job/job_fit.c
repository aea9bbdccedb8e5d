#include "job/job_fit.h"
#include "base/memory/memory.h"
#include "job/chain/seals.h"
#include "job/deform_passes.h"
#include "job/pass/chain_fit.h"
#include "job/pass/cut_faces.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"

/* Opens the embedding, if that has not been done: to hold faces needs it early. */
static ffd_status reuse_embedding(deform_job *job, ffd_error *error)
{
    const chain_link *const link = &job->chain.links[0];
    if (!job->desc->embedding.path || job->embedding.uvw)
        return FFD_OK;
    return ffd_embedding_reuse(&job->desc->embedding, job->document, link->lattice, link->snap, job->threads,
                               &job->embedding, error);
}

/* Finds the faces that the mesh cuts. cuts: as of ffd_cut_faces_find. */
static ffd_status find_cut(deform_job *job, size_t link, cut_faces *cuts, ffd_error *error)
{
    mesh_pass pass = {.document = job->document,
                      .state = ffd_job_judged(job),
                      .chain = &job->chain,
                      .links = job->chain.blocks ? 0 : link,
                      .threads = job->threads,
                      .embedding = job->desc->embedding.path ? &job->embedding : NULL};
    TRY(reuse_embedding(job, error));
    if (pass.state == MESH_STORED)
        ffd_pass_take_locations(job, true, &pass);
    TRY(ffd_cut_faces_find(&pass, cuts, error));
    ffd_pass_keep_locations(job, &pass);
    return FFD_OK;
}

static void warn_if_still(const deform_job *job, size_t l)
{
    const chain_link *const link = &job->chain.links[l];
    if (link->sealed)
        ffd_seal_warn(link->lattice, link->sealed, job->chain.seal.layers - 1, link->lattice->spec->name,
                      &job->log);
}

static ffd_status seal_cut(deform_job *job, size_t link, ffd_error *error)
{
    lattice_chain *const chain = &job->chain;
    const size_t first = chain->blocks ? 0 : link, count = chain->blocks ? chain->count : 1;
    cut_faces *const cuts = ffd_alloc_zero(count, sizeof *cuts);
    ffd_status status;
    TRY_END(cuts ? find_cut(job, link, cuts, error) : ffd_fail_memory(error));
    for (size_t i = 0; i < count; i++) {
        TRY_END(ffd_seal_link(chain, first + i, cuts[i].faces, error));
        ffd_seal_tell(chain->links[first + i].lattice->spec->name, chain->seal.layers - 1, 1, cuts[i].faces,
                      cuts[i].vertices, &job->log);
        warn_if_still(job, first + i);
    }
    chain->seal.closes = chain->count == 1;
end:
    ffd_free(cuts);
    return status;
}

static ffd_status seal(void *context, size_t link, ffd_error *error)
{
    deform_job *const job = context;
    lattice_chain *const chain = &job->chain;
    const size_t end = chain->blocks ? chain->count : link + 1;
    if (chain->seal.layers == 0)
        return FFD_OK;
    if (chain->seal.faces == FFD_FACES_CUT)
        return seal_cut(job, link, error);
    for (size_t l = link; l < end; l++) {
        TRY(ffd_seal_link(chain, l, ffd_seal_named(&chain->seal, chain->links[l].lattice), error));
        warn_if_still(job, l);
    }
    return FFD_OK;
}

ffd_status ffd_job_fit(deform_job *job, ffd_error *error)
{
    const fit_seals seals = {seal, job};
    TRY(ffd_chain_fit(&job->chain, job->document, job->threads, &seals, error));
    return reuse_embedding(job, error);
}

void ffd_job_note_seam(const deform_job *job, ffd_job_result *result)
{
    const lattice_chain *const chain = &job->chain;
    ffd_seam_figures *const seam = &result->seam;
    if (chain->seal.layers == 0)
        return;
    seam->is_there = true;
    seam->continuity = job->desc->seam;
    seam->count = chain->count;
    for (size_t l = 0; l < chain->count; l++)
        seam->faces[l] = (uint8_t)chain->links[l].held;
}
