#include "io/gltf/gltf_weights.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "base/text/words.h"
#include "io/gltf/model/gltf_joints.h"
#include "io/gltf/read/gltf_elements.h"
#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

/* Vertices that are read at a time. */
#define BLOCK ((size_t)256)

/* What the primitives of a part give it. */
typedef struct part_source {
    size_t accessor;                 /* GLTF_NONE: nothing yet */
    const gltf_primitive *primitive; /* that gives it, else the first one that shows the part */
} part_source;

typedef struct weight_reader {
    const gltf_document *document;
    const weight_source *source;
    size_t *first; /* of each part, its first vertex in the document */
    part_source *parts;
    bool *is_named; /* WEIGHT_JOINT: the nodes of the name */
    double *weights;
} weight_reader;

/* Names the mesh of a primitive in a message: its name, or its number. */
static void name_mesh(const gltf_document *d, const gltf_primitive *primitive, char *text, size_t capacity)
{
    const uint32_t name = ffd_json_tree_member(&d->tree, d->mesh_values.values[primitive->mesh], "name");
    char *const own = name == JSON_NONE || d->tree.values[name].kind != JSON_STRING
                          ? NULL
                          : ffd_json_tree_string(&d->tree, name, NULL);
    char shown[100];
    if (own && *own) {
        ffd_name_shown(own, shown, sizeof shown);
        snprintf(text, capacity, "mesh \"%s\"", shown);
    } else {
        snprintf(text, capacity, "mesh %zu", primitive->mesh);
    }
    ffd_free(own);
}

/* Fails at a primitive. what: of its mesh. */
static ffd_status fail(const weight_reader *r, const gltf_primitive *primitive, ffd_status status,
                       const char *what, ffd_error *error)
{
    const gltf_document *const d = r->document;
    char mesh[120];
    name_mesh(d, primitive, mesh, sizeof mesh);
    return ffd_json_tree_fail(&d->tree, primitive->value, d->name, status, error, "%s %s ({weight})", mesh,
                              what);
}

/* The attribute that is wanted, as the file spells it or as the user does. */
static void name_wanted(const weight_reader *r, char *text, size_t capacity)
{
    if (r->source->kind == WEIGHT_COLOR)
        snprintf(text, capacity, "COLOR_0");
    else
        ffd_name_shown(r->source->name, text, capacity);
}

static bool equals_but_for_case(const char *a, const char *b)
{
    for (; *a && *b; a++, b++) {
        const char x = *a >= 'A' && *a <= 'Z' ? (char)(*a + 32) : *a;
        const char y = *b >= 'A' && *b <= 'Z' ? (char)(*b + 32) : *b;
        if (x != y)
            return false;
    }
    return *a == *b;
}

/* Finds the only attribute whose name equals the wanted one but for capitals: exporters write them in
   capitals. *value: JSON_NONE if there is none, or several. */
static ffd_status find_any_case(const weight_reader *r, uint32_t attributes, uint32_t *value,
                                ffd_error *error)
{
    const json_tree *const tree = &r->document->tree;
    size_t found = 0;
    for (uint32_t v = ffd_json_tree_first(tree, attributes); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v)) {
        char *const key = ffd_json_tree_key(tree, v);
        if (!key)
            return ffd_fail_memory(error);
        if (equals_but_for_case(key, r->source->name)) {
            *value = v;
            found++;
        }
        ffd_free(key);
    }
    *value = found == 1 ? *value : JSON_NONE;
    return FFD_OK;
}

/* Finds the JSON value of the attribute that is wanted of a primitive. */
static ffd_status find_attribute(const weight_reader *r, const gltf_primitive *primitive, uint32_t *value,
                                 ffd_error *error)
{
    const json_tree *const tree = &r->document->tree;
    const uint32_t attributes = ffd_json_tree_member(tree, primitive->value, "attributes");
    const bool is_color = r->source->kind == WEIGHT_COLOR;
    *value = ffd_json_tree_member(tree, attributes, is_color ? "COLOR_0" : r->source->name);
    return is_color || *value != JSON_NONE ? FFD_OK : find_any_case(r, attributes, value, error);
}

/* Whether each element stands for numbers from 0 to 1: floats, or integers that are normalized. */
static bool has_fractions(const gltf_accessor *accessor)
{
    return accessor->component == GLTF_FLOAT || accessor->normalized;
}

/* Finds the accessor of the attribute that is wanted; GLTF_NONE if the primitive has none. */
static ffd_status find_accessor(const weight_reader *r, const gltf_primitive *primitive, size_t *found,
                                ffd_error *error)
{
    const gltf_document *const d = r->document;
    const bool is_color = r->source->kind == WEIGHT_COLOR;
    uint32_t value;
    char name[100], what[240];
    *found = GLTF_NONE;
    TRY(find_attribute(r, primitive, &value, error));
    if (value == JSON_NONE)
        return FFD_OK;
    name_wanted(r, name, sizeof name);
    const size_t a = ffd_gltf_index(d, value, d->model.accessor_count);
    const gltf_accessor *const accessor = a == GLTF_NONE ? NULL : &d->model.accessors[a];
    const int least = is_color ? 3 : 1, most = is_color ? 4 : 1;
    if (!accessor || accessor->columns != 1 || accessor->rows < least || accessor->rows > most ||
        !has_fractions(accessor)) {
        snprintf(what, sizeof what, "has an attribute \"%s\" that is no %s of floats or normalized integers",
                 name, is_color ? "VEC3 or VEC4" : "SCALAR");
        return fail(r, primitive, FFD_E_INVALID, what, error);
    }
    if (!d->layouts[a].readable) {
        snprintf(what, sizeof what, "has an attribute \"%s\" whose data cannot be read", name);
        return fail(r, primitive, FFD_E_UNSUPPORTED, what, error);
    }
    if (accessor->count < d->model.accessors[primitive->accessor[GLTF_POSITION]].count) {
        snprintf(what, sizeof what, "has fewer values of \"%s\" than vertices", name);
        return fail(r, primitive, FFD_E_INVALID, what, error);
    }
    *found = a;
    return FFD_OK;
}

/* Reads numbers [first, first + count) of an accessor: the channel of colours, where one without alpha is
   opaque. */
static void read_numbers(const weight_reader *r, size_t accessor, size_t first, size_t count, double *numbers)
{
    const gltf_document *const d = r->document;
    const size_t rows = (size_t)d->model.accessors[accessor].rows, channel = (size_t)r->source->channel;
    double colours[4 * BLOCK];
    if (r->source->kind != WEIGHT_COLOR) {
        ffd_gltf_read(d, accessor, first, count, 1, numbers);
        return;
    }
    ffd_gltf_read(d, accessor, first, count, rows, colours);
    for (size_t i = 0; i < count; i++)
        numbers[i] = channel < rows ? colours[rows * i + channel] : 1;
}

/* Whether two numbers differ; NaNs do not. */
static bool differ(double a, double b)
{
    return !(a == b) && !(a != a && b != b);
}

/* Tiles of the values of a part. */
#define TILE ((size_t)1 << 14)

/* An accessor that is read for a part, or compared with what the part has. */
typedef struct accessor_work {
    const weight_reader *reader;
    const mesh_part *part;
    size_t accessor;
    double *weights; /* of the part */
    bool compares;
    atomic_bool differs;
} accessor_work;

static void take_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    accessor_work *const work = context;
    double numbers[BLOCK];
    (void)tile, (void)worker;
    for (size_t at = first; at < last && !ffd_deadline_passed_at(at); at += BLOCK) {
        const size_t count = last - at < BLOCK ? last - at : BLOCK;
        double *const to = work->weights + at;
        read_numbers(work->reader, work->accessor, at, count, work->compares ? numbers : to);
        for (size_t i = 0; i < count && work->compares; i++)
            if (ffd_part_selects(work->part, at + i) && differ(to[i], numbers[i]))
                atomic_store(&work->differs, true);
    }
}

/* Reads the values of an accessor for a part, or compares them with those that another primitive of the part
   gave it: what has one position has one weight. */
static ffd_status take_accessor(const weight_reader *r, size_t p, size_t accessor,
                                const gltf_primitive *primitive, ffd_error *error)
{
    const mesh_part *const part = &r->document->mesh_parts[p];
    part_source *const given = &r->parts[p];
    accessor_work work = {.reader = r,
                          .part = part,
                          .accessor = accessor,
                          .weights = r->weights + r->first[p],
                          .compares = given->accessor != GLTF_NONE};
    atomic_init(&work.differs, false);
    ffd_parallel_tiles(part->vertex_count, TILE, r->document->threads, take_tile, &work);
    TRY(ffd_deadline_check(error));
    if (atomic_load(&work.differs))
        return fail(r, primitive, FFD_E_INVALID,
                    "has primitives that share their positions, but give them different weights", error);
    given->accessor = accessor;
    return FFD_OK;
}

static ffd_status take_skin(const weight_reader *r, size_t p, ffd_error *error)
{
    r->parts[p].accessor = 0;
    return ffd_gltf_joint_shares(r->document, p, r->is_named, r->weights + r->first[p], error);
}

static ffd_status take_instance(const weight_reader *r, const gltf_instance *instance, ffd_error *error)
{
    const gltf_document *const d = r->document;
    const size_t p = instance->part[GLTF_POSITION];
    size_t accessor;
    if (p == GLTF_NONE || !instance->selected || d->mesh_parts[p].vertex_count == 0)
        return FFD_OK;
    part_source *const given = &r->parts[p];
    given->primitive = given->primitive ? given->primitive : instance->primitive;
    if (r->source->kind == WEIGHT_JOINT)
        return given->accessor == GLTF_NONE && d->parts[p].skin ? take_skin(r, p, error) : FFD_OK;
    TRY(find_accessor(r, instance->primitive, &accessor, error));
    return accessor == GLTF_NONE || accessor == given->accessor
               ? FFD_OK
               : take_accessor(r, p, accessor, instance->primitive, error);
}

/* Returns the name of a node, which the caller frees; NULL if it has none. */
static char *name_of(const gltf_document *d, size_t node)
{
    const uint32_t name = ffd_json_tree_member(&d->tree, d->node_values.values[node], "name");
    return name == JSON_NONE || d->tree.values[name].kind != JSON_STRING
               ? NULL
               : ffd_json_tree_string(&d->tree, name, NULL);
}

/* Marks the nodes of the name among the joints, and finds the most similar name of a joint, which the caller
   frees. Returns how many are marked. */
static size_t mark_named(const weight_reader *r, const bool *is_joint, nearest_word *nearest, char **kept)
{
    const gltf_document *const d = r->document;
    size_t count = 0;
    for (size_t n = 0; n < d->model.node_count; n++) {
        char *own = is_joint[n] ? name_of(d, n) : NULL;
        if (!own)
            continue;
        r->is_named[n] = strcmp(own, r->source->name) == 0;
        count += r->is_named[n];
        ffd_nearest_offer(nearest, own);
        if (nearest->best == own) {
            char *const before = *kept;
            *kept = own;
            own = before;
        }
        ffd_free(own);
    }
    return count;
}

/* Finds the joints of the name. Errors: FFD_E_INVALID (there are none), FFD_E_MEMORY. */
static ffd_status find_joints(weight_reader *r, ffd_error *error)
{
    const gltf_document *const d = r->document;
    nearest_word nearest = {.word = r->source->name, .length = strlen(r->source->name)};
    bool *const is_joint = ffd_alloc_zero(d->model.node_count, sizeof *is_joint);
    char *kept = NULL, shown[100], best[100] = "";
    ffd_status status;
    r->is_named = ffd_alloc_zero(d->model.node_count, sizeof *r->is_named);
    TRY_END(is_joint && r->is_named ? FFD_OK : ffd_fail_memory(error));
    for (size_t s = 0; s < d->skin_values.count; s++)
        for (size_t j = 0; j < d->skins[s].joint_count; j++)
            is_joint[d->skins[s].joints[j]] = true;
    if (mark_named(r, is_joint, &nearest, &kept) > 0)
        goto end;
    const char *const meant = nearest.best ? ffd_nearest_meant(&nearest) : NULL;
    ffd_name_shown(r->source->name, shown, sizeof shown);
    if (meant)
        ffd_name_shown(meant, best, sizeof best);
    status = ffd_fail_file(error, FFD_E_INVALID, d->name, "no skin has a joint \"%s\"%s%s%s ({weight})",
                           shown, meant ? " (nearest: " : "", best, meant ? ")" : "");
end:
    ffd_free(is_joint);
    ffd_free(kept);
    return status;
}

/* Refuses a part with selected vertices that no primitive gave weights. */
static ffd_status check_part(const weight_reader *r, size_t p, ffd_error *error)
{
    const mesh_part *const part = &r->document->mesh_parts[p];
    char name[100], what[200];
    if (part->repeats_positions || part->skipped || part->vertex_count == 0 || !r->parts[p].primitive ||
        r->parts[p].accessor != GLTF_NONE)
        return FFD_OK;
    name_wanted(r, name, sizeof name);
    if (r->source->kind == WEIGHT_JOINT)
        snprintf(what, sizeof what, "has no skin%s",
                 r->document->space == FFD_SPACE_MESH ? " in its own space" : "");
    else
        snprintf(what, sizeof what, "has no attribute \"%s\"", name);
    return fail(r, r->parts[p].primitive, FFD_E_INVALID, what, error);
}

static ffd_status read(const mesh_document *document, const weight_source *source, double *weights,
                       ffd_error *error)
{
    const gltf_document *const d = ffd_gltf_of(document);
    weight_reader r = {.document = d, .source = source, .weights = weights};
    ffd_status status;
    TRY_END(ffd_first_vertices(document, &r.first, error));
    r.parts = ffd_alloc_zero(document->part_count, sizeof *r.parts);
    TRY_END(r.parts ? FFD_OK : ffd_fail_memory(error));
    for (size_t p = 0; p < document->part_count; p++)
        r.parts[p].accessor = GLTF_NONE;
    if (source->kind == WEIGHT_JOINT)
        TRY_END(find_joints(&r, error));
    for (size_t i = 0; i < d->instance_count; i++)
        TRY_END(take_instance(&r, &d->instances[i], error));
    for (size_t p = 0; p < document->part_count; p++)
        TRY_END(check_part(&r, p, error));
end:
    ffd_free(r.first);
    ffd_free(r.parts);
    ffd_free(r.is_named);
    return status;
}

const mesh_weight_calls ffd_gltf_weights = {.kinds = WEIGHT_BIT(WEIGHT_ATTRIBUTE) | WEIGHT_BIT(WEIGHT_COLOR) |
                                                     WEIGHT_BIT(WEIGHT_JOINT),
                                            .read = read};
