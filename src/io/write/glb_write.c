#include "base/json_text.h"
#include "base/memory.h"
#include "base/number.h"
#include "base/path.h"
#include "io/gltf/base64.h"
#include "io/gltf/glb.h"
#include "io/gltf/uri.h"
#include "io/write/glb_plan.h"
#include "io/write/sink.h"
#include "io/write/write.h"
#include <ffd/version.h>
#include <float.h>
#include <math.h>
#include <string.h>

/* Bytes of base64 made at once: a multiple of 3, so that pieces join. */
#define BLOCK 3072

/* Primitives with more vertices have indices of 32 bits: the largest of 16 is reserved. */
#define SHORT_INDEX_VERTICES 65535

enum { TYPE_U8 = 5121, TYPE_U16 = 5123, TYPE_U32 = 5125, TYPE_FLOAT = 5126 };
enum { TARGET_VERTICES = 34962, TARGET_INDICES = 34963 };

/* The bufferViews, in this order; one that is empty is left out. */
enum { VIEW_POSITIONS, VIEW_NORMALS, VIEW_TEXCOORDS, VIEW_COLOURS, VIEW_SHORT, VIEW_LONG, VIEW_COUNT };

typedef struct gltf_writer {
    const mesh_model *model;
    glb_plan plan;
    bool byte_colours;
    size_t sizes[VIEW_COUNT], begins[VIEW_COUNT], numbers[VIEW_COUNT], filled[VIEW_COUNT], total;
    byte_buffer text;
    json_text json;
    size_t accessors;
    model_sink sink;
    bool base64;
    unsigned char block[BLOCK]; /* of bytes that become base64 */
    size_t used;
    ffd_error *error;
} gltf_writer;

static bool has_short_indices(const glb_primitive *primitive)
{
    return primitive->vertex_count <= SHORT_INDEX_VERTICES;
}

static size_t colour_size(const gltf_writer *w)
{
    return w->byte_colours ? 4 : 16;
}

static void measure(gltf_writer *w)
{
    for (size_t i = 0; i < w->plan.primitive_count; i++) {
        const glb_primitive *primitive = &w->plan.primitives[i];
        w->sizes[VIEW_POSITIONS] += 12 * primitive->vertex_count;
        w->sizes[VIEW_NORMALS] += primitive->normals ? 12 * primitive->vertex_count : 0;
        w->sizes[VIEW_TEXCOORDS] += primitive->texcoords ? 8 * primitive->vertex_count : 0;
        w->sizes[VIEW_COLOURS] += w->model->colours ? colour_size(w) * primitive->vertex_count : 0;
        if (has_short_indices(primitive))
            w->sizes[VIEW_SHORT] += 2 * primitive->index_count;
        else
            w->sizes[VIEW_LONG] += 4 * primitive->index_count;
    }
    size_t number = 0;
    for (int v = 0; v < VIEW_COUNT; v++) {
        w->begins[v] = w->total;
        w->numbers[v] = number;
        number += w->sizes[v] > 0;
        w->total += (w->sizes[v] + 3) / 4 * 4;
    }
}

/* Members */

static void add_views(gltf_writer *w)
{
    const size_t strides[VIEW_COUNT] = {12, 12, 8, colour_size(w), 0, 0};
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
        ffd_json_count(&w->json, "target", strides[v] > 0 ? TARGET_VERTICES : TARGET_INDICES);
        ffd_json_end(&w->json, '}');
    }
    ffd_json_end(&w->json, ']');
}

static void begin_accessor(gltf_writer *w, int view, size_t element, int component, size_t count,
                           const char *type)
{
    ffd_json_object(&w->json, NULL, true);
    ffd_json_count(&w->json, "bufferView", w->numbers[view]);
    ffd_json_count(&w->json, "byteOffset", w->filled[view]);
    ffd_json_count(&w->json, "componentType", (uint64_t)component);
    ffd_json_count(&w->json, "count", count);
    ffd_json_string(&w->json, "type", type);
    w->filled[view] += element * count;
}

static void add_bounds(gltf_writer *w, const glb_primitive *primitive)
{
    double least[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, largest[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < primitive->vertex_count; i++) {
        const size_t position = w->plan.vertices[primitive->first_vertex + i].position;
        for (size_t a = 0; a < 3; a++) {
            const double value = (float)w->model->positions[3 * position + a];
            least[a] = value < least[a] ? value : least[a];
            largest[a] = value > largest[a] ? value : largest[a];
        }
    }
    ffd_json_vector(&w->json, "min", least, 3);
    ffd_json_vector(&w->json, "max", largest, 3);
}

static void add_accessors_of(gltf_writer *w, const glb_primitive *primitive)
{
    const size_t count = primitive->vertex_count;
    begin_accessor(w, VIEW_POSITIONS, 12, TYPE_FLOAT, count, "VEC3");
    add_bounds(w, primitive);
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
        begin_accessor(w, VIEW_COLOURS, colour_size(w), w->byte_colours ? TYPE_U8 : TYPE_FLOAT, count,
                       "VEC4");
        if (w->byte_colours)
            ffd_json_bool(&w->json, "normalized", true);
        ffd_json_end(&w->json, '}');
    }
    if (primitive->index_count > 0) {
        const bool narrow = has_short_indices(primitive);
        begin_accessor(w, narrow ? VIEW_SHORT : VIEW_LONG, narrow ? 2 : 4, narrow ? TYPE_U16 : TYPE_U32,
                       primitive->index_count, "SCALAR");
        ffd_json_end(&w->json, '}');
    }
}

static void add_accessors(gltf_writer *w)
{
    ffd_json_array(&w->json, "accessors", false);
    for (size_t i = 0; i < w->plan.primitive_count; i++)
        add_accessors_of(w, &w->plan.primitives[w->plan.by_mesh[i]]);
    ffd_json_end(&w->json, ']');
}

/* "object", "group" or "object/group"; nothing where there is neither. */
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
        ffd_json_array(&w->json, "primitives", false);
        for (; i < plan->primitive_count && plan->primitives[plan->by_mesh[i]].mesh == m; i++)
            add_primitive(w, &plan->primitives[plan->by_mesh[i]]);
        ffd_json_end(&w->json, ']');
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
        ffd_json_end(&w->json, '}');
    }
    ffd_json_end(&w->json, ']');
}

/* Only names are known. By itself a material is metal, which looks black where nothing is mirrored. */
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

/* uri: NULL for the BIN chunk. Returns where the text of the uri ends in the JSON. */
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

static size_t make_json(gltf_writer *w, bool on_one_line, const char *uri)
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
        add_accessors(w);
        add_views(w);
        uri_end = add_buffer(w, uri);
    }
    ffd_json_end(&w->json, '}');
    return uri_end;
}

/* Content */

static void flush_block(gltf_writer *w)
{
    char text[BLOCK / 3 * 4];
    ffd_base64_encode(w->block, w->used, text);
    ffd_sink_bytes(&w->sink, text, ffd_base64_length(w->used));
    w->used = 0;
}

static void put_bytes(gltf_writer *w, const unsigned char *bytes, size_t size)
{
    if (!w->base64) {
        ffd_sink_bytes(&w->sink, bytes, size);
        return;
    }
    for (size_t i = 0; i < size; i++) {
        w->block[w->used++] = bytes[i];
        if (w->used == BLOCK)
            flush_block(w);
    }
}

static void put_u32(gltf_writer *w, uint32_t value)
{
    unsigned char bytes[4];
    ffd_glb_write_u32(bytes, value);
    put_bytes(w, bytes, sizeof bytes);
}

static void put_floats(gltf_writer *w, const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t bits;
        memcpy(&bits, values + i, sizeof bits);
        put_u32(w, bits);
    }
}

static void put_position(gltf_writer *w, const model_corner *vertex)
{
    float values[3];
    for (size_t a = 0; a < 3; a++)
        values[a] = (float)w->model->positions[3 * (size_t)vertex->position + a];
    put_floats(w, values, 3);
}

static void put_colour(gltf_writer *w, const model_corner *vertex)
{
    const double *colour = w->model->colours + 4 * (size_t)vertex->position;
    for (size_t c = 0; c < 4; c++) {
        const unsigned char byte = w->byte_colours ? (unsigned char)floor(255 * colour[c] + 0.5) : 0;
        const float value = fabs(colour[c]) <= (double)FLT_MAX ? (float)colour[c] : 1;
        if (w->byte_colours)
            put_bytes(w, &byte, 1);
        else
            put_floats(w, &value, 1);
    }
}

static void put_vertex(gltf_writer *w, const model_corner *vertex, int view)
{
    float values[3] = {0, 0, 0};
    if (view == VIEW_POSITIONS)
        put_position(w, vertex);
    else if (view == VIEW_COLOURS)
        put_colour(w, vertex);
    else if (view == VIEW_NORMALS) {
        ffd_glb_normal(w->model, vertex->normal, values);
        put_floats(w, values, 3);
    } else {
        ffd_glb_texcoord(w->model, vertex->texcoord, values);
        put_floats(w, values, 2);
    }
}

static void put_indices(gltf_writer *w, const glb_primitive *primitive)
{
    const uint32_t *indices = w->plan.indices + primitive->first_index;
    for (size_t i = 0; i < primitive->index_count; i++) {
        unsigned char bytes[4];
        ffd_glb_write_u32(bytes, indices[i]);
        put_bytes(w, bytes, has_short_indices(primitive) ? 2 : 4);
    }
}

static bool has_view(const gltf_writer *w, const glb_primitive *primitive, int view)
{
    switch (view) {
    case VIEW_NORMALS:
        return primitive->normals;
    case VIEW_TEXCOORDS:
        return primitive->texcoords;
    case VIEW_SHORT:
        return has_short_indices(primitive);
    case VIEW_LONG:
        return !has_short_indices(primitive);
    default:
        return w->sizes[view] > 0;
    }
}

static void put_content(gltf_writer *w)
{
    static const unsigned char padding[3] = {0};
    for (int view = 0; view < VIEW_COUNT; view++) {
        for (size_t i = 0; i < w->plan.primitive_count && w->sink.status == FFD_OK; i++) {
            const glb_primitive *primitive = &w->plan.primitives[w->plan.by_mesh[i]];
            if (!has_view(w, primitive, view))
                continue;
            if (view >= VIEW_SHORT)
                put_indices(w, primitive);
            for (size_t v = 0; v < primitive->vertex_count && view < VIEW_SHORT; v++)
                put_vertex(w, &w->plan.vertices[primitive->first_vertex + v], view);
        }
        put_bytes(w, padding, (4 - w->sizes[view] % 4) % 4);
    }
    if (w->base64)
        flush_block(w);
}

/* Files */

static ffd_status begin(gltf_writer *w, const mesh_model *model, ffd_error *error)
{
    w->model = model;
    w->error = error;
    w->byte_colours = ffd_model_colours_fit_bytes(model);
    const ffd_status status = ffd_glb_make_plan(model, &w->plan, error);
    if (status == FFD_OK)
        measure(w);
    return status;
}

static void end(gltf_writer *w)
{
    ffd_buffer_free(&w->text);
    ffd_glb_free_plan(&w->plan);
    ffd_free(w);
}

static ffd_status put_glb(gltf_writer *w, const char *path)
{
    static const char blanks[] = "   ";
    make_json(w, true, NULL);
    if (w->text.failed)
        return ffd_fail_memory(w->error);
    const size_t json = w->text.size - 1; /* without the line's end */
    const size_t padded = (json + 3) / 4 * 4;
    const size_t bin = w->total > 0 ? GLB_CHUNK_HEADER_SIZE + w->total : 0;
    const size_t total = GLB_HEADER_SIZE + GLB_CHUNK_HEADER_SIZE + padded + bin;
    if (total > UINT32_MAX)
        return ffd_fail_file(w->error, FFD_E_LIMIT, path,
                             "would have %zu bytes, more than a GLB's 4294967295", total);
    put_u32(w, GLB_MAGIC);
    put_u32(w, GLB_VERSION);
    put_u32(w, (uint32_t)total);
    put_u32(w, (uint32_t)padded);
    put_u32(w, GLB_CHUNK_JSON);
    ffd_sink_bytes(&w->sink, w->text.data, json);
    ffd_sink_bytes(&w->sink, blanks, padded - json);
    if (bin > 0) {
        put_u32(w, (uint32_t)w->total);
        put_u32(w, GLB_CHUNK_BIN);
        put_content(w);
    }
    return w->sink.status;
}

static ffd_status write_glb(const mesh_model *model, const mesh_save_options *options, file_output *output,
                            ffd_error *error)
{
    gltf_writer *w = ffd_alloc_zero(1, sizeof *w);
    if (!w)
        return ffd_fail_memory(error);
    ffd_status status = begin(w, model, error);
    if (status == FFD_OK)
        status = ffd_output_begin(output, options->path, options->force, error);
    w->sink = (model_sink){output, error, status};
    if (status == FFD_OK)
        status = put_glb(w, options->path);
    end(w);
    return status;
}

/* On standard output all is in one file: the buffer is a data URI. */
static ffd_status put_stream(gltf_writer *w)
{
    const size_t split = make_json(w, false, "data:application/octet-stream;base64,");
    if (w->text.failed)
        return ffd_fail_memory(w->error);
    ffd_sink_bytes(&w->sink, w->text.data, split);
    w->base64 = true;
    if (split > 0)
        put_content(w);
    ffd_sink_bytes(&w->sink, w->text.data + split, w->text.size - split);
    return w->sink.status;
}

/* The buffer's name (to be freed): that of the output with the ending .bin. */
static char *bin_name(const char *path)
{
    char *stem = ffd_path_stem(path);
    byte_buffer name = {.failed = !stem};
    if (stem)
        ffd_buffer_text(&name, stem);
    ffd_buffer_text(&name, ".bin");
    ffd_free(stem);
    return ffd_buffer_finish(&name);
}

static ffd_status put_bin_file(gltf_writer *w, const mesh_save_options *options, const char *name,
                               bool *replaces)
{
    char *folder = ffd_path_folder(options->path), *path = folder ? ffd_path_join(folder, name) : NULL;
    *replaces = path && ffd_file_exists(path);
    if (!path)
        w->sink.status = ffd_fail_memory(w->error);
    else if (options->input && ffd_file_same(options->input, path))
        w->sink.status =
            ffd_fail_file(w->error, FFD_E_EXISTS, path, "is the input and is not overwritten by a buffer");
    else
        w->sink.status = ffd_output_begin(w->sink.output, path, options->force, w->error);
    put_content(w);
    ffd_free(folder);
    ffd_free(path);
    return w->sink.status;
}

static ffd_status put_files(gltf_writer *w, const mesh_save_options *options)
{
    bool replaces = false;
    char *name = bin_name(options->path), *uri = name ? ffd_uri_encode(name) : NULL;
    ffd_status status = uri ? FFD_OK : ffd_fail_memory(w->error);
    if (status == FFD_OK)
        make_json(w, false, uri);
    if (status == FFD_OK && w->text.failed)
        status = ffd_fail_memory(w->error);
    if (status == FFD_OK && w->total > 0)
        status = put_bin_file(w, options, name, &replaces);
    if (status == FFD_OK)
        status = ffd_output_begin(w->sink.output, options->path, options->force, w->error);
    if (status == FFD_OK && replaces)
        ffd_output_remove_first(w->sink.output);
    if (status == FFD_OK)
        status = ffd_output_write(w->sink.output, w->text.data, w->text.size, w->error);
    ffd_free(name);
    ffd_free(uri);
    return status;
}

static ffd_status write_gltf(const mesh_model *model, const mesh_save_options *options, file_output *output,
                             ffd_error *error)
{
    const bool stream = strcmp(options->path, "-") == 0;
    gltf_writer *w = ffd_alloc_zero(1, sizeof *w);
    if (!w)
        return ffd_fail_memory(error);
    ffd_status status = begin(w, model, error);
    if (status == FFD_OK && stream)
        status = ffd_output_begin(output, options->path, options->force, error);
    w->sink = (model_sink){output, error, status};
    if (status == FFD_OK)
        status = stream ? put_stream(w) : put_files(w, options);
    end(w);
    return status;
}

#define HOLDS                                                                                                \
    (MODEL_HAS_NORMALS | MODEL_HAS_CORNER_NORMALS | MODEL_HAS_POINT_NORMALS | MODEL_HAS_TEXCOORDS |          \
     MODEL_HAS_CORNER_TEXCOORDS | MODEL_HAS_COLOURS | MODEL_HAS_ALPHA | MODEL_HAS_LINES | MODEL_HAS_POINTS | \
     MODEL_HAS_OBJECTS | MODEL_HAS_GROUPS | MODEL_HAS_MATERIAL_NAMES)

const model_target ffd_glb_target = {
    .name = "glTF", .holds = HOLDS, .largest_coordinate = FLT_MAX, .write = write_glb};
const model_target ffd_gltf_target = {
    .name = "glTF", .holds = HOLDS, .largest_coordinate = FLT_MAX, .write = write_gltf};
