#include "io/gltf/read/gltf_textures.h"
#include <math.h>
#include <string.h>

/* A set's number, which is part of an attribute's name, must be less. */
#define SETS_MAX 1e6
/* Numbers of a transform must be less, so that degrees, and sums, are finite. */
#define LARGEST 1e300

bool ffd_gltf_read_count(const gltf_document *d, uint32_t value, double limit, size_t *count)
{
    double number;
    if (!ffd_json_span_number(&d->tree, value, &number) || !(number >= 0) || !(number < limit) ||
        floor(number) != number)
        return false;
    *count = (size_t)number;
    return true;
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

uint32_t ffd_gltf_next_texture(const gltf_document *d, uint32_t material, uint32_t v)
{
    const json_span *const tree = &d->tree;
    const uint32_t end = tree->values[material].next;
    for (v++; v < end;) {
        if (is_texture(tree, v))
            return v;
        v = ffd_json_span_key_is(tree, v, "extras") ? tree->values[v].next : v + 1;
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
    const uint32_t value = ffd_json_span_member(&d->tree, object, "texCoord");
    if (value != JSON_NONE && !ffd_gltf_read_count(d, value, SETS_MAX, set))
        add_fault(faults, value);
}

/* Reads a finite number; JSON_NONE leaves it as it is. */
static void read_number(const gltf_document *d, uint32_t value, double *number, gltf_texture_faults *faults)
{
    double read;
    if (value == JSON_NONE)
        return;
    if (ffd_json_span_number(&d->tree, value, &read) && fabs(read) < LARGEST)
        *number = read;
    else
        add_fault(faults, value);
}

/* Reads a member that is an array of two numbers. */
static void read_pair(const gltf_document *d, uint32_t object, const char *name, double pair[2],
                      gltf_texture_faults *faults)
{
    const uint32_t array = ffd_json_span_member(&d->tree, object, name);
    const bool is_pair =
        array != JSON_NONE && d->tree.values[array].kind == JSON_ARRAY && d->tree.values[array].count == 2;
    if (array != JSON_NONE && !is_pair)
        add_fault(faults, array);
    for (size_t i = 0; i < 2 && is_pair; i++)
        read_number(d, ffd_json_span_element(&d->tree, array, i), &pair[i], faults);
}

void ffd_gltf_read_texture(const gltf_document *d, uint32_t texture, gltf_texture_use *use,
                           gltf_texture_faults *faults)
{
    const json_span *const tree = &d->tree;
    const uint32_t transform = ffd_gltf_extension(d, texture, "KHR_texture_transform");
    const uint32_t rotation = ffd_json_span_member(tree, transform, "rotation");
    *use = (gltf_texture_use){.scale = {1, 1}};
    read_set(d, texture, &use->set, faults);
    if (transform != JSON_NONE && tree->values[transform].kind != JSON_OBJECT)
        add_fault(faults, transform);
    read_set(d, transform, &use->set, faults);
    read_pair(d, transform, "offset", use->offset, faults);
    read_pair(d, transform, "scale", use->scale, faults);
    read_number(d, rotation, &use->radians, faults);
}
