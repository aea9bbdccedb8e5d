#include "base/memory.h"
#include "io/gltf/gltf_document.h"
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#define BLOCK 256

typedef struct comparer {
    const gltf_document *a, *b;
    double tolerance;
    ffd_comparison *result;
    bool *is_position; /* an accessor */
    bool *is_unpacked; /* a view: of Draco data, whose elements are compared in its place */
    ffd_error *error;
} comparer;

static void differ(const comparer *c, const char *format, ...) FFD_PRINTF(2, 3);
static void differ(const comparer *c, const char *format, ...)
{
    if (!c->result->equal)
        return;
    c->result->equal = false;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(c->result->difference, sizeof c->result->difference, format, arguments);
    va_end(arguments);
}

static void differ_at(const comparer *c, uint32_t value, const char *what)
{
    char pointer[256];
    ffd_json_span_pointer(&c->a->tree, value, pointer, sizeof pointer);
    differ(c, "%s: %s", pointer[0] ? pointer : "/", what);
}

/* The value is `levels` above `value`; JSON_NONE past the top. */
static uint32_t above(const json_span *tree, uint32_t value, int levels)
{
    for (; levels > 0 && value != JSON_NONE; levels--)
        value = tree->values[value].parent;
    return value;
}

/* What may differ between equal files: where buffers are, and how long what follows their views is. */
static bool is_storage(const json_span *tree, uint32_t value)
{
    const uint32_t buffers = ffd_json_span_member(tree, 0, "buffers");
    return buffers != JSON_NONE && above(tree, value, 2) == buffers &&
           (ffd_json_span_key_is(tree, value, "uri") || ffd_json_span_key_is(tree, value, "byteLength"));
}

static bool is_position_accessor(const comparer *c, uint32_t value)
{
    const gltf_values *list = &c->a->accessor_values;
    size_t low = 0, high = list->count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (list->values[middle] < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low < list->count && list->values[low] == value && c->is_position[low];
}

/* Whether value is a number in "min" or "max" of an accessor of positions. */
static bool is_bound(const comparer *c, uint32_t value)
{
    const json_span *tree = &c->a->tree;
    const uint32_t array = above(tree, value, 1), accessor = above(tree, value, 2);
    return accessor != JSON_NONE && is_position_accessor(c, accessor) &&
           (ffd_json_span_key_is(tree, array, "min") || ffd_json_span_key_is(tree, array, "max"));
}

/* Whether a number has neither fraction nor exponent. */
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

/* As many characters of a number as a message has room for. */
static int shown_size(const json_span *tree, uint32_t value)
{
    const uint32_t size = tree->values[value].end - tree->values[value].begin;
    return size > 40 ? 40 : (int)size;
}

/* Whether two numbers of different text are equal. JSON has no leading zeros, so that plain integers, which
   may have more digits than a double holds, are not; but for 0 and -0. */
static bool equal_numbers(const comparer *c, uint32_t x, double a, uint32_t y, double b)
{
    if (is_plain_integer(&c->a->tree, x) && is_plain_integer(&c->b->tree, y) && (a < 0 || a > 0))
        return false;
    return !(a < b) && !(a > b);
}

/* Bounds follow from the positions, which are compared themselves: with a tolerance in the lattice's units,
   where bounds are not. */
static void compare_numbers(const comparer *c, uint32_t x, uint32_t y)
{
    const json_span *first = &c->a->tree, *second = &c->b->tree;
    double a = 0, b = 0;
    if (same_text(first, x, second, y))
        return;
    ffd_json_span_number(first, x, &a);
    ffd_json_span_number(second, y, &b);
    if (equal_numbers(c, x, a, y, b) || (c->tolerance > 0 && is_bound(c, x)))
        return;
    char what[96];
    if (a < b || a > b)
        snprintf(what, sizeof what, "%.17g and %.17g", a, b);
    else /* beyond what a double tells apart */
        snprintf(what, sizeof what, "%.*s and %.*s", shown_size(first, x),
                 first->text + first->values[x].begin, shown_size(second, y),
                 second->text + second->values[y].begin);
    differ_at(c, x, what);
}

static ffd_status compare_values(const comparer *c, uint32_t x, uint32_t y);

static ffd_status compare_arrays(const comparer *c, uint32_t x, uint32_t y)
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
    for (uint32_t v = ffd_json_span_first(&c->a->tree, x);
         v != JSON_NONE && status == FFD_OK && c->result->equal; v = ffd_json_span_after(&c->a->tree, v)) {
        status = compare_values(c, v, w);
        w = ffd_json_span_after(&c->b->tree, w);
    }
    return status;
}

/* The sorted members, in both, of two objects; one that only one object has is a difference. */
static ffd_status compare_members(const comparer *c, uint32_t x, const json_member *first, size_t first_count,
                                  const json_member *second, size_t second_count)
{
    ffd_status status = FFD_OK;
    size_t i = 0, j = 0;
    while ((i < first_count || j < second_count) && status == FFD_OK && c->result->equal) {
        const int order = i == first_count    ? 1
                          : j == second_count ? -1
                                              : ffd_json_span_compare_keys(first[i].tree, first[i].value,
                                                                           second[j].tree, second[j].value);
        if (order < 0 && !is_storage(first[i].tree, first[i].value))
            differ_at(c, first[i].value, "only the first file has it");
        if (order > 0 && !is_storage(second[j].tree, second[j].value)) {
            char *key = ffd_json_span_key(second[j].tree, second[j].value);
            char what[160];
            if (!key)
                return ffd_fail_memory(c->error);
            snprintf(what, sizeof what, "only the second file has \"%.100s\"", key);
            differ_at(c, x, what);
            ffd_free(key);
        }
        if (order == 0 && !is_storage(first[i].tree, first[i].value))
            status = compare_values(c, first[i].value, second[j].value);
        i += order <= 0;
        j += order >= 0;
    }
    return status;
}

static ffd_status compare_objects(const comparer *c, uint32_t x, uint32_t y)
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

/* Depth is limited by the scanner. */
static ffd_status compare_values(const comparer *c, uint32_t x, uint32_t y)
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

/* Compares positions as the part (GLTF_NONE: none) places them: differences in the lattice's units. */
static void compare_positions(const comparer *c, size_t accessor, size_t part)
{
    const size_t count = (size_t)c->a->model.accessors[accessor].count;
    double a[3 * BLOCK], b[3 * BLOCK];
    for (size_t first = 0; first < count; first += BLOCK) {
        const size_t size = count - first < BLOCK ? count - first : BLOCK;
        ffd_gltf_read(c->a, accessor, first, size, 3, a);
        ffd_gltf_read(c->b, accessor, first, size, 3, b);
        if (memcmp(a, b, 3 * size * sizeof *a) == 0)
            continue;
        if (part != GLTF_NONE) {
            ffd_part_place(&c->a->base, part, first, size, a);
            ffd_part_place(&c->a->base, part, first, size, b);
        }
        for (size_t i = 0; i < 3 * size; i++) {
            const double difference = fabs(a[i] - b[i]);
            if (difference > c->result->position_difference_max)
                c->result->position_difference_max = difference;
            if (!(difference <= c->tolerance) && (a[i] < b[i] || a[i] > b[i] || isnan(a[i]) != isnan(b[i])))
                differ(c, "/accessors/%zu: vertex %zu has %c %.17g and %.17g", accessor, first + i / 3,
                       "xyz"[i % 3], a[i], b[i]);
        }
    }
    c->result->positions_compared += count;
}

static bool both_read(const comparer *c, size_t accessor)
{
    return c->a->layouts[accessor].readable && c->b->layouts[accessor].readable;
}

/* Positions under each node that shows them, then those that none shows. */
static ffd_status compare_all_positions(const comparer *c)
{
    const gltf_document *d = c->a;
    bool *done = ffd_alloc_zero(d->model.accessor_count, sizeof *done);
    if (!done)
        return ffd_fail_memory(c->error);
    for (size_t i = 0; i < d->base.part_count; i++) {
        const size_t accessor = d->parts[i].streams[GLTF_POSITION].accessor;
        if (d->mesh_parts[i].repeats_positions || !both_read(c, accessor))
            continue;
        compare_positions(c, accessor, i);
        done[accessor] = true;
    }
    for (size_t a = 0; a < d->model.accessor_count; a++)
        if (c->is_position[a] && !done[a] && both_read(c, a))
            compare_positions(c, a, GLTF_NONE);
    ffd_free(done);
    return FFD_OK;
}

/* Sets the positions in b's copy of a view to a's: they are compared by themselves. */
static void equalize_positions(const comparer *c, size_t view, unsigned char *bytes)
{
    const unsigned char *mine = ffd_gltf_view_bytes(c->a, view);
    for (size_t a = 0; a < c->a->model.accessor_count; a++) {
        const gltf_accessor *accessor = &c->a->model.accessors[a];
        const gltf_layout *layout = &c->a->layouts[a];
        if (!c->is_position[a] || accessor->view != (int)view || !layout->data ||
            layout->packing == GLTF_DRACO)
            continue;
        for (size_t i = 0; i < accessor->count; i++) {
            const size_t at = (size_t)(accessor->offset + i * layout->stride);
            memcpy(bytes + at, mine + at, layout->element_size);
        }
    }
}

/* The bytes of a view, decoded if they can be; else as they are stored. NULL: there are none. */
static const unsigned char *find_bytes(const gltf_document *d, size_t view, size_t *size)
{
    const unsigned char *bytes = ffd_gltf_view_bytes(d, view);
    *size = (size_t)d->model.views[view].length;
    return bytes ? bytes : ffd_gltf_compressed_bytes(d, view, size);
}

static void compare_bytes(const comparer *c, size_t view, const unsigned char *a, const unsigned char *b,
                          size_t size)
{
    for (size_t k = 0; k < size && c->result->equal; k++)
        if (a[k] != b[k])
            differ(c, "/bufferViews/%zu: byte %zu is 0x%02x and 0x%02x", view, k, (unsigned)a[k],
                   (unsigned)b[k]);
}

static ffd_status compare_view(const comparer *c, size_t i)
{
    size_t size, other_size;
    const unsigned char *a = find_bytes(c->a, i, &size), *b = find_bytes(c->b, i, &other_size);
    if (!a != !b || (a && size != other_size))
        differ(c, "/bufferViews/%zu: only one file has its bytes", i);
    if (!a || !b || size != other_size || memcmp(a, b, size) == 0)
        return FFD_OK;
    if (!ffd_gltf_view_bytes(c->a, i)) { /* nobody can tell what is in it */
        compare_bytes(c, i, a, b, size);
        return FFD_OK;
    }
    unsigned char *bytes = ffd_alloc(size, 1);
    if (!bytes)
        return ffd_fail_memory(c->error);
    memcpy(bytes, b, size);
    equalize_positions(c, i, bytes);
    compare_bytes(c, i, a, bytes, size);
    ffd_free(bytes);
    return FFD_OK;
}

/* Elements out of Draco data that are no positions. */
static void compare_unpacked(const comparer *c, size_t accessor)
{
    const gltf_unpacked *a = &c->a->unpacked[accessor], *b = &c->b->unpacked[accessor];
    if (!a->bytes || c->is_position[accessor])
        return;
    if (!b->bytes || a->size != b->size || memcmp(a->bytes, b->bytes, a->size) != 0)
        differ(c, "/accessors/%zu: its elements differ", accessor);
}

static void find_unpacked(const gltf_document *d, bool *is_unpacked)
{
    for (size_t a = 0; a < d->model.accessor_count; a++)
        if (d->unpacked[a].bytes)
            is_unpacked[d->unpacked[a].view] = true;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count; p++) {
            double view;
            const uint32_t value =
                ffd_json_span_member(&d->tree, ffd_gltf_draco_value(d, m, p), "bufferView");
            if (d->draco_problems[d->first_primitive[m] + p] &&
                ffd_json_span_number(&d->tree, value, &view) && view < (double)d->model.view_count)
                is_unpacked[(size_t)view] = false;
        }
}

ffd_status ffd_gltf_compare(const mesh_document *first, const mesh_document *second, double tolerance,
                            ffd_comparison *comparison, ffd_error *error)
{
    const gltf_document *a = ffd_gltf_of(first), *b = ffd_gltf_of(second);
    *comparison = (ffd_comparison){.equal = true};
    comparer c = {a, b, tolerance, comparison, NULL, NULL, error};
    ffd_status status = FFD_OK;
    c.is_position = ffd_alloc_zero(a->model.accessor_count, sizeof *c.is_position);
    c.is_unpacked = ffd_alloc_zero(a->model.view_count, sizeof *c.is_unpacked);
    if (!c.is_position || !c.is_unpacked) {
        status = ffd_fail_memory(error);
        goto done;
    }
    for (size_t m = 0; m < a->model.mesh_count; m++)
        for (size_t p = 0; p < a->model.meshes[m].primitive_count; p++)
            if (a->model.meshes[m].primitives[p].accessor[GLTF_POSITION] >= 0)
                c.is_position[a->model.meshes[m].primitives[p].accessor[GLTF_POSITION]] = true;
    find_unpacked(a, c.is_unpacked);
    status = compare_values(&c, 0, 0);
    /* Equal JSON: accessors and views are the same in both. */
    if (status == FFD_OK && comparison->equal)
        status = compare_all_positions(&c);
    for (size_t i = 0; i < a->model.view_count && status == FFD_OK && comparison->equal; i++)
        if (!c.is_unpacked[i])
            status = compare_view(&c, i);
    for (size_t i = 0; i < a->model.accessor_count && status == FFD_OK && comparison->equal; i++)
        compare_unpacked(&c, i);
done:
    ffd_free(c.is_position);
    ffd_free(c.is_unpacked);
    return status;
}
