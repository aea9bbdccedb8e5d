/* view_targets.c - the morph targets of a page: what each moves before and after, and the sliders of their
   weights. */
#include "base/file/path.h"
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "job/pass/pass.h"
#include "job/view/view.h"
#include "mesh/morphs.h"
#include "mesh/rig.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct target_work {
    const view_targets_desc *desc;
    view_scene *scene;
    intern_table keys; /* of the sliders, in their order */
    size_t slider_capacity;
    mesh_targets targets; /* of the document of this side */
    size_t *first;        /* its first vertex of each part */
    uint32_t *places;     /* vertex of the scene of each of its vertices; VIEW_NONE: none */
    double *offsets;      /* of one target */
    memory_budget *budget;
    ffd_error *error;
} target_work;

/* Finds or adds the slider of a key. *slider: its index. */
static ffd_status find_slider(target_work *w, const byte_buffer *key, const char *name, double weight,
                              size_t *slider)
{
    view_scene *const scene = w->scene;
    uint32_t index;
    if (key->failed || !ffd_intern(&w->keys, key->data, key->size, &index))
        return ffd_fail_memory(w->error);
    *slider = index;
    if (index < scene->slider_count)
        return FFD_OK;
    if (!ffd_grow((void **)&scene->sliders, &w->slider_capacity, scene->slider_count + 1,
                  sizeof *scene->sliders))
        return ffd_fail_memory(w->error);
    view_slider *const to = &scene->sliders[scene->slider_count++];
    *to = (view_slider){.name = ffd_text_copy(name), .weight = weight};
    return to->name ? FFD_OK : ffd_fail_memory(w->error);
}

/* Targets of one name and one weight have one slider, in all meshes that a file shows; those without a name
   have one in each mesh, and are called as unnamed animations are. */
static ffd_status slider_of(target_work *w, const mesh_target *target, size_t *slider)
{
    const double weight = w->desc->stored ? 0 : target->weight;
    char name[40];
    byte_buffer key = {0};
    snprintf(name, sizeof name, "target %zu", target->number);
    if (target->name)
        ffd_buffer_format(&key, "n%.17g ", weight);
    else
        ffd_buffer_format(&key, "u%.17g %zu ", weight, target->mesh);
    ffd_buffer_text(&key, target->name ? target->name : name);
    const ffd_status status = find_slider(w, &key, target->name ? target->name : name, weight, slider);
    ffd_buffer_free(&key);
    return status;
}

static bool moves(const float offset[3])
{
    return isfinite(offset[0] + offset[1] + offset[2]) &&
           (offset[0] != 0 || offset[1] != 0 || offset[2] != 0);
}

/* Keeps what moves of `count` offsets, which are those of the document's vertices from `first` on. */
static ffd_status keep_moving(const target_work *w, size_t first, size_t count, const double *offsets,
                              view_target *to)
{
    size_t kept = 0;
    for (int pass = 0; pass < 2; pass++) {
        kept = 0;
        for (size_t i = 0; i < count; i++) {
            const float offset[3] = {(float)offsets[3 * i], (float)offsets[3 * i + 1],
                                     (float)offsets[3 * i + 2]};
            const uint32_t vertex = w->places[first + i];
            if (vertex == VIEW_NONE || !moves(offset))
                continue;
            if (pass == 1) {
                to->vertices[kept] = vertex;
                memcpy(to->offsets + 3 * kept, offset, sizeof offset);
            }
            kept++;
        }
        if (pass == 1)
            break;
        TRY(ffd_budget_take(w->budget, kept, sizeof *to->vertices + 3 * sizeof *to->offsets, w->error));
        to->vertices = ffd_alloc(kept, sizeof *to->vertices);
        to->offsets = ffd_alloc(kept, 3 * sizeof *to->offsets);
        if (!to->vertices || !to->offsets)
            return ffd_fail_memory(w->error);
    }
    to->count = kept;
    return FFD_OK;
}

bool ffd_view_replaces(const char *const *names, size_t count, const mesh_target *target)
{
    size_t k = 0;
    while (target->name && k < count && strcmp(target->name, names[k]) != 0)
        k++;
    return target->name && k < count;
}

/* Adds the targets that a document has. */
static ffd_status add_own(target_work *w, mesh_document *document, int side, bool after)
{
    view_target_list *const list = &w->scene->targets[side];
    for (size_t t = 0; t < w->targets.count; t++) {
        const mesh_target *const from = &w->targets.list[t];
        if (side == 1 && ffd_view_replaces(w->desc->morph_names, w->desc->morph_count, from))
            continue;
        view_target *const to = &list->list[list->count++];
        *to = (view_target){.rig_weight = from->rig_weight};
        TRY(slider_of(w, from, &to->slider));
        document->format->morphs->read_target(document, from, after, w->offsets);
        TRY(keep_moving(w, w->first[from->part], document->parts[from->part].vertex_count, w->offsets, to));
    }
    return FFD_OK;
}

/* Adds the targets that the lattices make, in full: this is how the shape after has them. */
static ffd_status add_new(target_work *w)
{
    view_target_list *const list = &w->scene->targets[1];
    const view_targets_desc *const desc = w->desc;
    const size_t count = (size_t)ffd_mesh_vertex_count(desc->before);
    for (size_t k = 0; k < desc->morph_count; k++) {
        view_target *const to = &list->list[list->count++];
        byte_buffer key = {0};
        *to = (view_target){.rig_weight = RIG_NONE};
        ffd_buffer_format(&key, "m%s", desc->morph_names[k]);
        const ffd_status status = find_slider(w, &key, desc->morph_names[k], 1, &to->slider);
        ffd_buffer_free(&key);
        TRY(status);
        for (size_t i = 0; i < 3 * count; i++)
            w->offsets[i] = (double)desc->morphs->moves[k][i];
        TRY(keep_moving(w, 0, count, w->offsets, to));
    }
    return FFD_OK;
}

static ffd_status make_arrays(target_work *w, const mesh_document *document, int side)
{
    const size_t count = (size_t)ffd_mesh_vertex_count(document);
    TRY(ffd_budget_check(w->budget, count, sizeof *w->places + 3 * sizeof *w->offsets, w->error));
    w->places = ffd_alloc(count, sizeof *w->places);
    w->offsets = ffd_alloc(count, 3 * sizeof *w->offsets);
    w->scene->targets[side].list =
        ffd_alloc_zero(w->targets.count + w->desc->morph_count, sizeof(view_target));
    if (!w->places || !w->offsets || !w->scene->targets[side].list)
        return ffd_fail_memory(w->error);
    for (size_t i = 0; i < count; i++)
        w->places[i] = VIEW_NONE;
    for (size_t v = 0; v < w->scene->vertex_count; v++)
        w->places[ffd_view_vertex_of(w->scene, side, v)] = (uint32_t)v;
    return ffd_first_vertices(document, &w->first, w->error);
}

/* A file has no results of its targets where the shape that default weights show was deformed as a whole.
   They are made here. */
static ffd_status deform_targets(const deform_job *job, mesh_document *document, ffd_error *error)
{
    const mesh_results results = {.state = MESH_STORED};
    const mesh_pass pass = {.document = document,
                            .state = MESH_STORED,
                            .chain = &job->chain,
                            .links = job->chain.count,
                            .weights = ffd_job_weights(job),
                            .rigid = ffd_job_rigid(job),
                            .threads = job->threads,
                            .embedding = job->desc->embedding.path ? &job->embedding : NULL,
                            .write = true};
    pass_totals totals;
    TRY(document->format->begin_results(document, &results, error));
    return ffd_pass_over_mesh(&pass, &totals, error);
}

static ffd_status make_side(target_work *w, mesh_document *document, int side, bool after)
{
    const mesh_morph_calls *const calls = document->format->morphs;
    w->budget = &document->budget;
    ffd_status status;
    TRY_END(calls ? calls->list_targets(document, &w->targets, w->error) : FFD_OK);
    if (w->targets.count == 0 && !(side == 1 && w->desc->morph_count > 0))
        goto end;
    if (after && w->targets.count > 0 && w->desc->job->converts)
        TRY_END(deform_targets(w->desc->job, document, w->error));
    TRY_END(make_arrays(w, document, side));
    TRY_END(add_own(w, document, side, after));
    if (side == 1)
        TRY_END(add_new(w));
end:
    ffd_mesh_targets_free(&w->targets);
    ffd_free(w->first);
    ffd_free(w->places);
    ffd_free(w->offsets);
    w->first = NULL;
    w->places = NULL;
    w->offsets = NULL;
    return status;
}

/* Sliders that nobody asked for do not make the view fail at a limit. */
ffd_status ffd_view_add_targets(const view_targets_desc *desc, view_scene *scene, ffd_error *error)
{
    ffd_error own = {0};
    target_work w = {.desc = desc, .scene = scene, .error = &own};
    ffd_status status;
    scene->same_targets = !desc->after && !desc->deforms && desc->morph_count == 0;
    TRY_END(make_side(&w, desc->before, 0, false));
    if (!scene->same_targets)
        TRY_END(make_side(&w, desc->after ? desc->after : desc->before, 1, desc->deforms));
end:
    ffd_intern_free(&w.keys);
    if (status == FFD_E_LIMIT) {
        ffd_log_line(desc->log, FFD_LOG_WARNING, "the sliders of morph targets are left out: %s",
                     own.message);
        ffd_view_scene_free_targets(scene);
        return FFD_OK;
    }
    if (status && error)
        *error = own;
    return status;
}
