/* obj_write.c - writes a model as a new OBJ file. */
#include "io/write/sink.h"
#include "io/write/write.h"
#include <float.h>

static void write_values(model_sink *sink, const mesh_model *model)
{
    for (size_t i = 0; i < model->position_count && sink->status == FFD_OK; i++) {
        ffd_sink_text(sink, "v");
        ffd_sink_numbers(sink, model->positions + 3 * i, 3);
        if (model->colours)
            ffd_sink_numbers(sink, model->colours + 4 * i, 3);
        ffd_sink_text(sink, "\n");
    }
    for (size_t i = 0; i < model->texcoord_count && sink->status == FFD_OK; i++) {
        ffd_sink_text(sink, "vt");
        ffd_sink_numbers(sink, model->texcoords + 2 * i, 2);
        ffd_sink_text(sink, "\n");
    }
    for (size_t i = 0; i < model->normal_count && sink->status == FFD_OK; i++) {
        ffd_sink_text(sink, "vn");
        ffd_sink_numbers(sink, model->normals + 3 * i, 3);
        ffd_sink_text(sink, "\n");
    }
}

/* Writes a name as one line: control characters such as line ends become '_', and so does a backslash at the
   end, which would join the next line. OBJ cannot end a name, so a run without one gets "default", the name
   with which every file begins. */
static void write_name(model_sink *sink, const char *keyword, const char *name)
{
    ffd_sink_text(sink, keyword);
    ffd_sink_text(sink, " ");
    if (!name)
        name = "default";
    for (const char *c = name; *c; c++) {
        const bool odd = (unsigned char)*c < ' ' || *c == 0x7f || (*c == '\\' && !c[1]);
        ffd_sink_bytes(sink, odd ? "_" : c, 1);
    }
    ffd_sink_text(sink, "\n");
}

static void write_names(model_sink *sink, const mesh_model *model, size_t r)
{
    static const model_run nothing = {MODEL_NONE, MODEL_NONE, MODEL_NONE, {0}, MODEL_NONE, 0};
    const model_run *run = &model->runs[r], *before = r > 0 ? run - 1 : &nothing;
    if (run->object != before->object)
        write_name(sink, "o", model_name(model, run->object));
    if (run->group != before->group)
        write_name(sink, "g", model_name(model, run->group));
    if (run->material != before->material)
        write_name(sink, "usemtl", model_name(model, run->material));
}

static void write_corner(model_sink *sink, const model_corner *corner, model_kind kind)
{
    const bool texcoord = corner->texcoord != MODEL_NONE && kind != MODEL_POINTS;
    const bool normal = corner->normal != MODEL_NONE && kind == MODEL_FACES;
    ffd_sink_text(sink, " ");
    ffd_sink_count(sink, (uint64_t)corner->position + 1);
    if (texcoord || normal)
        ffd_sink_text(sink, "/");
    if (texcoord)
        ffd_sink_count(sink, (uint64_t)corner->texcoord + 1);
    if (normal) {
        ffd_sink_text(sink, "/");
        ffd_sink_count(sink, (uint64_t)corner->normal + 1);
    }
}

static void write_elements(model_sink *sink, const mesh_model *model, size_t run, model_kind kind)
{
    static const char *const keywords[MODEL_KINDS] = {"f", "l", "p"};
    const size_t last = model_run_end(model, run, kind);
    for (size_t i = model->runs[run].first[kind]; i < last && sink->status == FFD_OK; i++) {
        size_t count;
        const model_corner *corners = model_element(&model->lists[kind], i, &count);
        ffd_sink_text(sink, keywords[kind]);
        for (size_t c = 0; c < count; c++)
            write_corner(sink, corners + c, kind);
        ffd_sink_text(sink, "\n");
    }
}

static ffd_status write(const mesh_model *model, const mesh_save_options *options, file_output *output,
                        const mesh_log *log, ffd_error *error)
{
    model_sink sink = {output, error, ffd_output_begin(output, options->path, options->force, error)};
    (void)log;
    write_values(&sink, model);
    /* A file without any statement is not an OBJ file. */
    if (model->position_count == 0 && (model->run_count == 0 || model->runs[0].object == MODEL_NONE))
        write_name(&sink, "o", NULL);
    for (size_t run = 0; run < model->run_count && sink.status == FFD_OK; run++) {
        write_names(&sink, model, run);
        for (int k = 0; k < MODEL_KINDS; k++)
            write_elements(&sink, model, run, (model_kind)k);
    }
    return sink.status;
}

const model_target ffd_obj_target = {
    .name = "OBJ",
    .holds = MODEL_HAS_FINE_POSITIONS | MODEL_HAS_NORMALS | MODEL_HAS_CORNER_NORMALS | MODEL_HAS_TEXCOORDS |
             MODEL_HAS_CORNER_TEXCOORDS | MODEL_HAS_COLOURS | MODEL_HAS_POLYGONS | MODEL_HAS_LINES |
             MODEL_HAS_POINTS | MODEL_HAS_LOOSE | MODEL_HAS_OBJECTS | MODEL_HAS_GROUPS |
             MODEL_HAS_MATERIAL_NAMES,
    .largest_coordinate = DBL_MAX,
    .write = write,
};
