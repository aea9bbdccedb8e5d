#include "io/gltf/gltf_attribute.h"
#include "base/vector/trig.h"
#include "io/gltf/read/gltf_textures.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define DEGREES_OF_RADIAN 57.29577951308232

static uint32_t attributes_of(const gltf_document *d, size_t m, size_t p)
{
    return ffd_json_span_member(&d->tree, ffd_gltf_primitive_value(d, m, p), "attributes");
}

size_t ffd_gltf_attribute(const gltf_document *d, size_t m, size_t p, const char *name, int least, int most)
{
    const uint32_t value = ffd_json_span_member(&d->tree, attributes_of(d, m, p), name);
    const int positions = d->model.meshes[m].primitives[p].accessor[GLTF_POSITION];
    size_t a;
    if (positions < 0 || !ffd_gltf_read_count(d, value, (double)d->model.accessor_count, &a))
        return GLTF_NONE;
    const gltf_accessor *accessor = &d->model.accessors[a];
    const bool fits = accessor->columns == 1 && accessor->rows >= least && accessor->rows <= most &&
                      accessor->count >= d->model.accessors[positions].count && d->layouts[a].readable;
    return fits ? a : GLTF_NONE;
}

/* Returns the JSON value of a primitive's material; JSON_NONE: it has none. */
static uint32_t material_of(const gltf_document *d, size_t m, size_t p)
{
    size_t material;
    const uint32_t value = ffd_json_span_member(&d->tree, ffd_gltf_primitive_value(d, m, p), "material");
    return ffd_gltf_read_count(d, value, (double)d->material_values.count, &material)
               ? d->material_values.values[material]
               : JSON_NONE;
}

/* Returns the base colour texture of a material, else another of its textures; JSON_NONE: none. */
static uint32_t main_texture(const gltf_document *d, uint32_t material)
{
    const json_span *tree = &d->tree;
    if (material == JSON_NONE)
        return JSON_NONE;
    uint32_t found = ffd_json_span_member(tree, ffd_json_span_member(tree, material, "pbrMetallicRoughness"),
                                          "baseColorTexture");
    if (found == JSON_NONE)
        found = ffd_json_span_member(
            tree, ffd_gltf_extension(d, material, "KHR_materials_pbrSpecularGlossiness"), "diffuseTexture");
    return found == JSON_NONE ? ffd_gltf_next_texture(d, material, material) : found;
}

/* Translation times rotation times scale. A rotation is counter-clockwise if v points upwards, but in glTF v
   points downwards. */
static void set_transform(const gltf_texture_use *use, gltf_texcoords *texcoords)
{
    const double *const scale = use->scale;
    double sine, cosine;
    ffd_sincos_degrees(use->radians * DEGREES_OF_RADIAN, &sine, &cosine);
    *texcoords = (gltf_texcoords){.accessor = texcoords->accessor,
                                  .to_u = {cosine * scale[0], sine * scale[1], use->offset[0]},
                                  .to_v = {-sine * scale[0], cosine * scale[1], use->offset[1]}};
}

/* Finds the texture coordinates that a texture of a primitive's material uses. Returns the number of their
   set. */
static size_t find_taken(const gltf_document *d, size_t m, size_t p, uint32_t texture, gltf_texcoords *taken)
{
    gltf_texture_use use;
    char name[32];
    ffd_gltf_read_texture(d, texture, &use, NULL);
    snprintf(name, sizeof name, "TEXCOORD_%zu", use.set);
    taken->accessor = ffd_gltf_attribute(d, m, p, name, 2, 2);
    set_transform(&use, taken);
    return use.set;
}

size_t ffd_gltf_texcoords(const gltf_document *d, size_t m, size_t p, gltf_texcoords *texcoords,
                          bool *stands_in)
{
    const size_t set = find_taken(d, m, p, main_texture(d, material_of(d, m, p)), texcoords);
    if (texcoords->accessor != GLTF_NONE)
        return set;
    const size_t other = find_taken(d, m, p, JSON_NONE, texcoords);
    *stands_in = texcoords->accessor != GLTF_NONE;
    return other;
}

static bool has_further_set(const gltf_document *d, size_t m, size_t p, const gltf_texcoords *texcoords)
{
    const json_span *tree = &d->tree;
    for (uint32_t v = ffd_json_span_first(tree, attributes_of(d, m, p)); v != JSON_NONE;
         v = ffd_json_span_after(tree, v)) {
        const char *key = tree->text + tree->values[v].key_begin + 1;
        size_t a = GLTF_NONE;
        if (strncmp(key, "TEXCOORD_", 9) == 0 &&
            (!ffd_gltf_read_count(d, v, (double)d->model.accessor_count, &a) || a != texcoords->accessor))
            return true;
    }
    return false;
}

bool ffd_gltf_has_more_texcoords(const gltf_document *d, size_t m, size_t p, const gltf_texcoords *texcoords)
{
    const uint32_t material = material_of(d, m, p);
    if (has_further_set(d, m, p, texcoords))
        return true;
    for (uint32_t v = material == JSON_NONE ? JSON_NONE : ffd_gltf_next_texture(d, material, material);
         v != JSON_NONE; v = ffd_gltf_next_texture(d, material, v)) {
        gltf_texcoords taken;
        find_taken(d, m, p, v, &taken);
        if (taken.accessor != GLTF_NONE && memcmp(&taken, texcoords, sizeof taken) != 0)
            return true;
    }
    return false;
}

void ffd_gltf_turn_texcoords(const gltf_texcoords *texcoords, size_t count, double *values)
{
    const double *to_u = texcoords->to_u, *to_v = texcoords->to_v;
    for (size_t i = 0; i < count; i++) {
        const double u = values[2 * i], v = values[2 * i + 1];
        values[2 * i] = to_u[0] * u + to_u[1] * v + to_u[2];
        values[2 * i + 1] = 1 - (to_v[0] * u + to_v[1] * v + to_v[2]);
    }
}
