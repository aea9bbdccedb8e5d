/* gltf_target_names.c - the names of morph targets. */
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_json_insert.h"
#include "io/gltf/edit/gltf_morphs.h"
#include "json/json_text.h"
#include <stdio.h>
#include <string.h>

static bool is_array(const gltf_document *d, uint32_t value)
{
    return value != JSON_NONE && d->tree.values[value].kind == JSON_ARRAY;
}

/* Returns the list in the extras of a mesh or primitive; JSON_NONE: none, or it is not a list. */
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
    const size_t count = d->mesh_uses[mesh].target_count, filed = d->mesh_uses[mesh].filed_targets;
    uint32_t *const names = ffd_alloc(count, sizeof *names);
    if (!names)
        return NULL;
    for (size_t t = 0; t < count; t++)
        names[t] = JSON_NONE;
    take_names(d, list_of(d, d->mesh_values.values[mesh]), names, filed);
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));)
        take_names(d, list_of(d, p->value), names, filed);
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

/* Whether the extras of a mesh have a list of names, or room for one. */
static bool can_hold_names(const gltf_document *d, size_t mesh)
{
    const uint32_t extras = ffd_json_tree_member(&d->tree, d->mesh_values.values[mesh], "extras");
    const uint32_t names = ffd_json_tree_member(&d->tree, extras, "targetNames");
    return (extras == JSON_NONE || d->tree.values[extras].kind == JSON_OBJECT) &&
           (names == JSON_NONE || is_array(d, names));
}

#define INVENTED "target_"

/* Adds a name that an invented one could be equal to. */
static bool reserve(const char *name, intern_table *taken)
{
    uint32_t index;
    return strncmp(name, INVENTED, strlen(INVENTED)) != 0 || ffd_intern(taken, name, strlen(name), &index);
}

/* Lists the names that targets of a mesh have, or get from the caller, and an invented one must not be.
   Returns false if memory runs out. */
static bool list_taken(const gltf_document *d, size_t mesh, const uint32_t *names, intern_table *taken)
{
    bool done = true;
    for (size_t k = 0; k < d->morph_count && done; k++)
        done = reserve(d->morphs[k].name, taken);
    for (size_t t = 0; t < d->mesh_uses[mesh].filed_targets && done; t++) {
        char *const name = names[t] == JSON_NONE ? NULL : ffd_json_tree_string(&d->tree, names[t], NULL);
        done = names[t] == JSON_NONE || (name && reserve(name, taken));
        ffd_free(name);
    }
    return done;
}

typedef struct invented_name {
    char text[64];
} invented_name;

/* Returns the name that an unnamed target gets: "target_3" or, where another one has that name, "target_3_1",
   and so on. */
static invented_name invent_name(size_t target, const intern_table *taken)
{
    invented_name name;
    uint32_t index;
    snprintf(name.text, sizeof name.text, INVENTED "%zu", target);
    for (size_t k = 1; ffd_intern_find(taken, name.text, strlen(name.text), &index); k++)
        snprintf(name.text, sizeof name.text, INVENTED "%zu_%zu", target, k);
    return name;
}

/* Logs which targets of a mesh get a name: those that have none, and have no place in its list. */
static void log_named(const gltf_document *d, size_t mesh, const uint32_t *names, const intern_table *taken,
                      const mesh_log *log)
{
    size_t count = 0, least = 0, last = 0;
    for (size_t t = ffd_json_tree_count(&d->tree, list_of(d, d->mesh_values.values[mesh]));
         t < d->mesh_uses[mesh].filed_targets; t++) {
        if (names[t] != JSON_NONE)
            continue;
        least = count++ ? least : t;
        last = t;
    }
    if (count == 1)
        ffd_log_line(log, FFD_LOG_INFO, "the unnamed morph target of mesh %zu is now called %s", mesh,
                     invent_name(least, taken).text);
    else if (count > 1)
        ffd_log_line(log, FFD_LOG_INFO, "the unnamed morph targets of mesh %zu are now called %s to %s", mesh,
                     invent_name(least, taken).text, invent_name(last, taken).text);
}

bool ffd_gltf_log_target_name(const gltf_document *d, size_t mesh, const mesh_log *log)
{
    const gltf_mesh_uses *const uses = &d->mesh_uses[mesh];
    uint32_t *const names = ffd_gltf_list_target_names(d, mesh);
    intern_table taken = {0};
    const bool done = names && list_taken(d, mesh, names, &taken);
    if (done && !can_hold_names(d, mesh))
        ffd_log_line(log, FFD_LOG_WARNING, "mesh %zu: its extras cannot hold the name of the morph target",
                     mesh);
    else if (done && uses->target_count == uses->filed_targets)
        log_named(d, mesh, names, &taken, log);
    ffd_intern_free(&taken);
    ffd_free(names);
    return done;
}

/* The names of the targets of a mesh. */
typedef struct name_writer {
    const gltf_document *document;
    size_t mesh, filed; /* filed: targets before the further ones */
    const uint32_t *names;
    intern_table taken; /* list_taken */
    json_edits *edits;
} name_writer;

/* Writes the name of a further target as a JSON string. */
static void write_added(const name_writer *w, size_t target, byte_buffer *text)
{
    const gltf_document *const d = w->document;
    json_text json;
    size_t k = 0;
    while (d->morphs[k].places[w->mesh] != target)
        k++;
    ffd_json_begin(&json, text);
    ffd_json_string(&json, NULL, d->morphs[k].name);
}

/* Writes the names of the targets from `first` on, and those of the further ones. */
static void write_names(const name_writer *w, size_t first, byte_buffer *text)
{
    const json_tree *const tree = &w->document->tree;
    for (size_t t = first; t < w->document->mesh_uses[w->mesh].target_count; t++) {
        ffd_buffer_text(text, t > first ? "," : "");
        if (t >= w->filed)
            write_added(w, t, text);
        else if (w->names[t] == JSON_NONE)
            ffd_buffer_format(text, "\"%s\"", invent_name(t, &w->taken).text);
        else
            ffd_buffer_append(text, tree->text + tree->values[w->names[t]].begin,
                              tree->values[w->names[t]].end - tree->values[w->names[t]].begin);
    }
}

/* Completes a list. If it has more names than the mesh had targets, the new names replace the surplus ones.
 */
static void edit_list(const name_writer *w, uint32_t list)
{
    const json_tree *const tree = &w->document->tree;
    const size_t count = w->document->mesh_uses[w->mesh].target_count, named = tree->values[list].count;
    byte_buffer text = {0};
    for (size_t t = w->filed; t < count && t < named; t++) {
        const json_value *const surplus = &tree->values[ffd_json_tree_element(tree, list, t)];
        write_added(w, t, &text);
        if (!text.failed)
            ffd_edits_replace(w->edits, surplus->begin, surplus->end, text.data, text.size);
        text.size = 0;
    }
    write_names(w, named, &text);
    if (named < count)
        ffd_gltf_insert_last(w->document, list, &text, w->edits);
    w->edits->failed = w->edits->failed || text.failed;
    ffd_buffer_free(&text);
}

static void edit_mesh(const name_writer *w)
{
    const gltf_document *const d = w->document;
    const uint32_t value = d->mesh_values.values[w->mesh];
    const uint32_t extras = ffd_json_tree_member(&d->tree, value, "extras");
    const uint32_t list = list_of(d, value);
    byte_buffer text = {0};
    if (!can_hold_names(d, w->mesh))
        return;
    if (list != JSON_NONE) {
        edit_list(w, list);
        return;
    }
    ffd_buffer_text(&text, extras == JSON_NONE ? "\"extras\":{\"targetNames\":[" : "\"targetNames\":[");
    write_names(w, 0, &text);
    ffd_buffer_text(&text, extras == JSON_NONE ? "]}" : "]");
    ffd_gltf_insert_last(d, extras == JSON_NONE ? value : extras, &text, w->edits);
    ffd_buffer_free(&text);
}

void ffd_gltf_edit_target_names(const gltf_document *d, size_t mesh, json_edits *edits)
{
    uint32_t *const names = ffd_gltf_list_target_names(d, mesh);
    name_writer w = {d, mesh, d->mesh_uses[mesh].filed_targets, names, {0}, edits};
    const bool done = names && list_taken(d, mesh, names, &w.taken);
    edits->failed = edits->failed || !done;
    if (done)
        edit_mesh(&w);
    for (const gltf_primitive *p = NULL; done && (p = ffd_gltf_next_primitive(d, mesh, p));) {
        const uint32_t list = list_of(d, p->value);
        if (list != JSON_NONE)
            edit_list(&w, list);
    }
    ffd_intern_free(&w.taken);
    ffd_free(names);
}
