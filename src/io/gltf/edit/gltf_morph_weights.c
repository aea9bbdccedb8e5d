/* gltf_morph_weights.c - what further morph targets get in the animations of a file. */
#include "base/memory/memory.h"
#include "base/text/buffer_binary.h"
#include "base/text/words.h"
#include "io/gltf/edit/gltf_json_insert.h"
#include "io/gltf/edit/gltf_morphs.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/read/gltf_index_table.h"
#include <stdio.h>
#include <string.h>

/* An output that some channels of a sampler need. */
typedef struct wanted_output {
    size_t sampler;
    size_t targets; /* the number of morph targets that the file has of the mesh that they drive */
    size_t added;   /* how many more the mesh gets, and the output has */
    bool is_single; /* they drive only the weight of a further target, which is to be 0 */
    size_t made;    /* the new accessor; GLTF_NONE: the old one stays */
    size_t place;   /* the index of the sampler that gets it */
    size_t next;    /* of the same sampler; GLTF_NONE: the last one */
} wanted_output;

/* An animation whose samplers get other outputs. */
typedef struct animation {
    uint32_t samplers, channels;
    size_t sampler_count, channel_count;
    uint32_t *sampler_values;
    size_t *first;  /* per sampler: its first wanted output; GLTF_NONE: none */
    bool *others;   /* per sampler: whether it also drives something else */
    size_t *wanted; /* per channel: its wanted output; GLTF_NONE: it keeps its own */
    wanted_output *outputs;
    size_t output_count, output_capacity;
    size_t copy_count; /* further samplers */
} animation;

/* Channels to warn of: their number, and the first one. */
typedef struct channel_note {
    size_t count;
    uint32_t first;
} channel_note;

typedef struct weight_writer {
    gltf_edit *file;
    channel_note stale; /* their weights are not one for each morph target */
    channel_note odd;   /* likewise, and they are left as they are */
} weight_writer;

/* Returns a member of an object as a whole number below count; GLTF_NONE if it is not one. */
static size_t index_of(const gltf_document *d, uint32_t object, const char *key, size_t count)
{
    return ffd_gltf_index(d, ffd_json_tree_member(&d->tree, object, key), count);
}

/* What a channel drives. */
typedef struct driven {
    size_t mesh;   /* GLTF_NONE: no weights of a mesh */
    size_t weight; /* the only one of its weights; GLTF_NONE: all */
} driven;

/* Returns what a JSON pointer to the weights of a mesh or of a node leads to. */
static driven follow_pointer(const gltf_document *d, const char *pointer)
{
    static const char weights[] = "/weights";
    const size_t length = sizeof weights - 1;
    const char *rest = "", *after = "";
    driven what = {GLTF_NONE, GLTF_NONE};
    const size_t mesh = ffd_gltf_pointed(pointer, "meshes", &rest);
    const size_t node = mesh == GLTF_NONE ? ffd_gltf_pointed(pointer, "nodes", &rest) : GLTF_NONE;
    if (strncmp(rest, weights, length) != 0)
        return what;
    if (rest[length]) { /* "/weights/3" reads as element 3 of a list "weights" */
        what.weight = ffd_gltf_pointed(rest, "weights", &after);
        if (what.weight == GLTF_NONE || *after)
            return what;
    }
    if (mesh < d->model.mesh_count)
        what.mesh = mesh;
    else if (node < d->model.node_count && d->model.nodes[node].mesh >= 0)
        what.mesh = (size_t)d->model.nodes[node].mesh;
    return what;
}

static driven find_target(gltf_edit *file, uint32_t target)
{
    const gltf_document *d = file->document;
    driven what = {GLTF_NONE, GLTF_NONE};
    const uint32_t pointer =
        ffd_json_tree_member(&d->tree, ffd_gltf_extension(d, target, "KHR_animation_pointer"), "pointer");
    if (pointer != JSON_NONE && d->tree.values[pointer].kind == JSON_STRING) {
        char *text = ffd_json_tree_string(&d->tree, pointer, NULL);
        if (text)
            what = follow_pointer(d, text);
        file->edits.failed = file->edits.failed || !text;
        ffd_free(text);
        return what;
    }
    const uint32_t path = ffd_json_tree_member(&d->tree, target, "path");
    const size_t node = index_of(d, target, "node", d->model.node_count);
    if (path != JSON_NONE && ffd_json_tree_string_is(&d->tree, path, "weights") && node != GLTF_NONE &&
        d->model.nodes[node].mesh >= 0)
        what.mesh = (size_t)d->model.nodes[node].mesh;
    return what;
}

static void end_animation(animation *a)
{
    ffd_free(a->sampler_values);
    ffd_free(a->first);
    ffd_free(a->others);
    ffd_free(a->wanted);
    ffd_free(a->outputs);
}

static bool begin_animation(const gltf_edit *file, uint32_t value, animation *a)
{
    const json_tree *tree = &file->document->tree;
    a->samplers = ffd_json_tree_member(tree, value, "samplers");
    a->channels = ffd_json_tree_member(tree, value, "channels");
    a->sampler_count = ffd_json_tree_count(tree, a->samplers);
    a->channel_count = ffd_json_tree_count(tree, a->channels);
    a->sampler_values = ffd_alloc(a->sampler_count, sizeof *a->sampler_values);
    a->first = ffd_alloc(a->sampler_count, sizeof *a->first);
    a->others = ffd_alloc_zero(a->sampler_count, sizeof *a->others);
    a->wanted = ffd_alloc(a->channel_count, sizeof *a->wanted);
    if (!a->sampler_values || !a->first || !a->others || !a->wanted)
        return false;
    size_t i = 0;
    for (uint32_t v = ffd_json_tree_first(tree, a->samplers); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v)) {
        a->first[i] = GLTF_NONE;
        a->sampler_values[i++] = v;
    }
    return true;
}

/* Returns the output that a sampler gets for the weights of a mesh, which is added if it is new; GLTF_NONE:
   memory ran out. */
static size_t want_output(animation *a, size_t sampler, const gltf_mesh_uses *mesh, bool is_single)
{
    const size_t targets = mesh->filed_targets, added = mesh->target_count - targets;
    size_t *last = &a->first[sampler];
    while (*last != GLTF_NONE && (a->outputs[*last].targets != targets || a->outputs[*last].added != added ||
                                  a->outputs[*last].is_single != is_single))
        last = &a->outputs[*last].next;
    if (*last != GLTF_NONE)
        return *last;
    const size_t index = a->output_count;
    *last = index; /* before the array moves */
    if (!ffd_grow((void **)&a->outputs, &a->output_capacity, index + 1, sizeof *a->outputs))
        return GLTF_NONE;
    a->outputs[a->output_count++] =
        (wanted_output){sampler, targets, added, is_single, GLTF_NONE, sampler, GLTF_NONE};
    return index;
}

/* Finds the channels that drive weights of meshes with further targets. */
static bool find_drivers(gltf_edit *file, animation *a)
{
    const json_tree *tree = &file->document->tree;
    size_t c = 0;
    for (uint32_t v = ffd_json_tree_first(tree, a->channels); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v), c++) {
        const size_t sampler = index_of(file->document, v, "sampler", a->sampler_count);
        a->wanted[c] = GLTF_NONE;
        if (sampler == GLTF_NONE)
            continue;
        const driven what = find_target(file, ffd_json_tree_member(tree, v, "target"));
        const gltf_mesh_uses *const mesh =
            what.mesh == GLTF_NONE ? NULL : &file->document->mesh_uses[what.mesh];
        const bool grows = mesh && mesh->target_count > mesh->filed_targets;
        const bool drives_added = what.weight == GLTF_NONE || (mesh && what.weight >= mesh->filed_targets &&
                                                               what.weight < mesh->target_count);
        if (grows && drives_added) {
            a->wanted[c] = want_output(a, sampler, mesh, what.weight != GLTF_NONE);
            if (a->wanted[c] == GLTF_NONE)
                return false;
        } else {
            a->others[sampler] = true;
        }
    }
    return true;
}

/* The layout of a sampler's output. */
typedef struct output_rows {
    size_t accessor, rows;
    size_t width; /* the values in a row */
    bool fits;    /* there is a value for each target */
} output_rows;

/* Finds the layout of the output that a sampler has, for weights of the targets. Returns false if it is
   unknown. */
static bool find_rows(const gltf_edit *file, uint32_t sampler, const wanted_output *wanted,
                      output_rows *layout)
{
    const gltf_document *d = file->document;
    const uint32_t interpolation = ffd_json_tree_member(&d->tree, sampler, "interpolation");
    const bool cubic =
        interpolation != JSON_NONE && ffd_json_tree_string_is(&d->tree, interpolation, "CUBICSPLINE");
    const size_t input = index_of(d, sampler, "input", d->model.accessor_count);
    layout->accessor = index_of(d, sampler, "output", d->model.accessor_count);
    if (layout->accessor == GLTF_NONE)
        return false;
    const gltf_accessor *const old = &d->model.accessors[layout->accessor];
    const size_t count = (size_t)old->count, parts = cubic ? 3 : 1, row = parts * wanted->targets;
    if (count == 0 || old->columns * old->rows != 1 || !d->layouts[layout->accessor].readable)
        return false;
    const size_t keys = input == GLTF_NONE ? 0 : (size_t)d->model.accessors[input].count;
    const bool is_whole = keys > 0 && count % keys == 0 && count / keys % parts == 0;
    layout->width = is_whole ? count / (keys * parts) : wanted->targets;
    layout->fits = keys == 0 || (is_whole && layout->width == wanted->targets && !wanted->is_single);
    if (keys > 0 && (keys <= count || row == 0))
        layout->rows = keys * parts;
    else /* those that have values: keys alone need no bytes in a file, and may be any number */
        layout->rows = row ? count / row * parts + (count % row ? parts : 0) : 0;
    return layout->rows > 0 && (keys > 0 || count % row == 0);
}

/* Makes an output in which the further targets have the weight 0, after those of the others: as many values
   as the old output has for them, and zeros. Zeros alone need no bytes. */
static void write_output(const weight_writer *w, const output_rows *old, wanted_output *wanted)
{
    const gltf_document *d = w->file->document;
    gltf_edit *const file = w->file;
    const size_t kept = wanted->is_single ? 0 : old->width < wanted->targets ? old->width : wanted->targets;
    const size_t width = wanted->is_single ? 1 : wanted->targets + wanted->added;
    const size_t count = (size_t)d->model.accessors[old->accessor].count;
    ffd_buffer_text(&file->accessors, file->accessor_count > 0 ? ",{" : "{");
    if (kept > 0)
        ffd_buffer_format(&file->accessors, "\"bufferView\":%zu,\"byteOffset\":%zu,", d->view_values.count,
                          file->bytes.size);
    ffd_buffer_format(&file->accessors, "\"componentType\":5126,\"count\":%zu,\"type\":\"SCALAR\"}",
                      old->rows * width);
    for (size_t r = 0; r < old->rows && kept > 0 && !file->bytes.failed; r++)
        for (size_t i = 0; i < width; i++) {
            double value = 0;
            if (i < kept && r * old->width + i < count) /* the last rows may lack some */
                ffd_gltf_read(d, old->accessor, r * old->width + i, 1, 1, &value);
            ffd_buffer_float(&file->bytes, value);
        }
    wanted->made = d->model.accessor_count + file->accessor_count++;
}

/* Returns the first channel that has a wanted output. */
static uint32_t first_channel(const weight_writer *w, const animation *a, size_t wanted)
{
    const json_tree *tree = &w->file->document->tree;
    size_t c = 0;
    uint32_t v = ffd_json_tree_first(tree, a->channels);
    while (a->wanted[c] != wanted) {
        v = ffd_json_tree_after(tree, v);
        c++;
    }
    return v;
}

static void note(const weight_writer *w, const animation *a, size_t wanted, channel_note *note)
{
    if (note->count == 0)
        note->first = first_channel(w, a, wanted);
    for (size_t c = 0; c < a->channel_count; c++)
        note->count += a->wanted[c] == wanted;
}

/* Makes the outputs, and notes those that did not fit their targets before. */
static void make_outputs(weight_writer *w, animation *a)
{
    for (size_t s = 0; s < a->sampler_count; s++)
        for (size_t i = a->first[s]; i != GLTF_NONE; i = a->outputs[i].next) {
            wanted_output *const wanted = &a->outputs[i];
            output_rows old;
            if (!find_rows(w->file, a->sampler_values[s], wanted, &old)) {
                a->others[s] = true;
                note(w, a, i, &w->odd);
                continue;
            }
            write_output(w, &old, wanted);
            if (!old.fits)
                note(w, a, i, &w->stale);
        }
}

/* Appends the text of a JSON value in which one number is replaced. */
static void copy_with_number(const gltf_edit *file, uint32_t value, uint32_t index, size_t with,
                             byte_buffer *text)
{
    const json_tree *tree = &file->document->tree;
    const json_value *whole = &tree->values[value], *part = &tree->values[index];
    ffd_buffer_append(text, tree->text + whole->begin, part->begin - whole->begin);
    ffd_buffer_format(text, "%zu", with);
    ffd_buffer_append(text, tree->text + part->end, whole->end - part->end);
}

/* Gives samplers their new outputs: the first one to the sampler itself, unless it also drives something
   else, and the others to copies of it. */
static void place_outputs(gltf_edit *file, animation *a)
{
    const gltf_document *d = file->document;
    byte_buffer copies = {0};
    for (size_t s = 0; s < a->sampler_count; s++) {
        const uint32_t index = ffd_json_tree_member(&d->tree, a->sampler_values[s], "output");
        bool is_taken = a->others[s];
        for (size_t i = a->first[s]; i != GLTF_NONE; i = a->outputs[i].next) {
            wanted_output *const wanted = &a->outputs[i];
            if (wanted->made == GLTF_NONE)
                continue;
            if (!is_taken) {
                ffd_edits_format(&file->edits, d->tree.values[index].begin, d->tree.values[index].end, "%zu",
                                 wanted->made);
                is_taken = true;
                continue;
            }
            ffd_buffer_text(&copies, a->copy_count > 0 ? "," : "");
            copy_with_number(file, a->sampler_values[s], index, wanted->made, &copies);
            wanted->place = a->sampler_count + a->copy_count++;
        }
    }
    if (a->copy_count > 0)
        ffd_gltf_insert_last(d, a->samplers, &copies, &file->edits);
    ffd_buffer_free(&copies);
}

static void redirect_channels(gltf_edit *file, const animation *a)
{
    const json_tree *tree = &file->document->tree;
    size_t c = 0;
    for (uint32_t v = ffd_json_tree_first(tree, a->channels); v != JSON_NONE;
         v = ffd_json_tree_after(tree, v), c++) {
        const wanted_output *const wanted = a->wanted[c] == GLTF_NONE ? NULL : &a->outputs[a->wanted[c]];
        if (!wanted || wanted->place == wanted->sampler)
            continue;
        const json_value *number = &tree->values[ffd_json_tree_member(tree, v, "sampler")];
        ffd_edits_format(&file->edits, number->begin, number->end, "%zu", wanted->place);
    }
}

static void warn(const weight_writer *w, const channel_note *note, const char *one, const char *many)
{
    char pointer[160], more[40] = "";
    if (note->count == 0)
        return;
    ffd_json_tree_pointer(&w->file->document->tree, note->first, pointer, sizeof pointer);
    if (note->count > 1)
        snprintf(more, sizeof more, " and %zu more", note->count - 1);
    ffd_log_line(w->file->log, FFD_LOG_WARNING, "%zu %s: %s%s", note->count,
                 ffd_plural(note->count, one, many), pointer, more);
}

void ffd_gltf_extend_weights(gltf_edit *file)
{
    const json_tree *tree = &file->document->tree;
    const uint32_t animations = ffd_json_tree_member(tree, 0, "animations");
    weight_writer w = {.file = file};
    for (uint32_t v = ffd_json_tree_first(tree, animations); v != JSON_NONE && !file->edits.failed;
         v = ffd_json_tree_after(tree, v)) {
        animation a = {0};
        if (ffd_gltf_is_replaced(file->document, v))
            continue;
        if (begin_animation(file, v, &a) && find_drivers(file, &a)) {
            make_outputs(&w, &a);
            place_outputs(file, &a);
            redirect_channels(file, &a);
        } else {
            file->edits.failed = true;
        }
        end_animation(&a);
    }
    warn(&w, &w.stale,
         "channel of an animation does not hold one weight for each morph target, and does not drive the new "
         "one",
         "channels of animations do not hold one weight for each morph target, and do not drive the new one");
    warn(&w, &w.odd, "channel of an animation has no readable weights for each key, and stays as it is",
         "channels of animations have no readable weights for each key, and stay as they are");
}
