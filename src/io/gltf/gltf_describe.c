/* gltf_describe.c - what `ffd info` reports of a glTF file. */
#include "base/memory/memory.h"
#include "io/gltf/model/gltf_faces.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_references.h"
#include "io/gltf/read/gltf_document.h"
#include "io/gltf/read/gltf_draco.h"
#include <string.h>

static void describe_text(const gltf_document *d, uint32_t value, const char *key, json_text *json,
                          bool *failed)
{
    char *text = ffd_json_tree_string(&d->tree, value, NULL);
    *failed = *failed || !text;
    ffd_json_string(json, key, text);
    ffd_free(text);
}

static void describe_asset(const gltf_document *d, json_text *json, bool *failed)
{
    const uint32_t asset = ffd_json_tree_member(&d->tree, 0, "asset");
    const uint32_t generator = ffd_json_tree_member(&d->tree, asset, "generator");
    describe_text(d, ffd_json_tree_member(&d->tree, asset, "version"), "version", json, failed);
    if (generator == JSON_NONE)
        ffd_json_null(json, "generator");
    else
        describe_text(d, generator, "generator", json, failed);
}

static void describe_count(const gltf_document *d, const char *key, json_text *json)
{
    const uint32_t array = ffd_json_tree_member(&d->tree, 0, key);
    ffd_json_count(json, key, array == JSON_NONE ? 0 : d->tree.values[array].count);
}

static void describe_strings(const gltf_document *d, const char *key, json_text *json, bool *failed)
{
    const uint32_t array = ffd_json_tree_member(&d->tree, 0, key);
    ffd_json_array(json, key, true);
    for (uint32_t v = ffd_json_tree_first(&d->tree, array); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v))
        describe_text(d, v, NULL, json, failed);
    ffd_json_end(json, ']');
}

/* How the vertices that a deformation can change are stored. */
typedef struct storage_facts {
    size_t vertices;                                   /* of POSITION accessors, counting each once */
    size_t morphed, sparse, quantized, draco, meshopt; /* numbers of primitives */
} storage_facts;

static void survey_primitive(const gltf_document *d, const gltf_primitive *primitive, bool *seen,
                             storage_facts *facts)
{
    const int positions = primitive->accessor[GLTF_POSITION];
    bool sparse = false, quantized = false, meshopt = false;
    for (int s = 0; s < GLTF_DEFORMED; s++) {
        const int a = primitive->accessor[s];
        if (a < 0)
            continue;
        sparse = sparse || d->model.accessors[a].sparse.present;
        quantized = quantized || d->model.accessors[a].component != GLTF_FLOAT;
        meshopt = meshopt || d->layouts[a].packing == GLTF_MESHOPT;
    }
    facts->morphed += primitive->target_count > 0;
    facts->sparse += sparse;
    facts->quantized += quantized;
    facts->meshopt += meshopt;
    facts->draco += ffd_gltf_draco_value(d, primitive) != JSON_NONE;
    if (positions >= 0 && !seen[positions]) {
        seen[positions] = true;
        facts->vertices += (size_t)d->model.accessors[positions].count;
    }
}

static ffd_status describe_storage(const gltf_document *d, json_text *json, ffd_error *error)
{
    bool *seen = ffd_alloc_zero(d->model.accessor_count, sizeof *seen);
    if (!seen)
        return ffd_fail_memory(error);
    storage_facts facts = {0};
    size_t triangles = 0, lines = 0, points = 0;
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        ffd_gltf_count_drawing(d, &d->model.primitives[i], &triangles, &lines, &points);
        survey_primitive(d, &d->model.primitives[i], seen, &facts);
    }
    ffd_free(seen);
    ffd_json_object(json, "stored", false);
    ffd_json_count(json, "vertices", facts.vertices);
    ffd_json_count(json, "triangles", triangles);
    ffd_json_count(json, "lines", lines);
    ffd_json_count(json, "points", points);
    ffd_json_count(json, "primitives_with_morph_targets", facts.morphed);
    ffd_json_count(json, "primitives_sparse", facts.sparse);
    ffd_json_count(json, "primitives_quantized", facts.quantized);
    ffd_json_count(json, "primitives_draco", facts.draco);
    ffd_json_count(json, "primitives_meshopt", facts.meshopt);
    ffd_json_end(json, '}');
    return FFD_OK;
}

/* Writes the names of all attributes, each once, in alphabetical order. */
static ffd_status describe_attributes(const gltf_document *d, json_text *json, ffd_error *error)
{
    size_t count = 0;
    for (size_t i = 0; i < d->model.primitive_count; i++)
        count += ffd_json_tree_count(
            &d->tree, ffd_json_tree_member(&d->tree, d->model.primitives[i].value, "attributes"));
    json_member *members = ffd_alloc(count, sizeof *members);
    if (!members)
        return ffd_fail_memory(error);
    count = 0;
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        const uint32_t attributes =
            ffd_json_tree_member(&d->tree, d->model.primitives[i].value, "attributes");
        for (uint32_t v = ffd_json_tree_first(&d->tree, attributes); v != JSON_NONE;
             v = ffd_json_tree_after(&d->tree, v))
            members[count++] = (json_member){&d->tree, v};
    }
    ffd_json_tree_sort_keys(members, count);
    ffd_status status = FFD_OK;
    ffd_json_array(json, "attributes", true);
    for (size_t i = 0; i < count; i++) {
        if (i > 0 &&
            ffd_json_tree_compare_keys(&d->tree, members[i - 1].value, &d->tree, members[i].value) == 0)
            continue;
        char *name = ffd_json_tree_key(&d->tree, members[i].value);
        TRY_END(name ? FFD_OK : ffd_fail_memory(error));
        ffd_json_string(json, NULL, name);
        ffd_free(name);
    }
    ffd_json_end(json, ']');
end:
    ffd_free(members);
    return status;
}

static void describe_buffers(const gltf_document *d, json_text *json)
{
    static const char *const kinds[] = {"none", "BIN chunk", "data URI", "file"};
    ffd_json_array(json, "buffers", false);
    for (size_t i = 0; i < d->buffer_values.count; i++) {
        ffd_json_object(json, NULL, true);
        ffd_json_count(json, "bytes", d->buffers[i].length);
        ffd_json_string(json, "stored_in", kinds[d->buffers[i].kind]);
        if (d->buffers[i].path)
            ffd_json_string(json, "file", d->buffers[i].path);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

ffd_status ffd_gltf_describe(const mesh_document *document, json_text *json, ffd_error *error)
{
    static const char *const counted[] = {"scenes", "nodes",      "meshes", "materials",
                                          "skins",  "animations", "images"};
    const gltf_document *d = ffd_gltf_of(document);
    bool failed = false;
    ffd_json_string(json, "container", d->binary ? "glb" : "gltf");
    describe_asset(d, json, &failed);
    for (size_t i = 0; i < sizeof counted / sizeof *counted; i++)
        describe_count(d, counted[i], json);
    ffd_json_count(json, "primitives", d->model.primitive_count);
    ffd_json_count(json, "nodes_with_mesh_not_shown", d->nodes_outside_scene);
    ffd_json_count(json, "nodes_with_mesh_of_coarser_detail", ffd_gltf_count_stand_ins(d, false));
    ffd_json_count(json, "nodes_with_mesh_of_colliders", ffd_gltf_count_stand_ins(d, true));
    if (d->shared_child != GLTF_NONE)
        ffd_json_count(json, "node_with_two_parents", d->shared_child);
    TRY(describe_attributes(d, json, error));
    TRY(describe_storage(d, json, error));
    ffd_mesh_describe_splats(document, json);
    describe_strings(d, "extensionsUsed", json, &failed);
    describe_strings(d, "extensionsRequired", json, &failed);
    describe_buffers(d, json);
    return failed ? ffd_fail_memory(error) : FFD_OK;
}
