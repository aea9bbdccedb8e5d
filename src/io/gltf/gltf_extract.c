/* gltf_extract.c - reads a glTF file into a mesh_model, for conversion to other formats. */
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "io/gltf/model/gltf_faces.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_instancing.h"
#include "io/gltf/model/gltf_parts.h"
#include "io/gltf/model/gltf_references.h"
#include "io/gltf/model/gltf_skin.h"
#include "io/gltf/read/gltf_document.h"
#include "io/gltf/read/gltf_elements.h"
#include "io/gltf/read/gltf_textures.h"
#include "mesh/srgb.h"
#include "splat/splat_color.h"
#include <stdio.h>
#include <string.h>

/* Texture coordinates in the model. The bytes of the struct are a key for lookups. */
typedef struct shown_texcoords {
    gltf_texcoords taken;
    /* The primitive whose morph targets change them, which are shown with a weight, its node, and the set's
       number; all GLTF_NONE: no targets do. */
    unsigned long long primitive, node, set;
} shown_texcoords;

_Static_assert(sizeof(shown_texcoords) == 10 * sizeof(double), "a key has no padding");

typedef struct extractor {
    const gltf_document *document;
    mesh_state state;
    mesh_model *model;
    size_t *first_position, *first_normal; /* per part */
    size_t *colours;                       /* per part: the accessor of its colours; GLTF_NONE: none yet */
    intern_table texcoords;                /* keys: shown_texcoords */
    size_t *first_texcoord;                /* per key of texcoords */
    size_t texcoords_capacity, texcoord_count;
    ffd_error *error;
} extractor;

/* A primitive under one node. */
typedef struct drawn {
    const gltf_primitive *primitive;
    size_t part; /* the part of its positions */
    uint32_t *corners;
    size_t count;
    /* Index in the model of its first one; GLTF_NONE: none. glow: the texture coordinates of the emission. */
    size_t position, normal, texcoord, glow;
    /* The node's transform mirrors, so that its triangles would face inward. */
    bool mirrored;
} drawn;

/* Whether a node is drawn: not if it is hidden, stands for another, or has instances. */
static bool is_drawn(const gltf_document *d, size_t node)
{
    return node == GLTF_NONE ||
           (!d->stands_in[node] && !ffd_gltf_is_hidden(d, node) && !ffd_gltf_instanced_node(d, node));
}

static bool is_primitive_drawn(const gltf_document *d, const gltf_primitive *primitive)
{
    const gltf_instance *const instances = ffd_gltf_instances(d, primitive);
    for (size_t n = 0; n < d->mesh_uses[primitive->mesh].node_count; n++)
        if (is_drawn(d, instances[n].node))
            return true;
    return false;
}

/* Visits the instances that are drawn by mesh, node and primitive, the order of models. */
static ffd_status visit_drawn(extractor *e, ffd_status (*visit)(extractor *, const gltf_instance *))
{
    const gltf_document *const d = e->document;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t n = 0; n < d->mesh_uses[m].node_count; n++)
            for (const gltf_primitive *p = NULL; (p = ffd_gltf_next_primitive(d, m, p));)
                if (is_drawn(d, ffd_gltf_instances(d, p)[n].node))
                    TRY(visit(e, &ffd_gltf_instances(d, p)[n]));
    return FFD_OK;
}

#define SET_NAME 32

static void name_set(unsigned long long set, char name[SET_NAME])
{
    snprintf(name, SET_NAME, "TEXCOORD_%llu", set);
}

/* Which of a material's textures is meant. */
typedef enum texcoord_use { BASE_TEXCOORDS, GLOW_TEXCOORDS } texcoord_use;

/* Finds the texture coordinates of a primitive under a node. */
static shown_texcoords texcoords_of(const extractor *e, const gltf_instance *instance, texcoord_use use)
{
    const gltf_document *const d = e->document;
    const gltf_primitive *const primitive = instance->primitive;
    shown_texcoords found = {.primitive = GLTF_NONE, .node = GLTF_NONE, .set = GLTF_NONE};
    char name[SET_NAME];
    bool stands_in;
    const size_t set = use == BASE_TEXCOORDS ? ffd_gltf_texcoords(d, primitive, &found.taken, &stands_in)
                                             : ffd_gltf_glow_texcoords(d, primitive, &found.taken);
    if (set == GLTF_NONE)
        found.taken.accessor = GLTF_NONE;
    name_set(set, name);
    if (found.taken.accessor == GLTF_NONE || e->state == MESH_STORED ||
        !ffd_gltf_add_shapes(d, primitive, instance->node, name,
                             (size_t)d->model.accessors[found.taken.accessor].count, 2, 2, NULL))
        return found;
    found.primitive = (size_t)(primitive - d->model.primitives);
    found.node = instance->node;
    found.set = set;
    return found;
}

/* Interns texture coordinates of a primitive under a node, and counts new ones. */
static ffd_status add_used_texcoords(extractor *e, const gltf_instance *instance, texcoord_use use)
{
    const gltf_document *d = e->document;
    const shown_texcoords texcoords = texcoords_of(e, instance, use);
    size_t *const count = &e->texcoord_count;
    uint32_t index;
    if (texcoords.taken.accessor == GLTF_NONE || *count > MODEL_VALUES_MAX)
        return FFD_OK; /* too many: refused later */
    const size_t known = e->texcoords.count;
    if (!ffd_intern(&e->texcoords, &texcoords, sizeof texcoords, &index) ||
        !ffd_grow((void **)&e->first_texcoord, &e->texcoords_capacity, e->texcoords.count,
                  sizeof *e->first_texcoord))
        return ffd_fail_memory(e->error);
    if (index < known)
        return FFD_OK;
    const uint64_t own = d->model.accessors[texcoords.taken.accessor].count;
    e->first_texcoord[index] = *count;
    *count = own > MODEL_VALUES_MAX - *count ? MODEL_VALUES_MAX + (size_t)1 : *count + (size_t)own;
    return FFD_OK;
}

static ffd_status add_texcoords(extractor *e, const gltf_instance *instance)
{
    TRY(add_used_texcoords(e, instance, BASE_TEXCOORDS));
    return e->model->wants_details ? add_used_texcoords(e, instance, GLOW_TEXCOORDS) : FFD_OK;
}

/* Returns the index of a primitive's first texture coordinate, GLTF_NONE if it has none. */
static size_t find_texcoords(const extractor *e, const gltf_instance *instance, texcoord_use use)
{
    const shown_texcoords texcoords = texcoords_of(e, instance, use);
    uint32_t index;
    return ffd_intern_find(&e->texcoords, &texcoords, sizeof texcoords, &index) ? e->first_texcoord[index]
                                                                                : GLTF_NONE;
}

/* Counts the values, and sets the first index of each part and of each set of texture coordinates. */
static ffd_status count_values(extractor *e)
{
    const gltf_document *d = e->document;
    size_t positions = 0, normals = 0;
    for (size_t i = 0; i < d->base.part_count; i++) {
        e->first_position[i] = positions;
        e->first_normal[i] = normals;
        e->colours[i] = GLTF_NONE;
        if (!is_drawn(d, d->parts[i].node))
            continue;
        positions += d->mesh_parts[i].repeats_positions ? 0 : d->mesh_parts[i].vertex_count;
        normals += d->mesh_parts[i].normal_count;
    }
    TRY(visit_drawn(e, add_texcoords));
    return ffd_model_make_values(e->model, positions, e->texcoord_count, normals, e->error);
}

/* Reads a stream's results where they differ from the file's values as floats, else the file's values: stored
   integers may be more precise than floats. */
static void read_stream(const gltf_document *d, mesh_state state, size_t part, gltf_semantic semantic,
                        double *values)
{
    const gltf_stream *stream = &d->parts[part].streams[semantic];
    const size_t count = d->mesh_parts[part].vertex_count;
    ffd_gltf_read_shown(d, part, semantic, state, 0, count, 3, values);
    for (size_t i = 0; i < 3 * count && stream->result; i++) {
        const bool filled = !stream->filled || stream->filled[i / 3 / MESH_RANGE_STEP];
        if (filled && ((float)values[i] < stream->result[i] || (float)values[i] > stream->result[i]))
            values[i] = stream->result[i];
    }
}

static void read_transform(const gltf_document *d, size_t part, size_t vertex, double transform[12])
{
    const mesh_part *p = &d->mesh_parts[part];
    if (p->skinned)
        ffd_gltf_read_transforms(&d->base, part, vertex, 1, transform, NULL);
    else
        memcpy(transform, p->linear, sizeof p->linear);
}

/* Transforms a normal by the inverse transpose of a matrix: the cofactor matrix divided by the determinant.
   Only the determinant's sign matters: it is negative if the matrix mirrors. */
static void turn_normal(const double linear[9], double normal[3])
{
    double cofactor[9];
    mat_cofactor(linear, cofactor);
    mat_apply(cofactor, normal, normal);
    const double length = vec_length(normal) * (mat_determinant(linear) < 0 ? -1 : 1);
    for (int a = 0; a < 3 && (length < 0 || length > 0); a++)
        normal[a] /= length;
}

static void turn_normals(const gltf_document *d, size_t part, double *normals)
{
    double transform[12];
    for (size_t i = 0; i < d->mesh_parts[part].normal_count && !d->mesh_parts[part].identity; i++) {
        read_transform(d, part, i, transform);
        turn_normal(transform, normals + 3 * i);
    }
}

static void fill_texcoords(const extractor *e, size_t index)
{
    const gltf_document *const d = e->document;
    double *const values = e->model->texcoords + 2 * e->first_texcoord[index];
    shown_texcoords shown;
    memcpy(&shown, ffd_intern_key(&e->texcoords, (uint32_t)index), sizeof shown);
    const size_t count = (size_t)d->model.accessors[shown.taken.accessor].count;
    ffd_gltf_read(d, (size_t)shown.taken.accessor, 0, count, 2, values);
    if (shown.set != GLTF_NONE) {
        char name[SET_NAME];
        name_set(shown.set, name);
        ffd_gltf_add_shapes(d, &d->model.primitives[shown.primitive], (size_t)shown.node, name, count, 2, 2,
                            values);
    }
    ffd_gltf_turn_texcoords(&shown.taken, count, values);
}

static void fill_values(const extractor *e)
{
    const gltf_document *d = e->document;
    for (size_t i = 0; i < d->base.part_count; i++) {
        const mesh_part *part = &d->mesh_parts[i];
        if (part->vertex_count == 0 || !is_drawn(d, d->parts[i].node))
            continue;
        if (!part->repeats_positions) {
            double *positions = e->model->positions + 3 * e->first_position[i];
            read_stream(d, e->state, i, GLTF_POSITION, positions);
            ffd_part_transform(&d->base, i, 0, part->vertex_count, positions);
        }
        if (part->normal_count > 0) {
            double *normals = e->model->normals + 3 * e->first_normal[i];
            read_stream(d, e->state, i, GLTF_NORMAL, normals);
            turn_normals(d, i, normals);
        }
    }
    for (size_t i = 0; i < e->texcoords.count; i++)
        fill_texcoords(e, i);
}

/* Reads the colours of a primitive, which are linear, and clamps them to 0 to 1 as viewers do (glTF 2.0,
   3.9.2 and 3.7.2.1). */
static ffd_status take_vertex_colours(extractor *e, const gltf_instance *instance, const drawn *drawing,
                                      size_t a)
{
    const gltf_document *d = e->document;
    const gltf_primitive *const primitive = instance->primitive;
    e->colours[drawing->part] = a;
    const size_t count = (size_t)d->model.accessors[primitive->accessor[GLTF_POSITION]].count;
    const size_t components = (size_t)d->model.accessors[a].rows, node = instance->node;
    const bool shapes = e->state == MESH_SHOWN &&
                        ffd_gltf_add_shapes(d, primitive, node, "COLOR_0", count, components, 4, NULL);
    const bool coarse = d->model.accessors[a].component == GLTF_U8 && !shapes &&
                        (!e->model->colours || e->model->coarse_colours);
    const ffd_status status = ffd_model_make_colours(e->model, e->error);
    e->model->coarse_colours = coarse;
    if (status)
        return status;
    double *const colours = e->model->colours + 4 * drawing->position;
    for (size_t i = 0; i < count; i++)
        ffd_gltf_read(d, a, i, 1, components, colours + 4 * i);
    if (shapes)
        ffd_gltf_add_shapes(d, primitive, node, "COLOR_0", count, components, 4, colours);
    for (size_t i = 0; i < count; i++) {
        double *const colour = colours + 4 * i;
        for (int c = 0; c < 4; c++)
            colour[c] = colour[c] > 0 ? lesser_of(colour[c], 1) : 0;
        for (int c = 0; c < 3; c++)
            colour[c] = ffd_srgb_from_linear(colour[c]);
    }
    return FFD_OK;
}

/* Whether the colours of splats are linear, not sRGB. */
static bool has_linear_splats(const gltf_document *d, const gltf_primitive *primitive)
{
    const uint32_t splatting = ffd_gltf_extension(d, primitive->value, "KHR_gaussian_splatting");
    const uint32_t space = ffd_json_tree_member(&d->tree, splatting, "colorSpace");
    return space != JSON_NONE && d->tree.values[space].kind == JSON_STRING &&
           ffd_json_tree_string_is(&d->tree, space, "lin_rec709_display");
}

/* Reads the colours and opacities of Gaussian splats. a: the accessor of the harmonics of degree 0. */
static ffd_status take_splat_colours(extractor *e, const gltf_primitive *primitive, const drawn *drawing,
                                     size_t a)
{
    const gltf_document *d = e->document;
    e->colours[drawing->part] = a;
    const size_t opacity = ffd_gltf_attribute(d, primitive, "KHR_gaussian_splatting:OPACITY", 1, 1);
    const size_t count = (size_t)d->model.accessors[primitive->accessor[GLTF_POSITION]].count;
    const bool is_linear = has_linear_splats(d, primitive);
    TRY(ffd_model_make_colours(e->model, e->error));
    double *const colours = e->model->colours + 4 * drawing->position;
    for (size_t i = 0; i < count; i++) {
        double *const colour = colours + 4 * i;
        ffd_gltf_read(d, a, i, 1, 3, colour);
        for (int c = 0; c < 3; c++) {
            const double shown = splat_color(colour[c]);
            colour[c] = is_linear ? ffd_srgb_from_linear(shown) : shown;
        }
        if (opacity != GLTF_NONE)
            ffd_gltf_read(d, opacity, i, 1, 1, &colour[3]);
        colour[3] = colour[3] > 0 ? lesser_of(colour[3], 1) : 0;
    }
    return FFD_OK;
}

static ffd_status take_colours(extractor *e, const gltf_instance *instance, const drawn *drawing)
{
    const gltf_document *d = e->document;
    const gltf_primitive *const primitive = instance->primitive;
    const size_t splats =
        e->model->wants_details
            ? ffd_gltf_attribute(d, primitive, "KHR_gaussian_splatting:SH_DEGREE_0_COEF_0", 3, 3)
            : GLTF_NONE;
    const size_t a = splats == GLTF_NONE ? ffd_gltf_attribute(d, primitive, "COLOR_0", 3, 4) : splats;
    if (a == GLTF_NONE || a == e->colours[drawing->part])
        return FFD_OK;
    return splats == GLTF_NONE ? take_vertex_colours(e, instance, drawing, a)
                               : take_splat_colours(e, primitive, drawing, a);
}

static model_corner corner_at(const drawn *drawing, uint32_t vertex)
{
    return (model_corner){(uint32_t)(drawing->position + vertex),
                          drawing->texcoord == GLTF_NONE ? MODEL_NONE
                                                         : (uint32_t)(drawing->texcoord + vertex),
                          drawing->normal == GLTF_NONE ? MODEL_NONE : (uint32_t)(drawing->normal + vertex)};
}

static ffd_status add_triangles(extractor *e, const drawn *drawing)
{
    const int mode = drawing->primitive->mode;
    const size_t count = mode == MODE_TRIANGLES ? drawing->count / 3
                         : drawing->count > 2   ? drawing->count - 2
                                                : 0;
    for (size_t t = 0; t < count; t++) {
        uint32_t triangle[3];
        gltf_triangle(mode, t, drawing->corners, triangle);
        const int second = drawing->mirrored ? 2 : 1;
        const model_corner corners[3] = {corner_at(drawing, triangle[0]),
                                         corner_at(drawing, triangle[second]),
                                         corner_at(drawing, triangle[3 - second])};
        TRY(ffd_model_add(e->model, MODEL_FACES, corners, 3, e->error));
    }
    return FFD_OK;
}

static ffd_status add_lines(extractor *e, const drawn *drawing)
{
    const bool pairs = drawing->primitive->mode == MODE_LINES;
    const size_t n = drawing->count;
    const size_t count = pairs ? n / 2 : n < 2 ? 0 : drawing->primitive->mode == MODE_LINE_LOOP ? n : n - 1;
    for (size_t i = 0; i < count; i++) {
        const size_t first = pairs ? 2 * i : i, second = first + 1 < n ? first + 1 : 0;
        const model_corner corners[2] = {corner_at(drawing, drawing->corners[first]),
                                         corner_at(drawing, drawing->corners[second])};
        TRY(ffd_model_add(e->model, MODEL_LINES, corners, 2, e->error));
    }
    return FFD_OK;
}

static ffd_status add_points(extractor *e, const drawn *drawing)
{
    for (size_t i = 0; i < drawing->count; i++) {
        const model_corner corner = corner_at(drawing, drawing->corners[i]);
        TRY(ffd_model_add(e->model, MODEL_POINTS, &corner, 1, e->error));
    }
    return FFD_OK;
}

/* Returns the member "name" of element i of a list; JSON_NONE if it is absent or empty. */
static uint32_t find_name(const gltf_document *d, const gltf_values *list, size_t i)
{
    const uint32_t name =
        i < list->count ? ffd_json_tree_member(&d->tree, list->values[i], "name") : JSON_NONE;
    return name != JSON_NONE && d->tree.values[name].end - d->tree.values[name].begin > 2 ? name : JSON_NONE;
}

/* Returns the name of element i of a list, or "KIND i" if it has none. The caller frees it. */
static char *name_of(const gltf_document *d, const gltf_values *list, size_t i, const char *kind)
{
    const uint32_t name = find_name(d, list, i);
    byte_buffer text = {0};
    if (name != JSON_NONE)
        return ffd_json_tree_string(&d->tree, name, NULL);
    ffd_buffer_format(&text, "%s %zu", kind, i);
    return ffd_buffer_finish(&text);
}

static char *object_name(const gltf_document *d, size_t mesh, size_t node)
{
    const bool by_mesh = node == GLTF_NONE || (find_name(d, &d->node_values, node) == JSON_NONE &&
                                               find_name(d, &d->mesh_values, mesh) != JSON_NONE);
    return by_mesh ? name_of(d, &d->mesh_values, mesh, "mesh") : name_of(d, &d->node_values, node, "node");
}

static ffd_status begin_run(extractor *e, const drawn *drawing, size_t node)
{
    const gltf_primitive *const primitive = drawing->primitive;
    const int64_t glow_step =
        drawing->glow == GLTF_NONE ? 0 : (int64_t)drawing->glow - (int64_t)drawing->texcoord;
    const gltf_document *d = e->document;
    double number;
    const bool has_material =
        ffd_json_tree_number(&d->tree, ffd_json_tree_member(&d->tree, primitive->value, "material"), &number);
    char *object = object_name(d, primitive->mesh, node);
    char *material = has_material ? name_of(d, &d->material_values, (size_t)number, "material") : NULL;
    ffd_status status;
    TRY_END(object && (material || !has_material)
                ? ffd_model_begin_run(e->model, object, NULL, material, e->error)
                : ffd_fail_memory(e->error));
    if (e->model->wants_details && has_material && number >= 0 && number < MODEL_NONE)
        TRY_END(ffd_model_set_material(e->model, (uint32_t)number, glow_step, e->error));
end:
    ffd_free(object);
    ffd_free(material);
    return status;
}

static bool is_mirrored(const gltf_document *d, size_t part)
{
    double transform[12];
    if (d->mesh_parts[part].identity || d->mesh_parts[part].vertex_count == 0)
        return false;
    read_transform(d, part, 0, transform);
    return mat_determinant(transform) < 0;
}

static ffd_status add_instance(extractor *e, const gltf_instance *instance)
{
    const gltf_document *d = e->document;
    const gltf_primitive *const primitive = instance->primitive;
    const size_t part = instance->part[GLTF_POSITION], normals = instance->part[GLTF_NORMAL];
    if (part == GLTF_NONE)
        return FFD_OK;
    if (primitive->mode == MODE_UNKNOWN && e->model->wants_details)
        return FFD_OK;
    if (primitive->mode == MODE_UNKNOWN)
        return ffd_json_tree_fail(&d->tree, primitive->value, d->name, FFD_E_INVALID, e->error,
                                  "what the primitive draws is not known, so that it cannot be converted");
    drawn drawing = {.primitive = primitive,
                     .part = part,
                     .position = e->first_position[part],
                     .normal = normals == GLTF_NONE ? GLTF_NONE : e->first_normal[normals],
                     .texcoord = find_texcoords(e, instance, BASE_TEXCOORDS),
                     .glow =
                         e->model->wants_details ? find_texcoords(e, instance, GLOW_TEXCOORDS) : GLTF_NONE,
                     .mirrored = is_mirrored(d, part)};
    if (drawing.texcoord == GLTF_NONE)
        drawing.texcoord = drawing.glow;
    ffd_status status;
    TRY_END(ffd_gltf_read_corners(d, primitive, &drawing.corners, &drawing.count, e->error));
    TRY_END(begin_run(e, &drawing, instance->node));
    TRY_END(take_colours(e, instance, &drawing));
    TRY_END(drawing.primitive->mode == MODE_POINTS     ? add_points(e, &drawing)
            : drawing.primitive->mode < MODE_TRIANGLES ? add_lines(e, &drawing)
                                                       : add_triangles(e, &drawing));
end:
    ffd_free(drawing.corners);
    return status;
}

static uint32_t feature_of_attribute(const json_tree *tree, uint32_t value)
{
    static const char *const known[] = {"POSITION", "NORMAL", "COLOR_0"};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (ffd_json_tree_key_is(tree, value, known[i]))
            return 0;
    if (ffd_json_tree_key_is(tree, value, "TANGENT"))
        return MODEL_HAS_TANGENTS;
    const char *key = tree->text + tree->values[value].key_begin + 1;
    if (strncmp(key, "TEXCOORD_", 9) == 0)
        return 0; /* see ffd_gltf_has_more_texcoords */
    return strncmp(key, "JOINTS_", 7) == 0 || strncmp(key, "WEIGHTS_", 8) == 0 ? MODEL_HAS_SKINS
                                                                               : MODEL_HAS_MORE;
}

static uint32_t features_of_primitive(const extractor *e, const gltf_primitive *primitive)
{
    const gltf_document *const d = e->document;
    gltf_texcoords texcoords;
    bool stands_in = false;
    ffd_gltf_texcoords(d, primitive, &texcoords, &stands_in);
    e->model->other_texcoords += stands_in;
    const uint32_t attributes = ffd_json_tree_member(&d->tree, primitive->value, "attributes");
    uint32_t found = primitive->target_count > 0 ? MODEL_HAS_MORPHS : 0;
    found |= ffd_gltf_has_more_texcoords(d, primitive, &texcoords) ? MODEL_HAS_MORE_TEXCOORDS : 0;
    for (uint32_t v = ffd_json_tree_first(&d->tree, attributes); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v))
        found |= feature_of_attribute(&d->tree, v);
    return found;
}

static bool has_any(const gltf_document *d, const char *array)
{
    return ffd_json_tree_first(&d->tree, ffd_json_tree_member(&d->tree, 0, array)) != JSON_NONE;
}

/* Returns the features of the file that a model cannot hold. */
static uint32_t features_of(const extractor *e)
{
    const gltf_document *d = e->document;
    uint32_t found = 0;
    for (size_t i = 0; i < d->model.primitive_count; i++)
        if (is_primitive_drawn(d, &d->model.primitives[i]))
            found |= features_of_primitive(e, &d->model.primitives[i]);
    for (size_t n = 0; n < d->model.node_count; n++)
        found |= d->model.nodes[n].child_count > 0 ? MODEL_HAS_HIERARCHY : 0;
    found |= has_any(d, "materials") ? MODEL_HAS_MATERIALS : 0;
    found |= has_any(d, "images") ? MODEL_HAS_TEXTURES : 0;
    found |= has_any(d, "skins") ? MODEL_HAS_SKINS : 0;
    found |= has_any(d, "animations") ? MODEL_HAS_ANIMATIONS : 0;
    found |=
        has_any(d, "cameras") || ffd_gltf_has_extension(d, 0, "KHR_lights_punctual") ? MODEL_HAS_CAMERAS : 0;
    found |= d->nodes_outside_scene > 0 || ffd_gltf_count_stand_ins(d, false) > 0 || d->hidden
                 ? MODEL_HAS_HIDDEN
                 : 0;
    found |= d->space == FFD_SPACE_MESH && d->model.node_count > 0 ? MODEL_HAS_TRANSFORMS : 0;
    return found;
}

/* Sets the file's indices of the positions; vertices that are not drawn count too. */
static ffd_status index_positions(extractor *e)
{
    const gltf_document *d = e->document;
    uint64_t index = 0;
    TRY(ffd_model_take(e->model, e->model->position_count, sizeof *e->model->indices, e->error));
    e->model->indices = ffd_alloc(e->model->position_count, sizeof *e->model->indices);
    if (!e->model->indices)
        return ffd_fail_memory(e->error);
    for (size_t i = 0; i < d->base.part_count; i++) {
        const mesh_part *const part = &d->mesh_parts[i];
        if (part->repeats_positions)
            continue;
        for (size_t v = 0; v < part->vertex_count && is_drawn(d, d->parts[i].node); v++)
            e->model->indices[e->first_position[i] + v] = index + v;
        index += part->vertex_count;
    }
    return FFD_OK;
}

static ffd_status extract(extractor *e)
{
    const gltf_document *d = e->document;
    e->first_position = ffd_alloc(d->base.part_count, sizeof *e->first_position);
    e->first_normal = ffd_alloc(d->base.part_count, sizeof *e->first_normal);
    e->colours = ffd_alloc(d->base.part_count, sizeof *e->colours);
    if (!e->first_position || !e->first_normal || !e->colours)
        return ffd_fail_memory(e->error);
    /* For the corners of one primitive at a time. */
    TRY(ffd_model_take(e->model, ffd_gltf_most_corners(d), sizeof(uint32_t), e->error));
    TRY(count_values(e));
    fill_values(e);
    if (e->model->wants_details)
        TRY(index_positions(e));
    e->model->nodes_left = d->instanced_node_count;
    TRY(visit_drawn(e, add_instance));
    e->model->features = features_of(e);
    return FFD_OK;
}

/* A model has no instances, and the node's own matrix places none of them. */
static ffd_status refuse_instances(const gltf_document *d, const mesh_model *model, ffd_error *error)
{
    if (d->instanced_node_count == 0 || model->wants_details)
        return FFD_OK;
    return ffd_json_tree_fail(&d->tree, d->node_values.values[d->instanced_nodes[0].node], d->name,
                              FFD_E_UNSUPPORTED, error,
                              "instances of EXT_mesh_gpu_instancing cannot be converted");
}

ffd_status ffd_gltf_extract(const mesh_document *document, mesh_state state, mesh_model *model,
                            ffd_error *error)
{
    extractor e = {.document = ffd_gltf_of(document), .state = state, .model = model, .error = error};
    ffd_status status;
    TRY_END(refuse_instances(e.document, model, error));
    TRY_END(extract(&e));
    TRY_END(ffd_model_finish(model, error));
end:
    ffd_free(e.first_position);
    ffd_free(e.first_normal);
    ffd_free(e.colours);
    ffd_free(e.first_texcoord);
    ffd_intern_free(&e.texcoords);
    return status;
}
