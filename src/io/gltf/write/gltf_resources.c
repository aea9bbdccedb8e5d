/* gltf_resources.c - copies or refers to the images of a file. */
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include "base/text/base64.h"
#include "base/text/words.h"
#include "io/gltf/file/glb.h"
#include "io/gltf/file/gltf_uri.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/write/gltf_saver.h"
#include "mesh/resource/image_file.h"
#include "mesh/resource/left_out.h"
#include "mesh/resource/resource_copy.h"
#include "json/json_parse.h"
#include <stdio.h>
#include <string.h>

/* The folders of input and output, and the images to copy. */
typedef struct resources {
    gltf_saver *saver;
    resource_copier copier;
    char *from, *to;
    resource_list copies;
    bool embeds; /* a GLB that is made of a .gltf holds its images */
    memory_budget budget;
    intern_table counted; /* the images that are files of the job, whose sizes raise the budget */
} resources;

static ffd_status image_path(const gltf_document *d, size_t image, char **path, ffd_error *error)
{
    return ffd_gltf_file_path(&d->tree, d->image_values.values[image], &d->base.folder, path, error);
}

/* Adds the images of a JSON text that may be copied, with their names. */
static ffd_status find_images(const json_tree *tree, const file_folder *mesh, path_list *files,
                              ffd_error *error)
{
    uint32_t image = ffd_json_tree_first(tree, ffd_json_tree_member(tree, 0, "images"));
    for (; image != JSON_NONE; image = ffd_json_tree_after(tree, image)) {
        char *relative;
        TRY(ffd_gltf_file_path(tree, image, mesh, &relative, error));
        if (relative && ffd_image_has_name(relative) && !ffd_image_is_hidden(relative))
            TRY(ffd_gltf_add_sibling(mesh, relative, files, error));
        else
            ffd_free(relative);
    }
    return FFD_OK;
}

/* Whether a JSON text has `letter` and then "ri" at the end of a string, or a character written as \u. */
static bool has_uri(const char *text, size_t size, char letter)
{
    const char *const end = text + size;
    for (const char *c = memchr(text, letter, size); c; c = memchr(c + 1, letter, (size_t)(end - c - 1)))
        if ((end - c >= 4 && memcmp(c + 1, "ri\"", 3) == 0) || (c > text && c[-1] == '\\'))
            return true;
    return false;
}

/* Whether a JSON text may have a member "uri" or "...Uri", perhaps with escapes: most GLB files have none. */
static bool may_name_files(const char *text, size_t size)
{
    return has_uri(text, size, 'u') || has_uri(text, size, 'U');
}

/* Parses the JSON text of a file that may name others. *is_model: false if it does not, or is not valid,
   which is not an error. */
static ffd_status parse(const char *path, const file_input *bytes, json_tree *tree, bool *is_model,
                        ffd_error *error)
{
    glb_layout layout;
    json_input json = {.text = (const char *)bytes->data, .size = bytes->size, .rules = JSON_ALLOW_MARK};
    *is_model = true;
    if (ffd_glb_is(bytes->data, bytes->size)) {
        *is_model = !ffd_glb_parse(bytes->data, bytes->size, path, &layout, NULL);
        json.text += *is_model ? layout.json_begin : 0;
        json.size = *is_model ? layout.json_size : 0;
    }
    *is_model = *is_model && may_name_files(json.text, json.size);
    const ffd_status parsed = *is_model ? ffd_json_parse(&json, tree, NULL) : FFD_E_INVALID;
    *is_model = parsed == FFD_OK;
    return parsed == FFD_E_MEMORY ? ffd_fail_memory(error) : FFD_OK;
}

/* Adds the files that the members of an array name. */
static ffd_status find_files(const json_tree *tree, const char *array, const file_folder *mesh,
                             path_list *files, ffd_error *error)
{
    uint32_t value = ffd_json_tree_first(tree, ffd_json_tree_member(tree, 0, array));
    for (; value != JSON_NONE; value = ffd_json_tree_after(tree, value)) {
        char *relative;
        TRY(ffd_gltf_file_path(tree, value, mesh, &relative, error));
        TRY(ffd_gltf_add_sibling(mesh, relative, files, error));
    }
    return FFD_OK;
}

ffd_status ffd_gltf_find_named(const char *path, const file_input *bytes, const mesh_named *named,
                               ffd_error *error)
{
    const file_folder mesh = {.file = path};
    json_tree tree;
    bool is_model;
    ffd_status status = parse(path, bytes, &tree, &is_model, error);
    if (!is_model)
        return status;
    if (named->files) {
        TRY_END(find_files(&tree, "buffers", &mesh, named->files, error));
        TRY_END(find_files(&tree, "images", &mesh, named->files, error));
        TRY_END(ffd_gltf_find_linked(&tree, &mesh, named->files, error));
    }
    if (named->copies)
        TRY_END(find_images(&tree, &mesh, named->copies, error));
    if (named->linked)
        TRY_END(ffd_gltf_find_linked(&tree, &mesh, named->linked, error));
end:
    ffd_json_tree_free(&tree);
    return status;
}

ffd_status ffd_gltf_list_images(const mesh_document *document, path_list *files, ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    for (size_t i = 0; i < d->image_values.count; i++) {
        char *relative = NULL;
        TRY(image_path(d, i, &relative, error));
        TRY(ffd_gltf_add_sibling(&d->base.folder, relative, files, error));
    }
    return FFD_OK;
}

ffd_status ffd_gltf_list_linked(const mesh_document *document, path_list *files, ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    return ffd_gltf_find_linked(&d->tree, &d->base.folder, files, error);
}

static ffd_status copy_image(const resources *r, const mesh_resource *image, ffd_error *error)
{
    const gltf_document *d = r->saver->document;
    ffd_error refused;
    TRY(ffd_resource_copy(&r->copier, image, &refused, error));
    if (!refused.status)
        return FFD_OK;
    return ffd_json_tree_fail(
        &d->tree, d->image_values.values[image->index], d->name, FFD_E_IO, error,
        "the image \"%s\" cannot be copied: %s; {resources=reference} refers to it where it is", image->path,
        refused.message);
}

static ffd_status refer_to_image(const resources *r, size_t image, const char *path, ffd_error *error)
{
    const gltf_document *d = r->saver->document;
    const uint32_t uri = ffd_json_tree_member(&d->tree, d->image_values.values[image], "uri");
    if (uri == JSON_NONE)
        return FFD_OK;
    char *from = ffd_path_resolve(r->from), *to = ffd_path_resolve(r->to);
    char *absolute = from ? ffd_path_join(from, path) : NULL;
    char *plain = absolute ? ffd_path_normalize(absolute) : NULL;
    char *relative = plain && to ? ffd_path_relative(to, plain) : NULL;
    char *encoded = relative ? ffd_uri_encode(relative) : NULL;
    ffd_status status = FFD_OK;
    if (!encoded)
        status = ffd_fail_memory(error);
    else
        ffd_edits_replace(&r->saver->edits, d->tree.values[uri].begin + 1, d->tree.values[uri].end - 1,
                          encoded, strlen(encoded));
    char *const texts[] = {from, to, absolute, plain, relative, encoded};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        ffd_free(texts[i]);
    return status;
}

/* Replaces the URI of an image by one that holds its bytes. */
static ffd_status put_data_uri(resources *r, size_t image, const file_input *bytes, ffd_error *error)
{
    const json_tree *const tree = &r->saver->document->tree;
    const uint32_t uri = ffd_json_tree_member(tree, r->saver->document->image_values.values[image], "uri");
    const size_t size = ffd_base64_length(bytes->size);
    TRY(ffd_budget_take(&r->budget, size, 2, error)); /* here, and among the edits */
    if (uri == JSON_NONE)
        return FFD_OK;
    char *const text = ffd_alloc(size, 1);
    if (!text)
        return ffd_fail_memory(error);
    ffd_base64_encode(bytes->data, bytes->size, text);
    const uint32_t begin = tree->values[uri].begin + 1, end = tree->values[uri].end - 1;
    ffd_edits_format(&r->saver->edits, begin, end, "data:%s;base64,",
                     ffd_image_media_type(bytes->data, bytes->size));
    ffd_edits_replace(&r->saver->edits, end, end, text, size);
    ffd_free(text);
    return FFD_OK;
}

/* Counts an image among the files of the job: once, however often it is named. */
static ffd_status count_image(resources *r, const char *path, size_t size, ffd_error *error)
{
    const size_t before = r->counted.count;
    uint32_t index;
    if (!ffd_intern(&r->counted, path, strlen(path), &index))
        return ffd_fail_memory(error);
    if (r->counted.count > before)
        ffd_budget_add_file(&r->budget, size, 0);
    return FFD_OK;
}

static ffd_status embed_image(resources *r, size_t index, char *path, ffd_error *error)
{
    const gltf_document *d = r->saver->document;
    const mesh_resource image = {path, &ffd_resource_image, index};
    const char *left =
        ffd_resource_is_outside(&r->copier.mesh, path) ? "is outside the model's folder" : NULL;
    ffd_error refused = {0};
    file_input bytes = {0};
    TRY(left ? FFD_OK : ffd_resource_load(&r->copier.mesh, &image, &bytes, &left, &refused, error));
    if (refused.status)
        return ffd_json_tree_fail(&d->tree, d->image_values.values[index], d->name, FFD_E_IO, error,
                                  "the image \"%s\" cannot be put into the output: %s; {resources=reference} "
                                  "refers to it where it is",
                                  path, refused.message);
    if (left) {
        char shown[RESOURCE_SHOWN];
        ffd_name_shown(path, shown, sizeof shown);
        ffd_log_line(r->saver->log, FFD_LOG_WARNING, "the image \"%s\" %s and is not in the output", shown,
                     left);
        return FFD_OK;
    }
    ffd_status status;
    TRY_END(count_image(r, path, bytes.size, error));
    TRY_END(put_data_uri(r, index, &bytes, error));
    TRY_END(ffd_resource_note(&r->copier, &image, error));
end:
    ffd_file_unload(&bytes);
    return status;
}

/* Warns of a URI that names no file: its name is empty or holds a NUL character, or it is absolute, so that
   an output which holds its images has not this one. */
static ffd_status warn_of_uri(const resources *r, size_t image, ffd_error *error)
{
    const json_tree *const tree = &r->saver->document->tree;
    const uint32_t uri = ffd_json_tree_member(tree, r->saver->document->image_values.values[image], "uri");
    char *const text = uri == JSON_NONE ? NULL : ffd_json_tree_string(tree, uri, NULL);
    if (uri == JSON_NONE || !text)
        return uri == JSON_NONE ? FFD_OK : ffd_fail_memory(error);
    const bool is_data = ffd_uri_is_data(text), is_absolute = ffd_uri_is_absolute(text);
    ffd_free(text);
    if (is_data || (is_absolute && !r->embeds))
        return FFD_OK;
    char written[400], shown[120];
    snprintf(written, sizeof written, "%.*s", (int)(tree->values[uri].end - tree->values[uri].begin),
             tree->text + tree->values[uri].begin);
    ffd_name_shown(written, shown, sizeof shown);
    ffd_log_line(r->saver->log, FFD_LOG_WARNING, "the image %s %s", shown,
                 is_absolute ? "is not a file beside the model and is not in the output"
                             : "is not the name of a file");
    return FFD_OK;
}

static ffd_status bring_image(resources *r, size_t image, ffd_error *error)
{
    char *path;
    ffd_status status = image_path(r->saver->document, image, &path, error);
    if (status)
        return status;
    if (!path)
        return warn_of_uri(r, image, error);
    if (r->embeds) {
        status = embed_image(r, image, path, error);
        ffd_free(path);
        return status;
    }
    if (r->saver->options->resources != FFD_RESOURCES_REFERENCE)
        return ffd_resources_add(&r->copies, &ffd_resource_image, image, path, error);
    status = refer_to_image(r, image, path, error);
    ffd_free(path);
    return status;
}

/* Refuses to overwrite one of the model's images by a file of the output model. */
static ffd_status refuse_image_name(const resources *r, size_t index, bool own_copy, ffd_error *error)
{
    const gltf_saver *saver = r->saver;
    mesh_resource image = {.kind = &ffd_resource_image, .index = index};
    TRY(image_path(saver->document, index, &image.path, error));
    if (!image.path)
        return FFD_OK;
    ffd_status status = FFD_OK;
    if (!saver->in_place && !ffd_output_is_stream(saver->options->path))
        TRY_END(ffd_resource_check_target(&r->copier, &image, own_copy, saver->options->path, error));
    for (size_t b = 0; b < saver->document->buffer_values.count; b++)
        if (saver->buffers[b].target)
            TRY_END(ffd_resource_check_target(&r->copier, &image, own_copy, saver->buffers[b].target, error));
end:
    ffd_free(image.path);
    return status;
}

/* Lists a file that an extension names, unless the output reaches it, it is the uri of an image, or it is
   among the known ones. */
static ffd_status leave_file(const resources *r, uint32_t uri, uint32_t extension, intern_table *known,
                             left_out *left, ffd_error *error)
{
    const json_tree *const tree = &r->saver->document->tree;
    char *path;
    TRY(ffd_gltf_uri_path(tree, uri, &r->saver->document->base.folder, &path, error));
    if (!path)
        return FFD_OK;
    ffd_status status = FFD_OK;
    char *const name = ffd_json_tree_key(tree, extension);
    const size_t before = known->count;
    uint32_t index;
    if (!name || !ffd_intern(known, path, strlen(path), &index)) {
        status = ffd_fail_memory(error);
    } else if (known->count > before) {
        char why[120];
        snprintf(why, sizeof why, "of %s", name);
        status = ffd_left_add_unreached(left, r->saver->options->to_sink ? NULL : r->to, path, why, error);
    }
    ffd_free(name);
    ffd_free(path);
    return status;
}

/* Lists the files that extensions name, which are neither images nor buffers. */
static ffd_status leave_linked(const resources *r, left_out *left, ffd_error *error)
{
    const json_tree *const tree = &r->saver->document->tree;
    intern_table known = {0};
    uint32_t extension, v = ffd_gltf_next_linked(tree, 0, &extension);
    ffd_status status = FFD_OK;
    for (; v != JSON_NONE; v = ffd_gltf_next_linked(tree, v + 1, &extension))
        TRY_END(leave_file(r, v, extension, &known, left, error));
end:
    ffd_intern_free(&known);
    return status;
}

/* Names them: they are not copied, whatever they are. */
static ffd_status warn_of_left(const resources *r, ffd_error *error)
{
    left_out left = {0};
    TRY(leave_linked(r, &left, error));
    ffd_left_out_log(&left, "file that an extension names is not copied",
                     "files that extensions name are not copied", r->saver->log);
    return FFD_OK;
}

/* Names what goes along with a file, but not with standard input. */
static ffd_status warn_of_stream(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    const resources r = {.saver = saver, .to = ffd_path_folder(saver->options->path)};
    left_out left = {0};
    resource_list images = {0};
    ffd_status status;
    TRY_END(r.to ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < d->image_values.count; i++) {
        char *path;
        TRY_END(image_path(d, i, &path, error));
        if (path)
            TRY_END(ffd_resources_add(&images, &ffd_resource_image, i, path, error));
    }
    for (size_t i = 0; i < images.count; i++)
        TRY_END(ffd_left_add_unreached(&left, saver->options->to_sink ? NULL : r.to, images.resources[i].path,
                                       "of images", error));
    TRY_END(leave_linked(&r, &left, error));
    ffd_left_out_log_stream(&left, saver->log);
end:
    ffd_resources_free(&images);
    ffd_free(r.to);
    return status;
}

ffd_status ffd_gltf_bring_images(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    const bool copies = saver->options->resources != FFD_RESOURCES_REFERENCE;
    const bool embeds = copies && saver->binary && !d->binary;
    if (ffd_file_is_stream(d->path) && !ffd_output_is_stream(saver->options->path))
        return warn_of_stream(saver, error);
    if (ffd_file_is_stream(d->path) || (ffd_output_is_stream(saver->options->path) && !embeds))
        return FFD_OK;
    resources r = {.saver = saver,
                   .from = ffd_path_folder(d->path),
                   .to = ffd_path_folder(saver->options->path),
                   .embeds = embeds,
                   .budget = d->base.budget};
    r.copier = (resource_copier){.mesh = d->base.folder,
                                 .from = r.from,
                                 .to = r.to,
                                 .output = saver->output,
                                 .log = saver->log,
                                 .options = saver->options};
    ffd_status status;
    TRY_END(r.from && r.to ? FFD_OK : ffd_fail_memory(error));
    const bool stay = saver->in_place || ffd_save_meets(saver->options, r.from, r.to);
    const bool own_copies = stay || (copies && !embeds);
    for (size_t i = 0; i < d->image_values.count; i++)
        TRY_END(refuse_image_name(&r, i, own_copies, error));
    for (size_t i = 0; i < d->image_values.count && (!stay || embeds); i++)
        TRY_END(bring_image(&r, i, error));
    ffd_resources_sort(&r.copies);
    for (size_t i = 0; i < r.copies.count; i++)
        TRY_END(copy_image(&r, &r.copies.resources[i], error));
    if (!stay && !ffd_output_is_stream(saver->options->path))
        TRY_END(warn_of_left(&r, error));
end:
    ffd_resources_free(&r.copies);
    ffd_intern_free(&r.counted);
    ffd_free(r.from);
    ffd_free(r.to);
    return status;
}
