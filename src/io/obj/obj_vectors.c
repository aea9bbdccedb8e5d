#include "io/obj/obj_vectors.h"
/* obj_vectors.c - the blocks of a file with their positions and normals. */
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "io/obj/obj_number.h"
#include "io/obj/resource/obj_linked.h"
#include <inttypes.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>

/* So many blocks at least, for threads to share, unless they would be smaller than that. */
#define BLOCKS 64
#define SMALLEST_BLOCK ((size_t)16 * 1024)
#define LARGEST_BLOCK ((size_t)1024 * 1024)

/* Elements of 3 numbers while they are being read. */
typedef struct vectors {
    double *xyz;
    size_t count, capacity;
} vectors;

/* What one block has. */
typedef struct block_content {
    vectors positions, normals;
    size_t texcoords, faces, lines;
    obj_oddity loose, joined; /* as in obj_scan; lines count from the block's first, 0 */
    obj_unknown unknown;      /* likewise */
    bool names_files;
    size_t addition; /* offset in the file after the last `vn`; 0: none */
    obj_block_users users;
    bool names_elements, names_groups;
    ffd_status status;
} block_content;

typedef struct reader {
    obj_document *document;
    obj_users *users;
    block_content *contents; /* of blocks that are not joined yet */
    /* Counts before the next block; the document gets them when no thread reads it any more. */
    size_t line, vertices, texcoords, normals, faces;
    obj_oddity loose, joined; /* as in obj_scan */
    size_t released;          /* bytes of the file whose pages are released (ffd_file_release_until) */
    size_t failed;            /* the first block that could not be read; SIZE_MAX: none so far */
    ffd_status status;        /* of that block */
    atomic_bool is_over;
} reader;

/* Positions that are read for the second time. */
typedef struct again {
    const obj_document *document;
    const uint32_t *wanted; /* NULL: all */
    size_t count;
    double *xyz;
} again;

/* Reads a number that was valid the first time. */
static void read_number(obj_scan *scan, double *value)
{
    text_word word;
    if (!ffd_obj_scan_number(scan, value) && !(ffd_obj_scan_word(scan, &word) && ffd_obj_number(word, value)))
        *value = NAN;
}

static ffd_status read_vector(const obj_document *d, obj_scan *scan, const char *what, vectors *list,
                              ffd_error *error)
{
    text_word word;
    if (!ffd_grow((void **)&list->xyz, &list->capacity, list->count + 1, 3 * sizeof *list->xyz))
        return ffd_fail_memory(error);
    double *const xyz = list->xyz + 3 * list->count;
    const bool at_once = ffd_obj_scan_numbers(scan, xyz);
    for (int a = 0; a < 3 && !at_once; a++) {
        double *value = &xyz[a];
        if (ffd_obj_scan_number(scan, value))
            continue;
        if (!ffd_obj_scan_word(scan, &word))
            return ffd_fail_line(error, FFD_E_INVALID, d->file.name, scan->keyword_line,
                                 "a %s needs 3 numbers, found %d", what, a);
        if (!ffd_obj_number(word, value))
            return ffd_fail_line(error, FFD_E_INVALID, d->file.name, scan->line,
                                 "coordinate %c of a %s is not a number: \"%.*s\"", "xyz"[a], what,
                                 ffd_text_display_size(word), word.first);
    }
    list->count++;
    return FFD_OK;
}

/* Whether a statement may name elements by their numbers. */
static bool may_name_elements(obj_keyword keyword)
{
    return keyword == OBJ_FACE || keyword == OBJ_LINE || keyword == OBJ_POINT || keyword == OBJ_OTHER;
}

static ffd_status read_block(const reader *r, size_t block, block_content *content, ffd_error *error)
{
    const obj_document *d = r->document;
    obj_walk walk;
    ffd_status status = FFD_OK;
    ffd_obj_document_walk_block(d, block, &walk);
    const size_t line = walk.scan.line;
    while (ffd_obj_scan_next(&walk.scan)) { /* totals are not known yet */
        const obj_keyword keyword = walk.scan.keyword;
        content->faces += keyword == OBJ_FACE;
        content->texcoords += keyword == OBJ_TEXCOORD;
        content->names_files =
            content->names_files || (keyword == OBJ_OTHER && ffd_obj_names_file(walk.scan.name));
        if (keyword == OBJ_OTHER && !ffd_obj_is_known(walk.scan.name) && content->unknown.count++ == 0) {
            content->unknown.line = walk.scan.keyword_line - line;
            content->unknown.name = walk.scan.name;
        }
        if (may_name_elements(keyword)) {
            content->names_elements = true;
            ffd_obj_users_scan(d, r->users, &walk.scan, &content->users);
        } else if (keyword == OBJ_VERTEX) {
            TRY_END(read_vector(d, &walk.scan, "vertex", &content->positions, error));
        } else if (keyword == OBJ_NORMAL) {
            TRY_END(read_vector(d, &walk.scan, "normal", &content->normals, error));
            ffd_obj_scan_finish(&walk.scan);
            content->addition = (size_t)(walk.scan.at - (const char *)d->file.input.data);
        } else if (keyword == OBJ_GROUP || keyword == OBJ_OBJECT) {
            content->names_groups = true;
        }
    }
end:
    content->lines = walk.scan.line - line;
    content->loose = (obj_oddity){walk.scan.loose.count, walk.scan.loose.line - line};
    content->joined = (obj_oddity){walk.scan.joined.count, walk.scan.joined.line - line};
    return status;
}

static void clear_content(block_content *content)
{
    content->positions.count = content->normals.count = 0;
    ffd_obj_free_block_users(&content->users);
    *content = (block_content){.positions = content->positions, .normals = content->normals};
}

static void free_content(block_content *content)
{
    ffd_free(content->positions.xyz);
    ffd_free(content->normals.xyz);
    ffd_obj_free_block_users(&content->users);
}

static void read_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    reader *r = context;
    obj_block *block = &r->document->blocks.list[first];
    block_content content = r->contents[worker]; /* a local copy: entries of the list share cache lines */
    (void)tile;
    (void)last;
    clear_content(&content);
    if (!atomic_load(&r->is_over)) {
        ffd_file_prefault(block->first, (size_t)(block->last - block->first));
        block->plain = ffd_obj_is_plain(block->first, block->last);
        content.status = ffd_deadline_check(NULL);
        if (!content.status)
            content.status = read_block(r, first, &content, NULL);
    }
    r->contents[worker] = content;
}

/* A failure does no harm: the store then grows as it is filled. */
static void expect(size_t count, spill_array *store)
{
    const size_t size = count * OBJ_VECTOR;
    if (size > 0 && size < SPILL_FROM)
        (void)ffd_spill_grow(store, size);
}

/* Reserves memory for all elements at once, unless there are too many; what is missing is
   then allocated later. */
static ffd_status expect_elements(reader *r, ffd_error *error)
{
    obj_document *d = r->document;
    const size_t positions = d->blocks.vertices + d->blocks.vertices / 8;
    const size_t normals = d->blocks.normals + d->blocks.normals / 8;
    expect(positions, &d->position_store);
    if (!d->only_positions)
        expect(normals, &d->direction_store);
    return ffd_obj_users_begin(d, positions, normals, r->users, error);
}

static bool append(const vectors *from, size_t count, spill_array *to)
{
    const size_t size = from->count * OBJ_VECTOR, old = count * OBJ_VECTOR;
    if (!ffd_spill_grow(to, old + size))
        return false;
    if (size > 0)
        memcpy((char *)to->data + old, from->xyz, size);
    ffd_spill_release_pages(to, old, size);
    return true;
}

/* line: of the first line that `more` counts from. */
static void add_oddity(obj_oddity *sum, const obj_oddity *more, size_t line)
{
    if (sum->count == 0)
        sum->line = line + more->line;
    sum->count += more->count;
}

/* Sets the numbers of the first line and elements of the block, and takes over its content. */
static void join_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    reader *r = context;
    obj_document *d = r->document;
    obj_block *block = &d->blocks.list[first];
    block_content *content = &r->contents[worker];
    (void)tile;
    (void)last;
    ffd_file_release_until(&d->file.input, block->last, &r->released);
    if (r->failed != SIZE_MAX)
        return;
    block->line = r->line;
    block->vertices = r->vertices;
    block->texcoords = r->texcoords;
    block->normals = r->normals;
    block->faces = r->faces;
    block->names_elements = content->names_elements;
    block->names_groups = content->names_groups;
    r->status = content->status;
    if (r->status == FFD_OK &&
        (!append(&content->positions, r->vertices, &d->position_store) ||
         (!d->only_positions && !append(&content->normals, r->normals, &d->direction_store))))
        r->status = FFD_E_MEMORY;
    if (r->status) {
        r->failed = first;
        atomic_store(&r->is_over, true);
        return;
    }
    add_oddity(&r->loose, &content->loose, r->line);
    add_oddity(&r->joined, &content->joined, r->line);
    d->names_files = d->names_files || content->names_files;
    if (d->unknown.count == 0) {
        d->unknown = content->unknown;
        d->unknown.line += r->line;
    } else {
        d->unknown.count += content->unknown.count;
    }
    r->line += content->lines;
    r->faces += content->faces;
    r->vertices += content->positions.count;
    r->texcoords += content->texcoords;
    r->normals += content->normals.count;
    d->addition = content->addition ? content->addition : d->addition;
    r->users->blocks[first] = content->users;
    content->users = (obj_block_users){0};
}

/* Reads a block that has failed again, now that its position is known, for the error message. */
static ffd_status find_failure(const reader *r, ffd_error *error)
{
    block_content content = {0};
    TRY(ffd_deadline_check(error));
    if (r->status == FFD_E_MEMORY)
        return ffd_fail_memory(error);
    const ffd_status status = read_block(r, r->failed, &content, error);
    free_content(&content);
    return status ? status : ffd_file_document_changed(&r->document->file, error);
}

static ffd_status note_flaws(reader *r, ffd_error *error)
{
    obj_document *const d = r->document;
    TRY(ffd_file_document_note_mark(&d->file, d->end, error));
    for (size_t i = 0; i < r->loose.count; i++)
        TRY(ffd_flaw_line(&d->file.base.flaws, d->file.name, r->loose.line, error,
                          "blanks follow the backslash at the end of the line: it goes on in the next"));
    for (size_t i = 0; i < r->joined.count; i++)
        TRY(ffd_flaw_line(&d->file.base.flaws, d->file.name, r->joined.line, error,
                          "the backslash at the end of the line joins the next one to it, which seems to be "
                          "a statement of its own"));
    return FFD_OK;
}

static ffd_status check_counts(const obj_document *d, ffd_error *error)
{
    if (d->vertices <= OBJ_ELEMENTS_MAX && d->normals <= OBJ_ELEMENTS_MAX)
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_LIMIT, d->file.name,
                         "more vertices or normals than the limit of %" PRIu32, OBJ_ELEMENTS_MAX);
}

static ffd_status read_blocks(reader *r, ffd_error *error)
{
    obj_document *d = r->document;
    TRY(expect_elements(r, error));
    if (!ffd_parallel_in_order(d->blocks.count, 1, d->threads, read_tile, join_tile, r))
        return ffd_fail_memory(error);
    ffd_file_release_pages(&d->file.input, d->file.input.data + r->released,
                           d->file.input.size - r->released);
    d->vertices = r->vertices;
    d->texcoords = r->texcoords;
    d->normals = r->normals;
    d->faces = r->faces;
    d->joined_line = r->joined.count > 0 ? r->joined.line : 0;
    if (r->failed != SIZE_MAX)
        return find_failure(r, error);
    d->file.positions = d->position_store.data;
    d->file.directions = d->direction_store.data;
    const ffd_status counted = check_counts(d, error);
    return counted ? counted : note_flaws(r, error);
}

static ffd_status cut(obj_document *d, ffd_error *error)
{
    const char *first = (const char *)d->file.input.data;
    size_t target = d->file.input.size / BLOCKS;
    if (target < SMALLEST_BLOCK)
        target = SMALLEST_BLOCK;
    if (target > LARGEST_BLOCK)
        target = LARGEST_BLOCK;
    if (ffd_text_has_mark(first, d->file.input.size))
        first += TEXT_MARK_SIZE;
    d->end = ffd_text_size(d->file.input.data, d->file.input.size);
    return ffd_obj_blocks_cut(&d->file.input, first, target, &d->blocks, error);
}

ffd_status ffd_obj_read_vectors(obj_document *d, obj_users *users, ffd_error *error)
{
    TRY(cut(d, error));
    const int slots = ffd_ordered_slots(d->threads);
    reader r = {.document = d,
                .users = users,
                .contents = ffd_alloc_zero((size_t)slots, sizeof *r.contents),
                .line = 1,
                .failed = SIZE_MAX};
    atomic_init(&r.is_over, false);
    ffd_status status = r.contents ? read_blocks(&r, error) : ffd_fail_memory(error);
    for (int i = 0; r.contents && i < slots; i++)
        free_content(&r.contents[i]);
    ffd_free(r.contents);
    return status;
}

static bool is_below(const void *wanted, const void *vertex)
{
    return *(const uint32_t *)wanted < *(const size_t *)vertex;
}

/* The number of the first wanted vertex that is not before this one. */
static size_t find_wanted(const again *a, size_t vertex)
{
    return lower_bound(&vertex, a->wanted, a->count, sizeof *a->wanted, is_below);
}

static void read_again_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const again *const a = context;
    const obj_document *const d = a->document;
    size_t vertex = d->blocks.list[first].vertices;
    const size_t end = last < d->blocks.count ? d->blocks.list[last].vertices : d->vertices;
    size_t next = a->wanted ? find_wanted(a, vertex) : vertex;
    obj_walk walk;
    (void)tile;
    (void)worker;
    if (a->wanted ? next == a->count || a->wanted[next] >= end : vertex == end)
        return;
    ffd_obj_document_walk_block(d, first, &walk);
    /* A file that somebody changes may have more vertices now. */
    while (vertex < end && ffd_obj_walk_next(&walk)) {
        if (walk.scan.keyword != OBJ_VERTEX)
            continue;
        double *const xyz = a->xyz + 3 * next;
        if (!a->wanted || (next < a->count && a->wanted[next] == vertex)) {
            for (int k = 0, at_once = ffd_obj_scan_numbers(&walk.scan, xyz); k < 3 && !at_once; k++)
                read_number(&walk.scan, &xyz[k]);
            next++;
        }
        vertex++;
    }
    ffd_obj_forget_block(d, first);
}

void ffd_obj_read_again(const obj_document *d, const uint32_t *wanted, size_t count, double *xyz)
{
    again a = {d, wanted, count, xyz};
    ffd_parallel_tiles(d->blocks.count, 1, d->threads, read_again_tile, &a);
}
