/* glb_json.c - the JSON of a new glTF file. */
#include "base/memory/memory.h"
#include "io/write/glb_values.h"
#include "io/write/glb_writer.h"
#include <ffd/version.h>
#include <math.h>
#include <string.h>

enum { TYPE_U16 = 5123, TYPE_U32 = 5125, TYPE_FLOAT = 5126 };
enum { TARGET_VERTICES = 34962, TARGET_INDICES = 34963 };

static void add_views(gltf_writer *w)
{
    const size_t strides[VIEW_COUNT] = {12, 12, 8, glb_colour_size(w), 12, 12, 0, 0, 0};
    ffd_json_array(&w->json, "bufferViews", false);
    for (int v = 0; v < VIEW_COUNT; v++) {
        if (w->sizes[v] == 0)
            continue;
        ffd_json_object(&w->json, NULL, true);
        ffd_json_count(&w->json, "buffer", 0);
        ffd_json_count(&w->json, "byteOffset", w->begins[v]);
        ffd_json_count(&w->json, "byteLength", w->sizes[v]);
        if (strides[v] > 0)
            ffd_json_count(&w->json, "byteStride", strides[v]);
        if (v != VIEW_CLIPS)
            ffd_json_count(&w->json, "target", strides[v] > 0 ? TARGET_VERTICES : TARGET_INDICES);
        ffd_json_end(&w->json, '}');
    }
    ffd_json_end(&w->json, ']');
}

static void begin_accessor(gltf_writer *w, int view, size_t element, int component, size_t count,
                           const char *type)
{
    ffd_json_object(&w->json, NULL, true);
    ffd_json_count(&w->json, "bufferView", w->indices[view]);
    ffd_json_count(&w->json, "byteOffset", w->filled[view]);
    ffd_json_count(&w->json, "componentType", (uint64_t)component);
    ffd_json_count(&w->json, "count", count);
    ffd_json_string(&w->json, "type", type);
    w->filled[view] += element * count;
}

/* The bounds of positions, or of their offsets in a morph target. */
static void add_bounds(gltf_writer *w, const glb_primitive *primitive, int view, size_t morph)
{
    double least[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, largest[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < primitive->vertex_count; i++) {
        const uint32_t position = w->plan.vertices[primitive->first_vertex + i].position;
        float values[3];
        if (view == VIEW_POSITIONS)
            ffd_glb_position(w->model, glb_origin(w, primitive), position, values);
        else
            ffd_glb_position_offset(w->model, morph, position, values);
        for (size_t a = 0; a < 3; a++) {
            const double value = values[a];
            least[a] = value < least[a] ? value : least[a];
            largest[a] = value > largest[a] ? value : largest[a];
        }
    }
    ffd_json_vector(&w->json, "min", least, 3);
    ffd_json_vector(&w->json, "max", largest, 3);
}

static void add_offsets_of(gltf_writer *w, const glb_primitive *primitive, size_t morph)
{
    begin_accessor(w, VIEW_POSITION_OFFSETS, 12, TYPE_FLOAT, primitive->vertex_count, "VEC3");
    add_bounds(w, primitive, VIEW_POSITION_OFFSETS, morph);
    ffd_json_end(&w->json, '}');
    if (!primitive->normals)
        return;
    begin_accessor(w, VIEW_NORMAL_OFFSETS, 12, TYPE_FLOAT, primitive->vertex_count, "VEC3");
    ffd_json_end(&w->json, '}');
}

static void add_accessors_of(gltf_writer *w, const glb_primitive *primitive)
{
    const size_t count = primitive->vertex_count;
    begin_accessor(w, VIEW_POSITIONS, 12, TYPE_FLOAT, count, "VEC3");
    add_bounds(w, primitive, VIEW_POSITIONS, 0);
    ffd_json_end(&w->json, '}');
    if (primitive->normals) {
        begin_accessor(w, VIEW_NORMALS, 12, TYPE_FLOAT, count, "VEC3");
        ffd_json_end(&w->json, '}');
    }
    if (primitive->texcoords) {
        begin_accessor(w, VIEW_TEXCOORDS, 8, TYPE_FLOAT, count, "VEC2");
        ffd_json_end(&w->json, '}');
    }
    if (w->model->colours) {
        begin_accessor(w, VIEW_COLOURS, glb_colour_size(w), w->byte_colours ? TYPE_U16 : TYPE_FLOAT, count,
                       "VEC4");
        if (w->byte_colours)
            ffd_json_bool(&w->json, "normalized", true);
        ffd_json_end(&w->json, '}');
    }
    if (primitive->index_count > 0) {
        const bool narrow = glb_has_short_indices(primitive);
        begin_accessor(w, narrow ? VIEW_SHORT : VIEW_LONG, narrow ? 2 : 4, narrow ? TYPE_U16 : TYPE_U32,
                       primitive->index_count, "SCALAR");
        ffd_json_end(&w->json, '}');
    }
    for (size_t k = 0; k < w->model->morph_count; k++)
        if (glb_has_morph(&w->plan, primitive, k))
            add_offsets_of(w, primitive, k);
}

static void add_accessors(gltf_writer *w)
{
    ffd_json_array(&w->json, "accessors", false);
    for (size_t i = 0; i < w->plan.primitive_count; i++)
        add_accessors_of(w, &w->plan.primitives[w->plan.by_mesh[i]]);
    ffd_glb_add_clip_accessors(&w->clips, w->indices[VIEW_CLIPS], &w->json);
    ffd_json_end(&w->json, ']');
}

/* Writes "object", "group" or "object/group"; nothing if the mesh has neither. */
static void add_name(gltf_writer *w, uint32_t mesh)
{
    uint32_t names[2];
    memcpy(names, ffd_intern_key(&w->plan.meshes, mesh), sizeof names);
    const char *object = model_name(w->model, names[0]), *group = model_name(w->model, names[1]);
    byte_buffer both = {0};
    if (!object || !group) {
        if (object || group)
            ffd_json_string(&w->json, "name", object ? object : group);
        return;
    }
    ffd_buffer_text(&both, object);
    ffd_buffer_text(&both, "/");
    ffd_buffer_text(&both, group);
    char *name = ffd_buffer_finish(&both);
    w->text.failed = w->text.failed || !name;
    ffd_json_string(&w->json, "name", name);
    ffd_free(name);
}

static bool has_morphs(const gltf_writer *w, const glb_primitive *primitive)
{
    for (size_t k = 0; k < w->model->morph_count; k++)
        if (glb_has_morph(&w->plan, primitive, k))
            return true;
    return false;
}

static void add_targets(gltf_writer *w, const glb_primitive *primitive)
{
    ffd_json_array(&w->json, "targets", true);
    for (size_t k = 0; k < w->model->morph_count; k++) {
        if (!glb_has_morph(&w->plan, primitive, k))
            continue;
        ffd_json_object(&w->json, NULL, true);
        ffd_json_count(&w->json, "POSITION", w->accessors++);
        if (primitive->normals)
            ffd_json_count(&w->json, "NORMAL", w->accessors++);
        ffd_json_end(&w->json, '}');
    }
    ffd_json_end(&w->json, ']');
}

/* Adds the weights and names of the targets. primitive: any one of the mesh. */
static void add_morphs(gltf_writer *w, const glb_primitive *primitive)
{
    ffd_json_array(&w->json, "weights", true);
    for (size_t k = 0; k < w->model->morph_count; k++)
        if (glb_has_morph(&w->plan, primitive, k))
            ffd_json_count(&w->json, NULL, 0);
    ffd_json_end(&w->json, ']');
    ffd_json_object(&w->json, "extras", true);
    ffd_json_array(&w->json, "targetNames", true);
    for (size_t k = 0; k < w->model->morph_count; k++)
        if (glb_has_morph(&w->plan, primitive, k))
            ffd_json_string(&w->json, NULL, w->model->morphs[k].name);
    ffd_json_end(&w->json, ']');
    ffd_json_end(&w->json, '}');
}

static void add_primitive(gltf_writer *w, const glb_primitive *primitive)
{
    static const unsigned modes[MODEL_KINDS] = {4, 1, 0};
    ffd_json_object(&w->json, NULL, true);
    ffd_json_object(&w->json, "attributes", true);
    ffd_json_count(&w->json, "POSITION", w->accessors++);
    if (primitive->normals)
        ffd_json_count(&w->json, "NORMAL", w->accessors++);
    if (primitive->texcoords)
        ffd_json_count(&w->json, "TEXCOORD_0", w->accessors++);
    if (w->model->colours)
        ffd_json_count(&w->json, "COLOR_0", w->accessors++);
    ffd_json_end(&w->json, '}');
    if (primitive->index_count > 0)
        ffd_json_count(&w->json, "indices", w->accessors++);
    if (primitive->material != MODEL_NONE)
        ffd_json_count(&w->json, "material", primitive->material);
    ffd_json_count(&w->json, "mode", modes[primitive->kind]);
    if (has_morphs(w, primitive))
        add_targets(w, primitive);
    ffd_json_end(&w->json, '}');
}

static void add_meshes(gltf_writer *w)
{
    const glb_plan *plan = &w->plan;
    size_t i = 0;
    ffd_json_array(&w->json, "meshes", false);
    for (uint32_t m = 0; m < plan->meshes.count; m++) {
        ffd_json_object(&w->json, NULL, false);
        add_name(w, m);
        const glb_primitive *morphs = NULL;
        ffd_json_array(&w->json, "primitives", false);
        for (; i < plan->primitive_count && plan->primitives[plan->by_mesh[i]].mesh == m; i++) {
            add_primitive(w, &plan->primitives[plan->by_mesh[i]]);
            if (has_morphs(w, &plan->primitives[plan->by_mesh[i]]))
                morphs = &plan->primitives[plan->by_mesh[i]];
        }
        ffd_json_end(&w->json, ']');
        if (morphs)
            add_morphs(w, morphs);
        ffd_json_end(&w->json, '}');
    }
    ffd_json_end(&w->json, ']');
}

static void add_nodes(gltf_writer *w)
{
    ffd_json_array(&w->json, "nodes", false);
    for (uint32_t m = 0; m < w->plan.meshes.count; m++) {
        ffd_json_object(&w->json, NULL, true);
        add_name(w, m);
        ffd_json_count(&w->json, "mesh", m);
        if (glb_is_far(w, m))
            ffd_json_vector(&w->json, "translation", w->origins + 3 * (size_t)m, 3);
        ffd_json_end(&w->json, '}');
    }
    ffd_json_end(&w->json, ']');
}

/* Adds the materials, of which only names are known. They are not metallic: glTF's default is, which looks
   black with nothing to reflect. */
static void add_materials(gltf_writer *w)
{
    ffd_json_array(&w->json, "materials", false);
    for (uint32_t i = 0; i < w->plan.materials.count; i++) {
        uint32_t name;
        memcpy(&name, ffd_intern_key(&w->plan.materials, i), sizeof name);
        ffd_json_object(&w->json, NULL, true);
        ffd_json_string(&w->json, "name", model_name(w->model, name));
        ffd_json_object(&w->json, "pbrMetallicRoughness", true);
        ffd_json_count(&w->json, "metallicFactor", 0);
        ffd_json_end(&w->json, '}');
        ffd_json_end(&w->json, '}');
    }
    ffd_json_end(&w->json, ']');
}

static void add_scene(gltf_writer *w)
{
    ffd_json_count(&w->json, "scene", 0);
    ffd_json_array(&w->json, "scenes", false);
    ffd_json_object(&w->json, NULL, true);
    if (w->plan.meshes.count > 0) {
        ffd_json_array(&w->json, "nodes", true);
        for (size_t m = 0; m < w->plan.meshes.count; m++)
            ffd_json_count(&w->json, NULL, m);
        ffd_json_end(&w->json, ']');
    }
    ffd_json_end(&w->json, '}');
    ffd_json_end(&w->json, ']');
}

/* uri: NULL for the BIN chunk. Returns the offset in the JSON where the text of the uri ends. */
static size_t add_buffer(gltf_writer *w, const char *uri)
{
    size_t end = 0;
    ffd_json_array(&w->json, "buffers", false);
    ffd_json_object(&w->json, NULL, true);
    if (uri) {
        ffd_json_string(&w->json, "uri", uri);
        end = w->text.size - 1;
    }
    ffd_json_count(&w->json, "byteLength", w->total);
    ffd_json_end(&w->json, '}');
    ffd_json_end(&w->json, ']');
    return end;
}

size_t ffd_glb_make_json(gltf_writer *w, bool on_one_line, const char *uri)
{
    size_t uri_end = 0;
    ffd_json_begin(&w->json, &w->text);
    ffd_json_object(&w->json, NULL, on_one_line);
    ffd_json_object(&w->json, "asset", true);
    ffd_json_string(&w->json, "version", "2.0");
    ffd_json_string(&w->json, "generator", "ffd " FFD_VERSION);
    ffd_json_end(&w->json, '}');
    add_scene(w);
    if (w->plan.meshes.count > 0) {
        add_nodes(w);
        add_meshes(w);
        if (w->plan.materials.count > 0)
            add_materials(w);
        ffd_glb_add_clips(&w->clips, w->accessors, &w->json);
        add_accessors(w);
        add_views(w);
        uri_end = add_buffer(w, uri);
    }
    ffd_json_end(&w->json, '}');
    return uri_end;
}
