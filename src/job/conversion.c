#include "job/conversion.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/text/words.h"
#include "io/formats.h"
#include "io/write/write.h"
#include "mesh/morph/morph_clip.h"
#include <float.h>
#include <math.h>

bool ffd_conversion_needed(const mesh_document *document, ffd_format format)
{
    return ffd_format_table(format) != document->format;
}

bool ffd_conversion_keeps(ffd_format format)
{
    const mesh_format *const table = ffd_format_table(format);
    return table && table->keeps_format;
}

ffd_status ffd_conversion_check(const mesh_document *document, ffd_format format, ffd_error *error)
{
    const model_target *target = ffd_model_target(format);
    if (!ffd_conversion_needed(document, format) || (target && !document->format->keeps_format))
        return FFD_OK;
    return ffd_fail(error, FFD_E_UNSUPPORTED,
                    "%s cannot become %s: meshes of volumes keep their format (meshio converts them)",
                    document->format->name, ffd_format_table(format)->name);
}

static bool fits(double value, const model_target *target)
{
    return fabs(value) <= target->largest_coordinate || (target->takes_not_finite && !isfinite(value));
}

/* Returns coordinate i of a morph target's offset. morph: the target's number plus 1; 0: coordinate i of the
   base shape. */
static double coordinate(const mesh_model *model, size_t i, size_t morph)
{
    return morph ? model->morphs[morph - 1].positions[i] - model->positions[i] : model->positions[i];
}

/* Returns the index of the first coordinate (*morph as above) that the target's number type cannot hold,
   among the marked positions (marks NULL: all); SIZE_MAX: none. */
static size_t find_unfit(const mesh_model *model, const model_target *target, const uint8_t *marks,
                         size_t *morph)
{
    for (*morph = 0; *morph <= model->morph_count; ++*morph) {
        for (size_t i = 0; i < 3 * model->position_count; i++)
            if ((!marks || marks[i / 3]) && !fits(coordinate(model, i, *morph), target))
                return i;
    }
    return SIZE_MAX;
}

/* Marks the positions used by elements that the target format can hold. Returns NULL if memory runs out. */
static uint8_t *mark_held(const mesh_model *model, const model_target *target)
{
    const bool held[MODEL_KINDS] = {[MODEL_FACES] = true,
                                    [MODEL_LINES] = target->holds & MODEL_HAS_LINES,
                                    [MODEL_POINTS] = target->holds & MODEL_HAS_POINTS};
    uint8_t *const marks = ffd_alloc_zero(model->position_count, 1);
    for (int k = 0; k < MODEL_KINDS && marks; k++)
        for (size_t i = 0; held[k] && i < model->lists[k].corner_count; i++)
            marks[model->lists[k].corners[i].position] = 1;
    return marks;
}

static ffd_status refuse(const mesh_model *model, const model_target *target, size_t i, size_t morph,
                         const char *path, ffd_error *error)
{
    const double value = coordinate(model, i, morph);
    const char axis = "xyz"[i % 3];
    if (isfinite(value))
        return ffd_fail_file(error, FFD_E_INVALID, path,
                             "%c of vertex %zu (counted from 0) is %g, too large for the numbers of %s", axis,
                             i / 3, value, target->name);
    return ffd_fail_file(
        error, FFD_E_INVALID, path,
        "%c of vertex %zu (counted from 0) is not finite (%s): readers of %s take no such number", axis,
        i / 3,
        isnan(value) ? "nan"
        : value > 0  ? "inf"
                     : "-inf",
        target->name);
}

/* A format that cannot hold unused positions writes only those of its elements, so only these must fit. */
static ffd_status check_range(const mesh_model *model, const model_target *target, const char *path,
                              ffd_error *error)
{
    size_t morph;
    size_t unfit = find_unfit(model, target, NULL, &morph);
    if (unfit != SIZE_MAX && !(target->holds & MODEL_HAS_LOOSE)) {
        uint8_t *const marks = mark_held(model, target);
        if (!marks)
            return ffd_fail_memory(error);
        unfit = find_unfit(model, target, marks, &morph);
        ffd_free(marks);
    }
    return unfit == SIZE_MAX ? FFD_OK : refuse(model, target, unfit, morph, path, error);
}

/* Sets vectors with a number above a limit to zero, and those that are not finite unless the target takes
   them. Returns their number. */
static size_t clear_unfit(double *vectors, size_t count, size_t width, double limit,
                          const model_target *target)
{
    size_t cleared = 0;
    for (size_t i = 0; vectors && i < count; i++, vectors += width) {
        bool fit = true;
        for (size_t c = 0; c < width; c++)
            fit = fit && (isfinite(vectors[c]) ? fabs(vectors[c]) <= limit : target->takes_not_finite);
        cleared += !fit;
        for (size_t c = 0; c < width && !fit; c++)
            vectors[c] = 0;
    }
    return cleared;
}

static bool holds(const model_target *target, uint32_t feature)
{
    return (target->holds & feature) != 0;
}

/* Clears normals, texture coordinates and colours that would not be finite in the file: they do not change
   the shape, so they are not a reason to fail. */
static void clear_attributes(mesh_model *model, const model_target *target, const mesh_log *log)
{
    const double largest = target->float_texcoords ? (double)FLT_MAX : DBL_MAX;
    const size_t normals = clear_unfit(model->normals, model->normal_count, 3, DBL_MAX, target),
                 texcoords = clear_unfit(model->texcoords, model->texcoord_count, 2, largest, target),
                 of_vertices = holds(target, MODEL_HAS_COLOURS)
                                   ? clear_unfit(model->colours, model->position_count, 4, DBL_MAX, target)
                                   : 0,
                 of_faces = holds(target, MODEL_HAS_FACE_COLOURS)
                                ? clear_unfit(model->face_colours, model->coloured_faces, 4, DBL_MAX, target)
                                : 0,
                 colours = of_vertices + of_faces;
    if (normals + texcoords + colours)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "not finite as numbers of %s, and zero: %zu %s, %zu texture %s, %zu %s", target->name,
                     normals, ffd_plural(normals, "normal", "normals"), texcoords,
                     ffd_plural(texcoords, "coordinate", "coordinates"), colours,
                     ffd_plural(colours, "colour", "colours"));
}

/* Returns the number of colours that were above 1 in some of their numbers. */
static size_t limit(double *colours, size_t count)
{
    size_t limited = 0;
    for (size_t i = 0; colours && i < count; i++) {
        bool above = false;
        for (double *value = colours + 4 * i, *end = value + 4; value < end; value++)
            if (isfinite(*value) && *value > 1) {
                above = true;
                *value = 1;
            }
        limited += above;
    }
    return limited;
}

/* No format can hold colours above 1. */
static void limit_colours(mesh_model *model, const model_target *target, const mesh_log *log)
{
    const size_t of_vertices = limit(model->colours, model->position_count),
                 of_faces = limit(model->face_colours, model->coloured_faces);
    const size_t limited = (holds(target, MODEL_HAS_COLOURS) ? of_vertices : 0) +
                           (holds(target, MODEL_HAS_FACE_COLOURS) ? of_faces : 0);
    if (limited)
        ffd_log_line(log, FFD_LOG_WARNING, "above 1, and 1 in %s: %zu %s", target->name, limited,
                     ffd_plural(limited, "colour", "colours"));
}

static void warn(const mesh_model *model, const model_target *target, const mesh_log *log)
{
    char lost[800];
    ffd_model_describe_loss(model, target->holds, lost, sizeof lost);
    if (*lost)
        ffd_log_line(log, FFD_LOG_WARNING, "%s cannot hold: %s", target->name, lost);
    if (model->other_texcoords && target->holds & MODEL_HAS_TEXCOORDS)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%zu %s the set of texture coordinates that %s texture uses: TEXCOORD_0 takes its place",
                     model->other_texcoords,
                     ffd_plural(model->other_texcoords, "primitive lacks", "primitives lack"),
                     ffd_plural(model->other_texcoords, "its", "their"));
    if (model->odd_texcoords && target->holds & MODEL_HAS_TEXCOORDS)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%zu %s texture coordinates, which are not two numbers for each corner, and %s left out",
                     model->odd_texcoords, ffd_plural(model->odd_texcoords, "face has", "faces have"),
                     ffd_plural(model->odd_texcoords, "is", "are"));
    if (model->position_count == 0 && model->features & MODEL_HAS_HIDDEN)
        ffd_log_line(log, FFD_LOG_WARNING, "the displayed scene is empty: the output has no vertices");
    for (size_t k = 0; k < model->morph_count; k++) {
        mesh_log_label label;
        const mesh_log labelled = ffd_log_morph(log, model->morphs[k].name, &label);
        if (!model->drops_still && !ffd_model_morphs(model, k))
            ffd_log_line(model->morph_count > 1 ? &labelled : log, FFD_LOG_WARNING,
                         "no vertex moves: all offsets of the morph target are 0");
    }
    if (model->morph_count > MORPHS_PLAYED)
        ffd_log_line(log, FFD_LOG_WARNING, "%zu morph targets: some viewers play only %d", model->morph_count,
                     MORPHS_PLAYED);
}

/* Makes the model to write. Models take their memory from the budget. */
static ffd_status make_model(const mesh_document *document, mesh_state state, const conversion_morph *morph,
                             memory_budget *budget, mesh_model *model, ffd_error *error)
{
    mesh_model after = {.budget = budget};
    if (!morph) {
        model->budget = budget;
        return document->format->model(document, state, model, error);
    }
    *model = *morph->base;
    *morph->base = (mesh_model){0};
    if (!morph->name)
        return FFD_OK;
    ffd_status status;
    TRY_END(document->format->model(document, state, &after, error));
    TRY_END(ffd_model_add_morph(model, &after, morph->name, error));
end:
    ffd_model_free(&after);
    return status;
}

ffd_status ffd_conversion_save(const mesh_document *document, mesh_state state, const conversion_morph *morph,
                               const mesh_save_options *options, file_output *output, const mesh_log *log,
                               ffd_error *error)
{
    const model_target *target = ffd_model_target(options->format);
    mesh_model model = {0};
    memory_budget budget = document->budget;
    ffd_status status;
    TRY_END(make_model(document, state, morph, &budget, &model, error));
    TRY_END(ffd_deadline_check(error));
    TRY_END(check_range(&model, target, options->path, error));
    clear_attributes(&model, target, log);
    limit_colours(&model, target, log);
    TRY_END(target->write(&model, options, output, log, error));
    warn(&model, target, log);
end:
    ffd_model_free(&model);
    return status;
}
