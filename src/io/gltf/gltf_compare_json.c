#include "io/gltf/gltf_compare_json.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include <stdio.h>
#include <string.h>

/* Returns the ancestor `levels` above `value`; JSON_NONE past the root. */
static uint32_t above(const json_span *tree, uint32_t value, int levels)
{
    for (; levels > 0 && value != JSON_NONE; levels--)
        value = tree->values[value].parent;
    return value;
}

/* Whether the value describes where or how elements are stored. */
static bool is_about_storage(const json_span *tree, uint32_t value)
{
    static const char *const keys[] = {"accessors", "bufferViews", "buffers", "meshes"};
    if (ffd_json_span_key_is(tree, value, "name"))
        return false;
    while (value != JSON_NONE && tree->values[value].parent != 0)
        value = tree->values[value].parent;
    for (size_t i = 0; value != JSON_NONE && i < sizeof keys / sizeof *keys; i++)
        if (ffd_json_span_key_is(tree, value, keys[i]))
            return true;
    return false;
}

static ffd_difference_kind kind_of(const json_span *tree, uint32_t value)
{
    const bool is_topology = is_about_storage(tree, value) && (ffd_json_span_key_is(tree, value, "count") ||
                                                               ffd_json_span_key_is(tree, value, "indices") ||
                                                               ffd_json_span_key_is(tree, value, "mode"));
    return is_topology ? FFD_DIFFERENCE_TOPOLOGY : FFD_DIFFERENCE_OTHER;
}

static void say_at(gltf_comparer *c, uint32_t value, const char *what)
{
    char pointer[256] = "";
    if (c->result->differences == 0) /* only the first one is reported */
        ffd_json_span_pointer(&c->a->tree, value, pointer, sizeof pointer);
    ffd_difference_say(c->result, kind_of(&c->a->tree, value), "%s: %s", pointer[0] ? pointer : "/", what);
}

static void differ_at(gltf_comparer *c, uint32_t value, const char *what)
{
    c->other_storage = c->other_storage || is_about_storage(&c->a->tree, value);
    say_at(c, value, what);
}

/* Whether the value may differ between equal files: the name of a buffer's file, and a buffer's length beyond
   its views. */
static bool is_storage(const json_span *tree, uint32_t value)
{
    const uint32_t buffers = ffd_json_span_member(tree, 0, "buffers");
    return buffers != JSON_NONE && above(tree, value, 2) == buffers &&
           (ffd_json_span_key_is(tree, value, "uri") || ffd_json_span_key_is(tree, value, "byteLength"));
}

static bool is_value_before(const void *element, const void *value)
{
    return *(const uint32_t *)element < *(const uint32_t *)value;
}

/* Returns the accessor that has the value as a number of its "min" or "max"; GLTF_NONE: the value is not
   one. */
static size_t bounded_accessor(const gltf_comparer *c, uint32_t value)
{
    const json_span *tree = &c->a->tree;
    const gltf_values *list = &c->a->accessor_values;
    const uint32_t array = above(tree, value, 1), accessor = above(tree, value, 2);
    if (accessor == JSON_NONE ||
        !(ffd_json_span_key_is(tree, array, "min") || ffd_json_span_key_is(tree, array, "max")))
        return GLTF_NONE;
    const size_t found =
        lower_bound(&accessor, list->values, list->count, sizeof *list->values, is_value_before);
    return found < list->count && list->values[found] == accessor ? found : GLTF_NONE;
}

/* Whether a number has neither a fraction nor an exponent. */
static bool is_plain_integer(const json_span *tree, uint32_t value)
{
    for (uint32_t i = tree->values[value].begin; i < tree->values[value].end; i++)
        if (!strchr("-0123456789", tree->text[i]))
            return false;
    return true;
}

static bool same_text(const json_span *a, uint32_t x, const json_span *b, uint32_t y)
{
    const size_t size = a->values[x].end - a->values[x].begin;
    return size == b->values[y].end - b->values[y].begin &&
           memcmp(a->text + a->values[x].begin, b->text + b->values[y].begin, size) == 0;
}

/* Returns the number of characters of a number to show in a message. */
static int shown_size(const json_span *tree, uint32_t value)
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
    const json_span *first = &c->a->tree, *second = &c->b->tree;
    double a = 0, b = 0;
    ffd_json_span_number(first, x, &a);
    ffd_json_span_number(second, y, &b);
    if (a < b || a > b)
        snprintf(what, capacity, "%.17g and %.17g", a, b);
    else /* doubles do not distinguish them */
        snprintf(what, capacity, "%.*s and %.*s", shown_size(first, x), first->text + first->values[x].begin,
                 shown_size(second, y), second->text + second->values[y].begin);
}

void ffd_gltf_differ_in_bound(gltf_comparer *c, const gltf_bound *bound)
{
    char what[96];
    differ_in_numbers(c, bound->in_a, bound->in_b, what, sizeof what);
    say_at(c, bound->in_a, what);
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
    const json_span *first = &c->a->tree, *second = &c->b->tree;
    double a = 0, b = 0;
    char what[96];
    if (same_text(first, x, second, y))
        return;
    ffd_json_span_number(first, x, &a);
    ffd_json_span_number(second, y, &b);
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
    ffd_status status = FFD_OK;
    uint32_t w = ffd_json_span_first(&c->b->tree, y);
    for (uint32_t v = ffd_json_span_first(&c->a->tree, x); v != JSON_NONE && status == FFD_OK;
         v = ffd_json_span_after(&c->a->tree, v)) {
        status = compare_values(c, v, w);
        w = ffd_json_span_after(&c->b->tree, w);
    }
    return status;
}

/* Adds the difference that only the second file has y, a member of object x. */
static ffd_status differ_in_second(gltf_comparer *c, uint32_t x, uint32_t y)
{
    char *key = ffd_json_span_key(&c->b->tree, y);
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
    ffd_status status = FFD_OK;
    size_t i = 0, j = 0;
    while ((i < first_count || j < second_count) && status == FFD_OK) {
        const int order = i == first_count    ? 1
                          : j == second_count ? -1
                                              : ffd_json_span_compare_keys(first[i].tree, first[i].value,
                                                                           second[j].tree, second[j].value);
        if (order < 0 && !is_storage(first[i].tree, first[i].value))
            differ_at(c, first[i].value, "only the first file has it");
        if (order > 0 && !is_storage(second[j].tree, second[j].value))
            status = differ_in_second(c, x, second[j].value);
        if (order == 0 && !is_storage(first[i].tree, first[i].value))
            status = compare_values(c, first[i].value, second[j].value);
        i += order <= 0;
        j += order >= 0;
    }
    return status;
}

static ffd_status compare_objects(gltf_comparer *c, uint32_t x, uint32_t y)
{
    const size_t first_count = c->a->tree.values[x].count, second_count = c->b->tree.values[y].count;
    json_member *first = ffd_alloc(first_count, sizeof *first),
                *second = ffd_alloc(second_count, sizeof *second);
    ffd_status status;
    if (first && second) {
        ffd_json_span_sort(&c->a->tree, x, first);
        ffd_json_span_sort(&c->b->tree, y, second);
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
        if (!ffd_json_span_equal_strings(&c->a->tree, x, &c->b->tree, y))
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

ffd_status ffd_gltf_compare_json(gltf_comparer *c)
{
    return compare_values(c, 0, 0);
}
