/* edit_points.c - where the vertices of a mesh are in the lattice that a page edits. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/vector/vec.h"
#include "deform/extension.h"
#include "embed/locator_border.h"
#include "job/chain/chain_apply.h"
#include "job/chain/point_outcome.h"
#include "job/deform_passes.h"
#include "job/pass/pass.h"
#include "job/view/edit.h"
#include "job/view/view.h"
#include "mesh/morphs.h"
#include <math.h>
#include <string.h>

/* What a pass finds, of the vertices of the document. */
typedef struct vertex_finds {
    ffd_location *locations;
    uint8_t *places;
    double *stored, *start;
    double *gradients; /* NULL with one lattice */
} vertex_finds;

typedef struct point_work {
    deform_job *job;
    const view_scene *scene;
    edit_points *points;
    vertex_finds found;
    size_t vertices; /* of the document */
    size_t links;    /* lattices before the edited one */
    const boundary *border;
    size_t capacity[6]; /* of the growing arrays of points */
    ffd_error *error;
} point_work;

static const chain_link *edited_link(const point_work *w)
{
    return &w->job->chain.links[w->links];
}

static size_t index_of(const point_work *w, size_t vertex)
{
    return ffd_view_vertex_of(w->scene, 0, vertex);
}

/* Sends the vertices to the edited lattice. */
static ffd_status locate_vertices(point_work *w)
{
    deform_job *const job = w->job;
    vertex_finds *const found = &w->found;
    const size_t bytes = sizeof *found->locations + 1 + (w->links > 0 ? 15 : 3) * sizeof(double);
    TRY(ffd_budget_take(&job->document->budget, w->vertices, bytes, w->error));
    found->locations = ffd_alloc_zero(w->vertices, sizeof *found->locations);
    found->places = ffd_alloc_zero(w->vertices, 1);
    found->start = ffd_alloc_zero(w->vertices, 3 * sizeof *found->start);
    found->gradients = w->links > 0 ? ffd_alloc_zero(w->vertices, 9 * sizeof *found->gradients) : NULL;
    if (!found->locations || !found->places || !found->start || (w->links > 0 && !found->gradients))
        return ffd_fail_memory(w->error);
    TRY(ffd_view_read_positions(job->document, MESH_STORED, &found->stored, w->error));
    mesh_pass pass = {.document = job->document,
                      .state = MESH_STORED,
                      .chain = &job->chain,
                      .links = w->links,
                      .threads = job->threads,
                      .locations = found->locations,
                      .places = found->places,
                      .deformed = found->start};
    pass_totals totals;
    TRY(ffd_pass_over_mesh(&pass, &totals, w->error));
    if (w->links == 0)
        return FFD_OK;
    pass.locations = NULL;
    pass.places = NULL;
    pass.gradients = found->gradients;
    return ffd_pass_over_mesh(&pass, &totals, w->error);
}

/* Memory of a point without its way, in bytes. */
#define POINT_BYTES (7 * sizeof(double) + sizeof(uint32_t) + 1)

/* Makes room for one more point. */
static ffd_status grow(point_work *w)
{
    edit_points *const p = w->points;
    const size_t needed = p->count + 1;
    const size_t way = w->job->chain.outside.extend ? EDIT_WAY * sizeof *p->ways : 0;
    TRY(ffd_budget_take(&w->job->document->budget, 1, POINT_BYTES + way, w->error));
    const bool made =
        ffd_grow((void **)&p->start, &w->capacity[0], needed, 3 * sizeof *p->start) &&
        ffd_grow((void **)&p->uvw, &w->capacity[1], needed, 3 * sizeof *p->uvw) &&
        ffd_grow((void **)&p->kinds, &w->capacity[2], needed, 1) &&
        ffd_grow((void **)&p->factors, &w->capacity[3], needed, sizeof *p->factors) &&
        ffd_grow((void **)&p->owners, &w->capacity[4], needed, sizeof *p->owners) &&
        (way == 0 || ffd_grow((void **)&p->ways, &w->capacity[5], needed, EDIT_WAY * sizeof *p->ways));
    return made ? FFD_OK : ffd_fail_memory(w->error);
}

/* Adds the point of the border that is nearest to a place. moves: the place follows it. */
static ffd_status take_border(point_work *w, const double x[3], bool moves, size_t point)
{
    edit_points *const p = w->points;
    const chain_link *const link = edited_link(w);
    boundary_point nearest;
    TRY(ffd_deadline_check(w->error));
    TRY(ffd_boundary_find(w->border, x, link->falloff > 0 ? link->falloff : HUGE_VAL, &nearest, w->error));
    if (!nearest.found)
        return FFD_OK;
    memcpy(p->uvw + 3 * point, nearest.uvw, sizeof nearest.uvw);
    if (!moves)
        return FFD_OK;
    double slope, *const way = p->ways + EDIT_WAY * point;
    p->kinds[point] = EDIT_EXTENDED;
    memcpy(way, nearest.uvw_by_p, sizeof nearest.uvw_by_p);
    way[9] = ffd_extension_fade(nearest.distance, link->falloff, &slope);
    for (size_t a = 0; a < 3; a++)
        way[10 + a] = slope * nearest.direction[a];
    return FFD_OK;
}

/* Adds a point. location: NULL: it is not selected, or is nowhere. needs_foot: of a point that stays, its
   place in the volume or on the border is wanted. */
static ffd_status add_point(point_work *w, const double x[3], const ffd_location *location, double factor,
                            uint32_t owner, bool needs_foot)
{
    edit_points *const p = w->points;
    const size_t point = p->count;
    TRY(grow(w));
    p->count++;
    memcpy(p->start + 3 * point, x, 3 * sizeof *x);
    p->factors[point] = factor;
    p->owners[point] = owner;
    p->kinds[point] = EDIT_STAYS;
    for (size_t a = 0; a < 3; a++)
        p->uvw[3 * point + a] = NAN;
    if (p->ways)
        memset(p->ways + EDIT_WAY * point, 0, EDIT_WAY * sizeof *p->ways);
    if (location && ffd_location_is_placed(location)) {
        p->kinds[point] = EDIT_INSIDE;
        memcpy(p->uvw + 3 * point, location->uvw, sizeof location->uvw);
        return FFD_OK;
    }
    const bool moves = location && w->job->chain.outside.extend && location->status != FFD_VERTEX_INVALID;
    if (!(moves || needs_foot) || !vec_is_finite(x))
        return FFD_OK;
    if (!location) { /* not selected: it may be inside */
        ffd_location own;
        TRY(ffd_locator_find(edited_link(w)->locator, x, 1, &own, w->error));
        if (ffd_location_is_placed(&own)) {
            memcpy(p->uvw + 3 * point, own.uvw, sizeof own.uvw);
            return FFD_OK;
        }
    }
    return take_border(w, x, moves, point);
}

/* Marks the vertices of the scene beside one that the lattice moves: edges to these may be torn. */
static uint8_t *mark_neighbours(const point_work *w)
{
    const view_scene *const scene = w->scene;
    uint8_t *const marks = ffd_alloc_zero(scene->vertex_count, 1);
    for (size_t t = 0; marks && t < scene->triangle_count; t++) {
        const uint32_t *const corners = scene->triangles + 3 * t;
        bool any = false;
        for (int c = 0; c < 3; c++)
            any = any || w->found.places[index_of(w, corners[c])] == PASS_INSIDE;
        for (int c = 0; any && c < 3; c++)
            marks[corners[c]] = 1;
    }
    return marks;
}

static ffd_status add_vertices(point_work *w)
{
    const view_scene *const scene = w->scene;
    uint8_t *const marks = mark_neighbours(w);
    ffd_status status = marks ? FFD_OK : ffd_fail_memory(w->error);
    for (size_t v = 0; v < scene->vertex_count && !status; v++) {
        const size_t index = index_of(w, v);
        const bool is_there = w->found.places[index] != PASS_ELSEWHERE;
        const double *const x = (is_there ? w->found.start : w->found.stored) + 3 * index;
        status = add_point(w, x, is_there ? &w->found.locations[index] : NULL, 1, 0, marks[v] != 0);
    }
    w->points->vertices = scene->vertex_count;
    ffd_free(marks);
    return status;
}

/* The points of a morph target that are located together. */
typedef struct target_run {
    double x[3 * CHAIN_RUN], delta[3 * CHAIN_RUN];
    point_outcome outcomes[CHAIN_RUN];
    chain_scratch scratch;
    uint32_t vertices[CHAIN_RUN];
    size_t count;
} target_run;

/* Positions and offsets of targets are floats in nearly all files. */
static void find_rounding(const void *context, size_t point, bool is_first, const double x[3], double half[3])
{
    (void)context, (void)point, (void)is_first;
    for (int a = 0; a < 3; a++)
        half[a] = fabs(x[a]) * 0x1p-23;
}

static ffd_status send_run(point_work *w, target_run *own, double weight)
{
    const chain_rounding rounding = {find_rounding, NULL};
    chain_run run = {.x = own->x,
                     .count = own->count,
                     .rounding = &rounding,
                     .scratch = &own->scratch,
                     .delta = own->delta,
                     .outcomes = own->outcomes};
    TRY(ffd_chain_locate(&w->job->chain, w->links, true, &run, w->error));
    for (size_t i = 0; i < own->count; i++) {
        w->points->factors[own->vertices[i]] -= weight;
        TRY(add_point(w, own->x + 3 * i, &own->scratch.locations[i], weight, own->vertices[i], false));
    }
    own->count = 0;
    return FFD_OK;
}

/* What is needed of all targets. */
typedef struct target_work {
    double *offsets;    /* of a target, of the vertices of a part */
    uint32_t *vertices; /* the scene's, by those of the document; VIEW_NONE: none */
    size_t *first;      /* vertex of each part */
    target_run *run;
} target_work;

/* Adds the points of a target with a weight. */
static ffd_status add_target(point_work *w, target_work *t, const mesh_target *target)
{
    mesh_document *const document = w->job->document;
    const mesh_part *const part = &document->parts[target->part];
    const size_t first = t->first[target->part];
    document->format->morphs->read_target(document, target, false, t->offsets);
    for (size_t i = 0; i < part->vertex_count; i++) {
        const double *const m = t->offsets + 3 * i;
        const uint32_t vertex = t->vertices[first + i];
        if (vertex == VIEW_NONE || !vec_is_finite(m) || (m[0] == 0 && m[1] == 0 && m[2] == 0))
            continue;
        double *const x = t->run->x + 3 * t->run->count;
        for (size_t a = 0; a < 3; a++)
            x[a] = w->found.stored[3 * (first + i) + a] + m[a];
        if (!ffd_part_selects(part, i)) {
            w->points->factors[vertex] -= target->weight;
            TRY(add_point(w, x, NULL, target->weight, vertex, false));
            continue;
        }
        t->run->vertices[t->run->count++] = vertex;
        if (t->run->count == CHAIN_RUN)
            TRY(send_run(w, t->run, target->weight));
    }
    return t->run->count > 0 ? send_run(w, t->run, target->weight) : FFD_OK;
}

static ffd_status prepare_targets(point_work *w, target_work *t)
{
    mesh_document *const document = w->job->document;
    TRY(ffd_first_vertices(document, &t->first, w->error));
    t->offsets = ffd_alloc(w->vertices, 3 * sizeof *t->offsets);
    t->vertices = ffd_alloc(w->vertices, sizeof *t->vertices);
    t->run = ffd_alloc_zero(1, sizeof *t->run);
    if (!t->offsets || !t->vertices || !t->run)
        return ffd_fail_memory(w->error);
    memset(t->vertices, 0xff, w->vertices * sizeof *t->vertices);
    for (size_t v = 0; v < w->scene->vertex_count; v++)
        t->vertices[index_of(w, v)] = (uint32_t)v;
    return FFD_OK;
}

static ffd_status add_targets(point_work *w)
{
    mesh_document *const document = w->job->document;
    const mesh_morph_calls *const calls = document->format->morphs;
    mesh_targets targets = {0};
    target_work own = {0};
    ffd_status status;
    TRY_END(calls ? calls->list_targets(document, &targets, w->error) : FFD_OK);
    if (targets.count > 0)
        TRY_END(prepare_targets(w, &own));
    for (size_t t = 0; t < targets.count && !w->job->stored; t++)
        if (targets.list[t].weight != 0)
            TRY_END(add_target(w, &own, &targets.list[t]));
end:
    ffd_mesh_targets_free(&targets);
    ffd_free(own.offsets);
    ffd_free(own.vertices);
    ffd_free(own.first);
    ffd_free(own.run);
    return status;
}

/* Takes the gradients of the lattices before, in the order of the scene. */
static ffd_status take_gradients(point_work *w)
{
    const view_scene *const scene = w->scene;
    edit_points *const p = w->points;
    if (!w->found.gradients)
        return FFD_OK;
    p->gradients = ffd_alloc(scene->vertex_count, 9 * sizeof *p->gradients);
    if (!p->gradients)
        return ffd_fail_memory(w->error);
    for (size_t v = 0; v < scene->vertex_count; v++)
        memcpy(p->gradients + 9 * v, w->found.gradients + 9 * index_of(w, v), 9 * sizeof *p->gradients);
    return FFD_OK;
}

static void count(const point_work *w, edit_counts *counts)
{
    for (size_t i = 0; i < w->vertices; i++) {
        counts->inside += w->found.places[i] == PASS_INSIDE;
        counts->outside += w->found.places[i] == PASS_OUTSIDE;
    }
}

ffd_status ffd_edit_find_points(deform_job *job, const view_scene *scene, edit_points *points,
                                edit_counts *counts, ffd_error *error)
{
    point_work w = {.job = job,
                    .scene = scene,
                    .points = points,
                    .vertices = (size_t)ffd_mesh_vertex_count(job->document),
                    .links = job->chain.count - 1,
                    .error = error};
    ffd_status status;
    TRY_END(ffd_locator_border(edited_link(&w)->locator, &w.border, error));
    TRY_END(locate_vertices(&w));
    TRY_END(add_vertices(&w));
    TRY_END(add_targets(&w));
    TRY_END(take_gradients(&w));
    count(&w, counts);
    /* The vertices own themselves. */
    memmove(points->owners, points->owners + points->vertices,
            (points->count - points->vertices) * sizeof *points->owners);
end:
    ffd_free(w.found.locations);
    ffd_free(w.found.places);
    ffd_free(w.found.stored);
    ffd_free(w.found.start);
    ffd_free(w.found.gradients);
    return status;
}
