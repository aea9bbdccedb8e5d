/* off_write.c - writes a model as a new OFF file. */
#include "base/text/number.h"
#include "io/write/sink.h"
#include "io/write/vertex_values.h"
#include "io/write/write.h"
#include <float.h>
#include <math.h>

typedef struct off_plan {
    const mesh_model *model;
    vertex_values values;
    bool byte_colours, byte_face_colours, face_alpha;
    /* Whether points are written as faces of one corner; the points of a cloud are just its vertices. */
    bool points;
} off_plan;

static ffd_status make_plan(const mesh_model *model, off_plan *plan, ffd_error *error)
{
    *plan = (off_plan){.model = model,
                       .byte_colours = ffd_model_colours_fit_bytes(model),
                       .byte_face_colours = ffd_model_face_colours_fit_bytes(model),
                       .face_alpha = ffd_model_has_face_alpha(model),
                       .points = model->lists[MODEL_FACES].count + model->lists[MODEL_LINES].count > 0};
    return ffd_vertex_values_find(model, &plan->values, error);
}

static void write_header(model_sink *sink, const off_plan *plan)
{
    const model_list *lists = plan->model->lists;
    ffd_sink_text(sink, plan->values.texcoords ? "ST" : "");
    ffd_sink_text(sink, plan->model->colours ? "C" : "");
    ffd_sink_text(sink, plan->values.normals ? "N" : "");
    ffd_sink_text(sink, "OFF\n");
    ffd_sink_count(sink, plan->model->position_count);
    ffd_sink_text(sink, " ");
    ffd_sink_count(sink, lists[MODEL_FACES].count +
                             (lists[MODEL_LINES].corner_count - lists[MODEL_LINES].count) +
                             (plan->points ? lists[MODEL_POINTS].count : 0));
    ffd_sink_text(sink, " 0\n"); /* nobody uses the number of edges */
}

static void write_named(model_sink *sink, const double *values, size_t width, uint32_t index)
{
    static const double zeros[3] = {0, 0, 0};
    ffd_sink_numbers(sink, index == MODEL_NONE ? zeros : values + width * index, width);
}

/* Writes a colour: whole numbers up to 255, as in most files, or numbers with a decimal point, which tells
   readers that the range is 0 to 1. */
static void write_colour(model_sink *sink, const double *colour, size_t width, bool bytes)
{
    for (size_t c = 0; c < width; c++) {
        const double value = colour[c];
        if (bytes) {
            ffd_sink_text(sink, " ");
            ffd_sink_count(sink, (uint64_t)floor_of(255 * value + 0.5));
        } else {
            ffd_sink_numbers(sink, &value, 1);
            ffd_sink_text(sink, value < floor_of(value) || value > floor_of(value) ? "" : ".0");
        }
    }
}

static void write_vertices(model_sink *sink, const off_plan *plan)
{
    const mesh_model *model = plan->model;
    for (size_t i = 0; i < model->position_count && sink->status == FFD_OK; i++) {
        const double *p = model->positions + 3 * i;
        for (int a = 0; a < 3; a++) {
            char text[FFD_NUMBER_CAPACITY];
            ffd_sink_text(sink, a ? " " : "");
            ffd_sink_bytes(sink, text, ffd_number_format(p[a], text));
        }
        if (plan->values.normals)
            write_named(sink, model->normals, 3, plan->values.normals[i]);
        if (model->colours)
            write_colour(sink, model->colours + 4 * i, 4, plan->byte_colours);
        if (plan->values.texcoords)
            write_named(sink, model->texcoords, 2, plan->values.texcoords[i]);
        ffd_sink_text(sink, "\n");
    }
}

static void write_corners(model_sink *sink, const model_corner *corners, size_t count)
{
    ffd_sink_count(sink, count);
    for (size_t c = 0; c < count; c++) {
        ffd_sink_text(sink, " ");
        ffd_sink_count(sink, corners[c].position);
    }
}

static void write_face(model_sink *sink, const model_corner *corners, size_t count)
{
    write_corners(sink, corners, count);
    ffd_sink_text(sink, "\n");
}

static void write_faces(model_sink *sink, const off_plan *plan)
{
    const model_list *const faces = &plan->model->lists[MODEL_FACES];
    for (size_t i = 0; i < faces->count && sink->status == FFD_OK; i++) {
        size_t count;
        const model_corner *corners = model_element(faces, i, &count);
        write_corners(sink, corners, count);
        if (plan->model->face_colours)
            write_colour(sink, plan->model->face_colours + 4 * i, plan->face_alpha ? 4 : 3,
                         plan->byte_face_colours);
        ffd_sink_text(sink, "\n");
    }
}

static void write_points(model_sink *sink, const model_list *list)
{
    for (size_t i = 0; i < list->count && sink->status == FFD_OK; i++)
        write_face(sink, list->corners + list->starts[i], 1);
}

static void write_lines(model_sink *sink, const model_list *list)
{
    for (size_t i = 0; i < list->count; i++) {
        size_t count;
        const model_corner *corners = model_element(list, i, &count);
        for (size_t c = 0; c + 1 < count; c++)
            write_face(sink, corners + c, 2);
    }
}

static ffd_status write(const mesh_model *model, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error)
{
    off_plan plan;
    model_sink sink = {output, error, make_plan(model, &plan, error)};
    (void)log;
    if (sink.status == FFD_OK)
        sink.status = ffd_output_begin(output, options->path, options->force, error);
    write_header(&sink, &plan);
    write_vertices(&sink, &plan);
    write_faces(&sink, &plan);
    write_lines(&sink, &model->lists[MODEL_LINES]);
    if (plan.points)
        write_points(&sink, &model->lists[MODEL_POINTS]);
    ffd_vertex_values_free(&plan.values);
    return sink.status;
}

const model_target ffd_off_target = {
    .name = "OFF",
    .holds = MODEL_HAS_FINE_POSITIONS | MODEL_HAS_NORMALS | MODEL_HAS_POINT_NORMALS | MODEL_HAS_TEXCOORDS |
             MODEL_HAS_COLOURS | MODEL_HAS_ALPHA | MODEL_HAS_POLYGONS | MODEL_HAS_LINES | MODEL_HAS_POINTS |
             MODEL_HAS_LOOSE | MODEL_HAS_FACE_COLOURS,
    .largest_coordinate = DBL_MAX,
    .write = write,
};
