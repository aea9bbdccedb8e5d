#include "job/pass/vertex_transform.h"
#include "base/vector/vec.h"
#include <string.h>

void ffd_vertex_places_read(const mesh_document *document, size_t part, size_t first, size_t count,
                            vertex_places *places)
{
    places->part = &document->parts[part];
    if (!places->part->skinned)
        return;
    document->format->read_transforms(document, part, first, count, places->transforms);
    for (size_t i = 0; i < count; i++)
        places->singular[i] = !mat_invert(places->transforms + 12 * i, places->inverses + 9 * i);
}

vertex_place ffd_vertex_place_of(const vertex_places *places, size_t i)
{
    const mesh_part *part = places->part;
    const double *own = places->transforms + 12 * i;
    if (part->skinned)
        return (vertex_place){own, own + 9, places->inverses + 9 * i, false, places->singular[i]};
    return (vertex_place){part->linear, part->offset, part->inverse, part->identity, part->singular};
}

void ffd_gradient_bring_back(const vertex_place *place, double gradient[9])
{
    double product[9];
    if (place->singular)
        memset(gradient, 0, sizeof product);
    if (place->identity || place->singular)
        return;
    mat_multiply(gradient, place->linear, product);
    mat_multiply(place->inverse, product, gradient);
}
