/* stl_write.c - writes a model as a new STL file. */
#include "io/stl/stl_document.h"
#include "io/write/sink.h"
#include "io/write/write.h"
#include "mesh/model_triangles.h"
#include <float.h>
#include <inttypes.h>

/* The normal is that of the corners as written; zeros if they have no area. */
static void write_triangle(model_sink *sink, const double *const corners[3])
{
    static const unsigned char no_attributes[2] = {0, 0};
    double stored[9], normal[3];
    for (size_t i = 0; i < 9; i++)
        stored[i] = (float)corners[i / 3][i % 3];
    const bool has_area = ffd_stl_normal(stored, normal);
    for (size_t a = 0; a < 3; a++)
        ffd_sink_float(sink, has_area ? normal[a] : 0);
    for (size_t i = 0; i < 9; i++)
        ffd_sink_float(sink, stored[i]);
    ffd_sink_bytes(sink, no_attributes, sizeof no_attributes);
}

static ffd_status write_face(model_sink *sink, const mesh_model *model, face_triangles *scratch, size_t face)
{
    size_t count = 0;
    TRY(ffd_face_triangles(scratch, model, face, &count, sink->error));
    for (size_t t = 0; t < count; t++) {
        const uint32_t *triangle = scratch->triangles + 3 * t;
        const double *const corners[3] = {scratch->points + 3 * (size_t)triangle[0],
                                          scratch->points + 3 * (size_t)triangle[1],
                                          scratch->points + 3 * (size_t)triangle[2]};
        write_triangle(sink, corners);
    }
    return FFD_OK;
}

static ffd_status write(const mesh_model *model, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error)
{
    /* Must not begin with "solid": readers would take the file for text. */
    static const char header[STL_HEADER] = "binary STL";
    const model_list *faces = &model->lists[MODEL_FACES];
    const size_t triangles = model_triangle_count(model);
    face_triangles scratch = {0};
    if (triangles > UINT32_MAX)
        return ffd_fail_file(error, FFD_E_LIMIT, options->path,
                             "would have %zu triangles, more than an STL's %" PRIu32, triangles, UINT32_MAX);
    model_sink sink = {output, error, ffd_output_begin(output, options->path, options->force, error)};
    ffd_sink_bytes(&sink, header, sizeof header);
    ffd_sink_u32(&sink, (uint32_t)triangles);
    for (size_t i = 0; i < faces->count && sink.status == FFD_OK; i++) {
        const ffd_status status = write_face(&sink, model, &scratch, i);
        sink.status = sink.status ? sink.status : status;
    }
    if (!sink.status)
        ffd_polygon_cut_warn(scratch.cutter.hurried, log);
    ffd_face_triangles_free(&scratch);
    return sink.status;
}

const model_target ffd_stl_target = {
    .name = "STL",
    .holds = 0,
    .largest_coordinate = FLT_MAX,
    .write = write,
};
