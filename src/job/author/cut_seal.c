#include "job/author/cut_seal.h"
#include "base/system/thread.h"
#include "job/chain/chain_load.h"
#include "job/input/selection.h"
#include "job/input/source.h"

static ffd_status add_mesh(const author_job *job, const ffd_source *source, const lattice_chain *chain,
                           cut_faces *cut, ffd_error *error)
{
    mesh_document *document = NULL;
    cut_faces own;
    ffd_status status;
    TRY_END(ffd_source_open(source, job->desc.threads, &document, error));
    TRY_END(ffd_mesh_check(document, error));
    TRY_END(
        ffd_selection_apply(job->desc.only, job->desc.only_count, ffd_source_name(source), document, error));
    const mesh_pass pass = {
        .document = document,
        .state = ffd_mesh_shows_shapes(document) ? MESH_SHOWN : MESH_STORED,
        .chain = chain,
        .threads = ffd_threads_for(job->desc.threads, ffd_mesh_vertex_count(document) / MESH_RANGE_STEP + 1)};
    TRY_END(ffd_cut_faces_find(&pass, &own, error));
    cut->faces |= own.faces;
    cut->vertices += own.vertices;
end:
    if (status)
        ffd_fail_name_file(error, ffd_source_name(source));
    ffd_source_close(&document);
    return status;
}

ffd_status ffd_author_find_cut(const author_job *job, ffd_lattice *lattice, cut_faces *cut, ffd_error *error)
{
    chain_link link = {.lattice = lattice};
    lattice_chain chain = {.links = &link, .count = 1};
    ffd_status status;
    *cut = (cut_faces){0};
    TRY_END(ffd_chain_prepare(&chain, 0, error));
    for (size_t i = 0; i < job->desc.mesh_count; i++)
        TRY_END(add_mesh(job, &job->meshes[i], &chain, cut, error));
end:
    ffd_locator_destroy(&link.locator);
    return status;
}
