#include "io/gltf/edit/gltf_target_names.h"
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_json_insert.h"
#include "json/json_text.h"

static bool is_array(const gltf_document *d, uint32_t value)
{
    return value != JSON_NONE && d->tree.values[value].kind == JSON_ARRAY;
}

/* Returns the list in the extras of a mesh or primitive; JSON_NONE: none, or it is no list. */
static uint32_t list_of(const gltf_document *d, uint32_t value)
{
    const uint32_t extras = ffd_json_tree_member(&d->tree, value, "extras");
    const uint32_t names = ffd_json_tree_member(&d->tree, extras, "targetNames");
    return is_array(d, names) ? names : JSON_NONE;
}

/* Takes the names of a list for those of count targets that have none yet. */
static void take_names(const gltf_document *d, uint32_t list, uint32_t *names, size_t count)
{
    size_t t = 0;
    for (uint32_t v = ffd_json_tree_first(&d->tree, list); v != JSON_NONE && t < count;
         v = ffd_json_tree_after(&d->tree, v), t++)
        if (names[t] == JSON_NONE && d->tree.values[v].kind == JSON_STRING)
            names[t] = v;
}

uint32_t *ffd_gltf_list_target_names(const gltf_document *d, size_t mesh)
{
    const size_t count = d->mesh_uses[mesh].target_count;
    uint32_t *const names = ffd_alloc(count, sizeof *names);
    if (!names)
        return NULL;
    for (size_t t = 0; t < count; t++)
        names[t] = JSON_NONE;
    take_names(d, list_of(d, d->mesh_values.values[mesh]), names, count);
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));)
        take_names(d, list_of(d, p->value), names, count);
    return names;
}

bool ffd_gltf_find_target(const gltf_document *d, size_t mesh, const char *name, size_t *target,
                          size_t *found)
{
    const size_t count = d->mesh_uses[mesh].target_count;
    uint32_t *const names = ffd_gltf_list_target_names(d, mesh);
    *target = GLTF_NONE;
    *found = 0;
    for (size_t t = 0; names && t < count; t++) {
        if (names[t] == JSON_NONE || !ffd_json_tree_string_is(&d->tree, names[t], name))
            continue;
        *target = *found == 0 ? t : *target;
        ++*found;
    }
    ffd_free(names);
    return names;
}

/* The names to add. */
typedef struct name_writer {
    gltf_grown *file;
    size_t mesh, count; /* count: targets before the further one */
    const uint32_t *names;
    const char *name; /* of the further target */
} name_writer;

/* Writes a name as a JSON string. */
static void write_name(const char *name, byte_buffer *text)
{
    json_text json;
    ffd_json_begin(&json, text);
    ffd_json_string(&json, NULL, name);
}

/* Writes the names of the targets from `first` on, and that of the further one. */
static void write_names(const name_writer *w, size_t first, byte_buffer *text)
{
    const json_tree *const tree = &w->file->document->tree;
    for (size_t t = first; t < w->count; t++) {
        const json_value *const name = w->names[t] == JSON_NONE ? NULL : &tree->values[w->names[t]];
        if (name)
            ffd_buffer_append(text, tree->text + name->begin, name->end - name->begin);
        else
            ffd_buffer_format(text, "\"target_%zu\"", t);
        ffd_buffer_text(text, ",");
    }
    write_name(w->name, text);
}

/* Logs which targets of the mesh have got a name: those from `first` on that had none. */
static void log_named(const name_writer *w, size_t first)
{
    size_t count = 0, least = 0, last = 0;
    for (size_t t = first; t < w->count; t++) {
        if (w->names[t] != JSON_NONE)
            continue;
        least = count++ ? least : t;
        last = t;
    }
    if (count == 1)
        ffd_log_line(w->file->log, FFD_LOG_INFO,
                     "the unnamed morph target of mesh %zu is now called target_%zu", w->mesh, least);
    else if (count > 1)
        ffd_log_line(w->file->log, FFD_LOG_INFO,
                     "the unnamed morph targets of mesh %zu are now called target_%zu to target_%zu", w->mesh,
                     least, last);
}

/* Completes a list. If it has more names than the mesh has targets, the new name replaces the first surplus
   one. */
static void edit_list(const name_writer *w, uint32_t list)
{
    gltf_grown *const file = w->file;
    const json_tree *const tree = &file->document->tree;
    const size_t named = tree->values[list].count;
    byte_buffer text = {0};
    write_names(w, named < w->count ? named : w->count, &text);
    if (named <= w->count) {
        ffd_gltf_insert_last(file->document, list, &text, &file->edits);
    } else if (!text.failed) {
        const json_value *value = &tree->values[ffd_json_tree_element(tree, list, w->count)];
        ffd_edits_replace(&file->edits, value->begin, value->end, text.data, text.size);
    }
    file->edits.failed = file->edits.failed || text.failed;
    ffd_buffer_free(&text);
}

static void edit_mesh(const name_writer *w)
{
    gltf_grown *const file = w->file;
    const json_tree *const tree = &file->document->tree;
    const uint32_t value = file->document->mesh_values.values[w->mesh];
    const uint32_t extras = ffd_json_tree_member(tree, value, "extras");
    const uint32_t names = ffd_json_tree_member(tree, extras, "targetNames");
    byte_buffer text = {0};
    if ((extras != JSON_NONE && tree->values[extras].kind != JSON_OBJECT) ||
        (names != JSON_NONE && !is_array(file->document, names))) {
        ffd_log_line(file->log, FFD_LOG_WARNING,
                     "mesh %zu: its extras cannot hold the name of the morph target", w->mesh);
        return;
    }
    log_named(w, names == JSON_NONE ? 0 : tree->values[names].count);
    if (names != JSON_NONE) {
        edit_list(w, names);
        return;
    }
    ffd_buffer_text(&text, extras == JSON_NONE ? "\"extras\":{\"targetNames\":[" : "\"targetNames\":[");
    write_names(w, 0, &text);
    ffd_buffer_text(&text, extras == JSON_NONE ? "]}" : "]");
    ffd_gltf_insert_last(file->document, extras == JSON_NONE ? value : extras, &text, &file->edits);
    ffd_buffer_free(&text);
}

void ffd_gltf_add_target_name(gltf_grown *file, size_t mesh, const char *name)
{
    const gltf_document *const d = file->document;
    uint32_t *const names = ffd_gltf_list_target_names(d, mesh);
    const name_writer w = {file, mesh, d->mesh_uses[mesh].target_count, names, name};
    file->edits.failed = file->edits.failed || !names;
    if (!names)
        return;
    edit_mesh(&w);
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));) {
        const uint32_t list = list_of(d, p->value);
        if (list != JSON_NONE)
            edit_list(&w, list);
    }
    ffd_free(names);
}
