#include "io/gltf/save/gltf_resources.h"
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/system/clock.h"
#include "io/gltf/file/uri.h"
#include <string.h>

/* An image to be copied. */
typedef struct image_copy {
    char *path; /* relative to the model */
    size_t image;
} image_copy;

/* The folders of input and output, and the images to be copied. */
typedef struct resources {
    gltf_saver *saver;
    char *from, *to;
    image_copy *copies; /* in the order of their paths */
    size_t copy_count, copy_capacity;
} resources;

/* Finds the normalized path, relative to the model, that an image's URI names; NULL with FFD_OK: not a
   file beside the model. */
static ffd_status image_path(const gltf_document *d, size_t image, char **path, ffd_error *error)
{
    *path = NULL;
    const uint32_t uri = ffd_json_span_member(&d->tree, d->image_values.values[image], "uri");
    if (uri == JSON_NONE)
        return FFD_OK;
    size_t size;
    char *text = ffd_json_span_string(&d->tree, uri, &size);
    if (!text)
        return ffd_fail_memory(error);
    if (!ffd_uri_is_data(text) && !ffd_uri_is_absolute(text)) {
        size = ffd_uri_decode(text, size);
        text[size] = 0;
        if (!memchr(text, 0, size) && size > 0) {
            *path = ffd_path_normalize(text);
            if (!*path) {
                ffd_free(text);
                return ffd_fail_memory(error);
            }
        }
    }
    ffd_free(text);
    return FFD_OK;
}

ffd_status ffd_gltf_list_images(const mesh_document *document, path_list *files, ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < d->image_values.count && status == FFD_OK; i++) {
        char *relative = NULL;
        status = image_path(d, i, &relative, error);
        char *path = relative ? ffd_path_beside(d->path, relative) : NULL;
        if (path)
            status = ffd_paths_add(files, path, error);
        else if (relative)
            status = ffd_fail_memory(error);
        ffd_free(path);
        ffd_free(relative);
    }
    return status;
}

/* The longest wait for other processes, and the time between checks, in seconds. */
#define MOST_WAITING 60.0
#define LOOK 0.002

/* Begins the image's file, unless it exists. Another model that is saved at the same time may be
   writing the same image: this waits for it. There is no deadlock, since all write their images in the
   order of their paths. */
static ffd_status begin_image(const resources *r, const char *target, bool *exists, ffd_error *error)
{
    const double begin = ffd_clock_seconds();
    for (;;) {
        *exists = ffd_file_exists(target);
        if (*exists)
            return FFD_OK;
        const ffd_status status = ffd_output_begin(r->saver->output, target, false, error);
        /* It may also have been created between these two calls. */
        const bool waits = status && (ffd_output_was_busy(r->saver->output) || status == FFD_E_EXISTS);
        if (!waits || ffd_clock_seconds() - begin > MOST_WAITING)
            return status;
        ffd_clock_sleep(LOOK);
    }
}

static ffd_status compare_image(const char *target, const file_input *bytes, ffd_error *error)
{
    bool same = false;
    const ffd_status status = ffd_file_compare(target, bytes, &same, error);
    if (status || same)
        return status;
    return ffd_fail_file(
        error, FFD_E_IO, target,
        "already exists and is not the image to be copied there (--resources reference copies none)");
}

static ffd_status write_image(const resources *r, const char *target, const file_input *bytes,
                              ffd_error *error)
{
    bool exists;
    if (ffd_file_exists(target))
        return compare_image(target, bytes, error);
    char *folder = ffd_path_folder(target);
    ffd_status status = folder ? ffd_output_folder(r->saver->output, folder, error) : ffd_fail_memory(error);
    ffd_free(folder);
    if (status == FFD_OK)
        status = begin_image(r, target, &exists, error);
    if (status)
        return status;
    return exists ? compare_image(target, bytes, error)
                  : ffd_output_write(r->saver->output, bytes->data, bytes->size, error);
}

static ffd_status copy_image(const resources *r, size_t image, const char *path, ffd_error *error)
{
    const gltf_document *d = r->saver->document;
    char *source = ffd_path_beside(d->path, path), *target = ffd_path_join(r->to, path);
    file_input bytes = {0};
    ffd_error reason = {0};
    ffd_status status = source && target ? FFD_OK : ffd_fail_memory(error);
    if (status)
        goto done;
    if (!ffd_path_leads_out(path) && !ffd_file_exists(source)) {
        ffd_log_line(r->saver->log, FFD_LOG_WARNING, "the image \"%s\" is missing and was not copied", path);
        goto done;
    }
    if (!ffd_path_leads_out(path))
        status = ffd_file_load_within(r->from, path, d->name, &bytes, &reason);
    if (ffd_path_leads_out(path) || status)
        status = ffd_json_span_fail(
            &d->tree, d->image_values.values[image], d->name,
            status == FFD_E_MEMORY ? FFD_E_MEMORY : FFD_E_IO, error,
            "the image \"%s\" cannot be copied: %s; --resources reference refers to it where it is", path,
            status ? reason.message : "it is outside the model's folder");
    else
        status = write_image(r, target, &bytes, error);
    if (status == FFD_OK && r->saver->options->copied)
        status = ffd_paths_add(r->saver->options->copied, source, error);
done:
    if (bytes.data)
        ffd_file_unload(&bytes);
    ffd_free(source);
    ffd_free(target);
    return status;
}

static ffd_status refer_to_image(const resources *r, size_t image, const char *path, ffd_error *error)
{
    const gltf_document *d = r->saver->document;
    const json_value *uri =
        &d->tree.values[ffd_json_span_member(&d->tree, d->image_values.values[image], "uri")];
    char *from = ffd_path_resolve(r->from), *to = ffd_path_resolve(r->to);
    char *absolute = from ? ffd_path_join(from, path) : NULL;
    char *plain = absolute ? ffd_path_normalize(absolute) : NULL;
    char *relative = plain && to ? ffd_path_relative(to, plain) : NULL;
    char *encoded = relative ? ffd_uri_encode(relative) : NULL;
    ffd_status status = FFD_OK;
    if (!encoded)
        status = ffd_fail_memory(error);
    else
        ffd_edits_replace(&r->saver->edits, uri->begin + 1, uri->end - 1, encoded, strlen(encoded));
    char *const texts[] = {from, to, absolute, plain, relative, encoded};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
        ffd_free(texts[i]);
    return status;
}

/* Adds an image to be copied. Two images may be one file, which is copied once. Takes ownership of the
   path. */
static ffd_status add_copy(resources *r, char *path, size_t image, ffd_error *error)
{
    size_t i = r->copy_count;
    while (i > 0 && strcmp(r->copies[i - 1].path, path) > 0)
        i--;
    const bool known = i > 0 && strcmp(r->copies[i - 1].path, path) == 0;
    if (known || !ffd_grow((void **)&r->copies, &r->copy_capacity, r->copy_count + 1, sizeof *r->copies)) {
        ffd_free(path);
        return known ? FFD_OK : ffd_fail_memory(error);
    }
    memmove(r->copies + i + 1, r->copies + i, (r->copy_count - i) * sizeof *r->copies);
    r->copies[i] = (image_copy){path, image};
    r->copy_count++;
    return FFD_OK;
}

static ffd_status bring_image(resources *r, size_t image, ffd_error *error)
{
    char *path;
    ffd_status status = image_path(r->saver->document, image, &path, error);
    if (status || !path)
        return status;
    if (r->saver->options->resources != FFD_RESOURCES_REFERENCE)
        return add_copy(r, path, image, error);
    status = refer_to_image(r, image, path, error);
    ffd_free(path);
    return status;
}

/* An image's file and, if the output refers to a copy in its own folder, the path of that. */
typedef struct image_paths {
    const char *path;
    char *source, *copy; /* copy: NULL if the output refers to the source */
} image_paths;

static ffd_status refuse_clash(const image_paths *image, const char *target, ffd_error *error)
{
    if (!ffd_file_same(image->source, target) &&
        !(image->copy &&
          (strcmp(image->path, ffd_path_name(target)) == 0 || ffd_file_same(image->copy, target))))
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_EXISTS, target,
                         "is also the path of the image \"%s\": give the output another name", image->path);
}

/* Refuses to overwrite one of the model's images by a file of the model itself. */
static ffd_status refuse_image_name(const resources *r, size_t number, bool own_copy, ffd_error *error)
{
    const gltf_saver *saver = r->saver;
    char *path;
    ffd_status status = image_path(saver->document, number, &path, error);
    if (status || !path)
        return status;
    const image_paths image = {.path = path,
                               .source = ffd_path_join(r->from, path),
                               .copy = own_copy ? ffd_path_join(r->to, path) : NULL};
    if (!image.source || (own_copy && !image.copy))
        status = ffd_fail_memory(error);
    if (status == FFD_OK && !saver->in_place)
        status = refuse_clash(&image, saver->options->path, error);
    for (size_t b = 0; b < saver->document->buffer_values.count && status == FFD_OK; b++)
        if (saver->buffers[b].target)
            status = refuse_clash(&image, saver->buffers[b].target, error);
    ffd_free(image.source);
    ffd_free(image.copy);
    ffd_free(path);
    return status;
}

ffd_status ffd_gltf_bring_images(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    if (ffd_file_is_stream(d->path) || ffd_output_is_stream(saver->options->path))
        return FFD_OK;
    resources r = {
        .saver = saver, .from = ffd_path_folder(d->path), .to = ffd_path_folder(saver->options->path)};
    ffd_status status = r.from && r.to ? FFD_OK : ffd_fail_memory(error);
    const bool stay = status == FFD_OK && (saver->in_place || ffd_file_same(r.from, r.to));
    const bool own_copies = stay || saver->options->resources == FFD_RESOURCES_COPY;
    for (size_t i = 0; i < d->image_values.count && status == FFD_OK; i++)
        status = refuse_image_name(&r, i, own_copies, error);
    for (size_t i = 0; i < d->image_values.count && status == FFD_OK && !stay; i++)
        status = bring_image(&r, i, error);
    for (size_t i = 0; i < r.copy_count && status == FFD_OK; i++)
        status = copy_image(&r, r.copies[i].image, r.copies[i].path, error);
    for (size_t i = 0; i < r.copy_count; i++)
        ffd_free(r.copies[i].path);
    ffd_free(r.copies);
    ffd_free(r.from);
    ffd_free(r.to);
    return status;
}
