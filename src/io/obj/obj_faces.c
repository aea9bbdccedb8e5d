#include "base/memory.h"
#include "base/thread.h"
#include "io/obj/obj_document.h"
#include <inttypes.h>
#include <stdatomic.h>
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

/* A normal that is named together with a vertex, whichever thread came first; OBJ_NONE: none so far. Nearly
   all vertices of most meshes have but one. */
typedef _Atomic uint32_t first_normal;

/* A corner's vertex and normal, from 0. */
typedef struct vertex_normal {
    uint32_t vertex, normal;
} vertex_normal;

/* What the faces, lines and points of one block are. */
typedef struct block_faces {
    size_t faces, corners, lines, points; /* corners: of faces */
    first_normal *firsts;                 /* of the document; may be NULL */
    vertex_normal *others;                /* corners of faces with a normal that is not their vertex' first */
    size_t count, capacity;
    size_t counts_back; /* the place behind the last index of a normal that does; 0: none */
    ffd_status status;
} block_faces;

typedef struct reader {
    const obj_document *document;
    first_normal *firsts; /* of each vertex; NULL: no normals are held */
    block_faces *blocks;
} reader;

static void note_index(const obj_document *d, const obj_scan *scan, const obj_corner *corner,
                       block_faces *block)
{
    if (corner->normal.value < 0)
        block->counts_back = (size_t)(scan->at - (const char *)d->input.data);
}

/* What is left alone may name normals too (surf). */
static void look_for_corners(const obj_document *d, obj_scan *scan, block_faces *block)
{
    text_word word;
    obj_corner corner;
    while (ffd_obj_scan_word(scan, &word))
        if (ffd_obj_corner(word, &corner))
            note_index(d, scan, &corner, block);
}

/* Whether the normal is the vertex' first one. */
static bool is_first(first_normal *first, uint32_t normal)
{
    uint32_t there = atomic_load_explicit(first, memory_order_relaxed);
    if (there == OBJ_NONE && atomic_compare_exchange_strong_explicit(
                                 first, &there, normal, memory_order_relaxed, memory_order_relaxed))
        return true;
    return there == normal;
}

static ffd_status add_normal(const obj_document *d, const obj_walk *walk, size_t vertex,
                             const obj_index *index, block_faces *block, ffd_error *error)
{
    size_t normal;
    const ffd_status status = check_index(d, &walk->scan, *index, walk->normals, "normal", &normal, error);
    if (status || !block->firsts || is_first(&block->firsts[vertex], (uint32_t)normal))
        return status;
    if (!ffd_grow((void **)&block->others, &block->capacity, block->count + 1, sizeof *block->others))
        return ffd_fail_memory(error);
    block->others[block->count++] = (vertex_normal){(uint32_t)vertex, (uint32_t)normal};
    return FFD_OK;
}

/* Checks the corners of a face, line or point. Only what is used is refused: a texcoord's index is not, nor a
   normal's in a file without any `vn`, as some tools write that leave the normals out. */
static ffd_status check_corners(const obj_document *d, obj_walk *walk, block_faces *block, ffd_error *error)
{
    obj_scan *scan = &walk->scan;
    const bool is_face = scan->keyword == OBJ_FACE;
    text_word word;
    obj_corner corner;
    ffd_status status = FFD_OK;
    while (status == FFD_OK && !ffd_obj_scan_is_over(scan)) {
        size_t vertex;
        const bool plain = ffd_obj_scan_corner(scan, &corner);
        if (!plain && !ffd_obj_scan_word(scan, &word))
            return FFD_OK;
        if (!plain && !ffd_obj_corner(word, &corner))
            return ffd_fail_line(error, FFD_E_INVALID, d->name, scan->line,
                                 "not a corner (v, v/t, v//n or v/t/n): \"%.*s\"", ffd_text_shown(word),
                                 word.first);
        status = check_index(d, scan, corner.vertex, walk->vertices, "vertex", &vertex, error);
        note_index(d, scan, &corner, block);
        block->corners += is_face;
        if (status == FFD_OK && is_face && d->normals > 0 &&
            corner.normal.text.first < corner.normal.text.last)
            status = add_normal(d, walk, vertex, &corner.normal, block, error);
    }
    return status;
}

static ffd_status read_block(const obj_document *d, size_t number, block_faces *block, ffd_error *error)
{
    obj_walk walk;
    ffd_status status = FFD_OK;
    ffd_obj_document_walk_block(d, number, &walk);
    while (status == FFD_OK && ffd_obj_walk_next(&walk)) {
        switch (walk.scan.keyword) {
        case OBJ_FACE:
            block->faces++;
            status = check_corners(d, &walk, block, error);
            break;
        case OBJ_LINE:
            block->lines++;
            status = check_corners(d, &walk, block, error);
            break;
        case OBJ_POINT:
            block->points++;
            status = check_corners(d, &walk, block, error);
            break;
        case OBJ_OTHER:
            look_for_corners(d, &walk.scan, block);
            break;
        default:
            break;
        }
    }
    return status;
}

static void read_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const reader *r = context;
    (void)tile;
    (void)worker;
    for (size_t i = first; i < last; i++) {
        const obj_block *text = &r->document->blocks.list[i];
        block_faces block = {.firsts = r->firsts}; /* the thread's own: the list's share lines of the cache */
        if (!text->names_elements)
            continue;
        block.status = read_block(r->document, i, &block, NULL);
        r->blocks[i] = block;
        ffd_file_forget(&r->document->input, text->first, (size_t)(text->last - text->first));
    }
}

/* Reads a block that has failed again for the words. */
static ffd_status find_failure(const obj_document *d, size_t number, ffd_status status, ffd_error *error)
{
    block_faces block = {0};
    if (status == FFD_E_MEMORY)
        return ffd_fail_memory(error);
    status = read_block(d, number, &block, error);
    return status ? status : ffd_fail_file(error, FFD_E_IO, d->name, "changes while it is read");
}

static uint32_t first_of(const reader *r, size_t vertex)
{
    return atomic_load_explicit(&r->firsts[vertex], memory_order_relaxed);
}

/* Sums up what the blocks have, but for normals. A `vn` added before an index that counts back would change
   its meaning: where one stands behind the last `vn`, the file's end is the place. */
static ffd_status join_blocks(obj_document *d, const block_faces *blocks, ffd_error *error)
{
    for (size_t i = 0; i < d->blocks.count; i++) {
        const block_faces *block = &blocks[i];
        if (block->status)
            return find_failure(d, i, block->status, error);
        d->faces += block->faces;
        d->corners += block->corners;
        d->lines += block->lines;
        d->points += block->points;
        d->addition = block->counts_back > d->addition ? d->input.size : d->addition;
    }
    return FFD_OK;
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

/* How many normals the lists of all vertices have, with repetitions. */
static uint64_t count_normals(const reader *r, uint64_t *others)
{
    uint64_t firsts = 0;
    for (size_t i = 0; i < r->document->vertices; i++)
        firsts += first_of(r, i) != OBJ_NONE;
    *others = 0;
    for (size_t b = 0; b < r->document->blocks.count; b++)
        *others += r->blocks[b].count;
    return firsts + *others;
}

/* Where no vertex has more than one. */
static void take_firsts(obj_document *d, const reader *r)
{
    uint32_t count = 0;
    for (size_t i = 0; i < d->vertices; i++) {
        const uint32_t first = first_of(r, i);
        d->pair_start[i] = count;
        if (first != OBJ_NONE)
            d->pair_normal[count++] = first;
    }
    d->pair_start[d->vertices] = count;
}

/* Counts the normals of each vertex, and fills each vertex's list from its end, which leaves pair_start[i +
   1] at the list's beginning. */
static void collect_normals(obj_document *d, const reader *r)
{
    for (size_t i = 0; i < d->vertices; i++)
        d->pair_start[i + 1] = first_of(r, i) != OBJ_NONE;
    for (size_t b = 0; b < d->blocks.count; b++)
        for (size_t i = 0; i < r->blocks[b].count; i++)
            d->pair_start[r->blocks[b].others[i].vertex + 1]++;
    for (size_t i = 0; i < d->vertices; i++)
        d->pair_start[i + 1] += d->pair_start[i];
    for (size_t i = 0; i < d->vertices; i++)
        if (first_of(r, i) != OBJ_NONE)
            d->pair_normal[--d->pair_start[i + 1]] = first_of(r, i);
    for (size_t b = 0; b < d->blocks.count; b++)
        for (size_t i = 0; i < r->blocks[b].count; i++) {
            const vertex_normal *other = &r->blocks[b].others[i];
            d->pair_normal[--d->pair_start[other->vertex + 1]] = other->normal;
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

static ffd_status make_pairs(const reader *r, obj_document *d, ffd_error *error)
{
    uint64_t others;
    const uint64_t count = count_normals(r, &others);
    if (count == 0)
        return FFD_OK;
    if (count > UINT32_MAX)
        return ffd_fail_file(error, FFD_E_LIMIT, d->name, "more than %" PRIu32 " face corners with a normal",
                             UINT32_MAX);
    d->pair_start = ffd_alloc_zero(d->vertices + 1, sizeof *d->pair_start);
    d->pair_normal = ffd_alloc((size_t)count, sizeof *d->pair_normal);
    if (!d->pair_start || !d->pair_normal)
        return ffd_fail_memory(error);
    if (others == 0) {
        take_firsts(d, r);
        return FFD_OK;
    }
    collect_normals(d, r);
    join_equal_normals(d, (size_t)count);
    return FFD_OK;
}

static ffd_status read_blocks(reader *r, obj_document *d, ffd_error *error)
{
    const bool normals = d->normals > 0 && !d->only_positions;
    r->firsts = normals ? ffd_alloc(d->vertices, sizeof *r->firsts) : NULL;
    if (normals && !r->firsts)
        return ffd_fail_memory(error);
    for (size_t i = 0; normals && i < d->vertices; i++)
        atomic_init(&r->firsts[i], OBJ_NONE);
    ffd_parallel_tiles(d->blocks.count, 1, d->threads, read_tile, r);
    const ffd_status status = join_blocks(d, r->blocks, error);
    return status || !normals ? status : make_pairs(r, d, error);
}

ffd_status ffd_obj_read_faces(obj_document *d, ffd_error *error)
{
    reader r = {.document = d, .blocks = ffd_alloc_zero(d->blocks.count, sizeof *r.blocks)};
    const ffd_status status = r.blocks ? read_blocks(&r, d, error) : ffd_fail_memory(error);
    for (size_t i = 0; r.blocks && i < d->blocks.count; i++)
        ffd_free(r.blocks[i].others);
    ffd_free(r.blocks);
    ffd_free(r.firsts);
    return status;
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
