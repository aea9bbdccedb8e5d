/* gltf_open.c - opens and closes a document. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/text/content.h"
#include "base/text/words.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/model/gltf_faults.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_instancing.h"
#include "io/gltf/model/gltf_parts.h"
#include "io/gltf/model/gltf_refuse.h"
#include "io/gltf/model/gltf_scene.h"
#include "io/gltf/model/gltf_skin.h"
#include "io/gltf/model/gltf_splats.h"
#include "io/gltf/model/gltf_vrm.h"
#include "io/gltf/read/gltf_check.h"
#include "io/gltf/read/gltf_contents.h"
#include "io/gltf/read/gltf_drawing.h"
#include "io/gltf/read/gltf_formal.h"
#include "io/gltf/read/gltf_hidden.h"
#include "io/gltf/read/gltf_schema.h"
#include "json/json_parse.h"
#include <stdlib.h>
#include <string.h>

/* Upper bounds of what the JSON library and tinygltf need for one object of a list, and of what the model
   keeps of it. */
#define OBJECT_BYTES 1024
#define KEPT_OBJECT_BYTES 256

/* Total bytes of small external buffers that are read into memory: thousands of buffers may name one file.
   Others are mapped, which takes no memory. */
#define MOST_READ ((size_t)1 << 24)

/* Bytes that stay in memory per byte of a file: the file itself. */
#define KEPT_PER_BYTE 1

/* The numbers in the JSON are checked once and used as indices later. Another program must not change them in
   between, which it can in a mapped file (mmap). */
static ffd_status copy_json(gltf_document *d, const char **text, size_t size, ffd_error *error)
{
    TRY(ffd_budget_take(&d->base.budget, size, 1, error));
    d->json = ffd_alloc(size, 1);
    if (!d->json)
        return ffd_fail_memory(error);
    memcpy(d->json, *text, size);
    ffd_file_release_pages(&d->input, *text, size);
    *text = d->json;
    return FFD_OK;
}

/* Whether a text is an object of JSON, by its first characters. */
static bool begins_as_object(const char *text, size_t size)
{
    const content_kind *const kind = ffd_content_kind(text, size);
    return kind && kind->format == FFD_FORMAT_GLTF;
}

/* What is wrong with the container, though its meaning is plain. */
static ffd_status note_container(gltf_document *d, ffd_error *error)
{
    mesh_flaws *const flaws = &d->base.flaws;
    const size_t behind = d->input.size - d->glb.end;
    if (behind > 0)
        TRY(ffd_flaw_line(
            flaws, d->name, 0, error,
            "GLB: %zu %s behind the length that the header states: %s left out when the file changes", behind,
            ffd_plural(behind, "byte stands", "bytes stand"), ffd_plural(behind, "it is", "they are")));
    if (d->glb.uneven > 0)
        TRY(ffd_flaw_line(flaws, d->name, 0, error,
                          "GLB: the size of the chunk at byte %zu is not a multiple of 4",
                          d->glb.uneven - GLB_CHUNK_HEADER_SIZE));
    if (d->glb.more_bins > 0)
        TRY(ffd_flaw_line(flaws, d->name, 0, error, "GLB: %zu more BIN %s not read", d->glb.more_bins,
                          ffd_plural(d->glb.more_bins, "chunk is", "chunks are")));
    return FFD_OK;
}

static ffd_status find_json(gltf_document *d, ffd_format format, ffd_error *error)
{
    const char *text = (const char *)d->input.data;
    size_t size = d->input.size;
    const bool is_glb = ffd_glb_is(d->input.data, d->input.size);
    if (format == FFD_FORMAT_GLB && !is_glb && begins_as_object(text, size))
        return ffd_fail_file(error, FFD_E_INVALID, d->name,
                             "is a glTF file in JSON, not a GLB file: its name must end in .gltf");
    if (format == FFD_FORMAT_GLB || (format == FFD_FORMAT_AUTO && is_glb)) {
        TRY(ffd_glb_parse(d->input.data, d->input.size, d->name, &d->glb, error));
        TRY(note_container(d, error));
        d->binary = true;
        text += d->glb.json_begin;
        size = d->glb.json_size;
    } else if (is_glb) {
        return ffd_fail_file(error, FFD_E_INVALID, d->name, "is a GLB file: its name must end in .glb");
    }
    if (d->input.mapped)
        TRY(copy_json(d, &text, size, error));
    const json_input json = {.text = text,
                             .size = size,
                             .name = d->name,
                             .rules = JSON_ALLOW_MARK | (d->binary ? JSON_NO_LINES : 0)};
    TRY(ffd_json_parse(&json, &d->tree, error));
    return ffd_budget_take(&d->base.budget, d->tree.count, sizeof *d->tree.values, error);
}

static ffd_status list_values(const gltf_document *d, const char *key, gltf_values *list, ffd_error *error)
{
    const uint32_t array = ffd_json_tree_member(&d->tree, 0, key);
    const size_t count = ffd_json_tree_count(&d->tree, array);
    list->values = ffd_alloc(count, sizeof *list->values);
    if (!list->values)
        return ffd_fail_memory(error);
    for (uint32_t v = ffd_json_tree_first(&d->tree, array); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v))
        list->values[list->count++] = v;
    return FFD_OK;
}

static ffd_status list_all_values(gltf_document *d, ffd_error *error)
{
    const struct {
        const char *key;
        gltf_values *list;
    } lists[] = {{"buffers", &d->buffer_values},     {"bufferViews", &d->view_values},
                 {"accessors", &d->accessor_values}, {"meshes", &d->mesh_values},
                 {"nodes", &d->node_values},         {"skins", &d->skin_values},
                 {"materials", &d->material_values}, {"images", &d->image_values},
                 {"textures", &d->texture_values},   {"samplers", &d->sampler_values}};
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        TRY(list_values(d, lists[i].key, lists[i].list, error));
    return FFD_OK;
}

static int compare_files(const void *a, const void *b)
{
    const file_input *const *x = a, *const *y = b;
    return memcmp((*x)->identity, (*y)->identity, sizeof(*x)->identity);
}

/* Takes the buffers' files from the memory budget, each file once even if several buffers name it. */
static ffd_status count_files(gltf_document *d, ffd_error *error)
{
    size_t count = 0;
    const file_input **files = ffd_alloc(d->buffer_values.count, sizeof *files);
    if (!files)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < d->buffer_values.count; i++)
        if (d->buffers[i].kind == BUFFER_FILE)
            files[count++] = &d->buffers[i].file;
    if (count > 0)
        qsort(files, count, sizeof *files, compare_files);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || compare_files(&files[i - 1], &files[i]) != 0)
            ffd_budget_add_file(&d->base.budget, files[i]->size, KEPT_PER_BYTE);
    ffd_free(files);
    return FFD_OK;
}

/* Notes the flaws of a loaded buffer. */
static ffd_status note_buffer(gltf_document *d, size_t i, ffd_error *error)
{
    const gltf_buffer *const buffer = &d->buffers[i];
    const uint32_t value = d->buffer_values.values[i], uri = ffd_json_tree_member(&d->tree, value, "uri");
    if (buffer->flaws & BUFFER_ODD_MARKER)
        TRY(ffd_gltf_flaw(d, uri, error,
                          "the head of the data URI does not end with \";base64\" in small letters"));
    if (buffer->flaws & BUFFER_BLANKS)
        TRY(ffd_gltf_flaw(d, uri, error, "there are blanks in the base64 of the data URI"));
    if (buffer->flaws & BUFFER_BACKSLASH)
        TRY(ffd_gltf_flaw(d, uri, error, "the URI has backslashes for slashes: \"%s\" is read",
                          buffer->path));
    if (buffer->flaws & BUFFER_SHORT)
        TRY(ffd_gltf_flaw(d, value, error, "the buffer has %zu bytes, less than its byteLength %zu",
                          buffer->size, buffer->stated));
    if (buffer->flaws & BUFFER_LONG)
        TRY(ffd_gltf_flaw(d, value, error, "the buffer has %zu bytes, more than its byteLength %zu",
                          buffer->size, buffer->stated));
    return FFD_OK;
}

static ffd_status load_buffers(gltf_document *d, ffd_error *error)
{
    size_t most_read = MOST_READ;
    d->buffers = ffd_alloc_zero(d->buffer_values.count, sizeof *d->buffers);
    if (!d->buffers)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < d->buffer_values.count; i++) {
        const bool bin = i == 0 && d->binary && d->glb.has_bin;
        TRY(ffd_gltf_load_buffer(&d->tree, d->buffer_values.values[i],
                                 bin ? d->input.data + d->glb.bin_begin : NULL, d->glb.bin_size,
                                 &d->base.folder, d->name, &most_read, &d->buffers[i], error));
        if (d->buffers[i].kind == BUFFER_DATA)
            TRY(ffd_budget_take(&d->base.budget, d->buffers[i].size, 1, error));
        TRY(note_buffer(d, i, error));
    }
    return count_files(d, error);
}

/* Counts the primitives that the JSON has. */
static uint64_t count_primitives(const gltf_document *d)
{
    uint64_t count = 0;
    for (size_t m = 0; m < d->mesh_values.count; m++)
        count += ffd_json_tree_count(&d->tree,
                                     ffd_json_tree_member(&d->tree, d->mesh_values.values[m], "primitives"));
    return count;
}

/* Limits the number of objects: one can take as few as 3 bytes of the file. */
static ffd_status limit_objects(gltf_document *d, ffd_error *error)
{
    const uint32_t scenes = ffd_json_tree_member(&d->tree, 0, "scenes");
    const uint64_t count = (uint64_t)d->buffer_values.count + d->view_values.count +
                           d->accessor_values.count + d->mesh_values.count + count_primitives(d) +
                           d->node_values.count + ffd_json_tree_count(&d->tree, scenes);
    TRY(ffd_budget_check(&d->base.budget, count, OBJECT_BYTES, error));
    return ffd_budget_take(&d->base.budget, count, KEPT_OBJECT_BYTES, error);
}

/* Finds the JSON of the model's primitives. Checks that the counts agree, since the model and the JSON are
   used side by side. */
static ffd_status join_json(gltf_document *d, ffd_error *error)
{
    gltf_model *const model = &d->model;
    size_t next = 0;
    bool same = model->view_count == d->view_values.count &&
                model->accessor_count == d->accessor_values.count &&
                model->mesh_count == d->mesh_values.count && model->node_count == d->node_values.count;
    for (size_t m = 0; m < model->mesh_count && same; m++) {
        const uint32_t primitives = ffd_json_tree_member(&d->tree, d->mesh_values.values[m], "primitives");
        same = model->meshes[m].primitive_count == ffd_json_tree_count(&d->tree, primitives);
        for (uint32_t v = ffd_json_tree_first(&d->tree, primitives); v != JSON_NONE && same;
             v = ffd_json_tree_after(&d->tree, v))
            model->primitives[next++].value = v;
    }
    return same ? FFD_OK
                : ffd_fail_file(error, FFD_E_INVALID, d->name,
                                "is not valid glTF: tinygltf did not read all of it");
}

static ffd_status parse_model(gltf_document *d, ffd_error *error)
{
    json_edits integers = {0};
    byte_buffer text = {0};
    ffd_status status;
    TRY_END(ffd_gltf_check_schema(&d->tree, d->name, &integers, error));
    TRY_END(list_all_values(d, error));
    TRY_END(limit_objects(d, error));
    TRY_END(ffd_gltf_write_shown(d, &integers, &text)
                ? ffd_gltf_parse_model(text.data, text.size, d->name, &d->model, error)
                : ffd_fail_memory(error));
end:
    ffd_edits_free(&integers);
    ffd_buffer_free(&text);
    return status;
}

static void free_decoded(gltf_document *d)
{
    for (size_t i = 0; d->decoded_views && i < d->model.view_count; i++)
        ffd_free(d->decoded_views[i]);
    for (size_t i = 0; d->view_exponents && i < d->model.view_count; i++)
        ffd_free(d->view_exponents[i]);
    for (size_t i = 0; d->unpacked && i < d->model.accessor_count; i++)
        ffd_free(d->unpacked[i].bytes);
    for (size_t i = 0; d->draco_problems && i < d->model.primitive_count; i++)
        ffd_free(d->draco_problems[i]);
    ffd_free(d->decoded_views);
    ffd_free(d->view_exponents);
    ffd_free(d->unpacked);
    ffd_free(d->draco_problems);
}

static void free_morphs(gltf_document *d)
{
    for (size_t k = 0; k < d->morph_count; k++) {
        for (size_t i = 0; i < d->morphs[k].result_count; i++)
            ffd_free(d->morphs[k].results[i]);
        ffd_free(d->morphs[k].results);
        ffd_free(d->morphs[k].places);
        ffd_free(d->morphs[k].name);
    }
    ffd_free(d->morphs);
    ffd_free(d->morph_name);
}

static void free_document(gltf_document *d)
{
    gltf_values *const lists[] = {
        &d->buffer_values, &d->view_values,     &d->accessor_values, &d->mesh_values,    &d->node_values,
        &d->skin_values,   &d->material_values, &d->image_values,    &d->texture_values, &d->sampler_values};
    ffd_gltf_free_edit(d);
    for (size_t i = 0; d->parts && i < ffd_gltf_part_count(d); i++) {
        for (int s = 0; s < GLTF_DEFORMED; s++)
            ffd_gltf_free_result(&d->parts[i].streams[s]);
        ffd_free(d->parts[i].selected);
        ffd_free(d->parts[i].used);
    }
    for (size_t i = 0; d->buffers && i < d->buffer_values.count; i++)
        ffd_gltf_free_buffer(&d->buffers[i]);
    for (size_t i = 0; i < sizeof lists / sizeof *lists; i++)
        ffd_free(lists[i]->values);
    ffd_gltf_free_skins(d);
    free_decoded(d);
    ffd_gltf_free_model(&d->model);
    ffd_json_tree_free(&d->tree);
    ffd_free(d->json);
    ffd_free(d->buffers);
    ffd_free(d->layouts);
    ffd_free(d->world);
    ffd_free(d->in_scene);
    ffd_free(d->scene_ranks);
    ffd_free(d->parents);
    ffd_free(d->stands_in);
    ffd_free(d->collides);
    ffd_free(d->selected_nodes);
    ffd_free(d->hidden);
    ffd_free(d->scene_nodes);
    ffd_free(d->mesh_uses);
    ffd_free(d->instances);
    ffd_free(d->parts);
    ffd_free(d->mesh_parts);
    ffd_free(d->shapes);
    ffd_free(d->targets);
    ffd_free(d->instanced_nodes);
    free_morphs(d);
    ffd_free(d->path);
    ffd_free(d);
}

ffd_status ffd_gltf_list_files(const mesh_document *document, path_list *files, ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    for (size_t i = 0; i < d->buffer_values.count; i++) {
        if (d->buffers[i].kind != BUFFER_FILE)
            continue;
        char *path = ffd_path_sibling(d->path, d->buffers[i].path);
        const ffd_status status = path ? ffd_paths_add(files, path, error) : ffd_fail_memory(error);
        ffd_free(path);
        TRY(status);
    }
    return FFD_OK;
}

/* Returns the size of the file and its buffers. */
static uint64_t count_bytes(const gltf_document *d)
{
    uint64_t bytes = d->input.size;
    for (size_t i = 0; i < d->buffer_values.count; i++)
        bytes += d->buffers[i].size;
    return bytes;
}

static ffd_status read_document(gltf_document *d, const ffd_source *source, ffd_error *error)
{
    d->path = ffd_text_copy(source->path);
    if (!d->path)
        return ffd_fail_memory(error);
    TRY(ffd_gltf_make_edit(d, error));
    d->name = ffd_file_display_name(d->path);
    d->base.folder = (file_folder){d->path, source->resolve, source->resolve_user};
    TRY(find_json(d, source->format, error));
    TRY(parse_model(d, error));
    TRY(join_json(d, error));
    TRY(ffd_gltf_read_drawings(d, error));
    TRY(load_buffers(d, error));
    d->threads = ffd_threads_for_bytes(source->threads, count_bytes(d));
    TRY(ffd_gltf_check_contents(d, error));
    ffd_gltf_choose_pages(d);
    d->layouts = ffd_alloc_zero(d->model.accessor_count, sizeof *d->layouts);
    if (!d->layouts)
        return ffd_fail_memory(error);
    TRY(ffd_gltf_check(d, error));
    TRY(ffd_gltf_check_indices(d, error));
    TRY(ffd_gltf_check_stated(d, error));
    TRY(ffd_gltf_check_vrm(d, error));
    TRY(ffd_gltf_find_required(d, source, error));
    ffd_gltf_find_held(d);
    TRY(ffd_gltf_list_skins(d, error));
    TRY(ffd_gltf_make_scene(d, error));
    TRY(ffd_gltf_note_weights(d, error));
    TRY(ffd_gltf_settle_skins(d, error));
    TRY(ffd_gltf_make_parts(d, error));
    TRY(ffd_gltf_make_shapes(d, error));
    TRY(ffd_gltf_find_splats(d, error));
    d->instancing_status = ffd_gltf_find_instanced_nodes(d, &d->instancing_error);
    d->skins_status = ffd_gltf_prepare_skins(d, &d->skins_error);
    if (d->skins_status == FFD_OK)
        TRY(ffd_gltf_judge_weights(d, error));
    TRY(ffd_gltf_refuse_formal(d, error));
    ffd_gltf_forget(d);
    if (d->skins_status == FFD_E_LIMIT)
        return ffd_fail(error, FFD_E_LIMIT, "%s", d->skins_error.message);
    const bool no_memory = d->skins_status == FFD_E_MEMORY || d->instancing_status == FFD_E_MEMORY;
    return no_memory ? ffd_fail_memory(error) : FFD_OK;
}

ffd_status ffd_gltf_open(file_input *input, const ffd_source *source, mesh_document **document,
                         ffd_error *error)
{
    *document = NULL;
    gltf_document *d = ffd_alloc_zero(1, sizeof *d);
    if (!d)
        return ffd_fail_memory(error);
    d->base.budget = ffd_budget_make(source->memory);
    ffd_budget_add_file(&d->base.budget, input->size, KEPT_PER_BYTE);
    d->base.flaws.strict = source->strict;
    d->space = source->space;
    d->threads = ffd_threads_for_bytes(source->threads, input->size);
    d->input = *input; /* the caller keeps it until everything has succeeded */
    const ffd_status status = read_document(d, source, error);
    if (status) {
        if (error)
            ffd_fail_name_file(error, d->name ? d->name : source->path);
        free_document(d);
        return status;
    }
    *input = (file_input){0};
    *document = &d->base;
    return FFD_OK;
}

void ffd_gltf_close(mesh_document *document)
{
    if (!document)
        return;
    gltf_document *d = (gltf_document *)document;
    ffd_file_unload(&d->input);
    free_document(d);
}
