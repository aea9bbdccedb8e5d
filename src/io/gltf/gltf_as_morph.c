/* gltf_as_morph.c - stores deformations as further morph targets, or in place of targets of the same name.
   The model gets targets of zeros; the results, which are offsets, become theirs. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_morphs.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_parts.h"

/* Moves the results of the current target, which are complete, from the streams to document->morphs. */
static ffd_status finish_target(gltf_document *d, ffd_error *error)
{
    const size_t count = d->base.part_count * GLTF_DEFORMED;
    gltf_morph morph = {.name = d->morph_name, .normals = d->results.directions, .result_count = count};
    if (!ffd_grow((void **)&d->morphs, &d->morph_capacity, d->morph_count + 1, sizeof *d->morphs))
        return ffd_fail_memory(error);
    morph.results = ffd_alloc_zero(count, sizeof *morph.results);
    if (!morph.results)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < count; i++) {
        gltf_stream *const stream = &d->parts[i / GLTF_DEFORMED].streams[i % GLTF_DEFORMED];
        morph.results[i] = stream->result;
        stream->result = NULL;
        ffd_gltf_free_result(stream);
    }
    d->morphs[d->morph_count++] = morph;
    d->morph_name = NULL;
    return FFD_OK;
}

ffd_status ffd_gltf_keep_base(mesh_document *document, const char *name, ffd_error *error)
{
    gltf_document *d = (gltf_document *)document;
    TRY(d->morph_name ? finish_target(d, error) : FFD_OK);
    d->morph_name = ffd_text_copy(name);
    if (!d->morph_name)
        return ffd_fail_memory(error);
    return FFD_OK;
}

ffd_status ffd_gltf_keep_clips(mesh_document *document, const morph_clip *clips, size_t count,
                               const char *const *names, size_t name_count, ffd_error *error)
{
    gltf_document *d = (gltf_document *)document;
    d->clips = clips;
    d->clip_count = count;
    const ffd_status status = ffd_gltf_check_clips(d, clips, count, names, name_count, error);
    if (status)
        ffd_fail_name_file(error, d->name);
    return status;
}

static bool is_moved(const gltf_document *d, const gltf_morph *morph, size_t part, size_t semantic)
{
    const float *result = ffd_gltf_morph_result(morph, part, semantic);
    for (size_t i = 0; result && i < 3 * d->mesh_parts[part].vertex_count; i++)
        if (result[i] < 0 || result[i] > 0)
            return true;
    return false;
}

/* moved caches the answers, one per stream of a part: 1 + the answer; 0: not computed yet. */
static bool is_stream_moved(const gltf_document *d, const gltf_morph *morph, size_t part, size_t semantic,
                            unsigned char *moved)
{
    if (part == GLTF_NONE)
        return false;
    unsigned char *known = &moved[part * GLTF_DEFORMED + semantic];
    if (*known == 0)
        *known = (unsigned char)(1 + is_moved(d, morph, part, semantic));
    return *known > 1;
}

/* Which meshes a target is for. */
typedef struct morph_marks {
    unsigned char *known; /* cache of is_stream_moved */
    bool *moved;          /* per mesh: whether it changes under a node */
    bool *selected;       /* per mesh: whether a selected node shows it */
    bool any_moved;
} morph_marks;

/* Marks the selected meshes, and among them those that change under a node. */
static void mark_meshes(const gltf_document *d, const gltf_morph *morph, morph_marks *marks)
{
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_instance *const instance = &d->instances[i];
        const size_t m = instance->primitive->mesh;
        const bool shown = instance->selected && instance->part[GLTF_POSITION] != GLTF_NONE;
        marks->selected[m] = marks->selected[m] || shown;
        for (size_t s = 0; s < GLTF_DEFORMED && instance->selected && !marks->moved[m]; s++)
            marks->moved[m] = is_stream_moved(d, morph, instance->part[s], s, marks->known);
        marks->any_moved = marks->any_moved || marks->moved[m];
    }
}

/* Sets the places of a target. A mesh gets it if it changed, or if it has one of the same name, which would
   be out of date. If nothing changed at all, every selected mesh gets it, unless still ones are dropped.
   Returns whether memory sufficed. */
static bool choose_places(const gltf_document *d, const morph_marks *marks, bool drops_still,
                          gltf_morph *morph, bool *any)
{
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        size_t named, found;
        if (!ffd_gltf_find_target(d, m, morph->name, &named, &found))
            return false;
        const bool gets = marks->moved[m] ||
                          (marks->selected[m] && ((!marks->any_moved && !drops_still) || named != GLTF_NONE));
        *any = *any || gets;
        morph->places[m] = !gets ? GLTF_NONE : named != GLTF_NONE ? named : d->mesh_uses[m].target_count;
    }
    return true;
}

/* Adds one target to the model. */
static ffd_status add_target(gltf_edit *edit, gltf_morph *morph, bool drops_still, const mesh_log *log,
                             ffd_error *error)
{
    const gltf_document *const d = edit->document;
    const size_t count = d->model.mesh_count;
    bool any = false;
    morph_marks marks = {.known = ffd_alloc_zero(d->base.part_count, GLTF_DEFORMED),
                         .moved = ffd_alloc_zero(count, sizeof *marks.moved),
                         .selected = ffd_alloc_zero(count, sizeof *marks.selected)};
    morph->places = ffd_alloc(count, sizeof *morph->places);
    bool made = marks.known && marks.moved && marks.selected && morph->places;
    if (made) {
        mark_meshes(d, morph, &marks);
        made = choose_places(d, &marks, drops_still, morph, &any);
    }
    ffd_free(marks.known);
    ffd_free(marks.moved);
    ffd_free(marks.selected);
    if (!made)
        return ffd_fail_memory(error);
    if (!any && drops_still)
        return FFD_OK;
    if (!any) {
        ffd_log_line(log, FFD_LOG_WARNING, "the file has no mesh that could get the morph target");
        return FFD_OK;
    }
    if (!marks.any_moved && !drops_still)
        ffd_log_line(log, FFD_LOG_WARNING, "no vertex moves: all offsets of the morph target are 0");
    return ffd_gltf_add_target(edit, morph, log, error);
}

/* Lends a target's results to the primitives that have it. */
static void lend_results(const gltf_document *d, const gltf_morph *morph)
{
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_instance *const instance = &d->instances[i];
        const size_t place = morph->places[instance->primitive->mesh];
        if (place == GLTF_NONE || !instance->selected)
            continue;
        const size_t shape = d->targets[instance->first_target + place];
        for (size_t s = 0; s < GLTF_DEFORMED && shape != GLTF_NONE; s++)
            if (d->parts[shape].streams[s].accessor != GLTF_NONE && instance->part[s] != GLTF_NONE)
                d->parts[shape].streams[s].result = morph->results[instance->part[s] * GLTF_DEFORMED + s];
    }
}

/* Takes them back. */
static void take_results(const gltf_document *d)
{
    for (size_t i = d->base.part_count; i < ffd_gltf_part_count(d); i++)
        for (size_t s = 0; s < GLTF_DEFORMED; s++)
            d->parts[i].streams[s].result = NULL;
}

/* Warns of meshes that now have more targets than many viewers play. */
static void warn_of_many(const gltf_document *d, const mesh_log *log)
{
    size_t meshes = 0, most = 0;
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        const size_t count = d->mesh_uses[m].target_count;
        if (count <= MORPHS_PLAYED || count <= d->mesh_uses[m].filed_targets)
            continue;
        meshes++;
        most = count > most ? count : most;
    }
    if (meshes > 0)
        ffd_log_line(log, FFD_LOG_WARNING, "%zu %s %zu morph targets: some viewers play only %d", meshes,
                     meshes == 1 ? "mesh has" : "meshes have up to", most, MORPHS_PLAYED);
}

/* Fills the edit with the targets and the animations of their weights. */
static ffd_status fill_edit(gltf_edit *edit, bool drops_still, const mesh_log *log, ffd_error *error)
{
    gltf_document *const d = edit->document;
    for (size_t k = 0; k < d->morph_count; k++) {
        mesh_log_label label;
        const mesh_log labelled = ffd_log_morph(log, d->morphs[k].name, &label);
        TRY(add_target(edit, &d->morphs[k], drops_still, d->morph_count > 1 ? &labelled : log, error));
    }
    TRY(edit->any ? ffd_gltf_make_shapes(d, error) : FFD_OK);
    TRY(ffd_gltf_animate_weights(edit, error));
    warn_of_many(d, log);
    return FFD_OK;
}

/* Returns how many of the targets a mesh gets, at most. */
static size_t count_new_targets(const gltf_document *d)
{
    size_t most = 0;
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        size_t count = 0;
        for (size_t k = 0; k < d->morph_count; k++)
            count += d->morphs[k].places[m] != GLTF_NONE;
        most = count > most ? count : most;
    }
    return most;
}

static ffd_status save_as_morph(mesh_document *document, const mesh_save_options *options,
                                file_output *output, const mesh_log *log, ffd_error *error)
{
    gltf_document *const d = (gltf_document *)document;
    ffd_status status;
    TRY_END(finish_target(d, error));
    d->edit->log = log;
    status = fill_edit(d->edit, options->animated, log, error);
    if (options->animated && !status)
        options->animated->targets = count_new_targets(d);
    if (options->bytes_left)
        *options->bytes_left = d->edit->bytes_left;
    TRY_END(status);
    for (size_t k = 0; k < d->morph_count; k++)
        lend_results(d, &d->morphs[k]);
    status = ffd_gltf_save_results(document, options, output, log, error);
    take_results(d);
end:
    ffd_gltf_clear_edit(d);
    return status;
}

ffd_status ffd_gltf_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                         const mesh_log *log, ffd_error *error)
{
    return ffd_gltf_of(document)->morph_name ? save_as_morph(document, options, output, log, error)
                                             : ffd_gltf_save_results(document, options, output, log, error);
}
