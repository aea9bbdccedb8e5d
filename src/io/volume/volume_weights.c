/* volume_weights.c - arrays of one number for each point, as weights. */
#include "io/volume/volume_document.h"
#include <string.h>

/* Returns the value of a type that stands for 1; 0: its numbers are no weights. */
static double unit_of(number_type type)
{
    return number_is_real(type) ? 1 : type == NUMBER_UINT8 ? 255 : type == NUMBER_UINT16 ? 65535 : 0;
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
        return ffd_fail_file(error, FFD_E_INVALID, d->file.name,
                             "the points have no array \"%.80s\" ({weight})", source->name);
    if (found->run.width != 1 || unit_of(found->run.type) == 0)
        return ffd_fail_line(error, FFD_E_INVALID, d->file.name, found->run.line,
                             "the array \"%.80s\" has %zu components of %s: weights are one of float, "
                             "double, uint8 or uint16 ({weight})",
                             source->name, found->run.width, ffd_type_name(found->run.type));
    if (!ffd_run_load(&found->run, weights))
        return ffd_file_document_changed(&d->file, error);
    for (size_t v = 0; v < d->file.part.vertex_count; v++)
        weights[v] /= unit_of(found->run.type);
    return FFD_OK;
}

const mesh_weight_calls ffd_volume_weights = {.kinds = WEIGHT_BIT(WEIGHT_PROPERTY), .read = read};
