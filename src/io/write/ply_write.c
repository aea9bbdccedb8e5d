/* ply_write.c - writes a model as a new PLY file. */
#include "io/write/sink.h"
#include "io/write/vertex_values.h"
#include "io/write/write.h"
#include <float.h>
#include <math.h>

#define LARGEST_UCHAR 255

/* What the file will hold. */
typedef struct ply_plan {
    const mesh_model *model;
    vertex_values values;
    bool corner_texcoords; /* vertices have several each: they are written with the faces */
    bool byte_colours, alpha;
    bool byte_face_colours, face_alpha;
    size_t longest; /* the largest number of corners of a face */
    size_t edges;
} ply_plan;

static ffd_status make_plan(const mesh_model *model, ply_plan *plan, ffd_error *error)
{
    const uint32_t has = model->features;
    *plan = (ply_plan){.model = model,
                       .corner_texcoords = has & MODEL_HAS_CORNER_TEXCOORDS,
                       .byte_colours = ffd_model_colours_fit_bytes(model),
                       .alpha = has & MODEL_HAS_ALPHA,
                       .byte_face_colours = ffd_model_face_colours_fit_bytes(model),
                       .face_alpha = ffd_model_has_face_alpha(model)};
    const model_list *faces = &model->lists[MODEL_FACES], *lines = &model->lists[MODEL_LINES];
    for (size_t i = 0; i < faces->count; i++) {
        const size_t corners = faces->starts[i + 1] - faces->starts[i];
        plan->longest = corners > plan->longest ? corners : plan->longest;
    }
    plan->edges = lines->corner_count - lines->count;
    return ffd_vertex_values_find(model, &plan->values, error);
}

static void write_element(model_sink *sink, const char *name, size_t count)
{
    ffd_sink_text(sink, "element ");
    ffd_sink_text(sink, name);
    ffd_sink_text(sink, " ");
    ffd_sink_count(sink, count);
    ffd_sink_text(sink, "\n");
}

static void write_colour_properties(model_sink *sink, bool bytes, bool alpha)
{
    ffd_sink_text(sink, bytes ? "property uchar red\nproperty uchar green\nproperty uchar blue\n"
                              : "property float red\nproperty float green\nproperty float blue\n");
    if (alpha)
        ffd_sink_text(sink, bytes ? "property uchar alpha\n" : "property float alpha\n");
}

static void write_header(model_sink *sink, const ply_plan *plan)
{
    const mesh_model *model = plan->model;
    const char *index = model->position_count > INT32_MAX ? "uint" : "int";
    ffd_sink_text(sink, "ply\nformat binary_little_endian 1.0\n");
    write_element(sink, "vertex", model->position_count);
    ffd_sink_text(sink, "property double x\nproperty double y\nproperty double z\n");
    if (plan->values.normals)
        ffd_sink_text(sink, "property double nx\nproperty double ny\nproperty double nz\n");
    if (plan->values.texcoords)
        ffd_sink_text(sink, "property float s\nproperty float t\n");
    if (model->colours)
        write_colour_properties(sink, plan->byte_colours, plan->alpha);
    if (model->lists[MODEL_FACES].count > 0) {
        write_element(sink, "face", model->lists[MODEL_FACES].count);
        ffd_sink_text(sink, plan->longest > LARGEST_UCHAR ? "property list int " : "property list uchar ");
        ffd_sink_text(sink, index);
        ffd_sink_text(sink, " vertex_indices\n");
        if (plan->corner_texcoords)
            ffd_sink_text(sink, 2 * plan->longest > LARGEST_UCHAR ? "property list int float texcoord\n"
                                                                  : "property list uchar float texcoord\n");
        if (model->face_colours)
            write_colour_properties(sink, plan->byte_face_colours, plan->face_alpha);
    }
    if (plan->edges > 0) {
        write_element(sink, "edge", plan->edges);
        ffd_sink_text(sink, "property ");
        ffd_sink_text(sink, index);
        ffd_sink_text(sink, " vertex1\nproperty ");
        ffd_sink_text(sink, index);
        ffd_sink_text(sink, " vertex2\n");
    }
    ffd_sink_text(sink, "end_header\n");
}

/* Writes the values with this index, or zeros for MODEL_NONE. */
static void write_values(model_sink *sink, const double *values, size_t width, uint32_t index)
{
    for (size_t i = 0; i < width; i++)
        ffd_sink_double(sink, index == MODEL_NONE ? 0 : values[width * index + i]);
}

/* Written as floats: many programs ignore texture coordinates that are doubles. */
static void write_texcoord(model_sink *sink, const ply_plan *plan, uint32_t index)
{
    for (size_t i = 0; i < 2; i++)
        ffd_sink_float(sink, index == MODEL_NONE ? 0 : plan->model->texcoords[2 * (size_t)index + i]);
}

static void write_colour(model_sink *sink, const double *colour, bool bytes, bool alpha)
{
    for (size_t c = 0; c < (alpha ? 4 : 3); c++) {
        const double value = colour[c];
        if (bytes) {
            const unsigned char byte = (unsigned char)floor_of(255 * value + 0.5);
            ffd_sink_bytes(sink, &byte, 1);
        } else
            ffd_sink_float(sink, value);
    }
}

static void write_vertices(model_sink *sink, const ply_plan *plan)
{
    const mesh_model *model = plan->model;
    for (size_t i = 0; i < model->position_count && sink->status == FFD_OK; i++) {
        write_values(sink, model->positions, 3, (uint32_t)i);
        if (plan->values.normals)
            write_values(sink, model->normals, 3, plan->values.normals[i]);
        if (plan->values.texcoords)
            write_texcoord(sink, plan, plan->values.texcoords[i]);
        if (model->colours)
            write_colour(sink, model->colours + 4 * i, plan->byte_colours, plan->alpha);
    }
}

static void write_list_count(model_sink *sink, size_t longest, size_t count)
{
    const unsigned char byte = (unsigned char)count;
    if (longest > LARGEST_UCHAR)
        ffd_sink_u32(sink, (uint32_t)count);
    else
        ffd_sink_bytes(sink, &byte, 1);
}

static void write_face_texcoords(model_sink *sink, const ply_plan *plan, const model_corner *corners,
                                 size_t count)
{
    write_list_count(sink, 2 * plan->longest, 2 * count);
    for (size_t c = 0; c < count; c++)
        write_texcoord(sink, plan, corners[c].texcoord);
}

static void write_faces(model_sink *sink, const ply_plan *plan)
{
    const model_list *faces = &plan->model->lists[MODEL_FACES];
    for (size_t i = 0; i < faces->count && sink->status == FFD_OK; i++) {
        size_t count;
        const model_corner *corners = model_element(faces, i, &count);
        write_list_count(sink, plan->longest, count);
        for (size_t c = 0; c < count; c++)
            ffd_sink_u32(sink, corners[c].position);
        if (plan->corner_texcoords)
            write_face_texcoords(sink, plan, corners, count);
        if (plan->model->face_colours)
            write_colour(sink, plan->model->face_colours + 4 * i, plan->byte_face_colours, plan->face_alpha);
    }
}

static void write_edges(model_sink *sink, const ply_plan *plan)
{
    const model_list *lines = &plan->model->lists[MODEL_LINES];
    for (size_t i = 0; i < lines->count; i++) {
        size_t count;
        const model_corner *corners = model_element(lines, i, &count);
        for (size_t c = 0; c + 1 < count; c++) {
            ffd_sink_u32(sink, corners[c].position);
            ffd_sink_u32(sink, corners[c + 1].position);
        }
    }
}

static ffd_status write(const mesh_model *model, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error)
{
    ply_plan plan;
    model_sink sink = {output, error, make_plan(model, &plan, error)};
    (void)log;
    if (sink.status == FFD_OK && plan.longest > INT32_MAX / 2)
        sink.status = ffd_fail_file(error, FFD_E_LIMIT, options->path,
                                    "a face has %zu corners, more than a PLY list can hold", plan.longest);
    if (sink.status == FFD_OK)
        sink.status = ffd_output_begin(output, options->path, options->force, error);
    write_header(&sink, &plan);
    write_vertices(&sink, &plan);
    write_faces(&sink, &plan);
    write_edges(&sink, &plan);
    ffd_vertex_values_free(&plan.values);
    return sink.status;
}

const model_target ffd_ply_target = {
    .name = "PLY",
    /* Points are the vertices themselves. */
    .holds = MODEL_HAS_FINE_POSITIONS | MODEL_HAS_NORMALS | MODEL_HAS_POINT_NORMALS | MODEL_HAS_TEXCOORDS |
             MODEL_HAS_CORNER_TEXCOORDS | MODEL_HAS_COLOURS | MODEL_HAS_ALPHA | MODEL_HAS_POLYGONS |
             MODEL_HAS_LINES | MODEL_HAS_POINTS | MODEL_HAS_LOOSE | MODEL_HAS_FACE_COLOURS,
    .largest_coordinate = DBL_MAX,
    .float_texcoords = true,
    .takes_not_finite = true, /* organized scans have NaN where nothing was measured */
    .write = write,
};
