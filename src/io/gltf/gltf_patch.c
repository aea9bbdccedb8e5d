#include "base/memory.h"
#include "base/number.h"
#include "io/gltf/gltf_saver.h"
#include <float.h>
#include <math.h>
#include <string.h>

static const json_value *value_of(const gltf_saver *saver, uint32_t value)
{
    return &saver->document->tree.values[value];
}

/* Writes the least or largest stored values into a "min" or "max", where they are not what it says. */
static void edit_bound(const gltf_saver *saver, uint32_t array, const float bound[3], json_edits *edits)
{
    const json_span *tree = &saver->document->tree;
    size_t c = 0;
    for (uint32_t v = ffd_json_span_first(tree, array); v != JSON_NONE && c < 3;
         v = ffd_json_span_after(tree, v)) {
        double old;
        const float wanted = bound[c++];
        if (ffd_json_span_number(tree, v, &old) && fabs(old) <= FLT_MAX && (float)old == wanted)
            continue;
        char text[FFD_NUMBER_CAPACITY];
        const size_t size = ffd_number_format((double)wanted, text);
        ffd_edits_replace(edits, tree->values[v].begin, tree->values[v].end, text, size);
    }
}

static void edit_bounds(const gltf_saver *saver, const gltf_version *version, json_edits *edits)
{
    const gltf_document *d = saver->document;
    const uint32_t accessor = d->accessor_values.values[version->accessor];
    const uint32_t min = ffd_json_span_member(&d->tree, accessor, "min");
    const uint32_t max = ffd_json_span_member(&d->tree, accessor, "max");
    if (min == JSON_NONE && max == JSON_NONE)
        return;
    float least[3], largest[3];
    memcpy(least, version->values, sizeof least);
    memcpy(largest, version->values, sizeof largest);
    for (size_t i = 1; i < d->model.accessors[version->accessor].count; i++)
        for (size_t c = 0; c < 3; c++) {
            const float value = version->values[3 * i + c];
            least[c] = value < least[c] ? value : least[c];
            largest[c] = value > largest[c] ? value : largest[c];
        }
    edit_bound(saver, min, least, edits);
    edit_bound(saver, max, largest, edits);
}

/* Lets a mesh's attributes name the accessors that hold what it shows at a place. */
static void edit_attributes(const gltf_saver *saver, size_t mesh, size_t place, json_edits *edits)
{
    const gltf_document *d = saver->document;
    for (size_t p = 0; p < d->model.meshes[mesh].primitive_count; p++)
        for (int s = 0; s < GLTF_DEFORMED; s++) {
            const size_t version = ffd_gltf_version_at(d, &saver->plan, mesh, p, (gltf_semantic)s, place);
            if (version == GLTF_NONE ||
                saver->plan.versions[version].output == saver->plan.versions[version].accessor)
                continue;
            const json_value *value = value_of(saver, ffd_gltf_attribute_value(d, mesh, p, (gltf_semantic)s));
            ffd_edits_format(edits, value->begin, value->end, "%zu", saver->plan.versions[version].output);
        }
}

static void replace_number(const gltf_saver *saver, uint32_t object, const char *key, size_t number,
                           json_edits *edits)
{
    const uint32_t member = ffd_json_span_member(&saver->document->tree, object, key);
    if (member != JSON_NONE)
        ffd_edits_format(edits, value_of(saver, member)->begin, value_of(saver, member)->end, "%zu", number);
}

/* Inserts a value at the end of an array that is not empty. */
static void add_element(gltf_saver *saver, const gltf_values *array, const byte_buffer *text)
{
    const uint32_t end = value_of(saver, array->values[array->count - 1])->end;
    ffd_edits_replace(&saver->edits, end, end, ",", 1);
    ffd_edits_replace(&saver->edits, end, end, text->data, text->size);
    saver->edits.failed = saver->edits.failed || text->failed;
}

/* Inserts a copy of a value, changed by edits of its own. */
static void add_copy(gltf_saver *saver, const gltf_values *array, size_t i, json_edits *edits)
{
    const json_value *value = value_of(saver, array->values[i]);
    byte_buffer text = {0};
    ffd_edits_sort(edits);
    ffd_edits_apply(edits, saver->document->tree.text, value->begin, value->end, &text);
    add_element(saver, array, &text);
    saver->edits.failed = saver->edits.failed || ffd_edits_failed(edits);
    ffd_buffer_free(&text);
    ffd_edits_free(edits);
}

static void add_view(gltf_saver *saver, const gltf_append *append, size_t buffer)
{
    const gltf_document *d = saver->document;
    const int old = d->model.accessors[saver->plan.versions[append->version].accessor].view;
    const uint32_t target = ffd_json_span_member(&d->tree, d->view_values.values[old], "target");
    byte_buffer text = {0};
    ffd_buffer_format(&text, "{\"buffer\":%zu,\"byteOffset\":%zu,\"byteLength\":%zu", buffer, append->offset,
                      append->size);
    if (target != JSON_NONE)
        ffd_buffer_format(&text, ",\"target\":%.*s",
                          (int)(value_of(saver, target)->end - value_of(saver, target)->begin),
                          d->tree.text + value_of(saver, target)->begin);
    ffd_buffer_text(&text, "}");
    add_element(saver, &d->view_values, &text);
    ffd_buffer_free(&text);
}

static void add_accessors(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    size_t *next = ffd_alloc_zero(d->buffer_values.count, sizeof *next);
    if (!next) {
        saver->edits.failed = true;
        return;
    }
    for (size_t i = 0; i < saver->plan.appended_count; i++) {
        const gltf_version *version = &saver->plan.versions[saver->plan.appended[i]];
        const uint32_t value = d->accessor_values.values[version->accessor];
        const size_t buffer = (size_t)d->model.views[d->model.accessors[version->accessor].view].buffer;
        add_view(saver, &saver->buffers[buffer].appends[next[buffer]++], buffer);
        json_edits edits = {0};
        replace_number(saver, value, "bufferView", d->view_values.count + i, &edits);
        replace_number(saver, value, "byteOffset", 0, &edits);
        edit_bounds(saver, version, &edits);
        add_copy(saver, &d->accessor_values, version->accessor, &edits);
    }
    ffd_free(next);
}

static void add_meshes(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    for (size_t i = 0; i < saver->plan.copy_count; i++) {
        const gltf_mesh_copy *copy = &saver->plan.copies[i];
        json_edits edits = {0};
        edit_attributes(saver, copy->mesh, copy->place, &edits);
        add_copy(saver, &d->mesh_values, copy->mesh, &edits);
    }
    for (size_t i = 0; i < saver->plan.change_count; i++) {
        const gltf_node_change *change = &saver->plan.changes[i];
        const size_t mesh = d->mesh_values.count + change->copy;
        replace_number(saver, d->node_values.values[change->node], "mesh", mesh, &saver->edits);
        ffd_gltf_log(saver, FFD_LOG_INFO,
                     "node %zu gets a copy of mesh %d, mesh %zu: it is deformed otherwise than under "
                     "other nodes",
                     change->node, d->model.nodes[change->node].mesh, mesh);
    }
}

/* A data URI keeps its head; one that is not plain base64 becomes so. */
static void edit_data_uri(gltf_saver *saver, size_t buffer)
{
    const gltf_document *d = saver->document;
    const json_value *uri =
        value_of(saver, ffd_json_span_member(&d->tree, d->buffer_values.values[buffer], "uri"));
    const uint32_t first = uri->begin + 1, last = uri->end - 1;
    bool base64 = false;
    const size_t head = ffd_data_uri_payload(d->tree.text + first, last - first, &base64);
    if (head != SIZE_MAX && base64) {
        ffd_edits_buffer(&saver->edits, first + (uint32_t)head, last, (int)buffer);
        return;
    }
    ffd_edits_format(&saver->edits, first, last, "data:application/octet-stream;base64,");
    ffd_edits_buffer(&saver->edits, last, last, (int)buffer);
}

static void edit_buffers(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    for (size_t b = 0; b < d->buffer_values.count; b++) {
        if (saver->buffers[b].length != d->buffers[b].length)
            replace_number(saver, d->buffer_values.values[b], "byteLength", saver->buffers[b].length,
                           &saver->edits);
        if (saver->buffers[b].changed && d->buffers[b].kind == BUFFER_DATA &&
            saver->buffers[b].kind == BUFFER_DATA)
            edit_data_uri(saver, b);
    }
}

ffd_status ffd_gltf_make_edits(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    for (size_t a = 0; a < d->model.accessor_count; a++)
        if (saver->plan.in_place[a] != GLTF_NONE)
            edit_bounds(saver, &saver->plan.versions[saver->plan.in_place[a]], &saver->edits);
    for (size_t m = 0; m < d->model.mesh_count; m++)
        edit_attributes(saver, m, saver->plan.base_places[m], &saver->edits);
    add_accessors(saver);
    add_meshes(saver);
    edit_buffers(saver);
    ffd_gltf_move_buffers(saver);
    return ffd_edits_failed(&saver->edits) ? ffd_fail_memory(error) : FFD_OK;
}
