#include "io/ply/ply_plain_faces.h"

bool ffd_ply_plain_faces(ply_encoding encoding, const ply_element *element, const ply_property *list,
                         size_t vertices, ply_plain_faces *plain)
{
    const bool is_signed = list->type == PLY_INT;
    const size_t largest = is_signed ? (size_t)INT32_MAX + 1 : UINT32_MAX;
    *plain = (ply_plain_faces){.limit = vertices < largest ? vertices : largest,
                               .count_limit = list->count_type == PLY_CHAR ? 128 : 256,
                               .swapped = encoding == PLY_BIG_ENDIAN};
    if (encoding == PLY_ASCII || ffd_ply_type_size(list->count_type) != 1 ||
        (list->type != PLY_INT && list->type != PLY_UINT))
        return false;
    for (size_t i = 0; i < element->property_count; i++) {
        const ply_property *const property = &element->properties[i];
        if (property != list && property->is_list)
            return false;
        if (property != list)
            *(property < list ? &plain->before : &plain->behind) += ffd_ply_type_size(property->type);
    }
    return true;
}
