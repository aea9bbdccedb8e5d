/* gltf_compare.c - compares two glTF files: their JSON and the contents of their buffers. */
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/read/gltf_document.h"
#include "io/gltf/read/gltf_draco.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/read/gltf_views.h"
#include "mesh/difference.h"
#include <stdio.h>
#include <string.h>

/* The first number of an accessor's "min" or "max" that differs in the second file. */
typedef struct gltf_bound {
    uint32_t in_a, in_b; /* JSON values; 0: none */
} gltf_bound;

/* What is known of an accessor's elements, besides the bytes of their bufferViews. */
typedef enum gltf_elements { GLTF_NOT_COMPARED, GLTF_ALL_SAME, GLTF_DIFFER } gltf_elements;

typedef struct gltf_comparer {
    const gltf_document *a, *b;
    ffd_comparison *result;
    /* For each accessor of a. */
    uint8_t *kinds;  /* ffd_difference_kind: what its elements are */
    uint8_t *states; /* a gltf_elements */
    gltf_bound *bounds;
    /* For each bufferView of a. */
    bool *is_same;     /* all its bytes are equal, decoded if they can be */
    bool *is_unpacked; /* it is Draco data: its elements are compared instead */
    /* The JSON differs in accessors, bufferViews or meshes: elements are not compared. */
    bool other_storage;
    memory_budget budget; /* for visiting elements; a copy of a's */
    ffd_error *error;
} gltf_comparer;

/* Returns the ancestor `levels` above `value`; JSON_NONE past the root. */
static uint32_t above(const json_tree *tree, uint32_t value, int levels)
{
    for (; levels > 0 && value != JSON_NONE; levels--)
        value = tree->values[value].parent;
    return value;
}

/* Whether the value describes where or how elements are stored. */
static bool is_about_storage(const json_tree *tree, uint32_t value)
{
    static const char *const keys[] = {"accessors", "bufferViews", "buffers", "meshes"};
    if (ffd_json_tree_key_is(tree, value, "name"))
        return false;
    while (value != JSON_NONE && tree->values[value].parent != 0)
        value = tree->values[value].parent;
    for (size_t i = 0; value != JSON_NONE && i < sizeof keys / sizeof *keys; i++)
        if (ffd_json_tree_key_is(tree, value, keys[i]))
            return true;
    return false;
}

static ffd_difference_kind kind_of(const json_tree *tree, uint32_t value)
{
    const bool is_topology = is_about_storage(tree, value) && (ffd_json_tree_key_is(tree, value, "count") ||
                                                               ffd_json_tree_key_is(tree, value, "indices") ||
                                                               ffd_json_tree_key_is(tree, value, "mode"));
    return is_topology ? FFD_DIFFERENCE_TOPOLOGY : FFD_DIFFERENCE_OTHER;
}

static void report_difference(gltf_comparer *c, uint32_t value, const char *what)
{
    char pointer[256] = "";
    if (c->result->differences == 0) /* only the first one is reported */
        ffd_json_tree_pointer(&c->a->tree, value, pointer, sizeof pointer);
    ffd_difference_add_text(c->result, kind_of(&c->a->tree, value), "%s: %s", pointer[0] ? pointer : "/",
                            what);
}

static void differ_at(gltf_comparer *c, uint32_t value, const char *what)
{
    c->other_storage = c->other_storage || is_about_storage(&c->a->tree, value);
    report_difference(c, value, what);
}

/* Whether the value may differ between equal files: the name of a buffer's file, and a buffer's length beyond
   its views. */
static bool is_storage(const json_tree *tree, uint32_t value)
{
    const uint32_t buffers = ffd_json_tree_member(tree, 0, "buffers");
    return buffers != JSON_NONE && above(tree, value, 2) == buffers &&
           (ffd_json_tree_key_is(tree, value, "uri") || ffd_json_tree_key_is(tree, value, "byteLength"));
}

static bool is_value_before(const void *element, const void *value)
{
    return *(const uint32_t *)element < *(const uint32_t *)value;
}

/* Returns the accessor that has the value as a number of its "min" or "max"; GLTF_NONE: the value is not
   one. */
static size_t bounded_accessor(const gltf_comparer *c, uint32_t value)
{
    const json_tree *tree = &c->a->tree;
    const gltf_values *list = &c->a->accessor_values;
    const uint32_t array = above(tree, value, 1), accessor = above(tree, value, 2);
    if (accessor == JSON_NONE ||
        !(ffd_json_tree_key_is(tree, array, "min") || ffd_json_tree_key_is(tree, array, "max")))
        return GLTF_NONE;
    const size_t found =
        lower_bound(&accessor, list->values, list->count, sizeof *list->values, is_value_before);
    return found < list->count && list->values[found] == accessor ? found : GLTF_NONE;
}

/* Whether a number has neither a fraction nor an exponent. */
static bool is_plain_integer(const json_tree *tree, uint32_t value)
{
    for (uint32_t i = tree->values[value].begin; i < tree->values[value].end; i++)
        if (!strchr("-0123456789", tree->text[i]))
            return false;
    return true;
}

static bool same_text(const json_tree *a, uint32_t x, const json_tree *b, uint32_t y)
{
    const size_t size = a->values[x].end - a->values[x].begin;
    return size == b->values[y].end - b->values[y].begin &&
           memcmp(a->text + a->values[x].begin, b->text + b->values[y].begin, size) == 0;
}

/* Returns the number of characters of a number to show in a message. */
static int shown_size(const json_tree *tree, uint32_t value)
{
    const uint32_t size = tree->values[value].end - tree->values[value].begin;
    return size > 40 ? 40 : (int)size;
}

/* Whether two numbers with different text are equal. Two plain integers never are: JSON has no leading zeros,
   and they may have more digits than a double holds. The exception is 0 and -0. */
static bool equal_numbers(gltf_comparer *c, uint32_t x, double a, uint32_t y, double b)
{
    if (is_plain_integer(&c->a->tree, x) && is_plain_integer(&c->b->tree, y) && (a < 0 || a > 0))
        return false;
    return !(a < b) && !(a > b);
}

static void differ_in_numbers(const gltf_comparer *c, uint32_t x, uint32_t y, char *what, size_t capacity)
{
    const json_tree *first = &c->a->tree, *second = &c->b->tree;
    double a = 0, b = 0;
    ffd_json_tree_number(first, x, &a);
    ffd_json_tree_number(second, y, &b);
    if (a < b || a > b)
        snprintf(what, capacity, "%.17g and %.17g", a, b);
    else /* doubles do not distinguish them */
        snprintf(what, capacity, "%.*s and %.*s", shown_size(first, x), first->text + first->values[x].begin,
                 shown_size(second, y), second->text + second->values[y].begin);
}

/* Adds the difference of a bound to the result. */
static void differ_in_bound(gltf_comparer *c, const gltf_bound *bound)
{
    char what[96];
    differ_in_numbers(c, bound->in_a, bound->in_b, what, sizeof what);
    report_difference(c, bound->in_a, what);
}

/* Bounds follow from the elements, which are compared on their own. With a tolerance bounds are not compared:
   the tolerance is in the lattice's units, bounds are not. */
static void note_bound(gltf_comparer *c, size_t accessor, uint32_t x, uint32_t y)
{
    const uint8_t kind = c->kinds[accessor];
    const double tolerance = kind == FFD_DIFFERENCE_POSITION  ? c->result->tolerance
                             : kind <= FFD_DIFFERENCE_TANGENT ? c->result->direction_tolerance
                                                              : 0;
    if (!(tolerance > 0) && c->bounds[accessor].in_a == 0)
        c->bounds[accessor] = (gltf_bound){x, y};
}

static void compare_numbers(gltf_comparer *c, uint32_t x, uint32_t y)
{
    const json_tree *first = &c->a->tree, *second = &c->b->tree;
    double a = 0, b = 0;
    char what[96];
    if (same_text(first, x, second, y))
        return;
    ffd_json_tree_number(first, x, &a);
    ffd_json_tree_number(second, y, &b);
    if (equal_numbers(c, x, a, y, b))
        return;
    const size_t accessor = bounded_accessor(c, x);
    if (accessor != GLTF_NONE) {
        note_bound(c, accessor, x, y);
        return;
    }
    differ_in_numbers(c, x, y, what, sizeof what);
    differ_at(c, x, what);
}

static ffd_status compare_values(gltf_comparer *c, uint32_t x, uint32_t y);

static ffd_status compare_arrays(gltf_comparer *c, uint32_t x, uint32_t y)
{
    if (c->a->tree.values[x].count != c->b->tree.values[y].count) {
        char what[96];
        snprintf(what, sizeof what, "%lu and %lu elements", (unsigned long)c->a->tree.values[x].count,
                 (unsigned long)c->b->tree.values[y].count);
        differ_at(c, x, what);
        return FFD_OK;
    }
    uint32_t w = ffd_json_tree_first(&c->b->tree, y);
    for (uint32_t v = ffd_json_tree_first(&c->a->tree, x); v != JSON_NONE;
         v = ffd_json_tree_after(&c->a->tree, v)) {
        TRY(compare_values(c, v, w));
        w = ffd_json_tree_after(&c->b->tree, w);
    }
    return FFD_OK;
}

/* Adds the difference that only the second file has y, a member of object x. */
static ffd_status differ_in_second(gltf_comparer *c, uint32_t x, uint32_t y)
{
    char *key = ffd_json_tree_key(&c->b->tree, y);
    char what[160];
    if (!key)
        return ffd_fail_memory(c->error);
    snprintf(what, sizeof what, "only the second file has \"%.100s\"", key);
    c->other_storage = c->other_storage || is_about_storage(&c->b->tree, y);
    differ_at(c, x, what);
    ffd_free(key);
    return FFD_OK;
}

/* Compares the members of two objects, sorted by key; a member of only one of them is a difference. */
static ffd_status compare_members(gltf_comparer *c, uint32_t x, const json_member *first, size_t first_count,
                                  const json_member *second, size_t second_count)
{
    size_t i = 0, j = 0;
    while (i < first_count || j < second_count) {
        const int order = i == first_count    ? 1
                          : j == second_count ? -1
                                              : ffd_json_tree_compare_keys(first[i].tree, first[i].value,
                                                                           second[j].tree, second[j].value);
        if (order < 0 && !is_storage(first[i].tree, first[i].value))
            differ_at(c, first[i].value, "only the first file has it");
        if (order > 0 && !is_storage(second[j].tree, second[j].value))
            TRY(differ_in_second(c, x, second[j].value));
        if (order == 0 && !is_storage(first[i].tree, first[i].value))
            TRY(compare_values(c, first[i].value, second[j].value));
        i += order <= 0;
        j += order >= 0;
    }
    return FFD_OK;
}

static ffd_status compare_objects(gltf_comparer *c, uint32_t x, uint32_t y)
{
    const size_t first_count = c->a->tree.values[x].count, second_count = c->b->tree.values[y].count;
    json_member *first = ffd_alloc(first_count, sizeof *first),
                *second = ffd_alloc(second_count, sizeof *second);
    ffd_status status;
    if (first && second) {
        ffd_json_tree_sort(&c->a->tree, x, first);
        ffd_json_tree_sort(&c->b->tree, y, second);
        status = compare_members(c, x, first, first_count, second, second_count);
    } else {
        status = ffd_fail_memory(c->error);
    }
    ffd_free(first);
    ffd_free(second);
    return status;
}

/* The parser limits the depth of this recursion. */
static ffd_status compare_values(gltf_comparer *c, uint32_t x, uint32_t y)
{
    const uint8_t kind = c->a->tree.values[x].kind;
    if (kind != c->b->tree.values[y].kind) {
        differ_at(c, x, "values of different kinds");
        return FFD_OK;
    }
    switch ((json_kind)kind) {
    case JSON_NUMBER:
        compare_numbers(c, x, y);
        return FFD_OK;
    case JSON_STRING:
        if (!ffd_json_tree_equal_strings(&c->a->tree, x, &c->b->tree, y))
            differ_at(c, x, "different texts");
        return FFD_OK;
    case JSON_ARRAY:
        return compare_arrays(c, x, y);
    case JSON_OBJECT:
        return compare_objects(c, x, y);
    default:
        return FFD_OK;
    }
}

/* Compares the JSON. Ignores the bounds of elements that may differ by a tolerance, and stores differing
   bounds of other measurable elements in c->bounds. Errors: FFD_E_MEMORY. */
static ffd_status compare_json(gltf_comparer *c)
{
    return compare_values(c, 0, 0);
}

#define BLOCK 256

/* Names an element in messages. */
typedef struct element_name {
    size_t accessor, element;
    const char *what; /* "vertex", "element" */
} element_name;

/* A difference_label. */
static void format_element(const void *context, char *text, size_t capacity)
{
    const element_name *name = context;
    snprintf(text, capacity, "/accessors/%zu: %s %zu", name->accessor, name->what, name->element);
}

/* The kinds of elements */

static void note_kind(gltf_comparer *c, int accessor, ffd_difference_kind kind)
{
    if (accessor >= 0 && kind < c->kinds[accessor])
        c->kinds[accessor] = (uint8_t)kind;
}

static void note_texcoords(gltf_comparer *c, uint32_t primitive)
{
    const json_tree *tree = &c->a->tree;
    const uint32_t attributes = ffd_json_tree_member(tree, primitive, "attributes");
    uint32_t value = attributes;
    for (int n = 0; value != JSON_NONE; n++) {
        char key[32];
        double accessor;
        snprintf(key, sizeof key, "TEXCOORD_%d", n);
        value = ffd_json_tree_member(tree, attributes, key);
        if (ffd_json_tree_number(tree, value, &accessor) && accessor >= 0 &&
            accessor < (double)c->a->model.accessor_count)
            note_kind(c, (int)accessor, FFD_DIFFERENCE_TEXCOORD);
    }
}

static void note_kinds(gltf_comparer *c)
{
    const gltf_document *d = c->a;
    memset(c->kinds, FFD_DIFFERENCE_OTHER, d->model.accessor_count);
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        const gltf_primitive *primitive = &d->model.primitives[i];
        for (size_t s = 0; s < gltf_vector_slots(primitive); s++)
            note_kind(c, gltf_slot_accessor(primitive, s), (ffd_difference_kind)(s % GLTF_DEFORMED));
        note_kind(c, primitive->indices, FFD_DIFFERENCE_TOPOLOGY);
        note_texcoords(c, primitive->value);
    }
}

/* The elements */

static bool both_read(const gltf_comparer *c, size_t accessor)
{
    return c->a->layouts[accessor].readable && c->b->layouts[accessor].readable;
}

/* Whether all bytes of an accessor are known to be equal. */
static bool has_same_bytes(const gltf_comparer *c, size_t accessor)
{
    const gltf_accessor *stored = &c->a->model.accessors[accessor];
    const gltf_sparse *sparse = &stored->sparse;
    if (c->a->layouts[accessor].packing == GLTF_DRACO)
        return false;
    return (stored->view < 0 || c->is_same[stored->view]) &&
           (!sparse->present || (c->is_same[sparse->indices_view] && c->is_same[sparse->values_view]));
}

/* Compares elements [first, first + count), transformed by the part (GLTF_NONE: untransformed). Differences
   are in the lattice's units, or in the file's where the part's matrix hides them. */
static void compare_block(gltf_comparer *c, size_t accessor, size_t part, size_t first, size_t count)
{
    const ffd_difference_kind kind = (ffd_difference_kind)c->kinds[accessor];
    const size_t size = (size_t)c->a->model.accessors[accessor].rows;
    element_name name = {accessor, first, kind == FFD_DIFFERENCE_POSITION ? "vertex" : "element"};
    double a[4 * BLOCK], b[4 * BLOCK], world_a[4 * BLOCK], world_b[4 * BLOCK];
    ffd_gltf_read(c->a, accessor, first, count, size, a);
    ffd_gltf_read(c->b, accessor, first, count, size, b);
    if (memcmp(a, b, size * count * sizeof *a) == 0)
        return;
    c->states[accessor] = GLTF_DIFFER;
    memcpy(world_a, a, size * count * sizeof *a);
    memcpy(world_b, b, size * count * sizeof *b);
    if (part != GLTF_NONE) {
        ffd_part_transform(&c->a->base, part, first, count, world_a);
        ffd_part_transform(&c->a->base, part, first, count, world_b);
    }
    for (size_t i = 0; i < count; i++, name.element++) {
        const double *x = world_a + size * i, *y = world_b + size * i;
        bool hidden = true;
        for (size_t k = 0; k < size; k++)
            hidden = hidden && !(ffd_difference_of(x[k], y[k]) > 0);
        ffd_difference_vector(c->result, kind, (int)size, hidden ? a + size * i : x,
                              hidden ? b + size * i : y, format_element, &name);
    }
}

/* Compares positions, normals or tangents. */
static void compare_vectors(gltf_comparer *c, size_t accessor, size_t part)
{
    const size_t count = has_same_bytes(c, accessor) ? 0 : (size_t)c->a->model.accessors[accessor].count;
    if (c->states[accessor] == GLTF_NOT_COMPARED)
        c->states[accessor] = GLTF_ALL_SAME;
    for (size_t first = 0; first < count; first += BLOCK)
        compare_block(c, accessor, part, first, count - first < BLOCK ? count - first : BLOCK);
}

/* Compares a part's positions, and those of its morph targets, which are offsets. */
static void compare_part(gltf_comparer *c, size_t i)
{
    const gltf_document *d = c->a;
    const mesh_part *part = &d->mesh_parts[i];
    const size_t accessor = d->parts[i].streams[GLTF_POSITION].accessor;
    const gltf_part *shapes = d->parts + d->base.part_count + d->parts[i].first_shape;
    if (!part->repeats_positions && both_read(c, accessor)) {
        compare_vectors(c, accessor, i);
        c->result->positions_compared += part->vertex_count;
    }
    for (size_t s = 0; s < part->shape_count; s++) {
        const size_t offsets = shapes[s].streams[GLTF_POSITION].accessor;
        if (offsets != GLTF_NONE && both_read(c, offsets))
            compare_vectors(c, offsets, i);
    }
}

/* Compares elements that are not vectors, byte by byte. */
static void compare_elements(gltf_comparer *c, size_t accessor)
{
    const uint64_t count = has_same_bytes(c, accessor) ? 0 : c->a->model.accessors[accessor].count;
    const size_t size = c->a->layouts[accessor].element_size;
    c->states[accessor] = GLTF_ALL_SAME;
    for (size_t i = 0; i < count; i++)
        if (memcmp(ffd_gltf_element(c->a, accessor, i), ffd_gltf_element(c->b, accessor, i), size) != 0) {
            c->states[accessor] = GLTF_DIFFER;
            ffd_difference_add_text(c->result, (ffd_difference_kind)c->kinds[accessor],
                                    "/accessors/%zu: element %zu differs", accessor, i);
        }
}

/* Limits the work where many accessors share the same few bytes: these are then compared as bytes of the
   bufferView. (The size of decoded Draco data was limited before.) */
static bool may_compare(gltf_comparer *c, size_t accessor)
{
    const uint64_t count = c->a->model.accessors[accessor].count;
    return both_read(c, accessor) && (c->a->layouts[accessor].packing == GLTF_DRACO ||
                                      ffd_budget_take(&c->budget, count, 1, NULL) == FFD_OK);
}

/* Compares positions under each node that uses them, then the other accessors. */
static void compare_accessors(gltf_comparer *c)
{
    for (size_t i = 0; i < c->a->base.part_count; i++)
        compare_part(c, i);
    for (size_t a = 0; a < c->a->model.accessor_count; a++)
        if (c->states[a] == GLTF_NOT_COMPARED && may_compare(c, a)) {
            if (c->kinds[a] <= FFD_DIFFERENCE_TANGENT)
                compare_vectors(c, a, GLTF_NONE);
            else
                compare_elements(c, a);
        }
    for (size_t a = 0; a < c->a->model.accessor_count; a++)
        if (c->bounds[a].in_a && c->states[a] != GLTF_DIFFER)
            differ_in_bound(c, &c->bounds[a]);
}

/* The bytes */

/* Returns the bytes of a view, decoded if possible, else as stored. NULL: no bytes. */
static const unsigned char *find_bytes(const gltf_document *d, size_t view, size_t *size)
{
    const unsigned char *bytes = ffd_gltf_view_bytes(d, view);
    *size = (size_t)d->model.views[view].length;
    return bytes ? bytes : ffd_gltf_compressed_bytes(d, view, size);
}

static void find_same_views(gltf_comparer *c)
{
    for (size_t i = 0; i < c->a->model.view_count; i++) {
        size_t size, other_size;
        const unsigned char *a = find_bytes(c->a, i, &size), *b = find_bytes(c->b, i, &other_size);
        c->is_same[i] = !a == !b && (!a || (size == other_size && memcmp(a, b, size) == 0));
    }
}

/* Whether a view holds elements of an accessor, dense or sparse. */
static bool lies_in(const gltf_accessor *accessor, size_t view)
{
    return accessor->view == (int)view ||
           (accessor->sparse.present && accessor->sparse.values_view == (int)view);
}

/* Overwrites, in b's copy of a view, the elements that were compared on their own with a's. */
static void equalize_elements(const gltf_comparer *c, size_t view, unsigned char *bytes)
{
    const uintptr_t begin = (uintptr_t)ffd_gltf_view_bytes(c->b, view);
    const uintptr_t end = begin + (size_t)c->b->model.views[view].length;
    for (size_t a = 0; a < c->a->model.accessor_count; a++) {
        const gltf_accessor *accessor = &c->a->model.accessors[a];
        const size_t size = c->a->layouts[a].element_size;
        if (c->states[a] == GLTF_NOT_COMPARED || !lies_in(accessor, view) ||
            c->a->layouts[a].packing == GLTF_DRACO)
            continue;
        for (size_t i = 0; i < accessor->count; i++) {
            const uintptr_t at = (uintptr_t)ffd_gltf_element(c->b, a, i);
            if (at >= begin && at < end)
                memcpy(bytes + (at - begin), ffd_gltf_element(c->a, a, i), size);
        }
    }
}

/* Adds one difference at most. */
static void compare_bytes(gltf_comparer *c, size_t view, const unsigned char *a, const unsigned char *b,
                          size_t size)
{
    for (size_t k = 0; k < size; k++)
        if (a[k] != b[k]) {
            ffd_difference_add_text(c->result, FFD_DIFFERENCE_OTHER,
                                    "/bufferViews/%zu: byte %zu is 0x%02x and 0x%02x", view, k,
                                    (unsigned)a[k], (unsigned)b[k]);
            return;
        }
}

/* Compares the bytes of a view that are not elements. */
static ffd_status compare_view(gltf_comparer *c, size_t i)
{
    size_t size, other_size;
    const unsigned char *a = find_bytes(c->a, i, &size), *b = find_bytes(c->b, i, &other_size);
    if (!a || !b || size != other_size) {
        ffd_difference_add_text(c->result, FFD_DIFFERENCE_OTHER,
                                "/bufferViews/%zu: only one file has its bytes", i);
        return FFD_OK;
    }
    if (!ffd_gltf_view_bytes(c->a, i) || !ffd_gltf_view_bytes(c->b, i)) { /* the content is unknown */
        compare_bytes(c, i, a, b, size);
        return FFD_OK;
    }
    unsigned char *bytes = ffd_alloc(size, 1);
    if (!bytes)
        return ffd_fail_memory(c->error);
    memcpy(bytes, b, size);
    equalize_elements(c, i, bytes);
    compare_bytes(c, i, a, bytes, size);
    ffd_free(bytes);
    return FFD_OK;
}

static void find_unpacked(const gltf_document *d, bool *is_unpacked)
{
    for (size_t a = 0; a < d->model.accessor_count; a++)
        if (d->unpacked[a].bytes)
            is_unpacked[d->unpacked[a].view] = true;
}

/* Unmarks Draco data that could not be decoded, so that its bytes are compared. */
static void leave_problems(const gltf_document *d, bool *is_unpacked)
{
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        double view;
        const uint32_t value =
            ffd_json_tree_member(&d->tree, ffd_gltf_draco_value(d, &d->model.primitives[i]), "bufferView");
        if (d->draco_problems[i] && ffd_json_tree_number(&d->tree, value, &view) &&
            view < (double)d->model.view_count)
            is_unpacked[(size_t)view] = false;
    }
}

/* Compares the contents of two files whose JSON agrees in accessors and bufferViews. */
static ffd_status compare_contents(gltf_comparer *c)
{
    find_unpacked(c->a, c->is_unpacked);
    leave_problems(c->a, c->is_unpacked);
    leave_problems(c->b, c->is_unpacked);
    find_same_views(c);
    compare_accessors(c);
    for (size_t i = 0; i < c->a->model.view_count; i++)
        if (!c->is_unpacked[i] && !c->is_same[i])
            TRY(compare_view(c, i));
    return FFD_OK;
}

static bool make_tables(gltf_comparer *c)
{
    const gltf_model *model = &c->a->model;
    c->kinds = ffd_alloc(model->accessor_count, sizeof *c->kinds);
    c->states = ffd_alloc_zero(model->accessor_count, sizeof *c->states);
    c->bounds = ffd_alloc_zero(model->accessor_count, sizeof *c->bounds);
    c->is_same = ffd_alloc_zero(model->view_count, sizeof *c->is_same);
    c->is_unpacked = ffd_alloc_zero(model->view_count, sizeof *c->is_unpacked);
    return c->kinds && c->states && c->bounds && c->is_same && c->is_unpacked;
}

ffd_status ffd_gltf_compare(const mesh_document *first, const mesh_document *second,
                            ffd_comparison *comparison, ffd_error *error)
{
    gltf_comparer c = {.a = ffd_gltf_of(first),
                       .b = ffd_gltf_of(second),
                       .result = comparison,
                       .budget = first->budget,
                       .error = error};
    ffd_status status = FFD_OK;
    if (!make_tables(&c))
        TRY_END(ffd_fail_memory(error));
    note_kinds(&c);
    TRY_END(compare_json(&c));
    if (c.other_storage)
        comparison->complete = false;
    else
        TRY_END(compare_contents(&c));
end:
    ffd_free(c.kinds);
    ffd_free(c.states);
    ffd_free(c.bounds);
    ffd_free(c.is_same);
    ffd_free(c.is_unpacked);
    return status;
}
