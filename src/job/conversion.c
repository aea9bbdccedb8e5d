#include "job/conversion.h"
#include "io/formats.h"
#include "io/write/write.h"
#include "job/source.h"
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

static ffd_status check_range(const mesh_model *model, const model_target *target, const char *path,
                              ffd_error *error)
{
    for (size_t i = 0; i < 3 * model->position_count; i++)
        if (!(fabs(model->positions[i]) <= target->largest_coordinate))
            return ffd_fail_file(error, FFD_E_INVALID, path,
                                 "%c of vertex %zu (counted from 0) is %g, too large for the numbers of %s",
                                 "xyz"[i % 3], i / 3, model->positions[i], target->name);
    return FFD_OK;
}

static void warn(const mesh_model *model, const model_target *target, const mesh_log *log)
{
    char lost[800];
    ffd_model_describe_loss(model, target->holds, lost, sizeof lost);
    if (*lost)
        ffd_log_line(log, FFD_LOG_WARNING, "%s cannot hold: %s", target->name, lost);
}

ffd_status ffd_conversion_save(const mesh_document *document, const mesh_save_options *options,
                               file_output *output, const mesh_log *log, ffd_error *error)
{
    const model_target *target = ffd_model_target(options->format);
    mesh_model model = {0};
    ffd_status status = document->format->model(document, &model, error);
    if (status == FFD_OK)
        status = check_range(&model, target, options->path, error);
    if (status == FFD_OK)
        status = target->write(&model, options, output, error);
    if (status == FFD_OK)
        warn(&model, target, log);
    ffd_model_free(&model);
    return status;
}
