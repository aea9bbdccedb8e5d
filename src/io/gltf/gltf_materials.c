/* gltf_materials.c - the materials of a file: base colours, opacity, emission, and their textures. */
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "io/gltf/file/gltf_uri.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/read/gltf_document.h"
#include "io/gltf/read/gltf_views.h"
#include "mesh/mesh.h"
#include "mesh/resource/material_images.h"
#include <float.h>
#include <stdio.h>

/* An image that is not a file beside the model. */
typedef struct inner_image {
    const gltf_document *document;
    material_images *images;
    char *name;      /* for messages */
    uint32_t *index; /* of the image among those of the materials */
    ffd_error *error;
} inner_image;

static char *image_name(const gltf_document *d, size_t image)
{
    const uint32_t name = ffd_json_tree_member(&d->tree, d->image_values.values[image], "name");
    byte_buffer text = {0};
    if (name != JSON_NONE && d->tree.values[name].kind == JSON_STRING &&
        d->tree.values[name].end - d->tree.values[name].begin > 2)
        return ffd_json_tree_string(&d->tree, name, NULL);
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
        ffd_images_add(i->images, i->name, bytes, (size_t)v->length, i->index, i->error);
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
    TRY_END(status);
    TRY_END(ffd_images_add(i->images, i->name, buffer.data, buffer.size, i->index, i->error));
end:
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
static ffd_status load_inner(const gltf_document *d, material_images *images, size_t image, uint32_t *index,
                             ffd_error *error)
{
    const uint32_t value = d->image_values.values[image];
    const uint32_t view = ffd_json_tree_member(&d->tree, value, "bufferView");
    const uint32_t uri = ffd_json_tree_member(&d->tree, value, "uri");
    const size_t v = ffd_gltf_index(d, view, d->model.view_count);
    char key[40]; /* cannot be the path of a file: these are relative */
    bool is_known;
    snprintf(key, sizeof key, v == GLTF_NONE ? "/image %zu" : "/bufferView %zu", v == GLTF_NONE ? image : v);
    TRY(ffd_images_find(images, key, &is_known, index, error));
    if (is_known)
        return FFD_OK;
    ffd_status status = FFD_OK;
    const inner_image inner = {d, images, image_name(d, image), index, error};
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

/* Loads an image from a bufferView, a data URI or a file beside the model, unless it is loaded already. Sets
   *index to its index among the images of the materials, or to MATERIAL_LOST if it cannot be loaded. Errors:
   FFD_E_LIMIT, FFD_E_MEMORY. */
static ffd_status load_image(const gltf_document *d, material_images *images, size_t image, uint32_t *index,
                             ffd_error *error)
{
    const uint32_t value = d->image_values.values[image];
    char *path = NULL;
    ffd_status status = FFD_OK;
    if (ffd_json_tree_member(&d->tree, value, "bufferView") == JSON_NONE)
        TRY_END(ffd_gltf_file_path(&d->tree, value, &d->base.folder, &path, error));
    TRY_END(path ? ffd_images_load(images, path, index, error) : load_inner(d, images, image, index, error));
end:
    ffd_free(path);
    return status;
}

/* The default of alphaCutoff. */
#define HALF 0.5

typedef struct reader {
    const gltf_document *document;
    material_images images;
    ffd_error *error;
} reader;

/* The JSON values that define a material's base colour; each may be JSON_NONE. */
typedef struct base_colour {
    uint32_t factor, texture;
} base_colour;

/* Finds the base colour. The diffuse colour of KHR_materials_pbrSpecularGlossiness takes its place if only
   that has a texture, or a factor; the texture coordinates of the model are chosen in the same way. */
static base_colour find_colour(const gltf_document *d, uint32_t material)
{
    const json_tree *const tree = &d->tree;
    const uint32_t base = ffd_json_tree_member(tree, material, "pbrMetallicRoughness");
    const uint32_t older = ffd_gltf_extension(d, material, "KHR_materials_pbrSpecularGlossiness");
    const base_colour first = {ffd_json_tree_member(tree, base, "baseColorFactor"),
                               ffd_json_tree_member(tree, base, "baseColorTexture")};
    const base_colour second = {ffd_json_tree_member(tree, older, "diffuseFactor"),
                                ffd_json_tree_member(tree, older, "diffuseTexture")};
    if (first.texture != JSON_NONE)
        return first;
    return second.texture != JSON_NONE || first.factor == JSON_NONE ? second : first;
}

/* Reads a colour factor: components that are not numbers stay, those outside 0 to 1 become 1. */
static void read_factor(const json_tree *tree, uint32_t array, int count, double *color)
{
    double number;
    if (array == JSON_NONE || tree->values[array].kind != JSON_ARRAY)
        return;
    uint32_t value = ffd_json_tree_first(tree, array);
    for (int c = 0; c < count && value != JSON_NONE; c++, value = ffd_json_tree_after(tree, value))
        if (ffd_json_tree_number(tree, value, &number))
            color[c] = material_share(number);
}

static void read_alpha(const gltf_document *d, uint32_t value, mesh_material *material)
{
    const uint32_t mode = ffd_json_tree_member(&d->tree, value, "alphaMode");
    const uint32_t cutoff = ffd_json_tree_member(&d->tree, value, "alphaCutoff");
    double number;
    if (mode == JSON_NONE || d->tree.values[mode].kind != JSON_STRING)
        return;
    if (ffd_json_tree_string_is(&d->tree, mode, "BLEND"))
        material->alpha = MATERIAL_BLEND;
    if (!ffd_json_tree_string_is(&d->tree, mode, "MASK"))
        return;
    const bool is_valid = ffd_json_tree_number(&d->tree, cutoff, &number) && number >= 0 && number <= DBL_MAX;
    material->alpha = MATERIAL_MASK;
    material->alpha_cutoff = is_valid ? number : HALF;
}

static texture_wrap read_wrap(const gltf_document *d, uint32_t sampler, const char *key)
{
    enum { CLAMP_TO_EDGE = 33071, MIRRORED_REPEAT = 33648 };
    const size_t mode = ffd_gltf_index(d, ffd_json_tree_member(&d->tree, sampler, key), MIRRORED_REPEAT + 1);
    return mode == CLAMP_TO_EDGE ? TEXTURE_CLAMP : mode == MIRRORED_REPEAT ? TEXTURE_MIRROR : TEXTURE_REPEAT;
}

/* Returns the image of a texture: its source, or else that of EXT_texture_webp; GLTF_NONE: neither is valid.
   A file with both has the same picture twice, the first for programs that cannot read the second. */
static size_t find_image(const gltf_document *d, uint32_t texture)
{
    const uint32_t webp = ffd_gltf_extension(d, texture, "EXT_texture_webp");
    const size_t count = d->image_values.count;
    const size_t image = ffd_gltf_index(d, ffd_json_tree_member(&d->tree, texture, "source"), count);
    return image != GLTF_NONE ? image
                              : ffd_gltf_index(d, ffd_json_tree_member(&d->tree, webp, "source"), count);
}

/* Returns why a texture has no image. */
static const char *why_no_image(const gltf_document *d, uint32_t texture)
{
    static const char *const extensions[][2] = {
        {"KHR_texture_basisu", "has an image of KHR_texture_basisu only"},
        {"EXT_texture_avif", "has an image of EXT_texture_avif only"},
        {"MSFT_texture_dds", "has an image of MSFT_texture_dds only"}};
    const uint32_t webp = ffd_gltf_extension(d, texture, "EXT_texture_webp");
    for (size_t i = 0; i < sizeof extensions / sizeof *extensions; i++)
        if (ffd_gltf_has_extension(d, texture, extensions[i][0]))
            return extensions[i][1];
    return ffd_json_tree_member(&d->tree, texture, "source") == JSON_NONE &&
                   ffd_json_tree_member(&d->tree, webp, "source") == JSON_NONE
               ? "has no image"
               : "names an image that is not there";
}

/* Notes, once per texture, why it has no image. index: GLTF_NONE if the texture does not exist. */
static ffd_status leave_texture(reader *r, size_t index, const char *why, uint32_t *image)
{
    char name[40] = "a texture", key[sizeof name + 1];
    bool is_known;
    if (index != GLTF_NONE)
        snprintf(name, sizeof name, "texture %zu", index);
    snprintf(key, sizeof key, "/%s", name); /* cannot be the path of a file: these are relative */
    TRY(ffd_images_find(&r->images, key, &is_known, image, r->error));
    if (!is_known)
        ffd_left_add(&r->images.left, name, why);
    return FFD_OK;
}

/* info: a textureInfo; JSON_NONE leaves the texture as it is. */
static ffd_status read_texture(reader *r, uint32_t info, mesh_texture *to)
{
    if (info == JSON_NONE)
        return FFD_OK;
    const gltf_document *const d = r->document;
    const size_t index =
        ffd_gltf_index(d, ffd_json_tree_member(&d->tree, info, "index"), d->texture_values.count);
    if (index == GLTF_NONE)
        return leave_texture(r, GLTF_NONE, "that a material names is not there", &to->image);
    const uint32_t texture = d->texture_values.values[index];
    const size_t sampler =
        ffd_gltf_index(d, ffd_json_tree_member(&d->tree, texture, "sampler"), d->sampler_values.count);
    const size_t image = find_image(d, texture);
    if (sampler != GLTF_NONE) {
        to->wrap[0] = read_wrap(d, d->sampler_values.values[sampler], "wrapS");
        to->wrap[1] = read_wrap(d, d->sampler_values.values[sampler], "wrapT");
    }
    return image == GLTF_NONE ? leave_texture(r, index, why_no_image(d, texture), &to->image)
                              : load_image(d, &r->images, image, &to->image, r->error);
}

static void read_emission(const gltf_document *d, uint32_t material, double emission[3])
{
    const uint32_t stronger = ffd_gltf_extension(d, material, "KHR_materials_emissive_strength");
    double strength = 1;
    read_factor(&d->tree, ffd_json_tree_member(&d->tree, material, "emissiveFactor"), 3, emission);
    ffd_json_tree_number(&d->tree, ffd_json_tree_member(&d->tree, stronger, "emissiveStrength"), &strength);
    for (int c = 0; c < 3 && strength >= 0 && strength <= DBL_MAX; c++)
        emission[c] *= strength;
}

static char *name_of(const gltf_document *d, uint32_t material)
{
    const uint32_t name = ffd_json_tree_member(&d->tree, material, "name");
    const bool has_name = name != JSON_NONE && d->tree.values[name].kind == JSON_STRING;
    return has_name ? ffd_json_tree_string(&d->tree, name, NULL) : ffd_text_copy("");
}

static ffd_status read_material(reader *r, uint32_t value)
{
    const gltf_document *const d = r->document;
    mesh_materials *const materials = r->images.materials;
    TRY(ffd_materials_add(materials, name_of(d, value), r->images.budget, r->error));
    mesh_material *const m = &materials->list[materials->count - 1];
    const base_colour colour = find_colour(d, value);
    const uint32_t sides = ffd_json_tree_member(&d->tree, value, "doubleSided");
    read_factor(&d->tree, colour.factor, 4, m->color);
    read_alpha(d, value, m);
    read_emission(d, value, m->emission);
    m->is_double_sided = sides != JSON_NONE && d->tree.values[sides].kind == JSON_TRUE;
    m->is_unlit = ffd_gltf_has_extension(d, value, "KHR_materials_unlit");
    TRY(read_texture(r, colour.texture, &m->base));
    return read_texture(r, ffd_json_tree_member(&d->tree, value, "emissiveTexture"), &m->glow);
}

ffd_status ffd_gltf_list_materials(mesh_document *document, const mesh_log *log, mesh_materials *materials,
                                   ffd_error *error)
{
    const gltf_document *const d = ffd_gltf_of(document);
    reader r = {.document = d,
                .images = {.materials = materials,
                           .budget = &document->budget,
                           .mesh = d->base.folder,
                           .has_folder = !ffd_file_is_stream(d->path)},
                .error = error};
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < d->material_values.count; i++)
        TRY_END(read_material(&r, d->material_values.values[i]));
end:
    ffd_images_end(&r.images, log);
    return status;
}
