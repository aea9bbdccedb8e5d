#include "io/gltf/edit/gltf_morph_text.h"
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_grown.h"
#include "io/gltf/edit/gltf_json_insert.h"
#include "io/gltf/edit/gltf_morph_weights.h"
#include "io/gltf/edit/gltf_target_names.h"
#include "io/gltf/read/gltf_users.h"

/* An attribute of a morph target of a primitive. */
typedef struct morph_place {
    const gltf_primitive *primitive; /* of the file */
    size_t target;
    gltf_semantic semantic;
} morph_place;

/* Whether every selected use of the primitive has results. Where a use has none the old offsets stay, which
   is right only for a use that is not selected. */
static bool has_results(const gltf_document *d, const gltf_morph *morph, const morph_place *place)
{
    const gltf_instance *const instances = ffd_gltf_instances(d, place->primitive);
    const size_t uses = d->mesh_uses[place->primitive->mesh].node_count;
    for (size_t n = 0; n < uses; n++) {
        const size_t part = instances[n].part[place->semantic];
        if (instances[n].selected &&
            (part == GLTF_NONE || !ffd_gltf_morph_result(morph, part, place->semantic)))
            return false;
    }
    return uses > 0;
}

/* Whether any node that shows the primitive is not selected: it keeps the old offsets. */
static bool is_partly_selected(const gltf_document *d, const gltf_primitive *primitive)
{
    const gltf_instance *const instances = ffd_gltf_instances(d, primitive);
    for (size_t n = 0; n < d->mesh_uses[primitive->mesh].node_count; n++)
        if (!instances[n].selected)
            return true;
    return false;
}

/* Whether the new offsets of an attribute can be stored in the old accessor. It must hold floats, only these
   offsets, in bytes of its own, and every selected use must have results in a target of source, whose
   instances are the document's. If some uses are not selected, they keep the old offsets, and the accessor
   may be shared: saving then gives the selected uses a new one. users: from ffd_gltf_count_users. */
static bool can_reuse(const gltf_document *d, const unsigned char *users, const morph_place *place,
                      const gltf_document *source, const gltf_morph *morph)
{
    const gltf_primitive *const primitive = place->primitive;
    const int number = primitive->target_accessors[GLTF_DEFORMED * place->target + place->semantic];
    if (number < 0)
        return false;
    const gltf_accessor *const accessor = &d->model.accessors[number];
    const gltf_layout *const layout = &d->layouts[number];
    const bool is_own =
        users[number] == 1 && !accessor->sparse.present && accessor->view >= 0 && layout->data;
    return accessor->component == GLTF_FLOAT && accessor->columns == 1 && accessor->rows == 3 &&
           (is_own || is_partly_selected(source, place->primitive)) &&
           accessor->count == d->model.accessors[primitive->accessor[place->semantic]].count &&
           layout->readable && layout->packing == GLTF_PLAIN && has_results(source, morph, place);
}

/* What accessors of zeros are for. Those of gaps are no others': equal targets would get equal results. */
enum { ZEROS_DIRECTIONS, ZEROS_POSITIONS, ZEROS_GAP, ZEROS_KINDS };

typedef struct morph_writer {
    gltf_grown file;
    const morph_request *request;
    bool *grow;                 /* per mesh: whether it gets one more target */
    unsigned char *users;       /* from ffd_gltf_count_users */
    size_t *zeros[ZEROS_KINDS]; /* per accessor: the new accessor with as many zeros (zeros_for) */
    bool loses;                 /* whether unselected nodes of the current mesh lose old offsets */
} morph_writer;

static bool is_array(const gltf_document *d, uint32_t value)
{
    return value != JSON_NONE && d->tree.values[value].kind == JSON_ARRAY;
}

/* Returns the new accessor of zeros for the offsets of an accessor's elements. */
static size_t zeros_for(morph_writer *w, size_t accessor, int kind)
{
    const gltf_document *d = w->file.document;
    size_t *number = &w->zeros[kind][accessor];
    if (*number != GLTF_NONE)
        return *number;
    ffd_buffer_format(&w->file.accessors, "%s{\"componentType\":5126,\"count\":%llu,\"type\":\"VEC3\"%s}",
                      w->file.accessor_count > 0 ? "," : "",
                      (unsigned long long)d->model.accessors[accessor].count,
                      kind == ZEROS_DIRECTIONS ? "" : ",\"min\":[0,0,0],\"max\":[0,0,0]");
    *number = d->model.accessor_count + w->file.accessor_count++;
    return *number;
}

/* Returns the accessor for an attribute of a target: that of the replaced target if it can be reused. */
static size_t accessor_for(morph_writer *w, const morph_place *place)
{
    const gltf_document *d = w->file.document;
    const gltf_primitive *const primitive = place->primitive;
    if (place->target < primitive->target_count &&
        can_reuse(d, w->users, place, w->request->source, w->request->morph))
        return (size_t)primitive->target_accessors[GLTF_DEFORMED * place->target + place->semantic];
    return zeros_for(w, (size_t)primitive->accessor[place->semantic],
                     place->semantic == GLTF_POSITION ? ZEROS_POSITIONS : ZEROS_DIRECTIONS);
}

/* Whether uses that are not selected have offsets, and lose them because the target gets another accessor. */
static bool loses_offsets(const morph_writer *w, const morph_place *place, size_t accessor)
{
    const gltf_primitive *const primitive = place->primitive;
    const int old = place->target < primitive->target_count
                        ? primitive->target_accessors[GLTF_DEFORMED * place->target + place->semantic]
                        : -1;
    return old >= 0 && (size_t)old != accessor && is_partly_selected(w->request->source, place->primitive);
}

/* Writes a target. It has normals and tangents only if these are deformed. */
static void write_target(morph_writer *w, const gltf_primitive *primitive, size_t target, byte_buffer *text)
{
    const bool wanted[GLTF_DEFORMED] = {true, w->request->morph->normals,
                                        w->request->morph->normals && primitive->accessor[GLTF_NORMAL] >= 0};
    bool first = true;
    ffd_buffer_text(text, "{");
    for (size_t s = 0; s < GLTF_DEFORMED; s++) {
        const morph_place place = {primitive, target, (gltf_semantic)s};
        const bool is_there = wanted[s] && primitive->accessor[s] >= 0;
        const size_t accessor = is_there ? accessor_for(w, &place) : GLTF_NONE;
        w->loses = w->loses || loses_offsets(w, &place, accessor);
        if (!is_there)
            continue;
        ffd_buffer_format(text, "%s\"%s\":%zu", first ? "" : ",", ffd_gltf_semantic_names[s], accessor);
        first = false;
    }
    ffd_buffer_text(text, "}");
}

static void replace_target(morph_writer *w, const gltf_primitive *primitive, size_t target, uint32_t targets)
{
    const json_tree *const tree = &w->file.document->tree;
    const json_value *const value = &tree->values[ffd_json_tree_element(tree, targets, target)];
    byte_buffer text = {0};
    write_target(w, primitive, target, &text);
    if (!text.failed)
        ffd_edits_replace(&w->file.edits, value->begin, value->end, text.data, text.size);
    w->file.edits.failed = w->file.edits.failed || text.failed;
    ffd_buffer_free(&text);
}

/* Writes a target that moves nothing, in the place of one that the primitive lacks. */
static void write_gap(morph_writer *w, const gltf_primitive *primitive, byte_buffer *text)
{
    ffd_buffer_text(text, "{");
    if (primitive->accessor[GLTF_POSITION] >= 0)
        ffd_buffer_format(text, "\"POSITION\":%zu",
                          zeros_for(w, (size_t)primitive->accessor[GLTF_POSITION], ZEROS_GAP));
    ffd_buffer_text(text, "},");
}

/* The target has the same place in all primitives of a mesh, also in those with fewer targets than others. */
static void add_to_primitive(morph_writer *w, const gltf_primitive *primitive)
{
    const gltf_document *d = w->file.document;
    const uint32_t value = primitive->value;
    const uint32_t targets = ffd_json_tree_member(&d->tree, value, "targets");
    const size_t place = w->request->places[primitive->mesh];
    byte_buffer text = {0};
    if (place < primitive->target_count) {
        replace_target(w, primitive, place, targets);
        return;
    }
    if (targets == JSON_NONE)
        ffd_buffer_text(&text, "\"targets\":[");
    for (size_t t = primitive->target_count; t < place; t++)
        write_gap(w, primitive, &text);
    write_target(w, primitive, place, &text);
    if (targets == JSON_NONE)
        ffd_buffer_text(&text, "]");
    ffd_gltf_insert_last(d, targets == JSON_NONE ? value : targets, &text, &w->file.edits);
    ffd_buffer_free(&text);
}

/* Adds a weight 0, or puts it in the place of one that no target had. targets: how many there are. make: also
   if there are no weights yet, as for a mesh; a node needs none of its own. */
static void add_weights(gltf_grown *file, uint32_t value, size_t targets, bool make)
{
    const gltf_document *const d = file->document;
    const json_tree *const tree = &d->tree;
    const uint32_t weights = ffd_json_tree_member(tree, value, "weights");
    byte_buffer text = {0};
    if (is_array(d, weights) && tree->values[weights].count > targets) {
        const json_value *const old = &tree->values[ffd_json_tree_element(tree, weights, targets)];
        ffd_edits_replace(&file->edits, old->begin, old->end, "0", 1);
    } else if (is_array(d, weights)) {
        ffd_buffer_text(&text, "0");
        ffd_gltf_insert_last(d, weights, &text, &file->edits);
    } else if (weights == JSON_NONE && make) {
        ffd_buffer_text(&text, "\"weights\":[");
        for (size_t t = 0; t < targets; t++)
            ffd_buffer_text(&text, "0,");
        ffd_buffer_text(&text, "0]");
        ffd_gltf_insert_last(d, value, &text, &file->edits);
    }
    ffd_buffer_free(&text);
}

static void log_replaced(morph_writer *w, size_t mesh)
{
    size_t target, found;
    if (!ffd_gltf_find_target(w->file.document, mesh, w->request->morph->name, &target, &found))
        w->file.edits.failed = true;
    const char *const loses = w->loses ? ", and nodes that are not selected lose its offsets, too" : "";
    if (found > 1)
        ffd_log_line(w->file.log, FFD_LOG_WARNING,
                     "mesh %zu has %zu morph targets of that name already: the first is replaced%s", mesh,
                     found, loses);
    else
        ffd_log_line(w->file.log, FFD_LOG_WARNING,
                     "mesh %zu has a morph target of that name already: it is replaced%s", mesh, loses);
}

static void add_to_meshes(morph_writer *w)
{
    const gltf_document *d = w->file.document;
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        if (!w->request->meshes[m])
            continue;
        w->loses = false;
        for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, m, p));)
            add_to_primitive(w, p);
        if (!w->grow[m]) {
            log_replaced(w, m);
            continue;
        }
        add_weights(&w->file, d->mesh_values.values[m], d->mesh_uses[m].target_count, true);
        ffd_gltf_add_target_name(&w->file, m, w->request->morph->name);
    }
    for (size_t n = 0; n < d->model.node_count; n++)
        if (d->model.nodes[n].mesh >= 0 && w->grow[d->model.nodes[n].mesh])
            add_weights(&w->file, d->node_values.values[n],
                        d->mesh_uses[(size_t)d->model.nodes[n].mesh].target_count, false);
}

/* Memory for a target that fills a gap: its text, and what opening the file keeps of it. */
#define GAP_BYTES 200

/* Refuses more gaps than the memory budget holds: a short file may have any number. */
static ffd_status limit_gaps(const gltf_document *d, const morph_request *request, ffd_error *error)
{
    uint64_t gaps = 0;
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        const gltf_primitive *const primitive = &d->model.primitives[i];
        const size_t place = request->meshes[primitive->mesh] ? request->places[primitive->mesh] : 0;
        gaps += primitive->target_count < place ? place - primitive->target_count : 0;
    }
    const ffd_status status = ffd_budget_check(&d->base.budget, gaps, GAP_BYTES, error);
    if (status)
        ffd_fail_name_file(error, d->name);
    return status;
}

ffd_status ffd_gltf_add_target(const gltf_document *d, const morph_request *request, file_input *made,
                               ffd_error *error)
{
    const size_t count = d->model.accessor_count;
    morph_writer w = {.file = {.document = d, .log = request->log}, .request = request};
    ffd_status status = limit_gaps(d, request, error);
    if (status)
        return status;
    w.users = ffd_gltf_count_users(d, NULL);
    w.grow = ffd_alloc(d->model.mesh_count, sizeof *w.grow);
    for (size_t m = 0; m < d->model.mesh_count && w.grow; m++)
        w.grow[m] = request->meshes[m] && request->places[m] == d->mesh_uses[m].target_count;
    bool made_all = w.users && w.grow;
    for (int i = 0; i < ZEROS_KINDS; i++) {
        w.zeros[i] = ffd_alloc(count, sizeof *w.zeros[i]);
        made_all = made_all && w.zeros[i];
        for (size_t a = 0; w.zeros[i] && a < count; a++)
            w.zeros[i][a] = GLTF_NONE;
    }
    if (made_all) {
        add_to_meshes(&w);
        ffd_gltf_extend_weights(&w.file, w.grow);
        status = ffd_gltf_grown_write(&w.file, made, error);
    } else {
        status = ffd_fail_memory(error);
    }
    ffd_free(w.grow);
    ffd_free(w.users);
    for (int i = 0; i < ZEROS_KINDS; i++)
        ffd_free(w.zeros[i]);
    ffd_gltf_grown_free(&w.file);
    return status;
}
