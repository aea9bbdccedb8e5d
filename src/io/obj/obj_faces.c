#include "io/obj/obj_faces.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "io/obj/obj_corner.h"
#include "io/obj/obj_vectors.h"
#include "mesh/face_filler.h"
#include "mesh/mixed_faces.h"
#include <inttypes.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

/* Adds up the counts of the blocks, except those of normals. A `vn` added before an index that counts back
   would change the meaning of that index: if there is such an index after the last `vn`, new ones are added
   at the end of the file. */
static void join_blocks(obj_document *d, const obj_users *users)
{
    for (size_t i = 0; i < d->blocks.count; i++) {
        const obj_block_users *block = &users->blocks[i];
        d->corners += block->corners;
        d->lines += block->lines;
        d->points += block->points;
        d->addition = block->counts_back > d->addition ? d->end : d->addition;
    }
}

static int compare_indices(const void *a, const void *b)
{
    const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return (x > y) - (x < y);
}

/* Nearly all lists are a handful; a fan's hub may have millions. */
static void sort_indices(uint32_t *indices, size_t count)
{
    if (count > 16) {
        qsort(indices, count, sizeof *indices, compare_indices);
        return;
    }
    for (size_t i = 1; i < count; i++) {
        const uint32_t index = indices[i];
        size_t j = i;
        for (; j > 0 && indices[j - 1] > index; j--)
            indices[j] = indices[j - 1];
        indices[j] = index;
    }
}

/* Vertices whose first normals a thread looks at at a time. */
#define TILE ((size_t)1 << 14)

/* The first normals, one after the other. */
typedef struct first_list {
    obj_document *document;
    const obj_users *users;
    uint32_t *counts; /* of each tile, then of all tiles before it */
} first_list;

static void count_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const first_list *list = context;
    uint32_t count = 0;
    (void)worker;
    for (size_t i = first; i < last; i++)
        count += ffd_obj_first_normal(list->users, i) != 0;
    list->counts[tile] = count;
}

/* For meshes in which no vertex has more than one normal. */
static void take_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const first_list *list = context;
    obj_document *d = list->document;
    uint32_t count = list->counts[tile];
    (void)worker;
    for (size_t i = first; i < last; i++) {
        const uint32_t normal = ffd_obj_first_normal(list->users, i);
        d->pair_start[i] = count;
        if (normal)
            d->pair_normal[count++] = normal - 1;
    }
}

/* Counts the normals of each vertex, and fills each vertex's list from its end, which leaves pair_start[i +
   1] at the list's beginning. */
static void collect_normals(obj_document *d, const obj_users *users)
{
    for (size_t i = 0; i < d->vertices; i++)
        d->pair_start[i + 1] = ffd_obj_first_normal(users, i) != 0;
    for (size_t b = 0; b < d->blocks.count; b++)
        for (size_t i = 0; i < users->blocks[b].other_count; i++)
            d->pair_start[users->blocks[b].others[i].vertex + 1]++;
    for (size_t i = 0; i < d->vertices; i++)
        d->pair_start[i + 1] += d->pair_start[i];
    for (size_t i = 0; i < d->vertices; i++)
        if (ffd_obj_first_normal(users, i))
            d->pair_normal[--d->pair_start[i + 1]] = ffd_obj_first_normal(users, i) - 1;
    for (size_t b = 0; b < d->blocks.count; b++)
        for (size_t i = 0; i < users->blocks[b].other_count; i++) {
            const obj_vertex_normal *other = &users->blocks[b].others[i];
            d->pair_normal[--d->pair_start[other->vertex + 1]] = other->normal;
        }
}

/* Sorts each list and keeps each normal once; pair_start then has its final meaning. */
static void join_equal_normals(obj_document *d, size_t total)
{
    size_t kept = 0;
    for (size_t i = 0; i < d->vertices; i++) {
        const size_t first = d->pair_start[i + 1], last = i + 1 < d->vertices ? d->pair_start[i + 2] : total;
        sort_indices(d->pair_normal + first, last - first);
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

/* How many normals the lists of all vertices have, with repetitions. */
static uint64_t count_normals(first_list *list, uint64_t *others)
{
    const obj_document *d = list->document;
    uint64_t firsts = 0;
    ffd_parallel_tiles(d->vertices, TILE, d->threads, count_tile, list);
    for (size_t tile = 0; tile * TILE < d->vertices; tile++) {
        const uint32_t count = list->counts[tile];
        list->counts[tile] = (uint32_t)firsts;
        firsts += count;
    }
    *others = 0;
    for (size_t b = 0; b < d->blocks.count; b++)
        *others += list->users->blocks[b].other_count;
    return firsts + *others;
}

static ffd_status make_lists(first_list *list, ffd_error *error)
{
    obj_document *d = list->document;
    uint64_t others;
    const uint64_t count = count_normals(list, &others);
    if (count == 0)
        return FFD_OK;
    if (count > UINT32_MAX)
        return ffd_fail_file(error, FFD_E_LIMIT, d->file.name,
                             "more than %" PRIu32 " face corners with a normal", UINT32_MAX);
    d->pair_start = ffd_alloc_zero(d->vertices + 1, sizeof *d->pair_start);
    d->pair_normal = ffd_alloc((size_t)count, sizeof *d->pair_normal);
    if (!d->pair_start || !d->pair_normal)
        return ffd_fail_memory(error);
    if (others == 0) {
        ffd_parallel_tiles(d->vertices, TILE, d->threads, take_tile, list);
        d->pair_start[d->vertices] = (uint32_t)count;
        return FFD_OK;
    }
    collect_normals(d, list->users);
    join_equal_normals(d, (size_t)count);
    return FFD_OK;
}

static ffd_status make_pairs(const obj_users *users, obj_document *d, ffd_error *error)
{
    first_list list = {d, users, ffd_alloc(d->vertices / TILE + 1, sizeof *list.counts)};
    const ffd_status status = list.counts ? make_lists(&list, error) : ffd_fail_memory(error);
    ffd_free(list.counts);
    return status;
}

ffd_status ffd_obj_read_faces(obj_document *d, obj_users *users, ffd_error *error)
{
    TRY(ffd_obj_users_finish(d, users, error));
    join_blocks(d, users);
    return users->firsts ? make_pairs(users, d, error) : FFD_OK;
}

static bool is_normal_up_to(const void *element, const void *normal)
{
    return *(const uint32_t *)element <= *(const size_t *)normal;
}

bool ffd_obj_find_pair(const obj_document *d, const obj_face_corner *corner, size_t *pair)
{
    if (!corner->has_normal || !d->pair_start)
        return false;
    /* The vertex's list is ascending. */
    const size_t first = d->pair_start[corner->vertex], end = d->pair_start[corner->vertex + 1];
    *pair = first + last_up_to(&corner->normal, d->pair_normal + first, end - first, sizeof *d->pair_normal,
                               is_normal_up_to);
    return *pair < end && d->pair_normal[*pair] == corner->normal;
}

/* The most corners of a face that is read without care. */
#define PLAIN_CORNERS 8

static const char *find_word_end(const char *c, const char *last)
{
    for (; last - c >= 8; c += 8) {
        const uint64_t low = bytes_low(load_u64((const unsigned char *)c));
        if (low)
            return c + __builtin_ctzll(low) / 8;
    }
    while (c < last && (unsigned char)*c > ' ')
        c++;
    return c;
}

/* Reads the corner at c, whose vertex has at most seven digits and counts from the file's first one. Returns
   the end of its word; NULL if it has to be read with care. */
static ALWAYS_INLINE const char *read_plain_corner(const char *c, const char *last, size_t vertices,
                                                   uint32_t *vertex)
{
    const uint64_t eight = load_u64((const unsigned char *)c), others = bytes_not_digits(eight);
    const int digits = others ? __builtin_ctzll(others) / 8 : 8;
    if (digits == 0 || digits == 8)
        return NULL;
    const uint64_t number = bytes_number((eight ^ '0' * BYTES_ONES) << (64 - 8 * digits));
    if (number - 1 >= vertices)
        return NULL;
    *vertex = (uint32_t)(number - 1);
    c += digits;
    return (unsigned char)*c <= ' ' ? c : find_word_end(c, last);
}

/* Takes the next statement if it is a face that is plainly written: as nearly all are, in one pass over its
   line. Its corners were checked when the file was opened. Returns the number of its vertices; 0 if there is
   another statement, which is not taken. */
static size_t take_plain_face(const obj_document *d, obj_walk *walk, uint32_t vertices[PLAIN_CORNERS])
{
    obj_scan *const scan = &walk->scan;
    size_t count = 0;
    ffd_obj_scan_finish(scan);
    const char *c = scan->at, *const last = scan->last;
    if (!scan->plain || last - c < 2 || c[0] != 'f' || c[1] != ' ' || walk->faces.seen == walk->faces.total)
        return 0;
    for (c++; last - c > 8; count++) {
        while (last - c > 8 && (*c == ' ' || *c == '\t'))
            c++;
        if (*c == '\n')
            break;
        if (count == PLAIN_CORNERS || !(c = read_plain_corner(c, last, d->vertices, &vertices[count])))
            return 0;
    }
    if (last - c <= 8 || count == 0)
        return 0;
    scan->at = c + 1;
    scan->line++;
    walk->faces.seen++;
    return count;
}

static ffd_status fill_faces(const obj_document *d, mesh_faces *faces, ffd_error *error)
{
    obj_walk walk;
    obj_face_corner corner;
    uint32_t plain[PLAIN_CORNERS];
    face_filler filler = {.faces = faces, .corners = d->corners};
    ffd_obj_document_walk_users(d, &walk);
    while (!filler.ends) {
        const size_t count = take_plain_face(d, &walk, plain);
        if (count == 0 && !ffd_obj_walk_next(&walk))
            break;
        if (count == 0 && walk.scan.keyword != OBJ_FACE)
            continue;
        ffd_filler_face(&filler);
        for (size_t i = 0; i < count; i++)
            ffd_filler_corner(&filler, plain[i]);
        while (count == 0 && ffd_obj_walk_corner(&walk, &corner))
            ffd_filler_corner(&filler, corner.vertex);
    }
    return ffd_filler_end(&filler, d->file.name, error);
}

ffd_status ffd_obj_faces(const mesh_document *document, mesh_state state, mesh_faces *faces, ffd_error *error)
{
    const obj_document *d = ffd_obj_of(document);
    (void)state;
    *faces = (mesh_faces){
        .vertex_count = d->vertices, .face_count = d->faces, .lines = d->lines, .points = d->points};
    TRY(ffd_mesh_faces_make(document, faces, d->corners, error));
    if (d->file.new_positions && d->file.new_positions == d->file.positions)
        ffd_obj_read_again(d, NULL, 0, faces->positions);
    else
        ffd_obj_read(document, 0, MESH_POSITIONS, MESH_STORED, 0, d->vertices, faces->positions);
    return fill_faces(d, faces, error);
}

typedef struct mixed_search {
    const obj_document *document;
    vertex_marks marks;
    face_list *lists; /* of each block */
} mixed_search;

static void search_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const mixed_search *const search = context;
    face_list list = {0};
    obj_walk walk;
    obj_face_corner corner;
    uint32_t plain[PLAIN_CORNERS];
    (void)tile;
    (void)last;
    (void)worker;
    if (!search->document->blocks.list[first].names_elements)
        return;
    ffd_obj_document_walk_block(search->document, first, &walk);
    while (!list.failed) {
        const size_t count = take_plain_face(search->document, &walk, plain);
        if (count == 0 && !ffd_obj_walk_next(&walk))
            break;
        if (count > 0 ? !ffd_marks_differ(&search->marks, plain, count) : walk.scan.keyword != OBJ_FACE)
            continue;
        for (size_t i = 0; i < count; i++)
            ffd_face_list_corner(&list, plain[i]);
        while (count == 0 && ffd_obj_walk_corner(&walk, &corner))
            ffd_face_list_corner(&list, (uint32_t)corner.vertex);
        ffd_face_list_end(&list, &search->marks);
    }
    search->lists[first] = list;
    ffd_obj_forget_block(search->document, first);
}

static ffd_status find_mixed(mixed_search *search, mesh_faces *faces, ffd_error *error)
{
    const obj_document *const d = search->document;
    ffd_parallel_tiles(d->blocks.count, 1, d->threads, search_tile, search);
    TRY(ffd_face_lists_narrow(&d->file.base, search->lists, d->blocks.count, faces, error));
    ffd_obj_read_again(d, faces->vertices, faces->vertex_count, faces->positions);
    return FFD_OK;
}

ffd_status ffd_obj_mixed_faces(const mesh_document *document, mesh_state state, const vertex_marks *marks,
                               mesh_faces *faces, ffd_error *error)
{
    const obj_document *const d = ffd_obj_of(document);
    mixed_search search = {d, *marks, ffd_alloc_zero(d->blocks.count, sizeof *search.lists)};
    (void)state;
    *faces = (mesh_faces){.vertex_count = d->vertices};
    const ffd_status status = search.lists ? find_mixed(&search, faces, error) : ffd_fail_memory(error);
    for (size_t b = 0; search.lists && b < d->blocks.count; b++)
        ffd_free(search.lists[b].words);
    ffd_free(search.lists);
    return status;
}

ffd_status ffd_obj_corner_normals(const mesh_document *document, const mesh_faces *faces, uint32_t *normals,
                                  ffd_error *error)
{
    const obj_document *d = ffd_obj_of(document);
    obj_walk walk;
    obj_face_corner corner;
    const size_t count = faces->start[faces->face_count]; /* they are read again, in the same order */
    size_t found = 0, pair;
    ffd_obj_document_walk_users(d, &walk);
    while (ffd_obj_walk_next(&walk))
        while (walk.scan.keyword == OBJ_FACE && ffd_obj_walk_corner(&walk, &corner)) {
            if (found == count || corner.vertex != faces->corners[found])
                return ffd_faces_changed(d->file.name, error);
            if (ffd_obj_find_pair(d, &corner, &pair) != corner.has_normal)
                return ffd_faces_changed(d->file.name, error);
            normals[found++] = corner.has_normal ? (uint32_t)pair : MESH_NO_NORMAL;
        }
    return found == count ? FFD_OK : ffd_faces_changed(d->file.name, error);
}

/* Sets the byte of a vertex, as other threads may do at the same time. */
static void mark(const obj_document *d, size_t vertex)
{
    atomic_store_explicit((_Atomic uint8_t *)&d->file.used[vertex], 1, memory_order_relaxed);
}

static void mark_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const obj_document *const d = context;
    obj_walk walk;
    obj_face_corner corner;
    uint32_t plain[PLAIN_CORNERS];
    (void)tile;
    (void)last;
    (void)worker;
    if (!d->blocks.list[first].names_elements)
        return;
    ffd_obj_document_walk_block(d, first, &walk);
    while (true) {
        const size_t count = take_plain_face(d, &walk, plain);
        if (count == 0 && !ffd_obj_walk_next(&walk))
            break;
        if (count == 0 && !ffd_obj_walk_uses(&walk))
            continue;
        for (size_t i = 0; i < count; i++)
            mark(d, plain[i]);
        while (count == 0 && ffd_obj_walk_corner(&walk, &corner))
            mark(d, corner.vertex);
    }
    ffd_obj_forget_block(d, first);
}

ffd_status ffd_obj_mark_used(mesh_document *document, ffd_error *error)
{
    obj_document *const d = (obj_document *)document;
    TRY(ffd_used_make(document, d->vertices, &d->file.used, error));
    ffd_parallel_tiles(d->blocks.count, 1, d->threads, mark_tile, d);
    if (ffd_used_keep(document, d->vertices, &d->file.used))
        d->file.part.used = d->file.used;
    return FFD_OK;
}
