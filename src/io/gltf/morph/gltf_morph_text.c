#include "io/gltf/morph/gltf_morph_text.h"
#include "base/memory/memory.h"
#include "io/gltf/morph/gltf_grown.h"
#include "io/gltf/morph/gltf_morph_reuse.h"
#include "io/gltf/morph/gltf_morph_weights.h"
#include "io/gltf/save/gltf_json_insert.h"

typedef struct morph_writer {
    gltf_grown file;
    const morph_request *request;
    bool *grow;           /* per mesh: whether it gets one more target */
    unsigned char *users; /* from ffd_gltf_count_users */
    size_t *zeros[2];     /* per accessor: the new accessor with as many zeros; [1]: with bounds */
    bool loses;           /* whether unselected nodes of the current mesh lose old offsets */
} morph_writer;

static bool is_array(const gltf_saver *saver, uint32_t value)
{
    return value != JSON_NONE && saver->document->tree.values[value].kind == JSON_ARRAY;
}

uint32_t ffd_gltf_target_names(const gltf_document *d, size_t mesh)
{
    const uint32_t extras = ffd_json_span_member(&d->tree, d->mesh_values.values[mesh], "extras");
    const uint32_t names = ffd_json_span_member(&d->tree, extras, "targetNames");
    return names != JSON_NONE && d->tree.values[names].kind == JSON_ARRAY ? names : JSON_NONE;
}

size_t ffd_gltf_find_target(const gltf_document *d, size_t mesh, const char *name)
{
    const size_t count = ffd_gltf_target_count(d, mesh);
    size_t t = 0;
    for (uint32_t v = ffd_json_span_first(&d->tree, ffd_gltf_target_names(d, mesh));
         v != JSON_NONE && t < count; v = ffd_json_span_after(&d->tree, v), t++)
        if (ffd_json_span_string_is(&d->tree, v, name))
            return t;
    return GLTF_NONE;
}

/* Returns the new accessor of zeros for the offsets of an accessor's elements. */
static size_t zeros_for(morph_writer *w, size_t accessor, bool bounds)
{
    const gltf_document *d = w->file.saver.document;
    size_t *number = &w->zeros[bounds][accessor];
    if (*number != GLTF_NONE)
        return *number;
    ffd_buffer_format(
        &w->file.data.accessors, "%s{\"componentType\":5126,\"count\":%llu,\"type\":\"VEC3\"%s}",
        w->file.data.accessor_count > 0 ? "," : "", (unsigned long long)d->model.accessors[accessor].count,
        bounds ? ",\"min\":[0,0,0],\"max\":[0,0,0]" : "");
    *number = d->model.accessor_count + w->file.data.accessor_count++;
    return *number;
}

/* Returns the accessor for an attribute of a target: that of the replaced target if it can be reused. */
static size_t accessor_for(morph_writer *w, const morph_place *place)
{
    const gltf_document *d = w->file.saver.document;
    const gltf_primitive *const primitive = &d->model.meshes[place->mesh].primitives[place->primitive];
    if (place->target < primitive->target_count &&
        ffd_gltf_can_reuse(d, w->users, place, w->request->source, w->request->morph))
        return (size_t)primitive->target_accessors[GLTF_DEFORMED * place->target + place->semantic];
    return zeros_for(w, (size_t)primitive->accessor[place->semantic], place->semantic == GLTF_POSITION);
}

/* Whether uses that are not selected have offsets, and lose them because the target gets another accessor. */
static bool loses_offsets(const morph_writer *w, const morph_place *place, size_t accessor)
{
    const gltf_primitive *const primitive =
        &w->file.saver.document->model.meshes[place->mesh].primitives[place->primitive];
    const int old = place->target < primitive->target_count
                        ? primitive->target_accessors[GLTF_DEFORMED * place->target + place->semantic]
                        : -1;
    return old >= 0 && (size_t)old != accessor &&
           ffd_gltf_is_partly_selected(w->request->source, place->mesh, place->primitive);
}

/* Writes a target. It has normals and tangents only if these are deformed. */
static void write_target(morph_writer *w, size_t mesh, size_t p, size_t target, byte_buffer *text)
{
    const gltf_document *d = w->file.saver.document;
    const gltf_primitive *const primitive = &d->model.meshes[mesh].primitives[p];
    const bool wanted[GLTF_DEFORMED] = {true, w->request->morph->normals,
                                        w->request->morph->normals && primitive->accessor[GLTF_NORMAL] >= 0};
    bool first = true;
    ffd_buffer_text(text, "{");
    for (size_t s = 0; s < GLTF_DEFORMED; s++) {
        const morph_place place = {mesh, p, target, (gltf_semantic)s};
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

static void replace_target(morph_writer *w, size_t mesh, size_t p, size_t target, uint32_t targets)
{
    const json_span *const tree = &w->file.saver.document->tree;
    const json_value *const value = &tree->values[ffd_json_span_element(tree, targets, target)];
    byte_buffer text = {0};
    write_target(w, mesh, p, target, &text);
    if (!text.failed)
        ffd_edits_replace(&w->file.saver.edits, value->begin, value->end, text.data, text.size);
    w->file.saver.edits.failed = w->file.saver.edits.failed || text.failed;
    ffd_buffer_free(&text);
}

static void add_to_primitive(morph_writer *w, size_t mesh, size_t p)
{
    const gltf_document *d = w->file.saver.document;
    const gltf_primitive *const primitive = &d->model.meshes[mesh].primitives[p];
    const uint32_t value = ffd_gltf_primitive_value(d, mesh, p);
    const uint32_t targets = ffd_json_span_member(&d->tree, value, "targets");
    const size_t place = ffd_gltf_target_place(primitive, w->request->named[mesh]);
    byte_buffer text = {0};
    if (place < primitive->target_count) {
        replace_target(w, mesh, p, place, targets);
        return;
    }
    if (targets == JSON_NONE)
        ffd_buffer_text(&text, "\"targets\":[");
    write_target(w, mesh, p, place, &text);
    if (targets == JSON_NONE)
        ffd_buffer_text(&text, "]");
    ffd_gltf_insert_last(&w->file.saver, targets == JSON_NONE ? value : targets, &text);
    ffd_buffer_free(&text);
}

/* Writes a name as a JSON string. */
static void write_name(const char *name, byte_buffer *text)
{
    json_text json;
    ffd_json_begin(&json, text);
    ffd_json_string(&json, NULL, name);
}

/* Writes names for the targets from `first` on: the new target's name for the last one, generated names for
   the others. */
static void write_names(const gltf_saver *saver, const char *name, size_t mesh, size_t first,
                        byte_buffer *text)
{
    const size_t count = ffd_gltf_target_count(saver->document, mesh);
    for (size_t t = first; t < count; t++)
        ffd_buffer_format(text, "\"target_%zu\",", t);
    write_name(name, text);
    if (first + 1 == count)
        ffd_log_line(saver->log, FFD_LOG_INFO,
                     "the unnamed morph target of mesh %zu is now called target_%zu", mesh, first);
    else if (first < count)
        ffd_log_line(saver->log, FFD_LOG_INFO,
                     "the unnamed morph targets of mesh %zu are now called target_%zu to target_%zu", mesh,
                     first, count - 1);
}

/* Adds the new target's name. If the list has more names than the mesh has targets, the name replaces the
   first surplus one. */
static void edit_names(gltf_saver *saver, const char *name, size_t mesh, uint32_t names)
{
    const json_span *tree = &saver->document->tree;
    const size_t count = ffd_gltf_target_count(saver->document, mesh), named = tree->values[names].count;
    byte_buffer text = {0};
    write_names(saver, name, mesh, named < count ? named : count, &text);
    if (named <= count) {
        ffd_gltf_insert_last(saver, names, &text);
    } else if (!text.failed) {
        const json_value *value = &tree->values[ffd_json_span_element(tree, names, count)];
        ffd_edits_replace(&saver->edits, value->begin, value->end, text.data, text.size);
    }
    saver->edits.failed = saver->edits.failed || text.failed;
    ffd_buffer_free(&text);
}

static void add_names(gltf_saver *saver, const char *name, size_t mesh)
{
    const json_span *tree = &saver->document->tree;
    const uint32_t value = saver->document->mesh_values.values[mesh];
    const uint32_t extras = ffd_json_span_member(tree, value, "extras");
    const uint32_t names = ffd_json_span_member(tree, extras, "targetNames");
    byte_buffer text = {0};
    if ((extras != JSON_NONE && tree->values[extras].kind != JSON_OBJECT) ||
        (names != JSON_NONE && !is_array(saver, names))) {
        ffd_log_line(saver->log, FFD_LOG_WARNING,
                     "mesh %zu: its extras cannot hold the name of the morph target", mesh);
        return;
    }
    if (names != JSON_NONE) {
        edit_names(saver, name, mesh, names);
        return;
    }
    ffd_buffer_text(&text, extras == JSON_NONE ? "\"extras\":{\"targetNames\":[" : "\"targetNames\":[");
    write_names(saver, name, mesh, 0, &text);
    ffd_buffer_text(&text, extras == JSON_NONE ? "]}" : "]");
    ffd_gltf_insert_last(saver, extras == JSON_NONE ? value : extras, &text);
    ffd_buffer_free(&text);
}

/* Adds a weight 0, or puts it in the place of one that no target had. targets: how many there are. make: also
   if there are no weights yet, as for a mesh; a node needs none of its own. */
static void add_weights(gltf_saver *saver, uint32_t value, size_t targets, bool make)
{
    const json_span *const tree = &saver->document->tree;
    const uint32_t weights = ffd_json_span_member(tree, value, "weights");
    byte_buffer text = {0};
    if (is_array(saver, weights) && tree->values[weights].count > targets) {
        const json_value *const old = &tree->values[ffd_json_span_element(tree, weights, targets)];
        ffd_edits_replace(&saver->edits, old->begin, old->end, "0", 1);
    } else if (is_array(saver, weights)) {
        ffd_buffer_text(&text, "0");
        ffd_gltf_insert_last(saver, weights, &text);
    } else if (weights == JSON_NONE && make) {
        ffd_buffer_text(&text, "\"weights\":[");
        for (size_t t = 0; t < targets; t++)
            ffd_buffer_text(&text, "0,");
        ffd_buffer_text(&text, "0]");
        ffd_gltf_insert_last(saver, value, &text);
    }
    ffd_buffer_free(&text);
}

static void add_to_meshes(morph_writer *w)
{
    const gltf_document *d = w->file.saver.document;
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        if (!w->request->meshes[m])
            continue;
        w->loses = false;
        for (size_t p = 0; p < d->model.meshes[m].primitive_count; p++)
            add_to_primitive(w, m, p);
        if (!w->grow[m]) {
            ffd_log_line(w->file.saver.log, FFD_LOG_WARNING,
                         "mesh %zu has a morph target of that name already: it is replaced%s", m,
                         w->loses ? ", and nodes that are not selected lose its offsets, too" : "");
            continue;
        }
        add_weights(&w->file.saver, d->mesh_values.values[m], ffd_gltf_target_count(d, m), true);
        add_names(&w->file.saver, w->request->morph->name, m);
    }
    for (size_t n = 0; n < d->model.node_count; n++)
        if (d->model.nodes[n].mesh >= 0 && w->grow[d->model.nodes[n].mesh])
            add_weights(&w->file.saver, d->node_values.values[n],
                        ffd_gltf_target_count(d, (size_t)d->model.nodes[n].mesh), false);
}

ffd_status ffd_gltf_add_target(const gltf_document *d, const morph_request *request, file_input *made,
                               ffd_error *error)
{
    const size_t count = d->model.accessor_count;
    morph_writer w = {.file.saver = {.document = d, .log = request->log}, .request = request};
    ffd_status status = FFD_OK;
    w.users = ffd_gltf_count_users(d, NULL);
    w.grow = ffd_alloc(d->model.mesh_count, sizeof *w.grow);
    for (size_t m = 0; m < d->model.mesh_count && w.grow; m++)
        w.grow[m] = request->meshes[m] && request->named[m] == GLTF_NONE;
    for (int i = 0; i < 2; i++) {
        w.zeros[i] = ffd_alloc(count, sizeof *w.zeros[i]);
        for (size_t a = 0; w.zeros[i] && a < count; a++)
            w.zeros[i][a] = GLTF_NONE;
    }
    if (w.zeros[0] && w.zeros[1] && w.grow && w.users) {
        add_to_meshes(&w);
        ffd_gltf_extend_weights(&w.file.saver, w.grow, &w.file.data);
        status = ffd_gltf_grown_write(&w.file, made, error);
    } else {
        status = ffd_fail_memory(error);
    }
    ffd_free(w.grow);
    ffd_free(w.users);
    ffd_free(w.zeros[0]);
    ffd_free(w.zeros[1]);
    ffd_gltf_grown_free(&w.file);
    return status;
}
