#include "base/memory.h"
#include "io/obj/obj_document.h"
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

static ffd_status check_index(const obj_document *d, const obj_scan *scan, obj_index index, obj_count count,
                              const char *kind, size_t *element, ffd_error *error)
{
    if (ffd_obj_find(index.value, count, element))
        return FFD_OK;
    const int shown = ffd_text_shown(index.text);
    if (index.value == 0)
        return ffd_fail_line(error, FFD_E_INVALID, d->name, scan->line, "%s index %.*s: the first is 1", kind,
                             shown, index.text.first);
    if (index.value < 0)
        return ffd_fail_line(error, FFD_E_INVALID, d->name, scan->line,
                             "%s index %.*s is out of range: %zu stand before", kind, shown, index.text.first,
                             count.seen);
    return ffd_fail_line(error, FFD_E_INVALID, d->name, scan->line,
                         "%s index %.*s is out of range: the file has %zu", kind, shown, index.text.first,
                         count.total);
}

/* A `vn` added before an index that counts back would change its meaning: the file's end is then the place.
 */
static void note_negative_normal(obj_document *d, const obj_corner *corner)
{
    if (corner->normal.value < 0)
        d->addition = d->input.size;
}

/* What is left alone may name normals too (surf). */
static void look_for_corners(obj_document *d, obj_scan *scan)
{
    text_word word;
    obj_corner corner;
    while (ffd_obj_scan_word(scan, &word))
        if (ffd_obj_corner(word, &corner))
            note_negative_normal(d, &corner);
}

/* Checks the corners of a face, line or point. Those of faces are counted, and those with a normal for their
   vertex: in pair_start[vertex + 1]. Only what is used is refused: a texcoord's index is not, nor a normal's
   in a file without any `vn`, as some tools write that leave the normals out. */
static ffd_status check_corners(obj_document *d, obj_walk *walk, uint64_t *with_normal, ffd_error *error)
{
    obj_scan *scan = &walk->scan;
    text_word word;
    obj_corner corner;
    while (ffd_obj_scan_word(scan, &word)) {
        size_t vertex, normal;
        if (!ffd_obj_corner(word, &corner))
            return ffd_fail_line(error, FFD_E_INVALID, d->name, scan->line,
                                 "not a corner (v, v/t, v//n or v/t/n): \"%.*s\"", ffd_text_shown(word),
                                 word.first);
        ffd_status status = check_index(d, scan, corner.vertex, walk->vertices, "vertex", &vertex, error);
        if (status)
            return status;
        note_negative_normal(d, &corner);
        if (scan->keyword != OBJ_FACE)
            continue;
        d->corners++;
        if (corner.normal.text.first == corner.normal.text.last || d->normals == 0)
            continue;
        status = check_index(d, scan, corner.normal, walk->normals, "normal", &normal, error);
        if (status)
            return status;
        if (++*with_normal > UINT32_MAX)
            return ffd_fail_line(error, FFD_E_LIMIT, d->name, scan->line,
                                 "more than %" PRIu32 " face corners with a normal", UINT32_MAX);
        d->pair_start[vertex + 1]++;
    }
    return FFD_OK;
}

static ffd_status check_statements(obj_document *d, uint64_t *with_normal, ffd_error *error)
{
    obj_walk walk;
    ffd_status status = FFD_OK;
    ffd_obj_document_walk_users(d, &walk);
    while (status == FFD_OK && ffd_obj_walk_next(&walk)) {
        switch (walk.scan.keyword) {
        case OBJ_NORMAL:
            ffd_obj_scan_finish(&walk.scan);
            d->addition = (size_t)(walk.scan.at - (const char *)d->input.data);
            break;
        case OBJ_FACE:
            d->faces++;
            status = check_corners(d, &walk, with_normal, error);
            break;
        case OBJ_LINE:
            d->lines++;
            status = check_corners(d, &walk, with_normal, error);
            break;
        case OBJ_POINT:
            d->points++;
            status = check_corners(d, &walk, with_normal, error);
            break;
        case OBJ_OTHER:
            look_for_corners(d, &walk.scan);
            break;
        default:
            break;
        }
    }
    return status;
}

static int compare_numbers(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Nearly all lists are a handful; a fan's hub may have millions. */
static void sort_numbers(uint32_t *numbers, size_t count)
{
    if (count > 16) {
        qsort(numbers, count, sizeof *numbers, compare_numbers);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        const uint32_t number = numbers[i];
        size_t j = i;
        for (; j > 0 && numbers[j - 1] > number; j--)
            numbers[j] = numbers[j - 1];
        numbers[j] = number;
    }
}

/* From pair_start[i + 1] = how many corners vertex i has to the place behind its last one. */
static void sum_counts(obj_document *d)
{
    for (size_t i = 0; i < d->vertices; i++)
        d->pair_start[i + 1] += d->pair_start[i];
}

/* Fills each vertex's list from its end, which leaves pair_start[i + 1] at the list's beginning. */
static void collect_normals(obj_document *d)
{
    obj_walk walk;
    obj_face_corner corner;
    ffd_obj_document_walk_users(d, &walk);
    while (ffd_obj_walk_next(&walk)) {
        if (walk.scan.keyword != OBJ_FACE)
            continue;
        while (ffd_obj_walk_corner(&walk, &corner))
            if (corner.has_normal)
                d->pair_normal[--d->pair_start[corner.vertex + 1]] = (uint32_t)corner.normal;
    }
}

/* Sorts each list and keeps each normal once; pair_start then has its final meaning. */
static void join_equal_normals(obj_document *d, size_t total)
{
    size_t kept = 0;
    for (size_t i = 0; i < d->vertices; i++) {
        const size_t first = d->pair_start[i + 1], last = i + 1 < d->vertices ? d->pair_start[i + 2] : total;
        sort_numbers(d->pair_normal + first, last - first);
        d->pair_start[i] = (uint32_t)kept;
        for (size_t p = first; p < last; p++)
            if (p == first || d->pair_normal[p] != d->pair_normal[p - 1])
                d->pair_normal[kept++] = d->pair_normal[p];
    }
    d->pair_start[d->vertices] = (uint32_t)kept;
    uint32_t *block = ffd_realloc(d->pair_normal, kept, sizeof *d->pair_normal);
    if (block)
        d->pair_normal = block;
}

ffd_status ffd_obj_read_faces(obj_document *d, ffd_error *error)
{
    uint64_t with_normal = 0;
    d->pair_start = ffd_alloc_zero(d->vertices + 1, sizeof *d->pair_start);
    if (!d->pair_start)
        return ffd_fail_memory(error);
    const ffd_status status = check_statements(d, &with_normal, error);
    if (status)
        return status;
    if (with_normal == 0) {
        ffd_free(d->pair_start);
        d->pair_start = NULL;
        return FFD_OK;
    }
    d->pair_normal = ffd_alloc((size_t)with_normal, sizeof *d->pair_normal);
    if (!d->pair_normal)
        return ffd_fail_memory(error);
    sum_counts(d);
    collect_normals(d);
    join_equal_normals(d, (size_t)with_normal);
    return FFD_OK;
}

/* The normal's place in the vertex's ascending list. */
size_t ffd_obj_find_pair(const obj_document *d, const obj_face_corner *corner)
{
    size_t low = d->pair_start[corner->vertex], high = d->pair_start[corner->vertex + 1];
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        if (d->pair_normal[middle] <= corner->normal)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static void fill_faces(const obj_document *d, mesh_faces *faces)
{
    obj_walk walk;
    obj_face_corner corner;
    size_t face = 0, count = 0;
    ffd_obj_document_walk_users(d, &walk);
    while (ffd_obj_walk_next(&walk)) {
        if (walk.scan.keyword != OBJ_FACE)
            continue;
        faces->start[face++] = count;
        while (ffd_obj_walk_corner(&walk, &corner))
            faces->corners[count++] = (uint32_t)corner.vertex;
    }
    faces->start[face] = count;
}

ffd_status ffd_obj_faces(const mesh_document *document, mesh_faces *faces, ffd_error *error)
{
    const obj_document *d = ffd_obj_of(document);
    *faces = (mesh_faces){
        .vertex_count = d->vertices, .face_count = d->faces, .lines = d->lines, .points = d->points};
    const ffd_status status = ffd_mesh_faces_make(document, faces, d->corners, error);
    if (status)
        return status;
    ffd_obj_read_positions(document, 0, 0, d->vertices, faces->positions);
    fill_faces(d, faces);
    return FFD_OK;
}

ffd_status ffd_obj_corner_normals(const mesh_document *document, const mesh_faces *faces, uint32_t *normals,
                                  ffd_error *error)
{
    const obj_document *d = ffd_obj_of(document);
    obj_walk walk;
    obj_face_corner corner;
    (void)faces; /* they are read again, in the same order */
    (void)error;
    ffd_obj_document_walk_users(d, &walk);
    while (ffd_obj_walk_next(&walk))
        while (walk.scan.keyword == OBJ_FACE && ffd_obj_walk_corner(&walk, &corner))
            *normals++ = corner.has_normal ? (uint32_t)ffd_obj_find_pair(d, &corner) : MESH_NO_NORMAL;
    return FFD_OK;
}
