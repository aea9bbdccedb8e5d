#include "io/gltf/read/gltf_textures.h"
#include "base/vector/trig.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A set's number, which is part of an attribute's name, must be less. */
#define SETS_MAX 1e6
/* Numbers of a transform must be less, so that degrees, and sums, are finite. */
#define LARGEST 1e300

/* Reads a whole number below limit. */
static bool read_count(const gltf_document *d, uint32_t value, double limit, size_t *count)
{
    double number;
    if (!ffd_json_tree_number(&d->tree, value, &number) || !(number >= 0) || !(number < limit) ||
        floor_of(number) != number)
        return false;
    *count = (size_t)number;
    return true;
}

/* Whether a JSON value is a textureInfo: in the material and in any of its extensions it is an object
   "...Texture" with an index. */
static bool is_texture(const json_tree *tree, uint32_t v)
{
    static const char ending[] = "Texture\"";
    const json_value *value = &tree->values[v];
    const size_t size = sizeof ending - 1;
    return value->kind == JSON_OBJECT && value->key_end - value->key_begin > size &&
           memcmp(tree->text + value->key_end - size, ending, size) == 0 &&
           ffd_json_tree_member(tree, v, "index") != JSON_NONE;
}

uint32_t ffd_gltf_next_texture(const gltf_document *d, uint32_t material, uint32_t v)
{
    const json_tree *const tree = &d->tree;
    const uint32_t end = tree->values[material].next;
    for (v++; v < end;) {
        if (is_texture(tree, v))
            return v;
        v = ffd_json_tree_key_is(tree, v, "extras") ? tree->values[v].next : v + 1;
    }
    return JSON_NONE;
}

static void add_fault(gltf_texture_faults *faults, uint32_t value)
{
    if (faults && faults->count < TEXTURE_FAULTS)
        faults->values[faults->count++] = value;
}

static void read_set(const gltf_document *d, uint32_t object, size_t *set, gltf_texture_faults *faults)
{
    const uint32_t value = ffd_json_tree_member(&d->tree, object, "texCoord");
    if (value != JSON_NONE && !read_count(d, value, SETS_MAX, set))
        add_fault(faults, value);
}

/* Reads a finite number; JSON_NONE leaves it as it is. */
static void read_number(const gltf_document *d, uint32_t value, double *number, gltf_texture_faults *faults)
{
    double read;
    if (value == JSON_NONE)
        return;
    if (ffd_json_tree_number(&d->tree, value, &read) && fabs(read) < LARGEST)
        *number = read;
    else
        add_fault(faults, value);
}

/* Reads a member that is an array of two numbers. */
static void read_pair(const gltf_document *d, uint32_t object, const char *name, double pair[2],
                      gltf_texture_faults *faults)
{
    const uint32_t array = ffd_json_tree_member(&d->tree, object, name);
    const bool is_pair =
        array != JSON_NONE && d->tree.values[array].kind == JSON_ARRAY && d->tree.values[array].count == 2;
    if (array != JSON_NONE && !is_pair)
        add_fault(faults, array);
    for (size_t i = 0; i < 2 && is_pair; i++)
        read_number(d, ffd_json_tree_element(&d->tree, array, i), &pair[i], faults);
}

void ffd_gltf_read_texture(const gltf_document *d, uint32_t texture, gltf_texture_use *use,
                           gltf_texture_faults *faults)
{
    const json_tree *const tree = &d->tree;
    const uint32_t transform = ffd_gltf_extension(d, texture, "KHR_texture_transform");
    const uint32_t rotation = ffd_json_tree_member(tree, transform, "rotation");
    *use = (gltf_texture_use){.scale = {1, 1}};
    read_set(d, texture, &use->set, faults);
    if (transform != JSON_NONE && tree->values[transform].kind != JSON_OBJECT)
        add_fault(faults, transform);
    read_set(d, transform, &use->set, faults);
    read_pair(d, transform, "offset", use->offset, faults);
    read_pair(d, transform, "scale", use->scale, faults);
    read_number(d, rotation, &use->radians, faults);
}

#define DEGREES_OF_RADIAN 57.29577951308232

static uint32_t attributes_of(const gltf_document *d, const gltf_primitive *primitive)
{
    return ffd_json_tree_member(&d->tree, primitive->value, "attributes");
}

size_t ffd_gltf_attribute(const gltf_document *d, const gltf_primitive *primitive, const char *name,
                          int least, int most)
{
    const uint32_t value = ffd_json_tree_member(&d->tree, attributes_of(d, primitive), name);
    const int positions = primitive->accessor[GLTF_POSITION];
    size_t a;
    if (positions < 0 || !read_count(d, value, (double)d->model.accessor_count, &a))
        return GLTF_NONE;
    const gltf_accessor *accessor = &d->model.accessors[a];
    const bool fits = accessor->columns == 1 && accessor->rows >= least && accessor->rows <= most &&
                      accessor->count >= d->model.accessors[positions].count && d->layouts[a].readable;
    return fits ? a : GLTF_NONE;
}

/* Returns the JSON value of a primitive's material; JSON_NONE: it has none. */
static uint32_t material_of(const gltf_document *d, const gltf_primitive *primitive)
{
    size_t material;
    const uint32_t value = ffd_json_tree_member(&d->tree, primitive->value, "material");
    return read_count(d, value, (double)d->material_values.count, &material)
               ? d->material_values.values[material]
               : JSON_NONE;
}

/* Returns the base colour texture of a material, else another of its textures; JSON_NONE: none. */
static uint32_t main_texture(const gltf_document *d, uint32_t material)
{
    const json_tree *tree = &d->tree;
    if (material == JSON_NONE)
        return JSON_NONE;
    uint32_t found = ffd_json_tree_member(tree, ffd_json_tree_member(tree, material, "pbrMetallicRoughness"),
                                          "baseColorTexture");
    if (found == JSON_NONE)
        found = ffd_json_tree_member(
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
static size_t find_taken(const gltf_document *d, const gltf_primitive *primitive, uint32_t texture,
                         gltf_texcoords *taken)
{
    gltf_texture_use use;
    char name[32];
    ffd_gltf_read_texture(d, texture, &use, NULL);
    snprintf(name, sizeof name, "TEXCOORD_%zu", use.set);
    taken->accessor = ffd_gltf_attribute(d, primitive, name, 2, 2);
    set_transform(&use, taken);
    return use.set;
}

size_t ffd_gltf_texcoords(const gltf_document *d, const gltf_primitive *primitive, gltf_texcoords *texcoords,
                          bool *stands_in)
{
    const size_t set = find_taken(d, primitive, main_texture(d, material_of(d, primitive)), texcoords);
    if (texcoords->accessor != GLTF_NONE)
        return set;
    const size_t other = find_taken(d, primitive, JSON_NONE, texcoords);
    *stands_in = texcoords->accessor != GLTF_NONE;
    return other;
}

size_t ffd_gltf_glow_texcoords(const gltf_document *d, const gltf_primitive *primitive,
                               gltf_texcoords *texcoords)
{
    const uint32_t glow = ffd_json_tree_member(&d->tree, material_of(d, primitive), "emissiveTexture");
    const size_t set = find_taken(d, primitive, glow, texcoords);
    return glow == JSON_NONE || texcoords->accessor == GLTF_NONE ? GLTF_NONE : set;
}

static bool has_further_set(const gltf_document *d, const gltf_primitive *primitive,
                            const gltf_texcoords *texcoords)
{
    const json_tree *tree = &d->tree;
    for (uint32_t v = ffd_json_tree_first(tree, attributes_of(d, primitive)); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v)) {
        const char *key = tree->text + tree->values[v].key_begin + 1;
        size_t a = GLTF_NONE;
        if (strncmp(key, "TEXCOORD_", 9) == 0 &&
            (!read_count(d, v, (double)d->model.accessor_count, &a) || a != texcoords->accessor))
            return true;
    }
    return false;
}

bool ffd_gltf_has_more_texcoords(const gltf_document *d, const gltf_primitive *primitive,
                                 const gltf_texcoords *texcoords)
{
    const uint32_t material = material_of(d, primitive);
    if (has_further_set(d, primitive, texcoords))
        return true;
    for (uint32_t v = material == JSON_NONE ? JSON_NONE : ffd_gltf_next_texture(d, material, material);
         v != JSON_NONE; v = ffd_gltf_next_texture(d, material, v)) {
        gltf_texcoords taken;
        find_taken(d, primitive, v, &taken);
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
