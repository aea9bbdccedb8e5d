#include "io/obj/obj_walk.h"

/* Whether the file had this element when its elements were counted. */
static bool count(obj_count *elements)
{
    return elements->seen++ < elements->total;
}

bool ffd_obj_walk_next(obj_walk *walk)
{
    if (!ffd_obj_scan_next(&walk->scan))
        return false;
    switch (walk->scan.keyword) {
    case OBJ_VERTEX:
        return count(&walk->vertices);
    case OBJ_TEXCOORD:
        return count(&walk->texcoords);
    case OBJ_NORMAL:
        return count(&walk->normals);
    case OBJ_FACE:
        return count(&walk->faces);
    default:
        return true;
    }
}

bool ffd_obj_find(int64_t index, obj_count count, size_t *element)
{
    const uint64_t size = index < 0 ? (uint64_t)-index : (uint64_t)index;
    if (index == 0 || size > (index < 0 ? count.seen : count.total))
        return false;
    *element = index < 0 ? count.seen - (size_t)size : (size_t)size - 1;
    return true;
}

bool ffd_obj_walk_corner(obj_walk *walk, obj_face_corner *corner)
{
    text_word word;
    obj_corner text;
    if (!ffd_obj_scan_corner(&walk->scan, &text) &&
        (!ffd_obj_scan_word(&walk->scan, &word) || !ffd_obj_corner(word, &text)))
        return false;
    if (!ffd_obj_find(text.vertex.value, walk->vertices, &corner->vertex))
        return false;
    corner->normal_text = text.normal.text;
    corner->has_normal = text.normal.text.first < text.normal.text.last &&
                         ffd_obj_find(text.normal.value, walk->normals, &corner->normal);
    return true;
}
