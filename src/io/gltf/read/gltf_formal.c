#include "io/gltf/read/gltf_formal.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/read/gltf_schema.h"
#include <stdio.h>
#include <string.h>

static ffd_status refuse(const gltf_document *d, uint32_t value, ffd_error *error, const char *format, ...)
    FFD_PRINTF(4, 5);

static ffd_status refuse(const gltf_document *d, uint32_t value, ffd_error *error, const char *format, ...)
{
    char message[sizeof error->message];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return ffd_json_tree_fail(&d->tree, value, d->name, FFD_E_INVALID, error, "%s", message);
}

/* Number types, as bits. */
enum {
    FLOATS = 1,
    U8 = 2,
    U16 = 4,
    UNORM8 = 8,
    UNORM16 = 16,
    I8 = 32,
    I16 = 64,
    NORM8 = 128,
    NORM16 = 256,
    OTHERS = 512
};

typedef struct attribute_format {
    int least, most; /* numbers of a vertex; 0: there is no such attribute */
    int types;
} attribute_format;

/* The formats of an attribute of a primitive and of its morph targets: glTF 2.0, 3.7.2.1 and 3.7.2.2, and
   KHR_mesh_quantization. */
typedef struct attribute_rule {
    const char *name; /* up to the number of the set, if it has sets */
    bool has_sets;
    attribute_format own, target;
    int more_types; /* with KHR_mesh_quantization */
} attribute_rule;

#define FRACTIONS (FLOATS | UNORM8 | UNORM16)
#define SIGNED_FRACTIONS (NORM8 | NORM16)

static const attribute_rule rules[] = {
    {"POSITION",
     false,
     {3, 3, FLOATS},
     {3, 3, FLOATS},
     U8 | U16 | UNORM8 | UNORM16 | I8 | I16 | SIGNED_FRACTIONS},
    {"NORMAL", false, {3, 3, FLOATS}, {3, 3, FLOATS}, SIGNED_FRACTIONS},
    {"TANGENT", false, {4, 4, FLOATS}, {3, 3, FLOATS}, SIGNED_FRACTIONS},
    {"TEXCOORD_",
     true,
     {2, 2, FRACTIONS},
     {2, 2, FRACTIONS | SIGNED_FRACTIONS},
     U8 | U16 | I8 | I16 | SIGNED_FRACTIONS},
    {"COLOR_", true, {3, 4, FRACTIONS}, {3, 4, FRACTIONS | SIGNED_FRACTIONS}, 0},
    {"JOINTS_", true, {4, 4, U8 | U16}, {0, 0, 0}, 0},
    {"WEIGHTS_", true, {4, 4, FRACTIONS}, {0, 0, 0}, 0},
};

static int type_of(const gltf_accessor *accessor)
{
    const bool is_normalized = accessor->normalized;
    switch (accessor->component) {
    case GLTF_FLOAT:
        return FLOATS;
    case GLTF_U8:
        return is_normalized ? UNORM8 : U8;
    case GLTF_U16:
        return is_normalized ? UNORM16 : U16;
    case GLTF_I8:
        return is_normalized ? NORM8 : I8;
    case GLTF_I16:
        return is_normalized ? NORM16 : I16;
    default:
        return OTHERS;
    }
}

/* What the attributes and indices before have used. */
typedef struct view_use {
    int attributes; /* the accessor that read it as attributes; -1: none */
    bool has_indices;
} view_use;

typedef struct attribute_check {
    const gltf_document *document;
    view_use *views;
    bool is_quantized; /* KHR_mesh_quantization is used */
} attribute_check;

/* Reads the number of a set, which has no leading zeros. Returns false if the text is none. */
static bool read_set(const char *text, unsigned *set)
{
    char again[16];
    if (sscanf(text, "%9u", set) != 1)
        return false;
    snprintf(again, sizeof again, "%u", *set);
    return strcmp(again, text) == 0;
}

/* Returns the rule of an attribute, and the number of its set; NULL: it is none of glTF. */
static const attribute_rule *find_rule(const char *name, unsigned *set)
{
    for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
        const size_t length = strlen(rules[i].name);
        *set = 0;
        if (rules[i].has_sets ? strncmp(name, rules[i].name, length) == 0 && read_set(name + length, set)
                              : strcmp(name, rules[i].name) == 0)
            return &rules[i];
    }
    return NULL;
}

/* Texts that name a format in a message, as "VEC3 of component type 5126". */
static void describe_format(const gltf_accessor *accessor, char *text, size_t capacity)
{
    const char *const kind = accessor->columns > 1 ? "MAT" : accessor->rows > 1 ? "VEC" : "SCALAR";
    char number[12] = "";
    if (accessor->rows > 1)
        snprintf(number, sizeof number, "%d", accessor->rows);
    snprintf(text, capacity, "%s%s of %scomponent type %d", kind, number,
             accessor->normalized ? "normalized " : "", accessor->component);
}

static ffd_status check_format(const attribute_check *check, uint32_t value, const char *name,
                               const attribute_rule *rule, bool is_target, int a, ffd_error *error)
{
    const gltf_accessor *const accessor = &check->document->model.accessors[a];
    const attribute_format *const allowed = is_target ? &rule->target : &rule->own;
    const int type = type_of(accessor);
    char format[64];
    if (accessor->columns == 1 && accessor->rows >= allowed->least && accessor->rows <= allowed->most &&
        (allowed->types | (check->is_quantized ? rule->more_types : 0)) & type)
        return FFD_OK;
    describe_format(accessor, format, sizeof format);
    return refuse(check->document, value, error, "%s is %s, which glTF does not have for it%s%s", name,
                  format, is_target ? " in a morph target" : "",
                  rule->more_types & type && !check->is_quantized
                      ? " without KHR_mesh_quantization in extensionsUsed"
                      : "");
}

/* The sets of an attribute are numbered from 0 on. Those of joints and weights are told elsewhere. */
static ffd_status check_set(const attribute_check *check, uint32_t attributes, uint32_t value,
                            const attribute_rule *rule, unsigned set, ffd_error *error)
{
    char before[40];
    if (set == 0)
        return FFD_OK;
    snprintf(before, sizeof before, "%s%u", rule->name, set - 1);
    if (ffd_json_tree_member(&check->document->tree, attributes, before) != JSON_NONE)
        return FFD_OK;
    return refuse(check->document, value, error, "there is %s%u, but no %s", rule->name, set, before);
}

/* Misaligned components are told elsewhere (gltf_check.c). */
static ffd_status check_alignment(const attribute_check *check, const gltf_accessor *accessor,
                                  const gltf_view *view, uint32_t value, ffd_error *error)
{
    const size_t component = ffd_gltf_component_size(accessor->component);
    const size_t size = component * (size_t)accessor->rows * (size_t)accessor->columns;
    const bool is_known = accessor->offset % component || (view->offset + accessor->offset) % component;
    if (is_known || (accessor->offset % 4 == 0 && (view->stride || size % 4 == 0)))
        return FFD_OK;
    return refuse(check->document, value, error,
                  "the values of a vertex attribute begin at multiples of 4 bytes, these do not");
}

#define ARRAY_BUFFER 34962
#define ELEMENT_ARRAY_BUFFER 34963

/* A bufferView holds either vertex attributes or indices, and its target, where it states one, says which. */
static ffd_status check_mixed(const attribute_check *check, int view, uint32_t value, bool is_indices,
                              ffd_error *error)
{
    const gltf_document *const d = check->document;
    const view_use *const use = &check->views[view];
    const uint32_t target = ffd_json_tree_member(&d->tree, d->view_values.values[view], "target");
    double number;
    if (use->attributes >= 0 && use->has_indices)
        return refuse(d, value, error, "bufferView %d holds vertex attributes and indices", view);
    if (!ffd_json_tree_number(&d->tree, target, &number) ||
        number != (is_indices ? ARRAY_BUFFER : ELEMENT_ARRAY_BUFFER))
        return FFD_OK;
    return refuse(d, value, error, "bufferView %d holds %s, but its target is %.0f", view,
                  is_indices ? "indices" : "vertex attributes", number);
}

static ffd_status check_view(const attribute_check *check, uint32_t value, int a, ffd_error *error)
{
    const gltf_document *const d = check->document;
    const gltf_accessor *const accessor = &d->model.accessors[a];
    if (accessor->view < 0)
        return FFD_OK;
    const gltf_view *const view = &d->model.views[accessor->view];
    view_use *const use = &check->views[accessor->view];
    const bool is_second = use->attributes >= 0 && use->attributes != a && view->stride == 0;
    use->attributes = a;
    TRY(check_alignment(check, accessor, view, value, error));
    if (is_second)
        TRY(refuse(d, value, error, "bufferView %d holds several vertex attributes, but states no byteStride",
                   accessor->view));
    return check_mixed(check, accessor->view, value, false, error);
}

/* An extension's attributes have its name before a colon. */
static bool is_own_name(const char *name)
{
    return name[0] == '_' || strchr(name, ':');
}

static ffd_status check_attribute(const attribute_check *check, uint32_t attributes, uint32_t value,
                                  const char *name, bool is_target, ffd_error *error)
{
    const gltf_document *const d = check->document;
    unsigned set;
    double number;
    const attribute_rule *const rule = find_rule(name, &set);
    if (!rule && !is_own_name(name))
        TRY(refuse(d, value, error, "there is no attribute \"%s\" in glTF: one of your own begins with _",
                   name));
    if (!ffd_json_tree_number(&d->tree, value, &number) ||
        !(number >= 0 && number < (double)d->model.accessor_count))
        return FFD_OK;
    if (rule)
        TRY(check_format(check, value, name, rule, is_target, (int)number, error));
    else if (d->model.accessors[(int)number].component == GLTF_U32)
        TRY(refuse(d, value, error, "no vertex attribute has numbers of component type %d", GLTF_U32));
    if (rule && !is_target)
        TRY(check_set(check, attributes, value, rule, set, error));
    return check_view(check, value, (int)number, error);
}

/* base: the attributes that the targets move; JSON_NONE: these are not of a target. */
static ffd_status check_list(const attribute_check *check, uint32_t attributes, uint32_t base,
                             ffd_error *error)
{
    const json_tree *const tree = &check->document->tree;
    ffd_status status = FFD_OK;
    for (uint32_t v = ffd_json_tree_first(tree, attributes); v != JSON_NONE && !status;
         v = ffd_json_tree_after(tree, v)) {
        char *const name = ffd_json_tree_key(tree, v);
        if (!name)
            return ffd_fail_memory(error);
        status = check_attribute(check, attributes, v, name, base != JSON_NONE, error);
        if (!status && base != JSON_NONE && ffd_json_tree_member(tree, base, name) == JSON_NONE)
            status = refuse(check->document, v, error, "a morph target moves %s, but the primitive has none",
                            name);
        ffd_free(name);
    }
    return status;
}

static ffd_status check_indices(const attribute_check *check, const gltf_primitive *primitive,
                                ffd_error *error)
{
    const gltf_document *const d = check->document;
    const int view = primitive->indices < 0 ? -1 : d->model.accessors[primitive->indices].view;
    if (view < 0)
        return FFD_OK;
    check->views[view].has_indices = true;
    return check_mixed(check, view, ffd_json_tree_member(&d->tree, primitive->value, "indices"), true, error);
}

static ffd_status check_primitive(const attribute_check *check, const gltf_primitive *primitive,
                                  ffd_error *error)
{
    const gltf_document *const d = check->document;
    const uint32_t attributes = ffd_json_tree_member(&d->tree, primitive->value, "attributes");
    const uint32_t targets = ffd_json_tree_member(&d->tree, primitive->value, "targets");
    if (ffd_json_tree_count(&d->tree, attributes) == 0)
        TRY(refuse(d, attributes == JSON_NONE ? primitive->value : attributes, error,
                   "a primitive has at least one attribute, this one has none"));
    TRY(check_list(check, attributes, JSON_NONE, error));
    for (uint32_t t = ffd_json_tree_first(&d->tree, targets); t != JSON_NONE;
         t = ffd_json_tree_after(&d->tree, t)) {
        if (ffd_json_tree_count(&d->tree, t) == 0)
            TRY(refuse(d, t, error, "a morph target has at least one attribute, this one has none"));
        TRY(check_list(check, t, attributes, error));
    }
    return check_indices(check, primitive, error);
}

static ffd_status check_attributes(const gltf_document *d, ffd_error *error)
{
    attribute_check check = {.document = d,
                             .is_quantized = ffd_gltf_uses(&d->tree, "KHR_mesh_quantization"),
                             .views = ffd_alloc(d->model.view_count, sizeof *check.views)};
    ffd_status status = FFD_OK;
    if (!check.views)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < d->model.view_count; i++)
        check.views[i] = (view_use){.attributes = -1};
    for (size_t i = 0; i < d->model.primitive_count; i++)
        TRY_END(check_primitive(&check, &d->model.primitives[i], error));
end:
    ffd_free(check.views);
    return status;
}

/* The number of entries of a min or max. */
static ffd_status check_bound(const gltf_document *d, uint32_t accessor, size_t numbers, const char *key,
                              ffd_error *error)
{
    const uint32_t value = ffd_json_tree_member(&d->tree, accessor, key);
    const size_t count = ffd_json_tree_count(&d->tree, value);
    if (value == JSON_NONE || count == numbers)
        return FFD_OK;
    return refuse(d, value, error, "%s has %zu %s for elements of %zu", key, count,
                  ffd_plural(count, "number", "numbers"), numbers);
}

static ffd_status check_accessor(const gltf_document *d, size_t i, ffd_error *error)
{
    const gltf_accessor *const accessor = &d->model.accessors[i];
    const uint32_t value = d->accessor_values.values[i];
    const uint32_t offset = ffd_json_tree_member(&d->tree, value, "byteOffset");
    const size_t numbers = (size_t)accessor->rows * (size_t)accessor->columns;
    if (accessor->view < 0 && offset != JSON_NONE)
        TRY(refuse(d, offset, error, "a byteOffset needs a bufferView, but there is none"));
    if (accessor->sparse.present && accessor->sparse.count == 0)
        TRY(refuse(d, ffd_json_tree_member(&d->tree, value, "sparse"), error,
                   "a sparse accessor replaces at least one element, this one none"));
    TRY(check_bound(d, value, numbers, "min", error));
    return check_bound(d, value, numbers, "max", error);
}

/* Refuses the extensions of an object that extensionsUsed does not list. */
static ffd_status check_undeclared(const gltf_document *d, const intern_table *used, uint32_t extensions,
                                   ffd_error *error)
{
    ffd_status status = FFD_OK;
    for (uint32_t v = ffd_json_tree_first(&d->tree, extensions); v != JSON_NONE && !status;
         v = ffd_json_tree_after(&d->tree, v)) {
        char *const name = ffd_json_tree_key(&d->tree, v);
        uint32_t index;
        if (!name)
            return ffd_fail_memory(error);
        if (!ffd_intern_find(used, name, strlen(name), &index))
            status = refuse(d, v, error, "%s is used, but not in extensionsUsed", name);
        ffd_free(name);
    }
    return status;
}

/* Whether a value has the name of an array of glTF. Others may be of any length. */
static bool is_named_array(const json_tree *tree, uint32_t value)
{
    static const char *const names[] = {
        "accessors",      "animations", "baseColorFactor",    "buffers",     "bufferViews", "cameras",
        "channels",       "children",   "emissiveFactor",     "images",      "joints",      "materials",
        "extensionsUsed", "matrix",     "extensionsRequired", "max",         "meshes",      "min",
        "nodes",          "primitives", "rotation",           "samplers",    "scale",       "scenes",
        "skins",          "targets",    "textures",           "translation", "weights"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (ffd_json_tree_key_is(tree, value, names[i]))
            return true;
    return false;
}

/* Looks at every value, except those in extras, which may be anything, for extensions and, outside of them,
   for arrays of nothing. */
static ffd_status check_values(const gltf_document *d, const intern_table *used, ffd_error *error)
{
    const json_tree *const tree = &d->tree;
    uint32_t end = 0; /* of the extensions that the value is in */
    for (uint32_t v = 1; v < tree->count; v++) {
        const json_value *const value = &tree->values[v];
        if (value->kind < JSON_ARRAY)
            continue;
        if (ffd_json_tree_key_is(tree, v, "extras")) {
            v = value->next - 1;
        } else if (value->kind == JSON_OBJECT && ffd_json_tree_key_is(tree, v, "extensions")) {
            TRY(check_undeclared(d, used, v, error));
            end = value->next > end ? value->next : end;
        } else if (value->kind == JSON_ARRAY && value->count == 0 && v >= end && is_named_array(tree, v)) {
            TRY(refuse(d, v, error, "an array has at least one element, this one has none"));
        }
    }
    return FFD_OK;
}

ffd_status ffd_gltf_refuse_formal(const gltf_document *d, ffd_error *error)
{
    intern_table used = {0};
    ffd_status status;
    if (!d->base.flaws.strict)
        return FFD_OK;
    for (size_t i = 0; i < d->model.accessor_count; i++)
        TRY(check_accessor(d, i, error));
    TRY(check_attributes(d, error));
    TRY_END(ffd_gltf_list_used(&d->tree, &used) ? FFD_OK : ffd_fail_memory(error));
    TRY_END(check_values(d, &used, error));
end:
    ffd_intern_free(&used);
    return status;
}
