/* gltf_follow.c - updates indices in extensions for meshes and accessors that are copied. */
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/read/gltf_index_table.h"
#include "io/gltf/write/gltf_plan.h"
#include "io/gltf/write/gltf_saver.h"
#include "json/json_text.h"
#include <stdlib.h>
#include <string.h>

#define POINTER_SIZE 256

static void leave(gltf_saver *saver, uint32_t value)
{
    ffd_buffer_append(&saver->left, &value, sizeof value);
}

/* One use of a mesh whose extensions are edited. */
typedef struct mesh_use {
    gltf_saver *saver;
    size_t mesh, use;
    bool deformed;
    json_edits *edits;
} mesh_use;

static bool is_deformed(const gltf_saver *saver, size_t mesh, size_t use)
{
    const gltf_document *d = saver->document;
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));)
        for (size_t s = 0; s < gltf_slot_count(p); s++)
            if (ffd_gltf_version_at(d, &saver->plan, p, s, use) != GLTF_NONE)
                return true;
    return false;
}

/* Returns the accessor of the output with the content that `accessor` has for a use of a mesh; GLTF_NONE: the
   mesh has no such accessor, or more than one. */
static size_t output_of(const mesh_use *u, size_t accessor)
{
    const gltf_document *d = u->saver->document;
    const gltf_plan *plan = &u->saver->plan;
    size_t output = GLTF_NONE;
    for (const gltf_primitive *primitive = NULL;
         (primitive = ffd_gltf_next_primitive(d, u->mesh, primitive));) {
        for (size_t s = 0; s < gltf_slot_count(primitive); s++) {
            if (gltf_slot_accessor(primitive, s) < 0 || (size_t)gltf_slot_accessor(primitive, s) != accessor)
                continue;
            const size_t version = ffd_gltf_version_at(d, plan, primitive, s, u->use);
            const size_t here = version == GLTF_NONE ? accessor : plan->versions[version].output;
            if (output != GLTF_NONE && output != here)
                return GLTF_NONE;
            output = here;
        }
    }
    return output;
}

static void follow_accessor(void *context, const gltf_index_place *place)
{
    const mesh_use *u = context;
    const gltf_document *d = u->saver->document;
    const size_t accessor = ffd_gltf_index(d, place->value, d->model.accessor_count);
    if (place->kind != GLTF_INDEX_SHAPE || accessor == GLTF_NONE || !u->deformed)
        return;
    const size_t output = output_of(u, accessor);
    const json_value *number = &d->tree.values[place->value];
    if (output == GLTF_NONE)
        leave(u->saver, place->value);
    else if (output != accessor)
        ffd_edits_format(u->edits, number->begin, number->end, "%zu", output);
}

void ffd_gltf_follow_accessors(gltf_saver *saver, size_t mesh, size_t use, json_edits *edits)
{
    mesh_use u = {saver, mesh, use, is_deformed(saver, mesh, use), edits};
    ffd_gltf_visit_mesh_indices(saver->document, mesh, follow_accessor, &u);
}

/* The copies of meshes, for lookups. */
typedef struct copies {
    gltf_saver *saver;
    size_t *of_node; /* per node: its copy in the plan; GLTF_NONE: none */
    /* Limits repeated elements: many elements, each repeated for many copies, could take any amount. */
    memory_budget budget;
    ffd_status status;
    ffd_error *error;
    size_t repeated; /* number of elements */
    uint32_t first;  /* the first repeated element */
} copies;

static bool is_of_mesh_before(const void *copy, const void *mesh)
{
    return ((const gltf_mesh_copy *)copy)->mesh < *(const size_t *)mesh;
}

/* Returns the index of a mesh's first copy in the plan, whose copies are sorted by mesh. */
static size_t first_copy(const gltf_plan *plan, size_t mesh)
{
    return lower_bound(&mesh, plan->copies, plan->copy_count, sizeof *plan->copies, is_of_mesh_before);
}

/* Writes a reference to a mesh: its index, or a pointer that ends with `rest`. */
static void write_name(const gltf_index_place *place, size_t mesh, const char *rest, byte_buffer *text)
{
    byte_buffer pointer = {0};
    json_text json;
    if (place->kind == GLTF_INDEX_MESH) {
        ffd_buffer_format(text, "%zu", mesh);
        return;
    }
    ffd_buffer_format(&pointer, "/meshes/%zu%s", mesh, rest);
    char *characters = ffd_buffer_finish(&pointer);
    ffd_json_begin(&json, text);
    if (characters)
        ffd_json_string(&json, NULL, characters);
    text->failed = text->failed || !characters;
    ffd_free(characters);
}

/* Appends a range of the file's JSON as the document's edit changes it: a channel may get another sampler. */
static void copy_edited(const gltf_document *d, uint32_t begin, uint32_t end, byte_buffer *text)
{
    ffd_edits_apply(&d->edit->edits, d->tree.text, begin, end, text);
}

/* Repeats an element of a list, for a copy of the mesh that it refers to. */
static void repeat(copies *c, const gltf_index_place *place, size_t copy, const char *rest)
{
    const gltf_document *d = c->saver->document;
    json_edits *edits = &c->saver->edits;
    const json_value *element = &d->tree.values[place->repeats], *value = &d->tree.values[place->value];
    const uint64_t size = sizeof(json_edit) + (element->end - element->begin);
    ffd_error problem = {0};
    byte_buffer text = {0};
    c->status = ffd_budget_take(&c->budget, 1, size, &problem);
    if (c->status) {
        ffd_json_tree_fail(&d->tree, place->repeats, d->name, c->status, c->error, "%s", problem.message);
        return;
    }
    ffd_buffer_text(&text, ",");
    copy_edited(d, element->begin, value->begin, &text);
    write_name(place, d->mesh_values.count + copy, rest, &text);
    copy_edited(d, value->end, element->end, &text);
    if (!text.failed)
        ffd_edits_replace(edits, element->end, element->end, text.data, text.size);
    edits->failed = edits->failed || text.failed;
    ffd_buffer_free(&text);
    c->first = c->repeated++ ? c->first : place->repeats;
}

/* Updates a value that refers to a mesh. rest: the rest of its pointer. */
static void follow_name(copies *c, const gltf_index_place *place, size_t mesh, const char *rest)
{
    gltf_saver *saver = c->saver;
    const gltf_document *d = saver->document;
    const gltf_plan *plan = &saver->plan;
    const size_t first = first_copy(plan, mesh);
    const bool in_node = place->kind == GLTF_INDEX_MESH && place->list && strcmp(place->list, "nodes") == 0;
    const json_value *number = &d->tree.values[place->value];
    if (first == plan->copy_count || plan->copies[first].mesh != mesh)
        return;
    if (place->repeats != JSON_NONE) {
        for (size_t i = first; i < plan->copy_count && plan->copies[i].mesh == mesh && c->status == FFD_OK;
             i++)
            repeat(c, place, i, rest);
    } else if (in_node && d->model.nodes[place->owner].mesh >= 0 &&
               (size_t)d->model.nodes[place->owner].mesh == mesh) {
        if (c->of_node[place->owner] != GLTF_NONE)
            ffd_edits_format(&saver->edits, number->begin, number->end, "%zu",
                             d->mesh_values.count + c->of_node[place->owner]);
    } else {
        leave(saver, place->value);
    }
}

static void follow_mesh(void *context, const gltf_index_place *place)
{
    copies *c = context;
    const gltf_document *d = c->saver->document;
    if (c->status)
        return;
    if (place->kind == GLTF_INDEX_MESH) {
        const size_t mesh = ffd_gltf_index(d, place->value, d->model.mesh_count);
        if (mesh != GLTF_NONE)
            follow_name(c, place, mesh, "");
    } else if (place->kind == GLTF_INDEX_POINTER && d->tree.values[place->value].kind == JSON_STRING) {
        const char *rest = "";
        char *pointer = ffd_json_tree_string(&d->tree, place->value, NULL);
        const size_t mesh = pointer ? ffd_gltf_pointed(pointer, "meshes", &rest) : GLTF_NONE;
        c->saver->edits.failed = c->saver->edits.failed || !pointer;
        if (mesh != GLTF_NONE)
            follow_name(c, place, mesh, rest);
        ffd_free(pointer);
    }
}

/* Warns of values that cannot follow. */
static void warn_of_left(gltf_saver *saver)
{
    const size_t count = ffd_gltf_warn_of_values(saver, &saver->left,
                                                 "index in an extension does not follow the deformed mesh",
                                                 "indices in extensions do not follow the deformed meshes");
    if (saver->options->indices_left)
        *saver->options->indices_left = count;
}

static void log_repeated(const copies *c)
{
    char pointer[POINTER_SIZE];
    if (c->repeated == 0)
        return;
    ffd_json_tree_pointer(&c->saver->document->tree, c->first, pointer, sizeof pointer);
    ffd_log_line(c->saver->log, FFD_LOG_INFO, "%zu %s, as %s is", c->repeated,
                 ffd_plural(c->repeated, "element that names a mesh is repeated for a copy of it",
                            "elements that name meshes are repeated for copies of these"),
                 pointer);
}

ffd_status ffd_gltf_follow_meshes(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    const gltf_plan *plan = &saver->plan;
    copies c = {saver, NULL, d->base.budget, FFD_OK, error, 0, JSON_NONE};
    if (plan->copy_count > 0) {
        c.of_node = ffd_alloc(d->model.node_count, sizeof *c.of_node);
        if (!c.of_node)
            return ffd_fail_memory(error);
        for (size_t n = 0; n < d->model.node_count; n++)
            c.of_node[n] = GLTF_NONE;
        for (size_t i = 0; i < plan->change_count; i++)
            c.of_node[plan->changes[i].node] = plan->changes[i].copy;
        ffd_gltf_visit_indices(d, follow_mesh, &c);
    }
    ffd_free(c.of_node);
    log_repeated(&c);
    if (c.status == FFD_OK)
        warn_of_left(saver);
    return c.status;
}
