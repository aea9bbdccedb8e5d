#include "io/gltf/gltf_attribute.h"
#include "base/vector/trig.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

#define DEGREES_OF_RADIAN 57.29577951308232
/* A set's number, which is part of an attribute's name, must be less. */
#define SETS_MAX 1e6

static uint32_t attributes_of(const gltf_document *d, size_t m, size_t p)
{
    return ffd_json_span_member(&d->tree, ffd_gltf_primitive_value(d, m, p), "attributes");
}

/* Reads a whole number below limit. */
static bool read_count(const gltf_document *d, uint32_t value, double limit, size_t *count)
{
    double number;
    if (!ffd_json_span_number(&d->tree, value, &number) || !(number >= 0) || !(number < limit))
        return false;
    *count = (size_t)number;
    return true;
}

size_t ffd_gltf_attribute(const gltf_document *d, size_t m, size_t p, const char *name, int least, int most)
{
    const uint32_t value = ffd_json_span_member(&d->tree, attributes_of(d, m, p), name);
    const int positions = d->model.meshes[m].primitives[p].accessor[GLTF_POSITION];
    size_t a;
    if (positions < 0 || !read_count(d, value, (double)d->model.accessor_count, &a))
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
    return read_count(d, value, (double)d->material_values.count, &material)
               ? d->material_values.values[material]
               : JSON_NONE;
}

/* Whether a JSON value is a textureInfo: in the material and in any of its extensions it is an object
   "...Texture" with an index. */
static bool is_texture(const json_span *tree, uint32_t v)
{
    static const char ending[] = "Texture\"";
    const json_value *value = &tree->values[v];
    const size_t size = sizeof ending - 1;
    return value->kind == JSON_OBJECT && value->key_end - value->key_begin > size &&
           memcmp(tree->text + value->key_end - size, ending, size) == 0 &&
           ffd_json_span_member(tree, v, "index") != JSON_NONE;
}

/* Returns the first texture of a material after v, one of its values or the material itself; JSON_NONE:
   none. */
static uint32_t next_texture(const json_span *tree, uint32_t material, uint32_t v)
{
    const uint32_t end = tree->values[material].next;
    for (v++; v < end;) {
        if (is_texture(tree, v))
            return v;
        v = ffd_json_span_key_is(tree, v, "extras") ? tree->values[v].next : v + 1;
    }
    return JSON_NONE;
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
    return found == JSON_NONE ? next_texture(tree, material, material) : found;
}

/* Reads a finite number; otherwise *number stays. */
static void read_number(const json_span *tree, uint32_t value, double *number)
{
    double read;
    if (ffd_json_span_number(tree, value, &read) && isfinite(read))
        *number = read;
}

static void read_pair(const json_span *tree, uint32_t array, double pair[2])
{
    for (size_t i = 0; i < 2; i++)
        read_number(tree, ffd_json_span_element(tree, array, i), &pair[i]);
}

/* Translation times rotation times scale. A rotation is counter-clockwise if v points upwards, but in glTF v
   points downwards. */
static void read_transform(const gltf_document *d, uint32_t transform, gltf_texcoords *texcoords)
{
    const json_span *tree = &d->tree;
    double offset[2] = {0, 0}, scale[2] = {1, 1}, radians = 0, sine, cosine;
    read_pair(tree, ffd_json_span_member(tree, transform, "offset"), offset);
    read_pair(tree, ffd_json_span_member(tree, transform, "scale"), scale);
    read_number(tree, ffd_json_span_member(tree, transform, "rotation"), &radians);
    ffd_sincos_degrees(fabs(radians) < 1e300 ? radians * DEGREES_OF_RADIAN : 0, &sine, &cosine);
    *texcoords = (gltf_texcoords){.accessor = texcoords->accessor,
                                  .to_u = {cosine * scale[0], sine * scale[1], offset[0]},
                                  .to_v = {-sine * scale[0], cosine * scale[1], offset[1]}};
}

/* Finds the texture coordinates that a texture of a primitive's material uses. Returns the number of their
   set. */
static size_t find_taken(const gltf_document *d, size_t m, size_t p, uint32_t texture, gltf_texcoords *taken)
{
    const uint32_t transform = ffd_gltf_extension(d, texture, "KHR_texture_transform");
    char name[32];
    size_t set = 0;
    if (!read_count(d, ffd_json_span_member(&d->tree, transform, "texCoord"), SETS_MAX, &set))
        read_count(d, ffd_json_span_member(&d->tree, texture, "texCoord"), SETS_MAX, &set);
    snprintf(name, sizeof name, "TEXCOORD_%zu", set);
    taken->accessor = ffd_gltf_attribute(d, m, p, name, 2, 2);
    read_transform(d, transform, taken);
    return set;
}

size_t ffd_gltf_texcoords(const gltf_document *d, size_t m, size_t p, gltf_texcoords *texcoords)
{
    const size_t set = find_taken(d, m, p, main_texture(d, material_of(d, m, p)), texcoords);
    return texcoords->accessor == GLTF_NONE ? find_taken(d, m, p, JSON_NONE, texcoords) : set;
}

static bool has_further_set(const gltf_document *d, size_t m, size_t p, const gltf_texcoords *texcoords)
{
    const json_span *tree = &d->tree;
    for (uint32_t v = ffd_json_span_first(tree, attributes_of(d, m, p)); v != JSON_NONE;
         v = ffd_json_span_after(tree, v)) {
        const char *key = tree->text + tree->values[v].key_begin + 1;
        size_t a = GLTF_NONE;
        if (strncmp(key, "TEXCOORD_", 9) == 0 &&
            (!read_count(d, v, (double)d->model.accessor_count, &a) || a != texcoords->accessor))
            return true;
    }
    return false;
}

bool ffd_gltf_has_more_texcoords(const gltf_document *d, size_t m, size_t p, const gltf_texcoords *texcoords)
{
    const uint32_t material = material_of(d, m, p);
    if (has_further_set(d, m, p, texcoords))
        return true;
    for (uint32_t v = material == JSON_NONE ? JSON_NONE : next_texture(&d->tree, material, material);
         v != JSON_NONE; v = next_texture(&d->tree, material, v)) {
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
