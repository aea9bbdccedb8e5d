#include "io/gltf/morph/gltf_morph_weights.h"
#include "base/memory/memory.h"
#include "base/text/buffer_binary.h"
#include "io/gltf/decode/gltf_read.h"
#include "io/gltf/refer/gltf_index_table.h"
#include "io/gltf/save/gltf_json_insert.h"
#include <math.h>
#include <string.h>

/* An animation whose samplers get longer outputs. */
typedef struct animation {
    uint32_t samplers, channels;
    size_t sampler_count;
    uint32_t *sampler_values;
    size_t *targets; /* per sampler: 1 + the number of targets of the mesh whose weights it drives; 0: none */
    bool *others;    /* per sampler: whether it also drives something else */
    size_t *copies;  /* per sampler: the number of its copy; GLTF_NONE: none */
    size_t copy_count;
} animation;

size_t ffd_gltf_target_count(const gltf_document *d, size_t mesh)
{
    size_t count = 0;
    for (size_t p = 0; p < d->model.meshes[mesh].primitive_count; p++)
        if (d->model.meshes[mesh].primitives[p].target_count > count)
            count = d->model.meshes[mesh].primitives[p].target_count;
    return count;
}

static bool read_index(const gltf_saver *saver, uint32_t object, const char *key, size_t count, size_t *index)
{
    double number;
    if (!ffd_json_span_number(&saver->document->tree,
                              ffd_json_span_member(&saver->document->tree, object, key), &number) ||
        !(number >= 0 && number < (double)count) || floor(number) < number)
        return false;
    *index = (size_t)number;
    return true;
}

/* Returns the mesh for a JSON pointer to all weights of a mesh or a node; GLTF_NONE: it points to something
   else. */
static size_t pointed_mesh(const gltf_document *d, const char *pointer)
{
    const char *rest = "";
    const size_t mesh = ffd_gltf_pointed(pointer, "meshes", &rest);
    if (mesh < d->model.mesh_count && strcmp(rest, "/weights") == 0)
        return mesh;
    const size_t node = ffd_gltf_pointed(pointer, "nodes", &rest);
    return node < d->model.node_count && d->model.nodes[node].mesh >= 0 && strcmp(rest, "/weights") == 0
               ? (size_t)d->model.nodes[node].mesh
               : GLTF_NONE;
}

/* Returns the mesh whose weights are the target of a channel; GLTF_NONE: the target is something else. */
static size_t target_mesh(gltf_saver *saver, uint32_t target)
{
    const gltf_document *d = saver->document;
    const uint32_t pointer =
        ffd_json_span_member(&d->tree, ffd_gltf_extension(d, target, "KHR_animation_pointer"), "pointer");
    if (pointer != JSON_NONE && d->tree.values[pointer].kind == JSON_STRING) {
        char *text = ffd_json_span_string(&d->tree, pointer, NULL);
        const size_t mesh = text ? pointed_mesh(d, text) : GLTF_NONE;
        saver->edits.failed = saver->edits.failed || !text;
        ffd_free(text);
        return mesh;
    }
    const uint32_t path = ffd_json_span_member(&d->tree, target, "path");
    size_t node;
    return path != JSON_NONE && ffd_json_span_string_is(&d->tree, path, "weights") &&
                   read_index(saver, target, "node", d->model.node_count, &node) &&
                   d->model.nodes[node].mesh >= 0
               ? (size_t)d->model.nodes[node].mesh
               : GLTF_NONE;
}

/* Returns the mesh, one of the marked ones, whose weights a channel drives; GLTF_NONE: none. */
static size_t driven_mesh(gltf_saver *saver, const bool *meshes, uint32_t channel)
{
    const size_t mesh = target_mesh(saver, ffd_json_span_member(&saver->document->tree, channel, "target"));
    return mesh != GLTF_NONE && meshes[mesh] ? mesh : GLTF_NONE;
}

static bool begin_animation(const gltf_saver *saver, uint32_t value, animation *a)
{
    const json_span *tree = &saver->document->tree;
    a->samplers = ffd_json_span_member(tree, value, "samplers");
    a->channels = ffd_json_span_member(tree, value, "channels");
    a->sampler_count = ffd_json_span_count(tree, a->samplers);
    a->sampler_values = ffd_alloc(a->sampler_count, sizeof *a->sampler_values);
    a->targets = ffd_alloc_zero(a->sampler_count, sizeof *a->targets);
    a->others = ffd_alloc_zero(a->sampler_count, sizeof *a->others);
    a->copies = ffd_alloc(a->sampler_count, sizeof *a->copies);
    if (!a->sampler_values || !a->targets || !a->others || !a->copies)
        return false;
    size_t i = 0;
    for (uint32_t v = ffd_json_span_first(tree, a->samplers); v != JSON_NONE;
         v = ffd_json_span_after(tree, v)) {
        a->copies[i] = GLTF_NONE;
        a->sampler_values[i++] = v;
    }
    return true;
}

static void end_animation(animation *a)
{
    ffd_free(a->sampler_values);
    ffd_free(a->targets);
    ffd_free(a->others);
    ffd_free(a->copies);
}

static void find_drivers(gltf_saver *saver, const bool *meshes, animation *a)
{
    const json_span *tree = &saver->document->tree;
    for (uint32_t v = ffd_json_span_first(tree, a->channels); v != JSON_NONE;
         v = ffd_json_span_after(tree, v)) {
        size_t sampler;
        if (!read_index(saver, v, "sampler", a->sampler_count, &sampler))
            continue;
        const size_t mesh = driven_mesh(saver, meshes, v);
        if (mesh == GLTF_NONE)
            a->others[sampler] = true;
        else
            a->targets[sampler] = 1 + ffd_gltf_target_count(saver->document, mesh);
    }
}

/* Copies the accessor with a 0 after every `targets` values; GLTF_NONE if it does not hold whole rows of
   them. */
static size_t extend_output(gltf_saver *saver, size_t accessor, size_t targets, bool cubic, morph_data *data)
{
    const gltf_document *d = saver->document;
    const gltf_accessor *old = &d->model.accessors[accessor];
    const size_t count = (size_t)old->count, row = cubic ? 3 * targets : targets;
    if (targets == 0 || count == 0 || count % row || old->columns * old->rows != 1 ||
        !d->layouts[accessor].readable)
        return GLTF_NONE;
    const size_t offset = data->bytes.size;
    for (size_t i = 0; i < count && !data->bytes.failed; i++) {
        double value;
        ffd_gltf_read(d, accessor, i, 1, 1, &value);
        ffd_buffer_float(&data->bytes, value);
        if (i % targets == targets - 1)
            ffd_buffer_float(&data->bytes, 0);
    }
    ffd_buffer_format(&data->accessors,
                      "%s{\"bufferView\":%zu,\"byteOffset\":%zu,\"componentType\":5126,\"count\":%zu,"
                      "\"type\":\"SCALAR\"}",
                      data->accessor_count > 0 ? "," : "", d->view_values.count, offset,
                      count + count / targets);
    return d->model.accessor_count + data->accessor_count++;
}

/* Appends the text of a JSON value in which one number is replaced. */
static void copy_with_number(const gltf_saver *saver, uint32_t value, uint32_t number, size_t with,
                             byte_buffer *text)
{
    const json_span *tree = &saver->document->tree;
    const json_value *whole = &tree->values[value], *part = &tree->values[number];
    ffd_buffer_append(text, tree->text + whole->begin, part->begin - whole->begin);
    ffd_buffer_format(text, "%zu", with);
    ffd_buffer_append(text, tree->text + part->end, whole->end - part->end);
}

/* Gives samplers their new outputs. A sampler that also drives something else gets a copy. */
static void extend_samplers(gltf_saver *saver, animation *a, morph_data *data)
{
    const gltf_document *d = saver->document;
    byte_buffer copies = {0};
    for (size_t i = 0; i < a->sampler_count; i++) {
        size_t output;
        if (a->targets[i] == 0 ||
            !read_index(saver, a->sampler_values[i], "output", d->model.accessor_count, &output))
            continue;
        const uint32_t interpolation = ffd_json_span_member(&d->tree, a->sampler_values[i], "interpolation");
        const bool cubic =
            interpolation != JSON_NONE && ffd_json_span_string_is(&d->tree, interpolation, "CUBICSPLINE");
        const size_t made = extend_output(saver, output, a->targets[i] - 1, cubic, data);
        if (made == GLTF_NONE)
            continue;
        const uint32_t number = ffd_json_span_member(&d->tree, a->sampler_values[i], "output");
        if (a->others[i]) {
            ffd_buffer_text(&copies, a->copy_count > 0 ? "," : "");
            copy_with_number(saver, a->sampler_values[i], number, made, &copies);
            a->copies[i] = a->sampler_count + a->copy_count++;
        } else {
            ffd_edits_format(&saver->edits, d->tree.values[number].begin, d->tree.values[number].end, "%zu",
                             made);
        }
    }
    if (a->copy_count > 0)
        ffd_gltf_insert_last(saver, a->samplers, &copies);
    ffd_buffer_free(&copies);
}

static void redirect_channels(gltf_saver *saver, const bool *meshes, const animation *a)
{
    const json_span *tree = &saver->document->tree;
    for (uint32_t v = ffd_json_span_first(tree, a->channels); v != JSON_NONE;
         v = ffd_json_span_after(tree, v)) {
        size_t sampler;
        if (!read_index(saver, v, "sampler", a->sampler_count, &sampler) || a->copies[sampler] == GLTF_NONE ||
            driven_mesh(saver, meshes, v) == GLTF_NONE)
            continue;
        const json_value *number = &tree->values[ffd_json_span_member(tree, v, "sampler")];
        ffd_edits_format(&saver->edits, number->begin, number->end, "%zu", a->copies[sampler]);
    }
}

void ffd_gltf_extend_weights(gltf_saver *saver, const bool *meshes, morph_data *data)
{
    const json_span *tree = &saver->document->tree;
    const uint32_t animations = ffd_json_span_member(tree, 0, "animations");
    for (uint32_t v = ffd_json_span_first(tree, animations); v != JSON_NONE && !saver->edits.failed;
         v = ffd_json_span_after(tree, v)) {
        animation a = {0};
        if (begin_animation(saver, v, &a)) {
            find_drivers(saver, meshes, &a);
            extend_samplers(saver, &a, data);
            redirect_channels(saver, meshes, &a);
        } else {
            saver->edits.failed = true;
        }
        end_animation(&a);
    }
}
