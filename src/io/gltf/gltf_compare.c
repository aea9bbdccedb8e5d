#include "io/gltf/gltf_compare.h"
#include "base/memory/memory.h"
#include "io/gltf/gltf_compare_json.h"
#include "io/gltf/read/gltf_draco.h"
#include "io/gltf/read/gltf_read.h"
#include "io/gltf/read/gltf_views.h"
#include <stdio.h>
#include <string.h>

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
    const json_span *tree = &c->a->tree;
    const uint32_t attributes = ffd_json_span_member(tree, primitive, "attributes");
    uint32_t value = attributes;
    for (int n = 0; value != JSON_NONE; n++) {
        char key[32];
        double accessor;
        snprintf(key, sizeof key, "TEXCOORD_%d", n);
        value = ffd_json_span_member(tree, attributes, key);
        if (ffd_json_span_number(tree, value, &accessor) && accessor >= 0 &&
            accessor < (double)c->a->model.accessor_count)
            note_kind(c, (int)accessor, FFD_DIFFERENCE_TEXCOORD);
    }
}

static void note_kinds(gltf_comparer *c)
{
    const gltf_document *d = c->a;
    memset(c->kinds, FFD_DIFFERENCE_OTHER, d->model.accessor_count);
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count; p++) {
            const gltf_primitive *primitive = &d->model.meshes[m].primitives[p];
            for (size_t s = 0; s < gltf_vector_slots(primitive); s++)
                note_kind(c, gltf_slot_accessor(primitive, s), (ffd_difference_kind)(s % GLTF_DEFORMED));
            note_kind(c, primitive->indices, FFD_DIFFERENCE_TOPOLOGY);
            note_texcoords(c, ffd_gltf_primitive_value(d, m, p));
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
            ffd_difference_say(c->result, (ffd_difference_kind)c->kinds[accessor],
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
            ffd_gltf_differ_in_bound(c, &c->bounds[a]);
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
            ffd_difference_say(c->result, FFD_DIFFERENCE_OTHER,
                               "/bufferViews/%zu: byte %zu is 0x%02x and 0x%02x", view, k, (unsigned)a[k],
                               (unsigned)b[k]);
            return;
        }
}

/* Compares the bytes of a view that are not elements. */
static ffd_status compare_view(gltf_comparer *c, size_t i)
{
    size_t size, other_size;
    const unsigned char *a = find_bytes(c->a, i, &size), *b = find_bytes(c->b, i, &other_size);
    if (!a || !b || size != other_size) {
        ffd_difference_say(c->result, FFD_DIFFERENCE_OTHER, "/bufferViews/%zu: only one file has its bytes",
                           i);
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

/* Compares the contents of two files whose JSON agrees in accessors and bufferViews. */
static ffd_status compare_contents(gltf_comparer *c)
{
    ffd_status status = FFD_OK;
    find_unpacked(c->a, c->is_unpacked);
    leave_problems(c->a, c->is_unpacked);
    leave_problems(c->b, c->is_unpacked);
    find_same_views(c);
    compare_accessors(c);
    for (size_t i = 0; i < c->a->model.view_count && status == FFD_OK; i++)
        if (!c->is_unpacked[i] && !c->is_same[i])
            status = compare_view(c, i);
    return status;
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
    if (make_tables(&c)) {
        note_kinds(&c);
        status = ffd_gltf_compare_json(&c);
    } else {
        status = ffd_fail_memory(error);
    }
    if (status == FFD_OK && c.other_storage)
        comparison->complete = false;
    else if (status == FFD_OK)
        status = compare_contents(&c);
    ffd_free(c.kinds);
    ffd_free(c.states);
    ffd_free(c.bounds);
    ffd_free(c.is_same);
    ffd_free(c.is_unpacked);
    return status;
}
