#include "job/measure/tear_figures.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/text/words.h"
#include "base/vector/vec.h"
#include "job/chain/block_nets.h"
#include "job/chain/marks.h"
#include "job/measure/tears.h"
#include "job/measure/weight_tears.h"
#include "lattice/lattice.h"
#include "mesh/cell_list.h"
#include "mesh/mixed_faces.h"
#include "mesh/selector.h"
#include <inttypes.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>

/* A deformation of a larger mesh reads the faces only if the figures are asked for. */
#define UNASKED_VERTICES ((uint64_t)5500000)

/* Unasked, edges in volumes that are not boxes are cut only if that takes little beside the search for the
   vertices: of a mesh that is coarse beside its lattice all edges may have to be, and in a lattice that
   overlaps itself each place takes long. These evaluations are allowed: this part of those of the search, and
   so many anyway. */
#define SHARE_OF_SEARCH (1.0 / 8)
#define FREE_EVALUATIONS 5e4

/* With fewer vertices a block than this it takes longer to compare the nets of blocks than to cut edges. */
#define LEAST_FOR_NETS 16

/* Memory of the arrays for each vertex, in bytes. */
#define ARRAY_BYTES (12 * sizeof(double))

static bool is_asked_for(const deform_job *job)
{
    return job->check || job->desc->quality || job->desc->fail_on & FFD_GATE_TEAR;
}

static size_t count_vertices(const deform_job *job)
{
    return (size_t)ffd_mesh_vertex_count(job->document);
}

/* The ends' displacements, and their derivatives, rule out most edges outside of a volume that is not a box.
 */
static ffd_status make_arrays(const deform_job *job, figure_arrays *arrays, ffd_error *error)
{
    const size_t count = count_vertices(job);
    if (job->chain.marks.parted_count == 0 || !job->chain.outside.extend || arrays->deformed ||
        (!is_asked_for(job) && count > UNASKED_VERTICES) ||
        ffd_budget_take(&arrays->budget, count, ARRAY_BYTES, NULL))
        return FFD_OK;
    arrays->deformed = ffd_alloc(count, 3 * sizeof *arrays->deformed);
    arrays->gradients = ffd_alloc(count, 9 * sizeof *arrays->gradients);
    return arrays->deformed && arrays->gradients ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_tear_figures_prepare(deform_job *job, figure_arrays *arrays, ffd_error *error)
{
    const size_t count = count_vertices(job);
    if (count == 0)
        return FFD_OK;
    if (job->chain.blocks && !is_asked_for(job) && count >= LEAST_FOR_NETS * job->chain.count)
        TRY(ffd_blocks_join(&job->chain, &job->blocks_join, error));
    ffd_marks_lay_out(&job->chain, !job->blocks_join || job->chain.outside.extend);
    /* Zeroed pages that are never written to take no memory. */
    job->kept = ffd_alloc_zero(count, job->chain.marks.planes);
    return job->kept ? make_arrays(job, arrays, error) : ffd_fail_memory(error);
}

/* Marks all vertices as left by lattices that move nothing. */
static void mark_left(const deform_job *job)
{
    const size_t vertices = count_vertices(job);
    for (size_t l = 0; l < job->chain.count && !job->chain.blocks; l++) {
        uint8_t *const marks = job->kept + ffd_kept_plane(l) * vertices;
        if (!job->chain.links[l].is_still)
            continue;
        for (size_t v = 0; v < vertices; v++)
            marks[v] |= ffd_kept_bit(l);
    }
}

/* The first planes of the marks. */
static vertex_marks marks_of(const deform_job *job, size_t planes)
{
    return (vertex_marks){job->kept, planes, count_vertices(job)};
}

/* Whether some vertices may not be moved by any link. They may share a position with vertices that move, so
   then all faces are read, not only those with mixed marks. */
static bool some_may_not_move(const deform_job *job)
{
    const vertex_marks marks = marks_of(job, 1);
    unsigned any = 0;
    for (size_t v = ffd_marks_next(&marks, 0); v < marks.vertices; v = ffd_marks_next(&marks, v + 1))
        any |= job->kept[v];
    return any & KEPT_ALWAYS;
}

/* Whether some vertices have marks that lead to torn edges: planes is set to how many planes tell. */
static bool may_tear(const deform_job *job, size_t *planes)
{
    const lattice_chain *const chain = &job->chain;
    const pass_totals *const totals = &job->totals;
    bool opens = chain->seam_count > 0 || totals->multiple_any > 0 || totals->extended > 0;
    for (size_t l = 0; l < chain->count; l++)
        opens = opens || chain->links[l].opens_axis;
    const bool parts = chain->marks.parted_count > 0 && opens;
    /* Where an edge leaves the volume by a held face, the displacement there is 0. */
    const bool stays =
        totals->kept > 0 && (!chain->seal.closes || is_asked_for(job) || some_may_not_move(job));
    *planes = parts ? chain->marks.planes : chain->marks.owners ? chain->marks.parts : chain->marks.kept;
    return totals->located + totals->extended > 0 &&
           (stays || parts || (chain->marks.owners && !(job->blocks_join && totals->extended == 0)) ||
            (is_asked_for(job) && chain->count > 1));
}

/* Lists the hidden vertices, except in parts that repeat positions. *ranges is freed by the caller. */
static ffd_status list_hidden(const deform_job *job, vertex_range **ranges, size_t *count, ffd_error *error)
{
    const mesh_document *const document = job->document;
    size_t end = 0;
    *count = 0;
    *ranges = ffd_alloc(document->part_count, sizeof **ranges);
    if (!*ranges)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < document->part_count; i++) {
        const mesh_part *const part = &document->parts[i];
        if (part->repeats_positions)
            continue;
        if (part->hidden && part->vertex_count > 0)
            (*ranges)[(*count)++] = (vertex_range){end, end + part->vertex_count};
        end += part->vertex_count;
    }
    return FFD_OK;
}

/* Reduces the marks to one byte a vertex: whether it stays and is visible, as in messages about vertices
   outside. */
static void mark_still(const deform_job *job)
{
    const mesh_document *const document = job->document;
    const vertex_marks bits = marks_of(job, job->chain.marks.kept);
    const mark_planes marks = {job->kept, bits.vertices};
    size_t first = 0;
    for (size_t v = ffd_marks_next(&bits, 0); v < bits.vertices; v = ffd_marks_next(&bits, v + 1))
        job->kept[v] = !ffd_marks_take_any(&marks, v, ffd_chain_layers(&job->chain));
    for (size_t i = 0; i < document->part_count; i++) {
        const mesh_part *const part = &document->parts[i];
        if (part->repeats_positions)
            continue;
        for (size_t v = 0; v < part->vertex_count && (part->hidden || part->used); v++)
            job->kept[first + v] &= ffd_part_shows(part, v);
        first += part->vertex_count;
    }
}

/* Finds the name of the part that stays, and how many of its vertices do. */
static void name_part(const deform_job *job, ffd_job_result *result)
{
    const vertex_marks still = marks_of(job, 1);
    const mesh_format *const format = job->document->format;
    mark_still(job);
    if (format->selectors)
        result->tear.stays = format->selectors->name_owner(job->document, result->tear.vertex, job->kept,
                                                           result->tear.part, sizeof result->tear.part);
    if (*result->tear.part)
        return;
    result->tear.stays = 0;
    for (size_t v = ffd_marks_next(&still, 0); v < still.vertices; v = ffd_marks_next(&still, v + 1))
        result->tear.stays++;
}

/* How many evaluations the edges may take. */
static long long most_evaluations(const deform_job *job)
{
    return is_asked_for(job)
               ? LLONG_MAX
               : (long long)(SHARE_OF_SEARCH * (double)job->totals.evaluations + FREE_EVALUATIONS);
}

/* has_all: count is of all edges. */
static void fill_result(const deform_job *job, const mesh_faces *faces, const tear_count *count, bool has_all,
                        ffd_job_result *result)
{
    const bool torn = count->edges > 0;
    result->tear.is_known = has_all;
    result->tear.edges = count->edges;
    result->tear.largest = count->largest;
    result->tear.vertex = torn ? ffd_faces_document_vertex(faces, count->vertex) : count->vertex;
    result->tear.cause = count->cause;
    if (torn)
        name_part(job, result);
}

/* Whether the extension of the lattices may jump. That of a box does not. */
static bool may_part(const lattice_chain *chain)
{
    bool parts = chain->blocks && chain->count > 1;
    for (size_t l = 0; l < chain->count; l++)
        parts = parts || !chain->links[l].is_convex;
    return parts;
}

/* The first planes of marks in which the ends of an edge have to differ, or what lies between them. Of blocks
   that are not boxes the parts tell what leads through other blocks. */
static size_t count_telling(const deform_job *job, size_t planes)
{
    return is_asked_for(job) && job->chain.blocks ? job->chain.marks.planes : planes;
}

/* marks: of the vertices of faces; planes: how many of theirs tell. */
static ffd_status count_marked(const deform_job *job, const mesh_faces *faces, uint8_t *marks, size_t planes,
                               const figure_arrays *arrays, const memory_budget *budget,
                               ffd_job_result *result, ffd_error *error)
{
    tear_count count;
    vertex_range *hidden = NULL;
    tear_question question = {.mesh = {.faces = faces,
                                       .chain = &job->chain,
                                       .marks = {marks, faces->vertex_count},
                                       .planes = count_telling(job, planes),
                                       .stays = job->totals.kept > 0,
                                       .passes = is_asked_for(job) && job->chain.count > 1,
                                       .continues = is_asked_for(job) && may_part(&job->chain),
                                       .deformed = arrays->deformed,
                                       .gradients = arrays->gradients,
                                       .weights = ffd_job_weights(job),
                                       .rigid = ffd_job_rigid(job),
                                       .state = ffd_job_judged(job),
                                       .budget = budget},
                              .marks = marks,
                              .torn = job->details ? &job->details->tears : NULL,
                              .threads = job->threads,
                              .most = most_evaluations(job)};
    TRY(list_hidden(job, &hidden, &question.mesh.hidden_count, error));
    question.mesh.hidden = hidden;
    const ffd_status status = ffd_tears_count(&question, &count, error);
    if (!status || status == FFD_E_LIMIT)
        fill_result(job, faces, &count, !status, result);
    ffd_free(hidden);
    return status;
}

/* planes: the first planes of marks that tell. */
static ffd_status count_torn(const deform_job *job, const mesh_faces *faces, size_t planes,
                             const figure_arrays *arrays, const memory_budget *budget, ffd_job_result *result,
                             ffd_error *error)
{
    const size_t all = job->chain.marks.planes, vertices = count_vertices(job), count = faces->vertex_count;
    if (!faces->vertices)
        return count_marked(job, faces, job->kept, planes, arrays, budget, result, error);
    TRY(ffd_budget_check(budget, count, all, error));
    uint8_t *const marks = ffd_alloc(count, all);
    if (!marks)
        return ffd_fail_memory(error);
    for (size_t p = 0; p < all; p++)
        for (size_t v = 0; v < count; v++)
            marks[p * count + v] = job->kept[p * vertices + faces->vertices[v]];
    ffd_status status = count_marked(job, faces, marks, planes, arrays, budget, result, error);
    ffd_free(marks);
    return status;
}

/* planes: those in which the corners of faces have to differ. */
static ffd_status read_and_count(deform_job *job, size_t planes, const figure_arrays *arrays,
                                 ffd_job_result *result, ffd_error *error)
{
    mesh_faces faces;
    memory_budget budget = arrays->budget;
    const mesh_format *const format = job->document->format;
    const vertex_marks marks = marks_of(job, planes);
    const bool all = some_may_not_move(job) || (is_asked_for(job) && job->chain.count > 1);
    mesh_faces_function *const every =
        ffd_mesh_volumes(job->document) > 0 ? format->cells->sides : format->faces;
    TRY(all ? every(job->document, ffd_job_judged(job), &faces, error)
            : format->mixed_faces(job->document, ffd_job_judged(job), &marks, &faces, error));
    ffd_status status;
    TRY_END(ffd_mesh_faces_take(&faces, faces.start[faces.face_count], &budget, error));
    TRY_END(count_torn(job, &faces, planes, arrays, &budget, result, error));
end:
    ffd_mesh_faces_free(&faces);
    return status;
}

bool ffd_tear_figures_count_splits(const deform_job *job)
{
    return is_asked_for(job) || count_vertices(job) <= UNASKED_VERTICES;
}

/* Counts the edges that the lattices tear. */
static ffd_status find_torn(deform_job *job, figure_arrays *arrays, ffd_job_result *result, ffd_error *error)
{
    ffd_error own;
    char line[1024];
    size_t planes;
    ffd_status status;
    if (!may_tear(job, &planes)) {
        result->tear.is_known = true;
        return FFD_OK;
    }
    mark_left(job);
    /* The faces of volumes are the outer ones: edges inside may be torn, too. */
    const bool has_edges = arrays->has_faces && ffd_mesh_volumes(job->document) == 0;
    if (has_edges && is_asked_for(job))
        return count_torn(job, &arrays->faces, planes, arrays, &arrays->budget, result, error);
    if (has_edges)
        status = count_torn(job, &arrays->faces, planes, arrays, &arrays->budget, result, &own);
    else if (!is_asked_for(job) && count_vertices(job) > UNASKED_VERTICES)
        status =
            ffd_fail(&own, FFD_E_LIMIT, "more than %" PRIu64 " vertices (see {quality})", UNASKED_VERTICES);
    else
        status = read_and_count(job, planes, arrays, result, &own);
    if (!status)
        return FFD_OK;
    if (job->desc->fail_on & FFD_GATE_TEAR || status == FFD_E_MEMORY || ffd_deadline_passed()) {
        if (error)
            *error = own;
        return status;
    }
    ffd_error_format(&own, line, sizeof line);
    ffd_log_line(&job->log, FFD_LOG_WARNING, "torn edges %sare not counted: %s",
                 result->tear.edges > 0 ? "of which both ends move " : "", line);
    return FFD_OK;
}

/* Counts vertices that lie apart since only one of them moves with a piece. Returns whether the largest step
   is one of theirs. */
static bool add_rigid_splits(const rigid_splits *splits, ffd_tear_figures *tear)
{
    tear->edges += splits->count;
    if (!(splits->largest > tear->largest))
        return false;
    tear->largest = splits->largest;
    tear->vertex = splits->vertex;
    tear->cause = FFD_TEAR_RIGID;
    return true;
}

ffd_status ffd_tear_figures_find(deform_job *job, figure_arrays *arrays, ffd_job_result *result,
                                 ffd_error *error)
{
    bool is_largest;
    TRY(find_torn(job, arrays, result, error));
    TRY(ffd_weight_tears_add(job, result, &is_largest, error));
    is_largest = add_rigid_splits(&job->rigid.splits, &result->tear) || is_largest;
    if (!is_largest)
        return FFD_OK;
    const mesh_selector_calls *const selectors = job->document->format->selectors;
    *result->tear.part = 0;
    if (selectors)
        selectors->name_owner(job->document, result->tear.vertex, job->kept, result->tear.part,
                              sizeof result->tear.part);
    return FFD_OK;
}
