#include "io/volume/volume_weights.h"

/* Returns the value of a type that stands for 1; 0: its numbers are no weights. */
static double unit_of(number_type type)
{
    return number_is_real(type) ? 1 : type == NUMBER_UINT8 ? 255 : type == NUMBER_UINT16 ? 65535 : 0;
}

ffd_status ffd_volume_no_weights(const volume_document *d, const weight_source *source, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_INVALID, d->file.name, "the points have no array \"%.80s\" ({weight})",
                         source->name);
}

ffd_status ffd_volume_check_weights(const volume_document *d, const weight_source *source, number_type type,
                                    size_t width, size_t line, ffd_error *error)
{
    if (width == 1 && unit_of(type) > 0)
        return FFD_OK;
    return ffd_fail_line(error, FFD_E_INVALID, d->file.name, line,
                         "the array \"%.80s\" has %zu %s of %s: weights are one of float, double, uint8 or "
                         "uint16 ({weight})",
                         source->name, width, width == 1 ? "component" : "components", ffd_type_name(type));
}

void ffd_volume_scale_weights(number_type type, double *weights, size_t count)
{
    for (size_t v = 0; v < count; v++)
        weights[v] /= unit_of(type);
}

static ffd_status read(const mesh_document *document, const weight_source *source, double *weights,
                       ffd_error *error)
{
    const volume_document *const d = ffd_volume_of(document);
    const volume_array *found = NULL;
    for (size_t i = 0; i < d->array_count && !found; i++)
        if (!d->arrays[i].of_cells && ffd_text_is(d->arrays[i].name, source->name))
            found = &d->arrays[i];
    if (!found)
        return ffd_volume_no_weights(d, source, error);
    const number_run *const run = &found->run;
    TRY(ffd_volume_check_weights(d, source, run->type, run->width, run->line, error));
    if (!ffd_run_load(run, weights))
        return ffd_file_document_changed(&d->file, error);
    ffd_volume_scale_weights(run->type, weights, d->file.part.vertex_count);
    return FFD_OK;
}

const mesh_weight_calls ffd_volume_weights = {.kinds = WEIGHT_BIT(WEIGHT_PROPERTY), .read = read};
