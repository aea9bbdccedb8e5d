#include "io/obj/obj_document.h"
#include "io/obj/resource/obj_linked.h"

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

bool ffd_obj_walk_freeform(obj_walk *walk)
{
    /* With their parameter ranges before the vertices; then those of version 2, which have none. curv2 and sp
       name points of the parameter space (vp). */
    static const struct {
        const char *name;
        int parameters;
    } statements[] = {{"curv", 2}, {"surf", 4}, {"bsp", 0}, {"bzp", 0}, {"cdc", 0}, {"cdp", 0}};
    text_word word;
    if (walk->scan.keyword != OBJ_OTHER)
        return false;
    for (size_t i = 0; i < sizeof statements / sizeof *statements; i++) {
        int left = statements[i].parameters;
        if (!ffd_text_is(walk->scan.name, statements[i].name))
            continue;
        while (left > 0 && ffd_obj_scan_word(&walk->scan, &word))
            left--;
        return left == 0;
    }
    return false;
}

static bool are_plain(const obj_block *first, const obj_block *last)
{
    while (first < last && first->plain)
        first++;
    return first->plain;
}

static void walk_blocks(const obj_document *d, size_t first, size_t last, obj_walk *walk)
{
    const obj_block *from = &d->blocks.list[first], *to = &d->blocks.list[last];
    *walk = (obj_walk){
        .scan = {.at = from->first, .last = to->last, .line = from->line, .plain = are_plain(from, to)},
        .vertices = {d->vertices, from->vertices},
        .texcoords = {d->texcoords, from->texcoords},
        .normals = {d->normals, from->normals},
        .faces = {d->faces, from->faces}};
}

void ffd_obj_document_walk(const obj_document *d, obj_walk *walk)
{
    walk_blocks(d, 0, d->blocks.count - 1, walk);
}

void ffd_obj_document_walk_block(const obj_document *d, size_t block, obj_walk *walk)
{
    walk_blocks(d, block, block, walk);
}

void ffd_obj_document_walk_users(const obj_document *d, obj_walk *walk)
{
    size_t first = 0;
    while (first + 1 < d->blocks.count && !d->blocks.list[first].names_elements)
        first++;
    walk_blocks(d, first, d->blocks.count - 1, walk);
}

void ffd_obj_forget_block(const obj_document *d, size_t block)
{
    const obj_block *const b = &d->blocks.list[block];
    ffd_file_release_pages(&d->file.input, (const unsigned char *)b->first, (size_t)(b->last - b->first));
}

ffd_status ffd_obj_list_linked(const mesh_document *document, path_list *files, ffd_error *error)
{
    const obj_document *const d = ffd_obj_of(document);
    return d->names_files && d->file.path ? ffd_obj_find_linked(&d->file.input, d->file.path, files, error)
                                          : FFD_OK;
}
