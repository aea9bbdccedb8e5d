/* gltf_targets.c - writes further and replaced morph targets: their accessors, which store only nonzero
   offsets where most are 0, and what primitives, meshes and nodes say of them. */
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "io/gltf/edit/gltf_json_insert.h"
#include "io/gltf/edit/gltf_morphs.h"
#include "io/gltf/write/gltf_plan.h"
#include "io/gltf/write/gltf_saver.h"
#include <string.h>

#define VECTOR (3 * sizeof(float))

/* The largest number of elements that 16-bit indices can number. */
#define SHORT_INDICES ((size_t)65536)

static bool is_zero(const float *xyz)
{
    static const float zero[3] = {0, 0, 0};
    return memcmp(xyz, zero, VECTOR) == 0; /* -0 is stored: sparse or not, a target has the same bits */
}

static bool may_be_sparse(const gltf_document *d, const gltf_version *version)
{
    return version->accessor != GLTF_NONE && ffd_gltf_is_added(d, version->accessor);
}

static void put_index(gltf_stored_part *sparse, size_t k, size_t index)
{
    if (sparse->index_size == 2) {
        sparse->bytes[2 * k] = index & 255;
        sparse->bytes[2 * k + 1] = (unsigned char)(index >> 8 & 255);
    } else {
        store_u32(sparse->bytes + 4 * k, (uint32_t)index);
    }
}

/* Stores the nonzero vectors; their number is sparse->count. */
static ffd_status store(const float *values, size_t count, memory_budget *budget, gltf_stored_part *sparse,
                        ffd_error *error)
{
    sparse->index_size = count <= SHORT_INDICES ? 2 : 4;
    sparse->values_at = ffd_gltf_align(sparse->count * sparse->index_size);
    sparse->size = sparse->values_at + sparse->count * VECTOR;
    TRY(ffd_budget_take(budget, sparse->size, 1, error));
    sparse->bytes = ffd_alloc_zero(sparse->size, 1);
    if (!sparse->bytes)
        return ffd_fail_memory(error);
    for (size_t i = 0, k = 0; i < count; i++) {
        if (is_zero(values + 3 * i))
            continue;
        put_index(sparse, k, i);
        for (size_t c = 0; c < 3; c++)
            store_float(sparse->bytes + sparse->values_at + k * VECTOR + c * sizeof(float),
                        values[3 * i + c]);
        k++;
    }
    return FFD_OK;
}

ffd_status ffd_gltf_list_sparse(gltf_saver *saver, ffd_error *error)
{
    const gltf_document *const d = saver->document;
    memory_budget budget = d->base.budget;
    saver->sparse = ffd_alloc_zero(saver->plan.appended_count, sizeof *saver->sparse);
    if (!saver->sparse)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < saver->plan.appended_count; i++) {
        const gltf_version *const version = &saver->plan.versions[saver->plan.appended[i]];
        gltf_stored_part *const sparse = &saver->sparse[i];
        if (!saver->options->sparse_targets || !may_be_sparse(d, version))
            continue;
        const size_t count = (size_t)d->model.accessors[version->accessor].count;
        for (size_t v = 0; v < count; v++)
            sparse->count += !is_zero(version->values + 3 * v);
        if (sparse->count <= count / 3)
            TRY(store(version->values, count, &budget, sparse, error));
    }
    return FFD_OK;
}

/* Writes the member "sparse" of an accessor, followed by a comma. view: the bufferView of its indices and
 * values. */
static void write_sparse(const gltf_stored_part *sparse, size_t view, byte_buffer *text)
{
    ffd_buffer_format(text,
                      "\"sparse\":{\"count\":%zu,\"indices\":{\"bufferView\":%zu,\"componentType\":%d},"
                      "\"values\":{\"bufferView\":%zu,\"byteOffset\":%zu}},",
                      sparse->count, view, sparse->index_size == 2 ? GLTF_U16 : GLTF_U32, view,
                      sparse->values_at);
}

void ffd_gltf_free_sparse(gltf_saver *saver)
{
    for (size_t i = 0; saver->sparse && i < saver->plan.appended_count; i++)
        ffd_free(saver->sparse[i].bytes);
    ffd_free(saver->sparse);
}

void ffd_gltf_write_new_accessor(const gltf_saver *saver, size_t accessor, size_t appended, byte_buffer *text)
{
    const gltf_document *const d = saver->document;
    const gltf_plan *const plan = &saver->plan;
    const gltf_version *const version =
        appended == GLTF_NONE ? NULL : &plan->versions[plan->appended[appended]];
    const size_t view = ffd_gltf_view_end(d) + appended;
    ffd_buffer_text(text, text->size > 0 ? ",{" : "{");
    if (version && saver->sparse[appended].bytes)
        write_sparse(&saver->sparse[appended], view, text);
    else if (version)
        ffd_buffer_format(text, "\"bufferView\":%zu,", view);
    ffd_buffer_format(text, "\"componentType\":%d,\"count\":%llu,\"type\":\"VEC3\"", GLTF_FLOAT,
                      (unsigned long long)d->model.accessors[accessor].count);
    if (d->edit->bounded.data[accessor - d->accessor_values.count])
        ffd_gltf_write_bounds(saver, version, text);
    ffd_buffer_text(text, "}");
}

void ffd_gltf_add_new_accessors(gltf_saver *saver)
{
    const gltf_document *const d = saver->document;
    const gltf_plan *const plan = &saver->plan;
    const size_t first = d->accessor_values.count, count = d->model.accessor_count - first;
    byte_buffer text = {0};
    size_t *const appended = ffd_alloc(count, sizeof *appended);
    saver->edits.failed = saver->edits.failed || !appended;
    for (size_t i = 0; i < count && appended; i++)
        appended[i] = GLTF_NONE;
    for (size_t i = 0; i < plan->appended_count && appended; i++)
        if (plan->versions[plan->appended[i]].rebinds)
            appended[plan->versions[plan->appended[i]].accessor - first] = i;
    for (size_t i = 0; i < count && appended; i++)
        ffd_gltf_write_new_accessor(saver, first + i, appended[i], &text);
    if (d->edit->accessor_count > 0) {
        ffd_buffer_text(&text, text.size > 0 ? "," : "");
        ffd_buffer_append(&text, d->edit->accessors.data, d->edit->accessors.size);
    }
    text.failed = text.failed || d->edit->accessors.failed;
    ffd_gltf_add_elements(d, &d->accessor_values, "accessors", &text, &saver->edits);
    ffd_buffer_free(&text);
    ffd_free(appended);
}

bool ffd_gltf_replaces_target(const gltf_document *d, size_t mesh, size_t target)
{
    for (size_t k = 0; k < d->morph_count; k++)
        if (d->morphs[k].places[mesh] == target)
            return true;
    return false;
}

/* Writes a target with the accessors that hold its offsets for a use of the mesh. */
static void write_target(const gltf_saver *saver, const gltf_primitive *primitive, size_t target, size_t use,
                         byte_buffer *text)
{
    bool first = true;
    ffd_buffer_text(text, "{");
    for (size_t s = 0; s < GLTF_DEFORMED; s++) {
        const size_t slot = GLTF_DEFORMED * (target + 1) + s;
        const int accessor = gltf_slot_accessor(primitive, slot);
        const size_t version = ffd_gltf_version_at(saver->document, &saver->plan, primitive, slot, use);
        if (accessor < 0)
            continue;
        ffd_buffer_format(text, "%s\"%s\":%zu", first ? "" : ",", ffd_gltf_semantic_names[s],
                          version == GLTF_NONE ? (size_t)accessor : saver->plan.versions[version].output);
        first = false;
    }
    ffd_buffer_text(text, "}");
}

/* Writes the targets of a primitive that replace others, and adds the further ones. */
static void edit_primitive(const gltf_saver *saver, const gltf_primitive *primitive, size_t use,
                           json_edits *edits)
{
    const gltf_document *const d = saver->document;
    const uint32_t targets = ffd_json_tree_member(&d->tree, primitive->value, "targets");
    size_t t = 0;
    byte_buffer text = {0};
    for (uint32_t v = ffd_json_tree_first(&d->tree, targets); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v), t++) {
        if (!ffd_gltf_replaces_target(d, primitive->mesh, t))
            continue;
        text.size = 0;
        write_target(saver, primitive, t, use, &text);
        if (!text.failed)
            ffd_edits_replace(edits, d->tree.values[v].begin, d->tree.values[v].end, text.data, text.size);
    }
    text.size = 0;
    if (targets == JSON_NONE)
        ffd_buffer_text(&text, "\"targets\":[");
    for (size_t first = t; t < primitive->target_count; t++) {
        ffd_buffer_text(&text, t > first ? "," : "");
        write_target(saver, primitive, t, use, &text);
    }
    if (targets == JSON_NONE)
        ffd_buffer_text(&text, "]");
    if (primitive->target_count > ffd_json_tree_count(&d->tree, targets))
        ffd_gltf_insert_last(d, targets == JSON_NONE ? primitive->value : targets, &text, edits);
    edits->failed = edits->failed || text.failed;
    ffd_buffer_free(&text);
}

/* Adds a weight 0 for each further target of a mesh, or puts it in the place of one that no target had. make:
   also if there are no weights yet, as for a mesh; a node needs none of its own. */
static void add_weights(const gltf_document *d, uint32_t value, const gltf_mesh_uses *mesh, bool make,
                        json_edits *edits)
{
    const json_tree *const tree = &d->tree;
    const uint32_t weights = ffd_json_tree_member(tree, value, "weights");
    const bool is_array = weights != JSON_NONE && tree->values[weights].kind == JSON_ARRAY;
    const size_t count = is_array ? tree->values[weights].count : 0;
    byte_buffer text = {0};
    if (mesh->target_count == mesh->filed_targets || (!is_array && (weights != JSON_NONE || !make)))
        return;
    ffd_buffer_text(&text, is_array ? "" : "\"weights\":[");
    for (size_t t = is_array ? mesh->filed_targets : 0, begin = text.size; t < mesh->target_count; t++) {
        const uint32_t old = t < count ? ffd_json_tree_element(tree, weights, t) : JSON_NONE;
        if (old != JSON_NONE)
            ffd_edits_replace(edits, tree->values[old].begin, tree->values[old].end, "0", 1);
        else
            ffd_buffer_text(&text, text.size > begin ? ",0" : "0");
    }
    ffd_buffer_text(&text, is_array ? "" : "]");
    if (text.size > 0)
        ffd_gltf_insert_last(d, is_array ? weights : value, &text, edits);
    ffd_buffer_free(&text);
}

void ffd_gltf_edit_targets(const gltf_saver *saver, size_t mesh, size_t use, json_edits *edits)
{
    const gltf_document *const d = saver->document;
    const gltf_mesh_uses *const uses = &d->mesh_uses[mesh];
    for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, mesh, p));)
        edit_primitive(saver, p, use, edits);
    add_weights(d, d->mesh_values.values[mesh], uses, true, edits);
    if (uses->target_count > uses->filed_targets)
        ffd_gltf_edit_target_names(d, mesh, edits);
}

void ffd_gltf_edit_node_weights(gltf_saver *saver)
{
    const gltf_document *const d = saver->document;
    for (size_t n = 0; n < d->model.node_count; n++)
        if (d->model.nodes[n].mesh >= 0)
            add_weights(d, d->node_values.values[n], &d->mesh_uses[d->model.nodes[n].mesh], false,
                        &saver->edits);
}
