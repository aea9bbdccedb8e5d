#include "io/gltf/read/gltf_schema.h"
#include "base/memory/memory.h"
#include "io/gltf/read/gltf_hidden.h"
#include "io/gltf/read/gltf_model.h"
#include <math.h>
#include <string.h>

typedef enum rule_kind {
    RULE_INDEX,     /* an integer from 0 to 2^31-1 */
    RULE_SIZE,      /* an integer from 0 to 2^53 */
    RULE_STRIDE,    /* 0 to 252; glTF: 4, 8, .. 252 */
    RULE_COMPONENT, /* a componentType */
    RULE_SHAPE,     /* an accessor's type */
    RULE_MODE,      /* a primitive's mode: any finite number here; glTF: 0 to 6 */
    RULE_BOOL,
    RULE_STRING,
    RULE_STRINGS,
    RULE_NUMBERS,   /* an array of `count` finite numbers; count 0: any number of them */
    RULE_FINITE,    /* any value, but an array's numbers are finite */
    RULE_INDICES,   /* an array of indices */
    RULE_INDEX_MAP, /* an object whose values are all indices */
    RULE_INDEX_MAPS,
    RULE_OBJECT, /* an object that follows `inner` */
    RULE_OBJECTS
} rule_kind;

typedef struct rule {
    const char *key;
    rule_kind kind;
    bool required;
    size_t count;
    const struct rule *inner; /* ends with a rule without a key; NULL: any members */
} rule;

typedef struct checker {
    const json_tree *tree;
    const char *name;
    json_edits *integers;
    ffd_error *error;
} checker;

static const rule asset_rules[] = {{"version", RULE_STRING, true, 0, NULL},
                                   {"minVersion", RULE_STRING, false, 0, NULL},
                                   {"generator", RULE_STRING, false, 0, NULL},
                                   {0}};
static const rule buffer_rules[] = {
    {"byteLength", RULE_SIZE, true, 0, NULL}, {"uri", RULE_STRING, false, 0, NULL}, {0}};
static const rule meshopt_rules[] = {
    {"buffer", RULE_INDEX, true, 0, NULL},    {"byteOffset", RULE_SIZE, false, 0, NULL},
    {"byteLength", RULE_SIZE, true, 0, NULL}, {"byteStride", RULE_SIZE, true, 0, NULL},
    {"count", RULE_SIZE, true, 0, NULL},      {"mode", RULE_STRING, true, 0, NULL},
    {"filter", RULE_STRING, false, 0, NULL},  {0}};
static const rule view_extension_rules[] = {{"EXT_meshopt_compression", RULE_OBJECT, false, 0, meshopt_rules},
                                            {"KHR_meshopt_compression", RULE_OBJECT, false, 0, meshopt_rules},
                                            {0}};
static const rule view_rules[] = {{"buffer", RULE_INDEX, true, 0, NULL},
                                  {"byteOffset", RULE_SIZE, false, 0, NULL},
                                  {"byteLength", RULE_SIZE, true, 0, NULL},
                                  {"byteStride", RULE_STRIDE, false, 0, NULL},
                                  {"target", RULE_INDEX, false, 0, NULL},
                                  {"extensions", RULE_OBJECT, false, 0, view_extension_rules},
                                  {0}};
/* tinygltf stores these offsets in an int. */
static const rule sparse_indices_rules[] = {{"bufferView", RULE_INDEX, true, 0, NULL},
                                            {"byteOffset", RULE_INDEX, false, 0, NULL},
                                            {"componentType", RULE_COMPONENT, true, 0, NULL},
                                            {0}};
static const rule sparse_values_rules[] = {
    {"bufferView", RULE_INDEX, true, 0, NULL}, {"byteOffset", RULE_INDEX, false, 0, NULL}, {0}};
static const rule sparse_rules[] = {{"count", RULE_INDEX, true, 0, NULL},
                                    {"indices", RULE_OBJECT, true, 0, sparse_indices_rules},
                                    {"values", RULE_OBJECT, true, 0, sparse_values_rules},
                                    {0}};
static const rule accessor_rules[] = {{"bufferView", RULE_INDEX, false, 0, NULL},
                                      {"byteOffset", RULE_SIZE, false, 0, NULL},
                                      {"componentType", RULE_COMPONENT, true, 0, NULL},
                                      {"normalized", RULE_BOOL, false, 0, NULL},
                                      {"count", RULE_SIZE, true, 0, NULL},
                                      {"type", RULE_SHAPE, true, 0, NULL},
                                      {"min", RULE_NUMBERS, false, 0, NULL},
                                      {"max", RULE_NUMBERS, false, 0, NULL},
                                      {"sparse", RULE_OBJECT, false, 0, sparse_rules},
                                      {0}};
static const rule draco_rules[] = {
    {"bufferView", RULE_INDEX, true, 0, NULL}, {"attributes", RULE_INDEX_MAP, true, 0, NULL}, {0}};
static const rule primitive_extension_rules[] = {
    {"KHR_draco_mesh_compression", RULE_OBJECT, false, 0, draco_rules}, {0}};
static const rule primitive_rules[] = {{"attributes", RULE_INDEX_MAP, true, 0, NULL},
                                       {"indices", RULE_INDEX, false, 0, NULL},
                                       {"material", RULE_INDEX, false, 0, NULL},
                                       {"mode", RULE_MODE, false, 0, NULL},
                                       {"targets", RULE_INDEX_MAPS, false, 0, NULL},
                                       {"extensions", RULE_OBJECT, false, 0, primitive_extension_rules},
                                       {0}};
static const rule mesh_rules[] = {{"primitives", RULE_OBJECTS, true, 0, primitive_rules},
                                  {"weights", RULE_FINITE, false, 0, NULL},
                                  {"name", RULE_STRING, false, 0, NULL},
                                  {0}};
static const rule node_rules[] = {{"mesh", RULE_INDEX, false, 0, NULL},
                                  {"skin", RULE_INDEX, false, 0, NULL},
                                  {"children", RULE_INDICES, false, 0, NULL},
                                  {"matrix", RULE_NUMBERS, false, 16, NULL},
                                  {"translation", RULE_NUMBERS, false, 3, NULL},
                                  {"rotation", RULE_NUMBERS, false, 4, NULL},
                                  {"scale", RULE_NUMBERS, false, 3, NULL},
                                  {"weights", RULE_FINITE, false, 0, NULL},
                                  {"extensions", RULE_OBJECT, false, 0, NULL},
                                  {"name", RULE_STRING, false, 0, NULL},
                                  {0}};
static const rule skin_rules[] = {
    {"joints", RULE_INDICES, true, 0, NULL}, {"inverseBindMatrices", RULE_INDEX, false, 0, NULL}, {0}};
static const rule scene_rules[] = {{"nodes", RULE_INDICES, false, 0, NULL}, {0}};
static const rule image_rules[] = {
    {"uri", RULE_STRING, false, 0, NULL}, {"bufferView", RULE_INDEX, false, 0, NULL}, {0}};
static const rule root_rules[] = {{"asset", RULE_OBJECT, true, 0, asset_rules},
                                  {"extensionsUsed", RULE_STRINGS, false, 0, NULL},
                                  {"extensionsRequired", RULE_STRINGS, false, 0, NULL},
                                  {"buffers", RULE_OBJECTS, false, 0, buffer_rules},
                                  {"bufferViews", RULE_OBJECTS, false, 0, view_rules},
                                  {"accessors", RULE_OBJECTS, false, 0, accessor_rules},
                                  {"meshes", RULE_OBJECTS, false, 0, mesh_rules},
                                  {"nodes", RULE_OBJECTS, false, 0, node_rules},
                                  {"scenes", RULE_OBJECTS, false, 0, scene_rules},
                                  {"scene", RULE_INDEX, false, 0, NULL},
                                  {"images", RULE_OBJECTS, false, 0, image_rules},
                                  {"skins", RULE_OBJECTS, false, 0, skin_rules},
                                  {"animations", RULE_OBJECTS, false, 0, NULL},
                                  {0}};

static ffd_status check_value(const checker *c, uint32_t value, const rule *r);

static ffd_status refuse(const checker *c, uint32_t value, const char *expected)
{
    const json_value *v = &c->tree->values[value];
    const int shown = v->end - v->begin > 40 ? 40 : (int)(v->end - v->begin);
    return ffd_json_tree_fail(c->tree, value, c->name, FFD_E_INVALID, c->error, "%s is expected, not %.*s%s",
                              expected, shown, c->tree->text + v->begin, shown == 40 ? "..." : "");
}

static bool is_kind(const checker *c, uint32_t value, json_kind kind)
{
    return c->tree->values[value].kind == kind;
}

static ffd_status check_stride(const checker *c, uint32_t value)
{
    double number;
    if (!ffd_json_tree_number(c->tree, value, &number) || !(number >= 0 && number <= 252) ||
        floor_of(number) != number)
        return refuse(c, value, "a multiple of 4 from 4 to 252");
    return FFD_OK;
}

static ffd_status check_mode(const checker *c, uint32_t value)
{
    double number;
    if (!ffd_json_tree_number(c->tree, value, &number) || !isfinite(number))
        return refuse(c, value, "a mode from 0 to 6");
    return FFD_OK;
}

/* Reads an integer of [0, largest], and shows it to tinygltf. */
static bool read_integer(const checker *c, uint32_t value, double largest, double *number)
{
    if (!ffd_json_tree_number(c->tree, value, number) || !(*number >= 0 && *number <= largest) ||
        floor_of(*number) != *number)
        return false;
    ffd_gltf_show_integer(c->tree, value, *number, c->integers);
    return true;
}

bool ffd_gltf_uses(const json_tree *tree, const char *extension)
{
    const uint32_t used = ffd_json_tree_member(tree, 0, "extensionsUsed");
    for (uint32_t v = ffd_json_tree_first(tree, used); v != JSON_NONE; v = ffd_json_tree_after(tree, v))
        if (ffd_json_tree_string_is(tree, v, extension))
            return true;
    return false;
}

bool ffd_gltf_list_used(const json_tree *tree, intern_table *names)
{
    const uint32_t used = ffd_json_tree_member(tree, 0, "extensionsUsed");
    bool whole = true;
    for (uint32_t v = ffd_json_tree_first(tree, used); v != JSON_NONE && whole;
         v = ffd_json_tree_after(tree, v)) {
        char *const name = ffd_json_tree_string(tree, v, NULL);
        uint32_t index;
        whole = name && ffd_intern(names, name, strlen(name), &index);
        ffd_free(name);
    }
    return whole;
}

/* The component type added by KHR_accessor_float64. */
#define COMPONENT_DOUBLE 5130

static ffd_status check_component(const checker *c, uint32_t value, bool known, double number)
{
    if (known && number >= 5120 && number <= 5126 && (number < 5124 || number > 5124))
        return FFD_OK;
    if (!(known && number >= COMPONENT_DOUBLE && number <= COMPONENT_DOUBLE) ||
        !ffd_gltf_uses(c->tree, "KHR_accessor_float64"))
        return refuse(c, value, "a component type (5120 to 5123, 5125, 5126)");
    return ffd_json_tree_fail(c->tree, value, c->name, FFD_E_UNSUPPORTED, c->error,
                              "component type %d, double precision, of KHR_accessor_float64 is not supported",
                              COMPONENT_DOUBLE);
}

static ffd_status check_integer(const checker *c, uint32_t value, rule_kind kind)
{
    double number = 0;
    const bool known = read_integer(c, value, kind == RULE_SIZE ? 0x1p53 : INT32_MAX, &number);
    switch (kind) {
    case RULE_INDEX:
        return known ? FFD_OK : refuse(c, value, "an integer from 0 to 2147483647");
    case RULE_SIZE:
        if (known && number > (double)GLTF_LARGEST_SIZE)
            return ffd_json_tree_fail(
                c->tree, value, c->name, FFD_E_LIMIT, c->error,
                "%.0f is more than the %zu that a program with addresses of 32 bits holds", number,
                GLTF_LARGEST_SIZE);
        return known ? FFD_OK : refuse(c, value, "an integer from 0 to 2^53");
    default:
        return check_component(c, value, known, number);
    }
}

static ffd_status check_shape(const checker *c, uint32_t value)
{
    static const char *const shapes[] = {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"};
    for (size_t i = 0; i < sizeof shapes / sizeof *shapes; i++)
        if (ffd_json_tree_string_is(c->tree, value, shapes[i]))
            return FFD_OK;
    return refuse(c, value, "\"SCALAR\", \"VEC2\" to \"VEC4\" or \"MAT2\" to \"MAT4\"");
}

static ffd_status check_members(const checker *c, uint32_t container, const rule *member)
{
    const json_tree *tree = c->tree;
    for (uint32_t v = ffd_json_tree_first(tree, container); v != JSON_NONE; v = ffd_json_tree_after(tree, v))
        TRY(check_value(c, v, member));
    return FFD_OK;
}

static ffd_status check_object(const checker *c, uint32_t object, const rule *rules)
{
    for (const rule *r = rules; r && r->key; r++) {
        const uint32_t member = ffd_json_tree_member(c->tree, object, r->key);
        if (member == JSON_NONE && !r->required)
            continue;
        if (member == JSON_NONE)
            return ffd_json_tree_fail(c->tree, object, c->name, FFD_E_INVALID, c->error, "\"%s\" is missing",
                                      r->key);
        TRY(check_value(c, member, r));
    }
    return FFD_OK;
}

/* The digits of the largest number. */
#define FINITE_DIGITS 308

/* Whether a number is finite; without an exponent it takes no parsing. */
static bool is_finite(const checker *c, uint32_t value)
{
    const json_value *const v = &c->tree->values[value];
    const size_t length = v->end - v->begin;
    const char *const text = c->tree->text + v->begin;
    double number;
    if (v->kind != JSON_NUMBER)
        return false;
    if (length < FINITE_DIGITS && !memchr(text, 'e', length) && !memchr(text, 'E', length))
        return true;
    return ffd_json_tree_number(c->tree, value, &number) && isfinite(number);
}

static ffd_status check_numbers(const checker *c, uint32_t value, size_t count)
{
    if (!is_kind(c, value, JSON_ARRAY))
        return refuse(c, value, "an array of numbers");
    if (count > 0 && c->tree->values[value].count != count)
        return ffd_json_tree_fail(c->tree, value, c->name, FFD_E_INVALID, c->error,
                                  "%zu numbers are expected, not %lu", count,
                                  (unsigned long)c->tree->values[value].count);
    for (uint32_t v = ffd_json_tree_first(c->tree, value); v != JSON_NONE;
         v = ffd_json_tree_after(c->tree, v)) {
        if (!is_finite(c, v))
            return refuse(c, v, "a finite number");
    }
    return FFD_OK;
}

static ffd_status check_finite(const checker *c, uint32_t value)
{
    for (uint32_t v = is_kind(c, value, JSON_ARRAY) ? ffd_json_tree_first(c->tree, value) : JSON_NONE;
         v != JSON_NONE; v = ffd_json_tree_after(c->tree, v))
        if (is_kind(c, v, JSON_NUMBER) && !is_finite(c, v))
            return refuse(c, v, "a finite number");
    return FFD_OK;
}

static ffd_status check_array(const checker *c, uint32_t value, const rule *element, const char *expected)
{
    return is_kind(c, value, JSON_ARRAY) ? check_members(c, value, element) : refuse(c, value, expected);
}

static ffd_status check_value(const checker *c, uint32_t value, const rule *r)
{
    static const rule index = {.kind = RULE_INDEX}, string = {.kind = RULE_STRING},
                      map = {.kind = RULE_INDEX_MAP};
    const rule object = {.kind = RULE_OBJECT, .inner = r->inner};
    switch (r->kind) {
    case RULE_INDEX:
    case RULE_SIZE:
    case RULE_COMPONENT:
        return check_integer(c, value, r->kind);
    case RULE_STRIDE:
        return check_stride(c, value);
    case RULE_MODE:
        return check_mode(c, value);
    case RULE_SHAPE:
        return check_shape(c, value);
    case RULE_BOOL:
        return is_kind(c, value, JSON_TRUE) || is_kind(c, value, JSON_FALSE)
                   ? FFD_OK
                   : refuse(c, value, "true or false");
    case RULE_STRING:
        return is_kind(c, value, JSON_STRING) ? FFD_OK : refuse(c, value, "a string");
    case RULE_STRINGS:
        return check_array(c, value, &string, "an array of strings");
    case RULE_NUMBERS:
        return check_numbers(c, value, r->count);
    case RULE_FINITE:
        return check_finite(c, value);
    case RULE_INDICES:
        return check_array(c, value, &index, "an array of integers");
    case RULE_INDEX_MAP:
        return is_kind(c, value, JSON_OBJECT) ? check_members(c, value, &index)
                                              : refuse(c, value, "an object");
    case RULE_INDEX_MAPS:
        return check_array(c, value, &map, "an array of objects");
    case RULE_OBJECT:
        return is_kind(c, value, JSON_OBJECT) ? check_object(c, value, r->inner)
                                              : refuse(c, value, "an object");
    case RULE_OBJECTS:
        return check_array(c, value, &object, "an array of objects");
    }
    return FFD_OK;
}

/* Whether the text is two whole numbers with a point between. */
static bool is_version(const char *text)
{
    static const char digits[] = "0123456789";
    const size_t major = strspn(text, digits);
    if (major == 0 || text[major] != '.')
        return false;
    const size_t minor = strspn(text + major + 1, digits);
    return minor > 0 && text[major + 1 + minor] == 0;
}

static ffd_status check_version(const checker *c)
{
    const uint32_t version =
        ffd_json_tree_member(c->tree, ffd_json_tree_member(c->tree, 0, "asset"), "version");
    char *text = ffd_json_tree_string(c->tree, version, NULL);
    if (!text)
        return ffd_fail_memory(c->error);
    ffd_status status = FFD_OK;
    if (!is_version(text))
        status = ffd_json_tree_fail(c->tree, version, c->name, FFD_E_INVALID, c->error,
                                    "\"%s\" is not a version of glTF like \"2.0\"", text);
    else if (strncmp(text, "2.", 2) != 0)
        status = ffd_json_tree_fail(c->tree, version, c->name, FFD_E_UNSUPPORTED, c->error,
                                    "glTF version \"%s\" is not known, only 2", text);
    ffd_free(text);
    return status;
}

ffd_status ffd_gltf_check_schema(const json_tree *tree, const char *name, json_edits *integers,
                                 ffd_error *error)
{
    const checker c = {.tree = tree, .name = name, .integers = integers, .error = error};
    if (tree->values[0].kind != JSON_OBJECT)
        return ffd_fail_file(error, FFD_E_INVALID, name, "is not glTF: the JSON is not an object");
    TRY(check_object(&c, 0, root_rules));
    return check_version(&c);
}
