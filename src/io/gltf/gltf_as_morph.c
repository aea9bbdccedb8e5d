/* gltf_as_morph.c - stores deformations as further morph targets, or in place of targets of the same name.
   The file with targets of zeros is opened as a document of its own. This document's results become the
   results of those targets, and that document is saved. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_clip.h"
#include "io/gltf/edit/gltf_left_bytes.h"
#include "io/gltf/edit/gltf_morph_text.h"
#include "io/gltf/edit/gltf_target_names.h"
#include "io/gltf/gltf_open.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_results.h"
#include "io/gltf/read/gltf_document.h"
#include "io/gltf/read/gltf_users.h"
#include <string.h>

/* Moves the results of the current target, which are complete, from the streams to document->morphs. */
static ffd_status finish_target(gltf_document *d, ffd_error *error)
{
    const size_t count = d->base.part_count * GLTF_DEFORMED;
    gltf_morph morph = {.name = d->morph_name, .normals = d->morph_normals, .result_count = count};
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
    d->base.keeps_base = true;
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

/* Which meshes get a target, and where. */
typedef struct morph_marks {
    const gltf_morph *morph;
    unsigned char *known; /* cache of is_stream_moved */
    bool *meshes;         /* per mesh: whether it gets the target */
    bool *selected;       /* per mesh: whether a selected node shows it */
    size_t *named;        /* per mesh: its own target of that name (ffd_gltf_find_target) */
    /* Per mesh: index of the new target among the mesh's targets; GLTF_NONE: it gets none. */
    size_t *places;
    bool any, moved; /* whether any mesh gets the target; whether any mesh changed */
} morph_marks;

static bool make_marks(const gltf_document *d, const gltf_morph *morph, morph_marks *marks)
{
    const size_t count = d->model.mesh_count;
    *marks = (morph_marks){.morph = morph,
                           .known = ffd_alloc_zero(d->base.part_count, GLTF_DEFORMED),
                           .meshes = ffd_alloc_zero(count, sizeof *marks->meshes),
                           .selected = ffd_alloc_zero(count, sizeof *marks->selected),
                           .named = ffd_alloc(count, sizeof *marks->named),
                           .places = ffd_alloc(count, sizeof *marks->places)};
    return marks->known && marks->meshes && marks->selected && marks->named && marks->places;
}

static void free_marks(morph_marks *marks)
{
    ffd_free(marks->known);
    ffd_free(marks->meshes);
    ffd_free(marks->selected);
    ffd_free(marks->named);
    ffd_free(marks->places);
}

/* Marks the selected meshes, and among them those that change under a node. */
static void mark_moved(const gltf_document *d, morph_marks *marks)
{
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_instance *const instance = &d->instances[i];
        const size_t m = instance->primitive->mesh;
        const bool shown = instance->selected && instance->part[GLTF_POSITION] != GLTF_NONE;
        marks->selected[m] = marks->selected[m] || shown;
        for (size_t s = 0; s < GLTF_DEFORMED && instance->selected && !marks->meshes[m]; s++)
            marks->meshes[m] = is_stream_moved(d, marks->morph, instance->part[s], s, marks->known);
        marks->moved = marks->moved || marks->meshes[m];
    }
}

/* A mesh gets the target if it changed, or if it has one of the same name, which would be out of date. If
   nothing changed at all, every selected mesh gets it. file: the document as it is now, which may have
   further targets. */
static ffd_status mark_meshes(const gltf_document *d, const gltf_document *file, morph_marks *marks,
                              ffd_error *error)
{
    mark_moved(d, marks);
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        size_t found;
        if (!ffd_gltf_find_target(file, m, marks->morph->name, &marks->named[m], &found))
            return ffd_fail_memory(error);
        marks->meshes[m] =
            marks->meshes[m] || (marks->selected[m] && (!marks->moved || marks->named[m] != GLTF_NONE));
        marks->any = marks->any || marks->meshes[m];
        marks->places[m] = !marks->meshes[m]              ? GLTF_NONE
                           : marks->named[m] != GLTF_NONE ? marks->named[m]
                                                          : file->mesh_uses[m].target_count;
    }
    return FFD_OK;
}

/* Lends a target's results to the primitives of the other document, or takes them back. Both documents have
   the same instances in the same order. */
static void lend_results(const gltf_document *d, const morph_marks *marks, bool back, gltf_document *other)
{
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_instance *from = &d->instances[i];
        gltf_instance *to = &other->instances[i];
        const size_t mesh = from->primitive->mesh;
        to->selected = from->selected;
        if (!marks->meshes[mesh] || !from->selected)
            continue;
        const size_t shape = other->targets[to->first_target + marks->places[mesh]];
        for (size_t s = 0; s < GLTF_DEFORMED && shape != GLTF_NONE; s++)
            if (other->parts[shape].streams[s].accessor != GLTF_NONE && from->part[s] != GLTF_NONE)
                other->parts[shape].streams[s].result =
                    back ? NULL : marks->morph->results[from->part[s] * GLTF_DEFORMED + s];
    }
}

/* The file, to which one target after another is added. */
typedef struct morph_file {
    const gltf_document *source;
    mesh_document *made; /* NULL: no target is added yet */
    file_input bytes;    /* of made */
    uint64_t bytes_left; /* bytes of replaced data that nothing uses any more */
} morph_file;

static const gltf_document *current(const morph_file *file)
{
    return file->made ? ffd_gltf_of(file->made) : file->source;
}

static void close_file(morph_file *file)
{
    ffd_gltf_close(file->made);
    ffd_file_unload(&file->bytes);
    file->made = NULL;
    file->bytes = (file_input){0};
}

/* Continues with bytes, the file made from the current one. Takes ownership of them. */
static ffd_status reopen(morph_file *file, file_input *bytes, ffd_error *error)
{
    const gltf_document *const d = file->source;
    const ffd_format format = d->binary ? FFD_FORMAT_GLB : FFD_FORMAT_GLTF;
    const ffd_source source = {.path = d->path,
                               .format = format,
                               .space = d->space,
                               .resolve = d->base.folder.resolve,
                               .resolve_user = d->base.folder.user};
    memory_budget budget = d->base.budget;
    budget.is_shared = true;
    close_file(file);
    file->bytes = *bytes;
    *bytes = (file_input){0};
    TRY(ffd_budget_take(&budget, file->bytes.size, 1, error));
    return ffd_gltf_open_within(&file->bytes, &source, &budget, &file->made, error);
}

static bool replaces(const gltf_document *d, const morph_marks *marks)
{
    for (size_t m = 0; m < d->model.mesh_count; m++)
        if (marks->meshes[m] && marks->named[m] != GLTF_NONE)
            return true;
    return false;
}

/* Continues with a file in which a target replaced another one, which may leave unused bytes. */
static ffd_status reopen_replaced(morph_file *file, file_input *bytes, const char *name, const mesh_log *log,
                                  ffd_error *error)
{
    const size_t count = current(file)->model.accessor_count;
    unsigned char *const before = ffd_gltf_count_users(current(file), NULL);
    ffd_status status = before ? reopen(file, bytes, error) : ffd_fail_memory(error);
    if (!status)
        status = ffd_gltf_warn_of_left(current(file), before, count, name, log, &file->bytes_left, error);
    ffd_free(before);
    return status;
}

/* Adds one target to the file. */
static ffd_status add_target(morph_file *file, morph_marks *marks, const mesh_log *log, ffd_error *error)
{
    const morph_request request = {file->source, marks->morph, marks->meshes, marks->places, log};
    file_input bytes = {0};
    TRY(mark_meshes(file->source, current(file), marks, error));
    if (!marks->any) {
        ffd_log_line(log, FFD_LOG_WARNING, "the file has no mesh that could get the morph target");
        return FFD_OK;
    }
    if (!marks->moved)
        ffd_log_line(log, FFD_LOG_WARNING, "no vertex moves: all offsets of the morph target are 0");
    ffd_status status = ffd_gltf_add_target(current(file), &request, &bytes, error);
    if (!status)
        status = replaces(file->source, marks) ? reopen_replaced(file, &bytes, marks->morph->name, log, error)
                                               : reopen(file, &bytes, error);
    ffd_file_unload(&bytes);
    return status;
}

static ffd_status add_targets(morph_file *file, morph_marks *marks, const mesh_log *log, ffd_error *error)
{
    const gltf_document *const d = file->source;
    for (size_t k = 0; k < d->morph_count; k++) {
        mesh_log_label label;
        if (!make_marks(d, &d->morphs[k], &marks[k]))
            return ffd_fail_memory(error);
        const mesh_log labelled = ffd_log_morph(log, d->morphs[k].name, &label);
        TRY(add_target(file, &marks[k], d->morph_count > 1 ? &labelled : log, error));
    }
    return FFD_OK;
}

static ffd_status add_clips(morph_file *file, const morph_marks *marks, const mesh_log *log, ffd_error *error)
{
    const gltf_document *const d = file->source;
    file_input bytes = {0};
    clip_target *const targets = ffd_alloc(d->morph_count, sizeof *targets);
    if (!targets)
        return ffd_fail_memory(error);
    for (size_t k = 0; k < d->morph_count; k++)
        targets[k] = (clip_target){d->morphs[k].name, marks[k].places};
    ffd_status status = ffd_gltf_add_clips(current(file), d->clips, d->clip_count, targets, d->morph_count,
                                           log, &bytes, &file->bytes_left, error);
    if (!status && bytes.data)
        status = reopen(file, &bytes, error);
    ffd_file_unload(&bytes);
    ffd_free(targets);
    return status;
}

/* Warns of meshes that now have more targets than many viewers play. */
static void warn_of_many(const gltf_document *d, const gltf_document *file, const mesh_log *log)
{
    size_t meshes = 0, most = 0;
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        const size_t count = file->mesh_uses[m].target_count;
        if (count <= MORPHS_PLAYED || count <= d->mesh_uses[m].target_count)
            continue;
        meshes++;
        most = count > most ? count : most;
    }
    if (meshes > 0)
        ffd_log_line(log, FFD_LOG_WARNING, "%zu %s %zu morph targets: some viewers play only %d", meshes,
                     meshes == 1 ? "mesh has" : "meshes have up to", most, MORPHS_PLAYED);
}

static ffd_status save_file(const morph_file *file, const morph_marks *marks,
                            const mesh_save_options *options, file_output *output, const mesh_log *log,
                            ffd_error *error)
{
    const gltf_document *const d = file->source;
    gltf_document *const other = (gltf_document *)file->made;
    other->base.sparse_targets = d->base.sparse_targets;
    other->own_accessors = other->model.accessor_count - d->model.accessor_count;
    for (size_t k = 0; k < d->morph_count; k++)
        lend_results(d, &marks[k], false, other);
    const ffd_status status = ffd_gltf_save_results(&other->base, options, output, log, error);
    for (size_t k = 0; k < d->morph_count; k++)
        lend_results(d, &marks[k], true, other);
    return status;
}

static ffd_status save_as_morph(mesh_document *document, const mesh_save_options *options,
                                file_output *output, const mesh_log *log, ffd_error *error)
{
    gltf_document *d = (gltf_document *)document;
    morph_file file = {.source = d};
    ffd_status status = finish_target(d, error);
    morph_marks *const marks = ffd_alloc_zero(d->morph_count, sizeof *marks);
    if (!status && !marks)
        status = ffd_fail_memory(error);
    if (!status)
        status = add_targets(&file, marks, log, error);
    if (!status && d->clip_count > 0)
        status = add_clips(&file, marks, log, error);
    if (!status)
        warn_of_many(d, current(&file), log);
    if (options->bytes_left)
        *options->bytes_left = file.bytes_left;
    if (!status)
        status = file.made ? save_file(&file, marks, options, output, log, error)
                           : ffd_gltf_save_results(document, options, output, log, error);
    close_file(&file);
    for (size_t k = 0; k < d->morph_count && marks; k++)
        free_marks(&marks[k]);
    ffd_free(marks);
    return status;
}

ffd_status ffd_gltf_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                         const mesh_log *log, ffd_error *error)
{
    return ffd_gltf_of(document)->morph_name ? save_as_morph(document, options, output, log, error)
                                             : ffd_gltf_save_results(document, options, output, log, error);
}
