/* gltf_patch.c - edits the JSON as the plan and the new buffers require. */
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_edit.h"
#include "io/gltf/edit/gltf_json_insert.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/write/gltf_plan.h"
#include "io/gltf/write/gltf_saver.h"

static const json_value *value_of(const gltf_saver *saver, uint32_t value)
{
    return &saver->document->tree.values[value];
}

/* Replaces the number of a member, if the object has it. */
static void replace_number(const gltf_saver *saver, uint32_t object, const char *key, size_t index,
                           json_edits *edits)
{
    const uint32_t member = ffd_json_tree_member(&saver->document->tree, object, key);
    if (member != JSON_NONE)
        ffd_edits_format(edits, value_of(saver, member)->begin, value_of(saver, member)->end, "%zu", index);
}

/* Edits the members of an object ("attributes" or a morph target) to name the accessors with the primitive's
   content for a use. first: the slot of the object's first attribute. */
static void edit_slots(const gltf_saver *saver, const gltf_primitive *primitive, uint32_t object,
                       size_t first, size_t use, json_edits *edits)
{
    const gltf_document *d = saver->document;
    for (size_t s = 0; s < GLTF_DEFORMED; s++) {
        const size_t version = ffd_gltf_version_at(d, &saver->plan, primitive, first + s, use);
        if (version == GLTF_NONE ||
            saver->plan.versions[version].output == saver->plan.versions[version].accessor)
            continue;
        replace_number(saver, object, ffd_gltf_semantic_names[s], saver->plan.versions[version].output,
                       edits);
    }
}

/* The same for the attributes of splats. */
static void edit_splats(const gltf_saver *saver, const gltf_primitive *primitive, uint32_t attributes,
                        size_t use, json_edits *edits)
{
    const gltf_document *d = saver->document;
    const size_t vectors = gltf_vector_slots(primitive);
    for (size_t slot = vectors; slot < gltf_slot_count(primitive); slot++) {
        const size_t version = ffd_gltf_version_at(d, &saver->plan, primitive, slot, use);
        char name[GLTF_SPLAT_NAME];
        if (version == GLTF_NONE ||
            saver->plan.versions[version].output == saver->plan.versions[version].accessor)
            continue;
        ffd_gltf_splat_name(slot - vectors, name);
        replace_number(saver, attributes, name, saver->plan.versions[version].output, edits);
    }
}

/* Edits a mesh to name the accessors with its content for a use. */
static void edit_attributes(const gltf_saver *saver, size_t mesh, size_t use, json_edits *edits)
{
    const gltf_document *d = saver->document;
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));) {
        const uint32_t targets = ffd_json_tree_member(&d->tree, p->value, "targets");
        const uint32_t attributes = ffd_json_tree_member(&d->tree, p->value, "attributes");
        size_t first = 0;
        edit_slots(saver, p, attributes, first, use, edits);
        edit_splats(saver, p, attributes, use, edits);
        for (uint32_t t = ffd_json_tree_first(&d->tree, targets); t != JSON_NONE;
             t = ffd_json_tree_after(&d->tree, t)) {
            first += GLTF_DEFORMED;
            if (!ffd_gltf_replaces_target(d, mesh, first / GLTF_DEFORMED - 1))
                edit_slots(saver, p, t, first, use, edits);
        }
    }
    ffd_gltf_edit_targets(saver, mesh, use, edits);
}

/* Adds a copy of an element, with edits of its own, to the element's list. */
static void add_copy(gltf_saver *saver, const gltf_values *list, const char *key, size_t i, json_edits *edits)
{
    const json_value *value = value_of(saver, list->values[i]);
    byte_buffer text = {0};
    ffd_edits_sort(edits);
    ffd_edits_apply(edits, saver->document->tree.text, value->begin, value->end, &text);
    ffd_gltf_add_elements(saver->document, list, key, &text, &saver->edits);
    saver->edits.failed = saver->edits.failed || ffd_edits_failed(edits);
    ffd_buffer_free(&text);
    ffd_edits_free(edits);
}

/* Copies "target" from the accessor's bufferView. Without a bufferView: an attribute's target. */
static void write_target(const gltf_saver *saver, const gltf_version *version, byte_buffer *text)
{
    const gltf_document *d = saver->document;
    if (version->width)
        return; /* not an attribute */
    const int view = d->model.accessors[version->accessor].view;
    if (view < 0) {
        ffd_buffer_text(text, ",\"target\":34962");
        return;
    }
    const uint32_t target = ffd_json_tree_member(&d->tree, d->view_values.values[view], "target");
    if (target != JSON_NONE)
        ffd_buffer_format(text, ",\"target\":%.*s",
                          (int)(value_of(saver, target)->end - value_of(saver, target)->begin),
                          d->tree.text + value_of(saver, target)->begin);
}

static void write_view(const gltf_saver *saver, const gltf_append *append, size_t buffer, byte_buffer *text)
{
    const gltf_version *version = &saver->plan.versions[append->version];
    const size_t element =
        ffd_gltf_version_width(saver->document, version) * ffd_gltf_component_size(version->component);
    ffd_buffer_format(text, "%s{\"buffer\":%zu,\"byteOffset\":%zu,\"byteLength\":%zu",
                      text->size > 0 ? "," : "", buffer, append->offset, append->size);
    if (append->stride > element && !append->bytes)
        ffd_buffer_format(text, ",\"byteStride\":%zu", append->stride);
    if (!append->bytes)
        write_target(saver, version, text);
    ffd_buffer_text(text, "}");
}

static void add_views(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    byte_buffer text = {0};
    size_t *next = ffd_alloc_zero(saver->buffer_count, sizeof *next);
    if (!next) {
        saver->edits.failed = true;
        return;
    }
    if (d->edit->bytes.size > 0) {
        const size_t buffer = ffd_gltf_added_buffer(d);
        ffd_buffer_format(&text, "{\"buffer\":%zu,\"byteOffset\":%zu,\"byteLength\":%zu}", buffer,
                          saver->buffers[buffer].appends[0].offset, d->edit->bytes.size);
        next[buffer]++;
    }
    for (size_t i = 0; i < saver->plan.appended_count; i++) {
        const size_t accessor = saver->plan.versions[saver->plan.appended[i]].accessor;
        const size_t buffer = ffd_gltf_append_buffer(d, accessor);
        write_view(saver, &saver->buffers[buffer].appends[next[buffer]++], buffer, &text);
    }
    ffd_gltf_write_unpacked_views(saver, &text);
    ffd_gltf_add_elements(d, &d->view_values, "bufferViews", &text, &saver->edits);
    ffd_buffer_free(&text);
    ffd_free(next);
}

/* Edits the copy of an accessor: its new bufferView, which holds all elements, and their type. */
static void edit_storage(const gltf_saver *saver, const gltf_version *version, size_t view, json_edits *edits)
{
    const gltf_document *d = saver->document;
    const json_tree *tree = &d->tree;
    const uint32_t accessor = d->accessor_values.values[version->accessor];
    const uint32_t sparse = ffd_json_tree_member(tree, accessor, "sparse");
    const uint32_t normalized = ffd_json_tree_member(tree, accessor, "normalized");
    const uint32_t inside = value_of(saver, accessor)->begin + 1;
    uint32_t gone[2];
    size_t gone_count = 0;
    if (ffd_json_tree_member(tree, accessor, "bufferView") == JSON_NONE)
        ffd_edits_format(edits, inside, inside, "\"bufferView\":%zu,", view);
    replace_number(saver, accessor, "bufferView", view, edits);
    replace_number(saver, accessor, "byteOffset", 0, edits);
    if (sparse != JSON_NONE)
        gone[gone_count++] = sparse;
    if (version->component != d->model.accessors[version->accessor].component) {
        replace_number(saver, accessor, "componentType", (size_t)version->component, edits);
        if (normalized != JSON_NONE)
            gone[gone_count++] = normalized;
    }
    ffd_edits_remove(edits, tree, accessor, gone, gone_count);
}

static void announce_floats(const gltf_saver *saver, const gltf_version *version)
{
    const int component = saver->document->model.accessors[version->accessor].component;
    if (version->component != component)
        ffd_log_line(
            saver->log, FFD_LOG_INFO,
            "accessor %zu: its component type %d cannot hold the results, which accessor %zu holds as floats",
            version->accessor, component, version->output);
}

/* Writes an accessor of matrices that the file did not have. */
static void write_matrices(const gltf_version *version, size_t view, byte_buffer *text)
{
    ffd_buffer_format(text, "{\"bufferView\":%zu,\"componentType\":%d,\"count\":%zu,\"type\":\"MAT4\"}", view,
                      GLTF_FLOAT, version->count);
}

static void add_accessors(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    ffd_gltf_add_new_accessors(saver);
    for (size_t i = 0; i < saver->plan.appended_count; i++) {
        const gltf_version *version = &saver->plan.versions[saver->plan.appended[i]];
        byte_buffer text = {0};
        json_edits edits = {0};
        if (version->rebinds)
            continue;
        if (version->accessor == GLTF_NONE) {
            write_matrices(version, ffd_gltf_view_end(d) + i, &text);
        } else if (ffd_gltf_is_added(d, version->accessor)) {
            ffd_gltf_write_new_accessor(saver, version->accessor, i, &text);
        } else {
            edit_storage(saver, version, ffd_gltf_view_end(d) + i, &edits);
            ffd_gltf_edit_bounds(saver, version, &edits);
            add_copy(saver, &d->accessor_values, "accessors", version->accessor, &edits);
            announce_floats(saver, version);
        }
        ffd_gltf_add_elements(d, &d->accessor_values, "accessors", &text, &saver->edits);
        ffd_buffer_free(&text);
    }
}

static void add_meshes(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    for (size_t i = 0; i < saver->plan.copy_count; i++) {
        const gltf_mesh_copy *copy = &saver->plan.copies[i];
        json_edits edits = {0};
        edit_attributes(saver, copy->mesh, copy->use, &edits);
        ffd_gltf_edit_compression(saver, copy->mesh, copy->use, &edits);
        ffd_gltf_follow_accessors(saver, copy->mesh, copy->use, &edits);
        add_copy(saver, &d->mesh_values, "meshes", copy->mesh, &edits);
    }
    for (size_t i = 0; i < saver->plan.change_count; i++) {
        const gltf_node_change *change = &saver->plan.changes[i];
        const size_t mesh = d->mesh_values.count + change->copy;
        replace_number(saver, d->node_values.values[change->node], "mesh", mesh, &saver->edits);
        ffd_log_line(
            saver->log, FFD_LOG_INFO,
            "node %zu gets a copy of mesh %d (mesh %zu): the mesh is deformed differently under other nodes",
            change->node, d->model.nodes[change->node].mesh, mesh);
    }
}

/* Replaces the data of a data URI. Its head stays if it says base64, else it is replaced as well. */
static void edit_data_uri(gltf_saver *saver, size_t buffer)
{
    const gltf_document *d = saver->document;
    const uint32_t uri = ffd_json_tree_member(&d->tree, d->buffer_values.values[buffer], "uri");
    if (uri == JSON_NONE)
        return;
    const uint32_t first = value_of(saver, uri)->begin + 1, last = value_of(saver, uri)->end - 1;
    data_uri_coding coding;
    const size_t head = ffd_data_uri_payload(d->tree.text + first, last - first, &coding);
    if (head != SIZE_MAX && coding != DATA_PLAIN) {
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

/* Edits nodes that follow the deformation, and the accessors of their skins and animations. */
static void edit_rig(gltf_saver *saver)
{
    const gltf_document *d = saver->document;
    if (!ffd_gltf_follows(d))
        return;
    size_t *const outputs = ffd_alloc(d->edit->content_count, sizeof *outputs);
    saver->edits.failed = saver->edits.failed || !outputs;
    for (size_t i = 0; i < d->edit->content_count && outputs; i++)
        outputs[i] = saver->plan.versions[saver->plan.content_versions[i]].output;
    if (outputs) {
        ffd_gltf_edit_nodes(d, &saver->edits);
        ffd_gltf_edit_skins(d, outputs, &saver->edits);
        ffd_gltf_edit_animations(d, outputs, &saver->edits);
    }
    ffd_free(outputs);
}

ffd_status ffd_gltf_make_edits(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *d = saver->document;
    for (size_t a = 0; a < d->model.accessor_count; a++)
        if (saver->plan.in_place[a] != GLTF_NONE)
            ffd_gltf_edit_bounds(saver, &saver->plan.versions[saver->plan.in_place[a]], &saver->edits);
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        edit_attributes(saver, m, saver->plan.base_uses[m], &saver->edits);
        ffd_gltf_edit_compression(saver, m, saver->plan.base_uses[m], &saver->edits);
        ffd_gltf_follow_accessors(saver, m, saver->plan.base_uses[m], &saver->edits);
    }
    ffd_gltf_edit_unpackings(saver);
    add_views(saver);
    add_accessors(saver);
    add_meshes(saver);
    TRY(ffd_gltf_follow_meshes(saver, error));
    ffd_gltf_warn_of_stale(saver);
    ffd_gltf_edit_node_weights(saver);
    edit_rig(saver);
    edit_buffers(saver);
    ffd_gltf_move_buffers(saver);
    const size_t added = d->buffer_values.count;
    if (saver->buffer_count > added)
        ffd_gltf_add_buffer(d, saver->buffers[added].length, saver->buffers[added].kind == BUFFER_DATA,
                            &saver->edits);
    ffd_gltf_drop_extensions(saver);
    return ffd_edits_failed(&saver->edits) ? ffd_fail_memory(error) : FFD_OK;
}
