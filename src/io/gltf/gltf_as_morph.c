/* gltf_as_morph.c - the deformation as a further morph target, or in place of one with its name. The file
   with a target of zeros is opened as a document of its own; the results of this document become the results
   of that target, and that document is saved. */
#include "io/gltf/gltf_as_morph.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/gltf/gltf_open.h"
#include "io/gltf/morph/gltf_morph_text.h"
#include "io/gltf/save/gltf_save.h"
#include "io/gltf/scene/gltf_results.h"
#include <string.h>

ffd_status ffd_gltf_keep_base(mesh_document *document, const char *name, ffd_error *error)
{
    gltf_document *d = (gltf_document *)document;
    d->morph_name = ffd_text_copy(name);
    if (!d->morph_name)
        return ffd_fail_memory(error);
    d->base.keeps_base = true;
    return FFD_OK;
}

static bool is_moved(const gltf_document *d, size_t part, size_t semantic)
{
    const float *result = d->parts[part].streams[semantic].result;
    for (size_t i = 0; result && i < 3 * d->mesh_parts[part].vertex_count; i++)
        if (result[i] < 0 || result[i] > 0)
            return true;
    return false;
}

/* moved caches the answers, one per stream of a part: 1 + the answer; 0: not known yet. */
static bool is_stream_moved(const gltf_document *d, size_t part, size_t semantic, unsigned char *moved)
{
    if (part == GLTF_NONE)
        return false;
    unsigned char *known = &moved[part * GLTF_DEFORMED + semantic];
    if (*known == 0)
        *known = (unsigned char)(1 + is_moved(d, part, semantic));
    return *known > 1;
}

/* The meshes that get the target. */
typedef struct morph_marks {
    bool *meshes;    /* gets it */
    bool *selected;  /* some node shows it, and is selected */
    size_t *named;   /* its target of the name (ffd_gltf_find_target) */
    bool any, moved; /* some mesh gets it; some mesh changed */
} morph_marks;

/* Marks the meshes that are selected, and those of them that changed under some node. */
static void mark_moved(const gltf_document *d, unsigned char *moved, morph_marks *marks)
{
    const gltf_instance *instance = d->instances;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t k = 0; k < d->model.meshes[m].primitive_count * d->mesh_uses[m].node_count;
             k++, instance++) {
            const bool shown = instance->selected && instance->part[GLTF_POSITION] != GLTF_NONE;
            marks->selected[m] = marks->selected[m] || shown;
            for (size_t s = 0; s < GLTF_DEFORMED && instance->selected && !marks->meshes[m]; s++)
                marks->meshes[m] = is_stream_moved(d, instance->part[s], s, moved);
            marks->moved = marks->moved || marks->meshes[m];
        }
}

/* A mesh gets the target where it changed, and where it has one of the name, which would be out of date;
   where nothing changed at all, every mesh does. */
static void mark_meshes(const gltf_document *d, unsigned char *moved, morph_marks *marks)
{
    mark_moved(d, moved, marks);
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        marks->named[m] = ffd_gltf_find_target(d, m);
        marks->meshes[m] =
            marks->meshes[m] || (marks->selected[m] && (!marks->moved || marks->named[m] != GLTF_NONE));
        marks->any = marks->any || marks->meshes[m];
    }
}

/* Lends the results to the targets of the other document's primitives, or takes them back. Both have the same
   instances in the same order. */
static void lend_results(const gltf_document *d, const morph_marks *marks, bool back, gltf_document *other)
{
    size_t k = 0;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count; p++)
            for (size_t n = 0; n < d->mesh_uses[m].node_count; n++, k++) {
                const gltf_instance *from = &d->instances[k];
                gltf_instance *to = &other->instances[k];
                to->selected = from->selected;
                if (!marks->meshes[m] || !from->selected)
                    continue;
                const size_t place =
                    ffd_gltf_target_place(&d->model.meshes[m].primitives[p], marks->named[m]);
                const size_t shape = other->targets[to->first_target + place];
                for (size_t s = 0; s < GLTF_DEFORMED && shape != GLTF_NONE; s++)
                    if (other->parts[shape].streams[s].accessor != GLTF_NONE && from->part[s] != GLTF_NONE)
                        other->parts[shape].streams[s].result =
                            back ? NULL : d->parts[from->part[s]].streams[s].result;
            }
}

static ffd_status save_with_target(const gltf_document *d, const morph_marks *marks,
                                   const mesh_save_options *options, file_output *output, const mesh_log *log,
                                   ffd_error *error)
{
    const ffd_format format = d->binary ? FFD_FORMAT_GLB : FFD_FORMAT_GLTF;
    const ffd_source source = {.path = d->path, .format = format, .space = d->space};
    memory_budget budget = d->base.budget;
    budget.is_shared = true;
    mesh_document *other = NULL;
    file_input file = {0};
    ffd_status status = ffd_gltf_add_target(d, marks->meshes, marks->named, log, &file, error);
    if (status == FFD_OK)
        status = ffd_budget_take(&budget, file.size, 1, error);
    if (status == FFD_OK)
        status = ffd_gltf_open_within(&file, &source, &budget, &other, error);
    if (status == FFD_OK) {
        ((gltf_document *)other)->own_accessors =
            ffd_gltf_of(other)->model.accessor_count - d->model.accessor_count;
        lend_results(d, marks, false, (gltf_document *)other);
        status = ffd_gltf_save_results(other, options, output, log, error);
        lend_results(d, marks, true, (gltf_document *)other);
    }
    ffd_gltf_close(other);
    ffd_file_unload(&file);
    return status;
}

static void drop_results(gltf_document *d)
{
    for (size_t i = 0; i < d->base.part_count; i++)
        for (int s = 0; s < GLTF_DEFORMED; s++)
            ffd_gltf_free_result(&d->parts[i].streams[s]);
    ffd_free(d->morph_name);
    d->morph_name = NULL;
}

static ffd_status save_as_morph(mesh_document *document, const mesh_save_options *options,
                                file_output *output, const mesh_log *log, ffd_error *error)
{
    gltf_document *d = (gltf_document *)document;
    morph_marks marks = {.meshes = ffd_alloc_zero(d->model.mesh_count, sizeof *marks.meshes),
                         .selected = ffd_alloc_zero(d->model.mesh_count, sizeof *marks.selected),
                         .named = ffd_alloc(d->model.mesh_count, sizeof *marks.named)};
    unsigned char *moved = ffd_alloc_zero(d->base.part_count, GLTF_DEFORMED);
    const bool allocated = marks.meshes && marks.selected && marks.named && moved;
    ffd_status status;
    if (allocated)
        mark_meshes(d, moved, &marks);
    if (!allocated) {
        status = ffd_fail_memory(error);
    } else if (marks.any) {
        if (!marks.moved)
            ffd_log_line(log, FFD_LOG_WARNING, "no vertex moves: all offsets of the morph target are 0");
        status = save_with_target(d, &marks, options, output, log, error);
    } else {
        ffd_log_line(log, FFD_LOG_WARNING, "the file has no mesh that could get the morph target");
        drop_results(d);
        status = ffd_gltf_save_results(document, options, output, log, error);
    }
    ffd_free(marks.meshes);
    ffd_free(marks.selected);
    ffd_free(marks.named);
    ffd_free(moved);
    return status;
}

ffd_status ffd_gltf_save(mesh_document *document, const mesh_save_options *options, file_output *output,
                         const mesh_log *log, ffd_error *error)
{
    return ffd_gltf_of(document)->morph_name ? save_as_morph(document, options, output, log, error)
                                             : ffd_gltf_save_results(document, options, output, log, error);
}
