#include "io/gltf/gltf_images.h"
#include "base/memory/memory.h"
#include "io/gltf/file/gltf_file_uris.h"
#include "io/gltf/file/uri.h"
#include "io/gltf/read/gltf_views.h"
#include <stdio.h>

/* An image that is not a file beside the model. */
typedef struct inner_image {
    const gltf_document *document;
    material_images *images;
    char *name; /* for messages */
    uint32_t *number;
    ffd_error *error;
} inner_image;

static char *name_of(const gltf_document *d, size_t image)
{
    const uint32_t name = ffd_json_span_member(&d->tree, d->image_values.values[image], "name");
    byte_buffer text = {0};
    if (name != JSON_NONE && d->tree.values[name].kind == JSON_STRING &&
        d->tree.values[name].end - d->tree.values[name].begin > 2)
        return ffd_json_span_string(&d->tree, name, NULL);
    ffd_buffer_format(&text, "image %zu", image);
    return ffd_buffer_finish(&text);
}

static ffd_status add_view(const inner_image *i, uint32_t value)
{
    const gltf_document *const d = i->document;
    const size_t view = ffd_gltf_index(d, value, d->model.view_count);
    const unsigned char *const bytes = view == GLTF_NONE ? NULL : ffd_gltf_view_bytes(d, view);
    if (!bytes) {
        ffd_left_add(&i->images->left, i->name,
                     view == GLTF_NONE ? "names a bufferView that is not there"
                                       : "is in a bufferView that cannot be read");
        return FFD_OK;
    }
    const gltf_view *const v = &d->model.views[view];
    const ffd_status status =
        ffd_images_add(i->images, i->name, bytes, (size_t)v->length, i->number, i->error);
    if (!d->decoded_views[view])
        ffd_gltf_forget_bytes(d, &d->buffers[v->buffer], (size_t)v->offset, (size_t)v->length);
    return status;
}

static ffd_status add_data_uri(const inner_image *i, uint32_t uri)
{
    gltf_buffer buffer;
    ffd_status status = ffd_gltf_load_data_uri(&i->document->tree, uri, i->document->name, &buffer, i->error);
    if (status == FFD_E_INVALID) {
        ffd_left_add(&i->images->left, i->name, "is not valid base64");
        return FFD_OK;
    }
    if (!status)
        status = ffd_images_add(i->images, i->name, buffer.data, buffer.size, i->number, i->error);
    ffd_gltf_free_buffer(&buffer);
    return status;
}

static bool is_data(const gltf_document *d, uint32_t uri)
{
    const json_value *const value = &d->tree.values[uri];
    char head[6] = "";
    for (size_t i = 0; i + 1 < sizeof head && value->begin + 1 + i < value->end; i++)
        head[i] = d->tree.text[value->begin + 1 + i];
    return value->kind == JSON_STRING && ffd_uri_is_data(head);
}

/* key: identifies the image; two images may share a bufferView. */
static ffd_status load_inner(const gltf_document *d, material_images *images, size_t image, uint32_t *number,
                             ffd_error *error)
{
    const uint32_t value = d->image_values.values[image];
    const uint32_t view = ffd_json_span_member(&d->tree, value, "bufferView");
    const uint32_t uri = ffd_json_span_member(&d->tree, value, "uri");
    const size_t v = ffd_gltf_index(d, view, d->model.view_count);
    char key[40]; /* cannot be the path of a file: these are relative */
    bool is_known;
    snprintf(key, sizeof key, v == GLTF_NONE ? "/image %zu" : "/bufferView %zu", v == GLTF_NONE ? image : v);
    ffd_status status = ffd_images_find(images, key, &is_known, number, error);
    if (status || is_known)
        return status;
    const inner_image inner = {d, images, name_of(d, image), number, error};
    if (!inner.name)
        return ffd_fail_memory(error);
    if (view != JSON_NONE)
        status = add_view(&inner, view);
    else if (uri != JSON_NONE && is_data(d, uri))
        status = add_data_uri(&inner, uri);
    else
        ffd_left_add(&images->left, inner.name,
                     uri == JSON_NONE ? "has no bytes" : "is outside the model's folder");
    ffd_free(inner.name);
    return status;
}

ffd_status ffd_gltf_load_image(const gltf_document *d, material_images *images, size_t image,
                               uint32_t *number, ffd_error *error)
{
    const uint32_t value = d->image_values.values[image];
    char *path = NULL;
    ffd_status status = FFD_OK;
    if (ffd_json_span_member(&d->tree, value, "bufferView") == JSON_NONE)
        status = ffd_gltf_file_path(&d->tree, value, d->path, &path, error);
    if (!status)
        status =
            path ? ffd_images_load(images, path, number, error) : load_inner(d, images, image, number, error);
    ffd_free(path);
    return status;
}
