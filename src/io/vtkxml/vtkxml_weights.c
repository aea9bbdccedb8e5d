/* vtkxml_weights.c - arrays of the points of a VTK file in XML as weights. */
#include "io/volume/volume_weights.h"
#include "io/vtkxml/vtkxml_data.h"

static const vtkxml_array *find(const vtkxml_document *d, size_t piece, const char *name)
{
    for (size_t i = 0; i < d->value_count; i++)
        if (d->values[i].piece == piece && ffd_text_is(d->values[i].array.name, name))
            return &d->values[i].array;
    return NULL;
}

static ffd_status read(const mesh_document *document, const weight_source *source, double *weights,
                       ffd_error *error)
{
    const vtkxml_document *const d = ffd_vtkxml_of(document);
    for (size_t p = 0; p < d->piece_count; p++) {
        const vtkxml_piece *const piece = &d->pieces[p];
        const vtkxml_array *const array = find(d, p, source->name);
        const char *first, *last;
        if (piece->points == 0)
            continue;
        if (!array)
            return ffd_volume_no_weights(&d->volume, source, error);
        TRY(ffd_volume_check_weights(&d->volume, source, array->is_number ? array->type : NUMBER_INT8,
                                     array->width, array->line, error));
        double *const of_piece = weights + piece->vertex;
        TRY(ffd_vtkxml_read(d, array, piece->points, "weight", of_piece, &first, &last, error));
        ffd_volume_scale_weights(array->type, of_piece, (size_t)piece->points);
    }
    return FFD_OK;
}

const mesh_weight_calls ffd_vtkxml_weights = {.kinds = WEIGHT_BIT(WEIGHT_PROPERTY), .read = read};
