#include "job/conversion.h"
#include "io/formats.h"
#include "io/write/write.h"
#include "job/input/source.h"
#include <math.h>

bool ffd_conversion_needed(const mesh_document *document, ffd_format format)
{
    return ffd_format_table(format) != document->format;
}

ffd_status ffd_conversion_check(const mesh_document *document, ffd_format format, ffd_error *error)
{
    const model_target *target = ffd_model_target(format);
    if (!ffd_conversion_needed(document, format) || (document->format->model && target))
        return FFD_OK;
    return ffd_fail(error, FFD_E_UNSUPPORTED, "%s cannot become %s in this build", document->format->name,
                    target ? target->name : "the output's format");
}

static ffd_status check_values(const double *values, const double *less, size_t count,
                               const model_target *target, const char *path, ffd_error *error)
{
    for (size_t i = 0; i < count; i++) {
        const double value = less ? values[i] - less[i] : values[i];
        if (!(fabs(value) <= target->largest_coordinate))
            return ffd_fail_file(error, FFD_E_INVALID, path,
                                 "%c of vertex %zu (counted from 0) is %g, too large for the numbers of %s",
                                 "xyz"[i % 3], i / 3, value, target->name);
    }
    return FFD_OK;
}

static ffd_status check_range(const mesh_model *model, const model_target *target, const char *path,
                              ffd_error *error)
{
    const size_t count = 3 * model->position_count;
    ffd_status status = check_values(model->positions, NULL, count, target, path, error);
    if (status == FFD_OK && model->morph_positions)
        status = check_values(model->morph_positions, model->positions, count, target, path, error);
    return status;
}

static void warn(const mesh_model *model, const conversion_morph *morph, const model_target *target,
                 const mesh_log *log)
{
    char lost[800];
    ffd_model_describe_loss(model, target->holds, lost, sizeof lost);
    if (*lost)
        ffd_log_line(log, FFD_LOG_WARNING, "%s cannot hold: %s", target->name, lost);
    if (morph && !ffd_model_morphs(model))
        ffd_log_line(log, FFD_LOG_WARNING, "nothing moves: no morph target is added");
}

/* The model as it is to be written; models take what they need from the budget. */
static ffd_status make_model(const mesh_document *document, const conversion_morph *morph,
                             memory_budget *budget, mesh_model *model, ffd_error *error)
{
    mesh_model after = {.budget = budget};
    if (!morph) {
        model->budget = budget;
        return document->format->model(document, model, error);
    }
    *model = *morph->base;
    *morph->base = (mesh_model){0};
    ffd_status status = document->format->model(document, &after, error);
    if (status == FFD_OK)
        status = ffd_model_add_morph(model, &after, morph->name, error);
    ffd_model_free(&after);
    return status;
}

ffd_status ffd_conversion_save(const mesh_document *document, const conversion_morph *morph,
                               const mesh_save_options *options, file_output *output, const mesh_log *log,
                               ffd_error *error)
{
    const model_target *target = ffd_model_target(options->format);
    mesh_model model = {0};
    memory_budget budget = document->budget;
    ffd_status status = make_model(document, morph, &budget, &model, error);
    if (status == FFD_OK)
        status = check_range(&model, target, options->path, error);
    if (status == FFD_OK)
        status = target->write(&model, options, output, error);
    if (status == FFD_OK)
        warn(&model, morph, target, log);
    ffd_model_free(&model);
    return status;
}
