#include "job/judge/tear_figures.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "job/chain/seams.h"
#include "job/judge/tear_steps.h"
#include "job/judge/tears.h"
#include "lattice/lattice.h"
#include "mesh/mixed_faces.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* A deformation of a larger mesh reads the faces only if the figures are asked for. */
#define UNASKED_VERTICES ((uint64_t)5500000)

static bool is_asked_for(const deform_job *job)
{
    return job->check || job->desc->quality || job->desc->fail_on & FFD_GATE_TEAR;
}

ffd_status ffd_tear_figures_prepare(deform_job *job, ffd_error *error)
{
    const uint64_t count = ffd_mesh_vertex_count(job->document);
    if (count == 0)
        return FFD_OK;
    /* Zeroed pages that are never written to take no memory. */
    job->kept = ffd_alloc_zero((size_t)count, ffd_kept_planes(ffd_chain_marked(&job->chain)));
    return job->kept ? FFD_OK : ffd_fail_memory(error);
}

static bool moves_nothing(const ffd_lattice *lattice)
{
    for (size_t i = 0; i < lattice->count; i++)
        if (lattice->moved[i] & POINT_MOVED)
            return false;
    return true;
}

/* Marks all vertices as left by lattices that move nothing. */
static void mark_left(const deform_job *job)
{
    const size_t vertices = (size_t)ffd_mesh_vertex_count(job->document);
    for (size_t l = 0; l < job->chain.count && !job->chain.blocks; l++) {
        uint8_t *const marks = job->kept + ffd_kept_plane(l) * vertices;
        if (!moves_nothing(job->chain.links[l].lattice))
            continue;
        for (size_t v = 0; v < vertices; v++)
            marks[v] |= ffd_kept_bit(l);
    }
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

static vertex_marks marks_of(const deform_job *job)
{
    return (vertex_marks){job->kept, ffd_kept_planes(ffd_chain_marked(&job->chain)),
                          (size_t)ffd_mesh_vertex_count(job->document)};
}

/* Reduces the marks to one byte a vertex: whether it stays and is visible, as in messages about vertices
   outside. */
static void mark_still(const deform_job *job)
{
    const mesh_document *const document = job->document;
    const vertex_marks marks = marks_of(job);
    const size_t acting = ffd_chain_layers(&job->chain);
    size_t first = 0;
    for (size_t v = ffd_marks_next(&marks, 0); v < marks.vertices; v = ffd_marks_next(&marks, v + 1))
        job->kept[v] = !ffd_tear_takes_part(job->kept, marks.vertices, (uint32_t)v, acting);
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
    const vertex_marks still = {job->kept, 1, (size_t)ffd_mesh_vertex_count(job->document)};
    const mesh_format *const format = job->document->format;
    mark_still(job);
    if (format->name_part)
        result->tear_stays = format->name_part(job->document, result->tear_vertex, job->kept,
                                               result->tear_part, sizeof result->tear_part);
    if (*result->tear_part)
        return;
    result->tear_stays = 0;
    for (size_t v = ffd_marks_next(&still, 0); v < still.vertices; v = ffd_marks_next(&still, v + 1))
        result->tear_stays++;
}

static void fill_result(const deform_job *job, const tear_question *question, const tear_count *count,
                        ffd_job_result *result)
{
    const bool blocks = job->chain.blocks, torn = count->edges > 0;
    const mesh_faces *const faces = question->faces;
    result->has_tear = true;
    result->tear_edges = count->edges;
    result->tear_largest = count->largest;
    result->tear_vertex = torn ? ffd_faces_number(faces, count->vertex) : count->vertex;
    result->tear_unselected = torn && count->mode == TEAR_UNMOVABLE;
    result->tear_between =
        torn && count->mode == TEAR_BORDER &&
        ffd_tear_takes_part(question->marks, faces->vertex_count, count->vertex, question->acting);
    result->tear_seam = torn && count->mode >= ffd_tear_seams(&job->chain);
    result->tear_disagrees = torn && blocks && count->mode == TEAR_DISAGREES;
    if (torn)
        name_part(job, result);
}

/* marks: of the vertices of faces. */
static ffd_status count_marked(const deform_job *job, const mesh_faces *faces, uint8_t *marks,
                               const memory_budget *budget, ffd_job_result *result, ffd_error *error)
{
    tear_count count;
    vertex_range *hidden = NULL;
    tear_question question = {.faces = faces,
                              .marks = marks,
                              .links = ffd_chain_marked(&job->chain),
                              .acting = ffd_chain_layers(&job->chain),
                              .lone = ffd_tear_seams(&job->chain),
                              .step = ffd_tear_steps_find,
                              .context = ffd_tear_steps_make(&job->chain, job->document, faces, marks),
                              .torn = job->details ? &job->details->tears : NULL,
                              .budget = budget};
    ffd_status status =
        question.context ? list_hidden(job, &hidden, &question.hidden_count, error) : ffd_fail_memory(error);
    question.hidden = hidden;
    if (!status)
        status = ffd_tears_count(&question, &count, error);
    if (!status)
        fill_result(job, &question, &count, result);
    ffd_tear_steps_free(question.context);
    ffd_free(hidden);
    return status;
}

static ffd_status count_torn(const deform_job *job, const mesh_faces *faces, const memory_budget *budget,
                             ffd_job_result *result, ffd_error *error)
{
    const vertex_marks all = marks_of(job);
    const size_t count = faces->vertex_count;
    if (!faces->numbers)
        return count_marked(job, faces, job->kept, budget, result, error);
    ffd_status status = ffd_budget_check(budget, count, all.planes, error);
    if (status)
        return status;
    uint8_t *const marks = ffd_alloc(count, all.planes);
    if (!marks)
        return ffd_fail_memory(error);
    for (size_t p = 0; p < all.planes; p++)
        for (size_t v = 0; v < count; v++)
            marks[p * count + v] = job->kept[p * all.vertices + faces->numbers[v]];
    status = count_marked(job, faces, marks, budget, result, error);
    ffd_free(marks);
    return status;
}

/* Whether some vertices may not be moved by any link. They may share a position with vertices that move, so
   then all faces are read, not only those with mixed marks. */
static bool some_may_not_move(const deform_job *job)
{
    const vertex_marks marks = marks_of(job);
    unsigned any = 0;
    for (size_t v = ffd_marks_next(&marks, 0); v < marks.vertices; v = ffd_marks_next(&marks, v + 1))
        any |= job->kept[v];
    return any & KEPT_ALWAYS;
}

static ffd_status read_and_count(deform_job *job, const memory_budget *left, ffd_job_result *result,
                                 ffd_error *error)
{
    mesh_faces faces;
    memory_budget budget = *left;
    const mesh_format *const format = job->document->format;
    const vertex_marks marks = marks_of(job);
    ffd_status status = some_may_not_move(job) ? format->faces(job->document, &faces, error)
                                               : format->mixed_faces(job->document, &marks, &faces, error);
    if (status)
        return status;
    status = ffd_mesh_faces_take(&faces, faces.start[faces.face_count], &budget, error);
    if (!status)
        status = count_torn(job, &faces, &budget, result, error);
    ffd_mesh_faces_free(&faces);
    return status;
}

ffd_status ffd_tear_figures_find(deform_job *job, figure_arrays *arrays, ffd_job_result *result,
                                 ffd_error *error)
{
    const pass_totals *const totals = &job->totals;
    ffd_error own;
    char line[1024];
    ffd_status status;
    if (totals->kept == 0 || totals->located + totals->extended == 0) {
        result->has_tear = true;
        return FFD_OK;
    }
    mark_left(job);
    if (arrays->has_faces)
        return count_torn(job, &arrays->faces, &arrays->budget, result, error);
    if (!is_asked_for(job) && ffd_mesh_vertex_count(job->document) > UNASKED_VERTICES)
        status =
            ffd_fail(&own, FFD_E_LIMIT, "more than %" PRIu64 " vertices (see --report)", UNASKED_VERTICES);
    else
        status = read_and_count(job, &arrays->budget, result, &own);
    if (status == FFD_OK)
        return FFD_OK;
    if (job->desc->fail_on & FFD_GATE_TEAR || status == FFD_E_MEMORY) {
        if (error)
            *error = own;
        return status;
    }
    ffd_error_format(&own, line, sizeof line);
    ffd_log_line(&job->log, FFD_LOG_WARNING, "torn edges are not counted: %s", line);
    return FFD_OK;
}

void ffd_tear_figures_describe(const ffd_job_result *result, char *text, size_t capacity)
{
    const char *const colon = strchr(result->tear_part, ':');
    char name[201] = "";
    if (colon)
        ffd_name_shown(colon + 1, name, sizeof name);
    if (result->tear_between) {
        snprintf(
            text, capacity,
            "the lattices move the two ends of edges differently; the largest step to a neighbour is %g, "
            "at vertex %" PRIu64 "%s%s (%" PRIu64 " torn %s)",
            result->tear_largest, result->tear_vertex, colon ? " of " : "", name, result->tear_edges,
            ffd_plural(result->tear_edges, "edge", "edges"));
        return;
    }
    if (result->tear_disagrees) {
        snprintf(text, capacity,
                 "blocks move %" PRIu64 " %s on their faces differently; the largest step to a "
                 "neighbour is %g",
                 result->disagreeing, ffd_plural(result->disagreeing, "vertex", "vertices"),
                 result->tear_largest);
        return;
    }
    if (result->tear_seam) {
        snprintf(text, capacity,
                 "the two faces of a lattice's seam are moved apart; the largest step to a neighbour is %g",
                 result->tear_largest);
        return;
    }
    snprintf(text, capacity, "%" PRIu64 " %s%s%s %s; the largest step to a neighbour is %g",
             result->tear_stays, ffd_plural(result->tear_stays, "vertex", "vertices"), colon ? " of " : "",
             name, ffd_plural(result->tear_stays, "stays", "stay"), result->tear_largest);
}

void ffd_tear_figures_warn(const deform_job *job, const ffd_job_result *result)
{
    char text[400];
    const char *const remedy =
        result->tear_disagrees || result->tear_seam ? "their control points there have to move alike"
        : result->tear_between     ? "see --blocks for lattices side by side, --outside extend, --falloff"
        : !result->tear_unselected ? "see --outside extend, --falloff, a larger lattice"
        : job->desc->only_count    ? "--only does not select them"
                                   : "the matrix of their node or skin has no inverse";
    if (!result->has_tear || result->tear_edges == 0)
        return;
    ffd_tear_figures_describe(result, text, sizeof text);
    ffd_log_line(&job->log, FFD_LOG_WARNING, "%s (%s)", text, remedy);
}
