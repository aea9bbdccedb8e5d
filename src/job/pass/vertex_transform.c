#include "job/pass/vertex_transform.h"
#include "base/vector/vec.h"
#include <string.h>

void ffd_vertex_transforms_read(const mesh_document *document, size_t part, size_t first, size_t count,
                                vertex_transforms *transforms, skin_weights *found)
{
    transforms->part = &document->parts[part];
    if (!transforms->part->skinned)
        return;
    document->format->read_transforms(document, part, first, count, transforms->transforms, found);
    for (size_t i = 0; i < count; i++)
        transforms->singular[i] = !mat_invert(transforms->transforms + 12 * i, transforms->inverses + 9 * i);
}

vertex_transform ffd_vertex_transform_of(const vertex_transforms *transforms, size_t i)
{
    const mesh_part *part = transforms->part;
    const double *own = transforms->transforms + 12 * i;
    if (part->skinned)
        return (vertex_transform){own, own + 9, transforms->inverses + 9 * i, false, transforms->singular[i]};
    return (vertex_transform){part->linear, part->offset, part->inverse, part->identity, part->singular};
}

void ffd_gradient_to_file(const vertex_transform *transform, double gradient[9])
{
    double product[9];
    if (transform->singular)
        memset(gradient, 0, sizeof product);
    if (transform->identity || transform->singular)
        return;
    mat_multiply(gradient, transform->linear, product);
    mat_multiply(transform->inverse, product, gradient);
}

void ffd_part_carry_gradient(const mesh_part *part, double gradient[9])
{
    double product[9];
    mat_multiply(part->carry, gradient, product);
    for (int i = 0; i < 9; i++)
        gradient[i] += part->carry[i] + product[i];
}
