/* glb_write.c - writes a model as a new .glb or .gltf file. */
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "io/gltf/file/glb.h"
#include "io/gltf/file/gltf_uri.h"
#include "io/write/glb_plan.h"
#include "io/write/glb_writer.h"
#include "io/write/write.h"
#include "mesh/polygon_cut.h"
#include "mesh/precision.h"
#include "mesh/resource/sidecar.h"
#include "mesh/srgb.h"
#include <float.h>
#include <inttypes.h>
#include <string.h>

/* Of the step of floats, relative to the diagonal of all. */
#define STEP_TOLERANCE 1e-6

/* Returns the exponent of the smallest power of two greater than size. */
static int exponent_above(double size)
{
    int exponent;
    frexp(size, &exponent);
    return exponent;
}

static double farthest_from(const ffd_bounds *box, const double from[3])
{
    double farthest = 0;
    for (int a = 0; a < 3; a++)
        farthest = larger_of(farthest, larger_of(from[a] - box->min[a], box->max[a] - from[a]));
    return farthest;
}

/* Fills the translation of what lies in a box: `common` if the step of floats at the largest coordinate
   relative to it is at most tolerance times the diagonal, else one of its own. */
static void choose_origin(const ffd_bounds *box, const double common[3], double tolerance, double origin[3])
{
    static const double zero[3] = {0, 0, 0};
    double sides[3];
    for (int a = 0; a < 3; a++)
        sides[a] = box->max[a] - box->min[a];
    memcpy(origin, common, 3 * sizeof *origin);
    const double diagonal = vec_length(sides);
    if (!(diagonal > 0) || !(box->min[0] <= box->max[0]) ||
        ldexp(1, exponent_above(farthest_from(box, common)) - FLT_MANT_DIG) <= tolerance * diagonal)
        return;
    /* Multiples smaller than a double's step cannot be distinguished. */
    const int step = exponent_above(farthest_from(box, zero)) - DBL_MANT_DIG,
              above = exponent_above(diagonal);
    const double unit = ldexp(1, above > step ? above : step);
    for (int a = 0; a < 3; a++)
        origin[a] =
            unit * floor_of((box->min[a] / 2 + box->max[a] / 2) / unit + 0.5) + 0.0; /* + 0.0: no -0 */
}

/* Extends the bounds by the written vertices of a primitive. */
static void widen_box(const glb_plan *plan, const glb_primitive *primitive, ffd_bounds *box)
{
    for (size_t i = 0; i < primitive->vertex_count; i++)
        ffd_bounds_widen(box, plan->model->positions +
                                  3 * (size_t)plan->vertices[primitive->first_vertex + i].position);
}

/* Makes the translations of the nodes, 3 numbers for each mesh, relative to which positions are then stored;
   free them with ffd_free, after an error too. All are zero if the step of floats at the largest coordinate
   is at most 1e-6 of the diagonal. Otherwise the coordinates are multiples of a unit, the next power of two
   above the diagonal: on each axis the multiple nearest to the middle. So parts of the same size that lie
   side by side mostly have the same translation. A mesh whose own shape would still be lost
   (mesh/precision.h) gets one by its own diagonal in the same way. Errors: FFD_E_MEMORY. */
static ffd_status choose_origins(const glb_plan *plan, double **origins, ffd_error *error)
{
    static const double zero[3] = {0, 0, 0};
    const size_t count = plan->meshes.count;
    double common[3];
    ffd_bounds all = ffd_bounds_empty();
    ffd_bounds *const boxes = ffd_alloc(count, sizeof *boxes);
    *origins = ffd_alloc(3 * count, sizeof **origins);
    if (!boxes || !*origins) {
        ffd_free(boxes);
        return ffd_fail_memory(error);
    }
    for (size_t m = 0; m < count; m++)
        boxes[m] = ffd_bounds_empty();
    for (size_t i = 0; i < plan->primitive_count; i++)
        widen_box(plan, &plan->primitives[i], &boxes[plan->primitives[i].mesh]);
    for (size_t m = 0; m < count; m++)
        ffd_bounds_join(&all, &boxes[m]);
    choose_origin(&all, zero, STEP_TOLERANCE, common);
    for (size_t m = 0; m < count; m++)
        choose_origin(&boxes[m], common, 2 * PART_TOLERANCE, *origins + 3 * m);
    ffd_free(boxes);
    return FFD_OK;
}

static void measure(gltf_writer *w)
{
    for (size_t i = 0; i < w->plan.primitive_count; i++) {
        const glb_primitive *primitive = &w->plan.primitives[i];
        const uint64_t vertices = primitive->vertex_count, indices = primitive->index_count;
        w->sizes[VIEW_POSITIONS] += 12 * vertices;
        w->sizes[VIEW_NORMALS] += primitive->normals ? 12 * vertices : 0;
        w->sizes[VIEW_TEXCOORDS] += primitive->texcoords ? 8 * vertices : 0;
        w->sizes[VIEW_COLOURS] += w->model->colours ? glb_colour_size(w) * vertices : 0;
        for (size_t k = 0; k < w->model->morph_count; k++) {
            const uint64_t offsets = glb_has_morph(&w->plan, primitive, k) ? 12 * vertices : 0;
            w->sizes[VIEW_POSITION_OFFSETS] += offsets;
            w->sizes[VIEW_NORMAL_OFFSETS] += primitive->normals ? offsets : 0;
        }
        if (glb_has_short_indices(primitive))
            w->sizes[VIEW_SHORT] += 2 * indices;
        else
            w->sizes[VIEW_LONG] += 4 * indices;
    }
    w->sizes[VIEW_CLIPS] = w->clips.bytes.size;
    size_t index = 0;
    for (int v = 0; v < VIEW_COUNT; v++) {
        w->begins[v] = w->total;
        w->indices[v] = index;
        index += w->sizes[v] > 0;
        w->total += ffd_gltf_align(w->sizes[v]);
    }
}

static ffd_status begin(gltf_writer *w, const mesh_model *model, ffd_error *error)
{
    w->model = model;
    w->error = error;
    w->byte_colours = ffd_model_colours_fit_bytes(model);
    for (unsigned byte = 0; byte < 256 && model->colours && w->byte_colours; byte++)
        w->linear_of_bytes[byte] = ffd_srgb_byte_to_linear(byte);
    TRY(ffd_glb_make_plan(model, &w->plan, error));
    TRY(ffd_glb_make_clips(&w->plan, &w->clips, error));
    measure(w);
    return choose_origins(&w->plan, &w->origins, error);
}

static void end(gltf_writer *w)
{
    ffd_buffer_free(&w->text);
    ffd_free(w->origins);
    ffd_glb_free_clips(&w->clips);
    ffd_glb_free_plan(&w->plan);
    ffd_free(w);
}

static ffd_status put_glb(gltf_writer *w, const char *path)
{
    static const char blanks[] = "   ";
    ffd_glb_make_json(w, true, NULL);
    if (w->text.failed)
        return ffd_fail_memory(w->error);
    const size_t json = w->text.size - 1; /* without the line end */
    const uint64_t padded = ffd_gltf_align(json), bin = w->total > 0 ? GLB_CHUNK_HEADER_SIZE + w->total : 0;
    const uint64_t total = GLB_HEADER_SIZE + GLB_CHUNK_HEADER_SIZE + padded + bin;
    if (total > UINT32_MAX)
        return ffd_fail_file(w->error, FFD_E_LIMIT, path,
                             "would have %" PRIu64 " bytes, more than a GLB's 4294967295", total);
    ffd_sink_u32(&w->sink, GLB_MAGIC);
    ffd_sink_u32(&w->sink, GLB_VERSION);
    ffd_sink_u32(&w->sink, (uint32_t)total);
    ffd_sink_u32(&w->sink, (uint32_t)padded);
    ffd_sink_u32(&w->sink, GLB_CHUNK_JSON);
    ffd_sink_bytes(&w->sink, w->text.data, json);
    ffd_sink_bytes(&w->sink, blanks, (size_t)(padded - json));
    if (bin > 0) {
        ffd_sink_u32(&w->sink, (uint32_t)w->total);
        ffd_sink_u32(&w->sink, GLB_CHUNK_BIN);
        ffd_glb_put_content(w);
    }
    return w->sink.status;
}

/* On standard output everything is in one file: the buffer is a data URI. */
static ffd_status put_stream(gltf_writer *w)
{
    const size_t split = ffd_glb_make_json(w, false, "data:application/octet-stream;base64,");
    if (w->text.failed)
        return ffd_fail_memory(w->error);
    ffd_sink_bytes(&w->sink, w->text.data, split);
    w->base64 = true;
    if (split > 0)
        ffd_glb_put_content(w);
    ffd_sink_bytes(&w->sink, w->text.data + split, w->text.size - split);
    return w->sink.status;
}

static ffd_status put_bin_file(gltf_writer *w, const mesh_save_options *options, const char *path)
{
    if (options->input && ffd_save_meets(options, options->input, path))
        w->sink.status =
            ffd_fail_file(w->error, FFD_E_EXISTS, path, "is the input and is not overwritten by a buffer");
    else
        w->sink.status = ffd_output_begin(w->sink.output, path, options->force, w->error);
    ffd_glb_put_content(w);
    return w->sink.status;
}

static ffd_status put_files(gltf_writer *w, const mesh_save_options *options, const mesh_log *log)
{
    sidecar_names names = {.options = options, .log = log};
    char *path;
    TRY(ffd_sidecar_next(&names, NULL, NULL, &path, w->error));
    char *const uri = path ? ffd_uri_encode(ffd_path_name(path)) : NULL;
    ffd_status status;
    TRY_END(uri ? FFD_OK : ffd_fail_memory(w->error));
    ffd_glb_make_json(w, false, uri);
    if (w->text.failed)
        TRY_END(ffd_fail_memory(w->error));
    if (w->total > 0)
        TRY_END(put_bin_file(w, options, path));
    if (w->total > 0 && options->outputs)
        TRY_END(ffd_paths_add(options->outputs, path, w->error));
    TRY_END(ffd_output_begin(w->sink.output, options->path, options->force, w->error));
    TRY_END(ffd_output_write(w->sink.output, w->text.data, w->text.size, w->error));
end:
    ffd_free(path);
    ffd_free(uri);
    return status;
}

static void log_origins(const gltf_writer *w, const mesh_log *log)
{
    char texts[3][FFD_NUMBER_CAPACITY];
    const size_t count = w->plan.meshes.count;
    size_t far = 0, first = 0, like_first = 0;
    for (size_t m = 0; m < count; m++) {
        if (!glb_is_far(w, m))
            continue;
        first = far++ == 0 ? m : first;
        like_first += memcmp(w->origins + 3 * m, w->origins + 3 * first, 3 * sizeof *w->origins) == 0;
    }
    if (far == 0)
        return;
    for (int a = 0; a < 3; a++)
        texts[a][ffd_number_format(w->origins[3 * first + (size_t)a], texts[a])] = 0;
    if (like_first == count)
        ffd_log_line(
            log, FFD_LOG_INFO,
            "details are too far from the origin for floats: the nodes have a translation, (%s, %s, %s)",
            texts[0], texts[1], texts[2]);
    else
        ffd_log_line(
            log, FFD_LOG_INFO,
            "details are too far from the origin for floats: %zu of %zu nodes have a translation, the "
            "first (%s, %s, %s)",
            far, count, texts[0], texts[1], texts[2]);
}

static void note_animation(const gltf_writer *w, mesh_animated *animated)
{
    const size_t morphs = w->model->morph_count;
    if (!animated)
        return;
    animated->bytes = w->sizes[VIEW_POSITION_OFFSETS] + w->sizes[VIEW_NORMAL_OFFSETS] + w->sizes[VIEW_CLIPS];
    for (size_t m = 0; m < w->plan.meshes.count; m++) {
        size_t count = 0;
        for (size_t k = 0; k < morphs; k++)
            count += w->plan.morphed[m * morphs + k];
        animated->targets = count > animated->targets ? count : animated->targets;
    }
}

static ffd_status write(const mesh_model *model, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, bool binary, ffd_error *error)
{
    const bool files = !binary && !ffd_output_is_stream(options->path);
    gltf_writer *w = ffd_alloc_zero(1, sizeof *w);
    if (!w)
        return ffd_fail_memory(error);
    ffd_status status;
    TRY_END(begin(w, model, error));
    if (!files)
        TRY_END(ffd_output_begin(output, options->path, options->force, error));
    w->sink = (model_sink){output, error, FFD_OK};
    TRY_END(files ? put_files(w, options, log) : binary ? put_glb(w, options->path) : put_stream(w));
    note_animation(w, options->animated);
    log_origins(w, log);
    ffd_polygon_cut_warn(w->plan.hurried_polygons, log);
end:
    end(w);
    return status;
}

static ffd_status write_glb(const mesh_model *model, const mesh_save_options *options, file_output *output,
                            const mesh_log *log, ffd_error *error)
{
    return write(model, options, output, log, true, error);
}

static ffd_status write_gltf(const mesh_model *model, const mesh_save_options *options, file_output *output,
                             const mesh_log *log, ffd_error *error)
{
    return write(model, options, output, log, false, error);
}

#define HOLDS                                                                                                \
    (MODEL_HAS_FINE_POSITIONS | MODEL_HAS_NORMALS | MODEL_HAS_CORNER_NORMALS | MODEL_HAS_POINT_NORMALS |     \
     MODEL_HAS_TEXCOORDS | MODEL_HAS_CORNER_TEXCOORDS | MODEL_HAS_COLOURS | MODEL_HAS_ALPHA |                \
     MODEL_HAS_LINES | MODEL_HAS_POINTS | MODEL_HAS_OBJECTS | MODEL_HAS_GROUPS | MODEL_HAS_MATERIAL_NAMES)

const model_target ffd_glb_target = {.name = "glTF",
                                     .holds = HOLDS,
                                     .largest_coordinate = FLT_MAX,
                                     .float_texcoords = true,
                                     .write = write_glb};
const model_target ffd_gltf_target = {.name = "glTF",
                                      .holds = HOLDS,
                                      .largest_coordinate = FLT_MAX,
                                      .float_texcoords = true,
                                      .write = write_gltf};
