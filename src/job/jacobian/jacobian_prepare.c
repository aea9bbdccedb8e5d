/* jacobian_prepare.c - prepares the rows: embeddings, gradients of later lattices, derivatives of moves. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "embed/boundary/boundary.h"
#include "job/chain/chain_apply.h"
#include "job/chain/lattice_memory.h"
#include "job/jacobian/jacobian.h"
#include "job/job_fit.h"
#include "job/judge/warnings.h"
#include "job/pass/pass.h"
#include "job/pass/vertex_rounding.h"
#include "points/embedding.h"
#include <math.h>
#include <string.h>

static mesh_pass pass_of(const jacobian *j, size_t links)
{
    return (mesh_pass){
        .document = j->job.document, .chain = &j->job.chain, .links = links, .threads = j->job.threads};
}

ffd_status ffd_jacobian_positions(const jacobian *j, size_t link, double *before, ffd_error *error)
{
    pass_totals totals;
    mesh_pass pass = pass_of(j, link);
    pass.deformed = before;
    return ffd_pass_over_mesh(&pass, &totals, error);
}

/* Lists the vertices outside that are extended from the border. */
static ffd_status find_extended(jacobian *j, const chain_link *link, const double *before,
                                ffd_embedding *embedding, ffd_error *error)
{
    const double reach = link->falloff > 0 ? link->falloff : HUGE_VAL;
    size_t capacity = 0;
    embedding->falloff = link->falloff;
    for (size_t i = 0; i < j->count; i++) {
        boundary_point nearest;
        if (ffd_embedding_has(embedding, i) || embedding->status[i] == FFD_VERTEX_INVALID ||
            !vec_is_finite(before + 3 * i))
            continue;
        TRY(ffd_deadline_check(error));
        TRY(ffd_boundary_find(link->border, before + 3 * i, reach, &nearest, error));
        if (!nearest.found)
            continue;
        TRY(ffd_budget_take(&j->budget, 1, sizeof *embedding->extended, error));
        if (!ffd_grow((void **)&embedding->extended, &capacity, embedding->extended_count + 1,
                      sizeof *embedding->extended))
            return ffd_fail_memory(error);
        embedding->extended[embedding->extended_count++] = (extended_point){i, nearest};
    }
    return FFD_OK;
}

/* Marks the selected vertices: only these can be outside. */
static ffd_status mark_selected(const jacobian *j, uint8_t *selected, ffd_error *error)
{
    vertex_owners owners;
    const mesh_document *const document = j->job.document;
    ffd_status status;
    TRY_END(ffd_vertex_owners_list(document, &owners, error));
    memset(selected, 1, j->count);
    for (size_t o = 0; o < owners.count; o++) {
        const mesh_part *const part = &document->parts[owners.parts[o]];
        for (size_t i = 0; i < part->vertex_count; i++)
            selected[owners.first[o] + i] = ffd_part_selects(part, i);
    }
end:
    ffd_vertex_owners_free(&owners);
    return status;
}

static ffd_status extend(jacobian *j, size_t index, ffd_embedding *embedding, ffd_error *error)
{
    const chain_link *const link = &j->job.chain.links[index];
    double *const before = ffd_alloc(j->count, 3 * sizeof *before);
    uint8_t *const selected = ffd_alloc(j->count, 1);
    ffd_status status;
    TRY_END(before && selected ? ffd_jacobian_positions(j, index, before, error) : ffd_fail_memory(error));
    TRY_END(mark_selected(j, selected, error));
    for (size_t i = 0; i < j->count; i++)
        if (!selected[i])
            before[3 * i] = (double)NAN;
    TRY_END(find_extended(j, link, before, embedding, error));
end:
    ffd_free(before);
    ffd_free(selected);
    return status;
}

static ffd_status fill_embedding(jacobian *j, jacobian_link *link, pass_totals *totals, ffd_error *error)
{
    const chain_link *const of = &j->job.chain.links[link->index];
    TRY(ffd_embedding_make(of->lattice, j->count, &link->embedding, error));
    if (of->sealed)
        TRY(ffd_row_seal_make(of->lattice, of->sealed, j->job.chain.seal.layers - 1, of->held, &link->seal,
                              error));
    mesh_pass pass = pass_of(j, link->index + 1);
    pass.pace = &j->pace;
    pass.uvw = link->embedding->uvw;
    pass.statuses = link->embedding->status;
    pass.locations = j->job.locations;
    pass.is_located = j->job.is_located;
    TRY(ffd_pass_over_mesh(&pass, totals, error));
    return of->border ? extend(j, link->index, link->embedding, error) : FFD_OK;
}

/* Scratch memory for a run of points through the later links. */
typedef struct later_scratch {
    double x[3 * CHAIN_RUN], delta[3 * CHAIN_RUN];
    point_outcome outcomes[CHAIN_RUN];
    chain_scratch chain;
} later_scratch;

/* Sends positions through the later links and stores their gradients F. */
static ffd_status find_later_run(const lattice_chain *later, const double *after, size_t count,
                                 later_scratch *s, double *gradients, ffd_error *error)
{
    chain_run run = {.x = s->x,
                     .count = count,
                     .scratch = &s->chain,
                     .delta = s->delta,
                     .gradient = gradients,
                     .outcomes = s->outcomes};
    memcpy(s->x, after, 3 * count * sizeof *s->x);
    TRY(ffd_chain_apply(later, later->count, &run, error));
    for (size_t i = 0; i < count; i++)
        for (int d = 0; d < 9; d += 4)
            gradients[9 * i + (size_t)d] += 1;
    return FFD_OK;
}

/* Computes, at each vertex, F of all links after one. */
static ffd_status find_later(const jacobian *j, jacobian_link *link, ffd_error *error)
{
    lattice_chain later = j->job.chain;
    later.links += link->index + 1;
    later.count -= link->index + 1;
    later.seam_count = 0;
    later.cache = NULL;
    if (later.count == 0)
        return FFD_OK;
    double *const after = ffd_alloc(j->count, 3 * sizeof *after);
    later_scratch *const scratch = ffd_alloc_zero(1, sizeof *scratch);
    link->later = ffd_alloc(j->count, 9 * sizeof *link->later);
    ffd_status status;
    TRY_END(after && scratch && link->later ? ffd_jacobian_positions(j, link->index + 1, after, error)
                                            : ffd_fail_memory(error));
    for (size_t first = 0; first < j->count; first += CHAIN_RUN) {
        const size_t left = j->count - first, count = left < CHAIN_RUN ? left : CHAIN_RUN;
        TRY_END(find_later_run(&later, after + 3 * first, count, scratch, link->later + 9 * first, error));
    }
end:
    ffd_free(after);
    ffd_free(scratch);
    return status;
}

/* Computes M^-1 at each vertex, unless all are the identity. */
static ffd_status find_inverses(jacobian *j, ffd_error *error)
{
    const mesh_document *const document = j->job.document;
    vertex_owners owners;
    vertex_transforms *transforms = NULL;
    bool any = false;
    ffd_status status;
    TRY_END(ffd_vertex_owners_list(document, &owners, error));
    for (size_t o = 0; o < owners.count; o++)
        any = any || !document->parts[owners.parts[o]].identity;
    transforms = any ? ffd_alloc(1, sizeof *transforms) : NULL;
    j->inverses = any ? ffd_alloc_zero(j->count, 9 * sizeof *j->inverses) : NULL;
    if (any && (!transforms || !j->inverses))
        TRY_END(ffd_fail_memory(error));
    for (size_t o = 0; o < owners.count && any; o++) {
        const size_t part = owners.parts[o], count = document->parts[part].vertex_count;
        for (size_t i = 0; i < count; i++) {
            if (i % VERTEX_TRANSFORMS == 0)
                ffd_vertex_transforms_read(document, part, i,
                                           count - i < VERTEX_TRANSFORMS ? count - i : VERTEX_TRANSFORMS,
                                           transforms, NULL);
            const vertex_transform transform = ffd_vertex_transform_of(transforms, i % VERTEX_TRANSFORMS);
            double *const inverse = j->inverses + 9 * (owners.first[o] + i);
            for (int d = 0; d < 9 && transform.identity; d += 4)
                inverse[d] = 1;
            if (!transform.identity && !transform.singular)
                memcpy(inverse, transform.inverse, 9 * sizeof *inverse);
        }
    }
end:
    ffd_free(transforms);
    ffd_vertex_owners_free(&owners);
    return status;
}

/* Finds the column of a number of a placeholder, which several lattices may share; adds it if it is new. */
static ffd_status find_column(jacobian *j, const spec_variable *variable, size_t component, size_t *column,
                              ffd_error *error)
{
    char *const name = ffd_spec_column_name(variable, component);
    for (*column = 0; name && *column < j->columns; ++*column)
        if (strcmp(j->names[*column], name) == 0) {
            ffd_free(name);
            return FFD_OK;
        }
    char **const more = name ? ffd_realloc(j->names, j->columns + 1, sizeof *more) : NULL;
    if (!more) {
        ffd_free(name);
        return ffd_fail_memory(error);
    }
    j->names = more;
    more[j->columns++] = name;
    return FFD_OK;
}

/* Charges the derivatives: 3 coordinates and a weight of each control point, for each number of a
   placeholder. */
static ffd_status take_tangents(jacobian *j, const ffd_lattice *lattice, ffd_error *error)
{
    return ffd_budget_take(&j->budget, ffd_spec_column_count(lattice->spec),
                           lattice->count * 4 * sizeof(double), error);
}

static ffd_status find_tangents(jacobian *j, jacobian_link *link, ffd_error *error)
{
    const ffd_lattice *const lattice = j->job.chain.links[link->index].lattice;
    const lattice_spec *const spec = lattice->spec;
    size_t own = 0;
    TRY(take_tangents(j, lattice, error));
    TRY(ffd_lattice_tangents_find(lattice, &link->tangents, error));
    link->columns = ffd_alloc(link->tangents.columns, sizeof *link->columns);
    if (!link->columns)
        return ffd_fail_memory(error);
    for (size_t v = 0; v < spec->variable_count; v++)
        for (size_t c = 0; c < spec->variables[v].size; c++)
            TRY(find_column(j, &spec->variables[v], c, &link->columns[own++], error));
    return FFD_OK;
}

/* Chooses the links to derive by: one, or all with placeholders. */
static ffd_status choose_links(jacobian *j, ffd_error *error)
{
    const size_t all = j->job.chain.count;
    const bool by_points = j->desc->by == FFD_BY_POINTS;
    const size_t of = j->desc->of == FFD_LATTICE_LAST ? all - 1 : j->desc->of;
    if (by_points && of >= all)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "{of}: there is no lattice %zu: the job has %zu, counted from 0", of, all);
    j->links = ffd_alloc_zero(all, sizeof *j->links);
    if (!j->links)
        return ffd_fail_memory(error);
    for (size_t l = 0; l < all; l++)
        if (by_points ? l == of : j->job.chain.links[l].lattice->spec->variable_count > 0)
            j->links[j->link_count++].index = l;
    return j->link_count > 0
               ? FFD_OK
               : ffd_fail(error, FFD_E_INVALID, "no lattice has a placeholder to differentiate by");
}

/* Charges the arrays of all vertices: u,v,w, statuses, gradients of later lattices, inverses, starts of rows,
   and temporary positions. */
static ffd_status take_vertices(jacobian *j, ffd_error *error)
{
    size_t bytes = 3 * sizeof(double) + 3 * sizeof(uint64_t);
    for (size_t l = 0; l < j->link_count; l++) {
        const bool has_later = j->links[l].index + 1 < j->job.chain.count;
        bytes += (has_later ? 12 : 3) * sizeof(double) + 1;
    }
    if (j->desc->components)
        bytes += 9 * sizeof *j->inverses;
    j->budget = j->job.document->budget;
    TRY(ffd_lattice_memory_share(&j->job.chain, &j->budget, error));
    return ffd_budget_take(&j->budget, j->count, bytes, error);
}

ffd_status ffd_jacobian_prepare(jacobian *j, ffd_error *error)
{
    const bool by_points = j->desc->by == FFD_BY_POINTS;
    pass_totals totals = {0};
    j->count = (size_t)ffd_mesh_vertex_count(j->job.document);
    TRY(ffd_mesh_check(j->job.document, error));
    TRY(ffd_deform_job_load_weights(&j->job, error));
    TRY(ffd_job_fit(&j->job, error));
    TRY(choose_links(j, error));
    TRY(take_vertices(j, error));
    j->pace = (chain_pace){.points = (double)j->count,
                           .threads = j->job.threads,
                           .links = j->job.chain.links,
                           .lattices = j->job.desc->lattices,
                           .more = " (see {timeout})",
                           .log = j->job.log};
    for (size_t l = 0; l < j->link_count; l++) {
        jacobian_link *const link = &j->links[l];
        TRY(fill_embedding(j, link, &totals, error));
        TRY(find_later(j, link, error));
        if (!by_points)
            TRY(find_tangents(j, link, error));
    }
    if (j->desc->components)
        TRY(find_inverses(j, error));
    ffd_result_warn(&totals, &j->job.chain, false, &j->job.log);
    j->blocks = !by_points || j->desc->components || j->links[0].later;
    j->rows = j->blocks ? 3 * j->count : j->count;
    if (by_points)
        j->columns = (j->blocks ? 3 : 1) * j->links[0].embedding->rest->count;
    return FFD_OK;
}

void ffd_jacobian_free(jacobian *j)
{
    for (size_t l = 0; l < j->link_count; l++) {
        ffd_embedding_destroy(&j->links[l].embedding);
        ffd_row_seal_free(&j->links[l].seal);
        ffd_free(j->links[l].later);
        ffd_free(j->links[l].columns);
        ffd_lattice_tangents_free(&j->links[l].tangents);
    }
    ffd_free(j->links);
    ffd_free(j->inverses);
    for (size_t c = 0; j->names && c < j->columns; c++)
        ffd_free(j->names[c]);
    ffd_free(j->names);
}
