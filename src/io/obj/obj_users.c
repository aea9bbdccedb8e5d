#include "io/obj/obj_users.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/text/words.h"

/* A block as it is being read, and what its statements may name. */
typedef struct block_reader {
    const obj_document *document;
    const obj_users *users;
    obj_count vertices, normals;
    bool any_normals; /* else indices of normals are accepted without a check: some tools
                         leave the normals out */
    ffd_error *error;
} block_reader;

static ffd_status check_index(const block_reader *r, const obj_scan *scan, obj_index index, obj_count count,
                              const char *kind, size_t *element)
{
    const char *const name = r->document->file.name;
    if (ffd_obj_find(index.value, count, element))
        return FFD_OK;
    const int shown = ffd_text_display_size(index.text);
    if (index.value == 0)
        return ffd_fail_line(r->error, FFD_E_INVALID, name, scan->line,
                             "%s index %.*s is out of range: indices start at 1", kind, shown,
                             index.text.first);
    if (index.value < 0)
        return ffd_fail_line(r->error, FFD_E_INVALID, name, scan->line,
                             "%s index %.*s is out of range: %zu %s before it", kind, shown, index.text.first,
                             count.seen, ffd_plural(count.seen, "comes", "come"));
    return ffd_fail_line(r->error, FFD_E_INVALID, name, scan->line,
                         "%s index %.*s is out of range: the file has %zu", kind, shown, index.text.first,
                         count.total);
}

static void note_greatest(size_t *greatest, size_t element)
{
    *greatest = *greatest > element ? *greatest : element + 1;
}

static void note_index(const block_reader *r, const obj_scan *scan, const obj_corner *corner,
                       obj_block_users *block)
{
    if (corner->normal.value < 0)
        block->counts_back = (size_t)(scan->at - (const char *)r->document->file.input.data);
}

/* A statement that is not read may name normals too (surf). */
static void find_corners(const block_reader *r, obj_scan *scan, obj_block_users *block)
{
    text_word word;
    obj_corner corner;
    while (ffd_obj_scan_word(scan, &word))
        if (ffd_obj_corner(word, &corner))
            note_index(r, scan, &corner, block);
}

/* Whether the normal is the vertex' first one. is_alone: no other thread asks; to lock the memory takes as
   long as to read a corner. */
static ALWAYS_INLINE bool is_first(_Atomic uint32_t *first, uint32_t normal, bool is_alone)
{
    const uint32_t index = normal + 1;
    uint32_t there = atomic_load_explicit(first, memory_order_relaxed);
    if (there == 0 && is_alone) {
        atomic_store_explicit(first, index, memory_order_relaxed);
        return true;
    }
    if (there == 0 && atomic_compare_exchange_strong_explicit(first, &there, index, memory_order_relaxed,
                                                              memory_order_relaxed))
        return true;
    return there == index;
}

static ffd_status add_normal(const block_reader *r, const obj_scan *scan, size_t vertex, obj_index index,
                             obj_block_users *block)
{
    size_t normal;
    TRY(check_index(r, scan, index, r->normals, "normal", &normal));
    note_greatest(&block->normals, normal);
    if (!r->users->firsts || is_first(&r->users->firsts[vertex], (uint32_t)normal, r->document->threads == 1))
        return FFD_OK;
    if (!ffd_grow((void **)&block->others, &block->other_capacity, block->other_count + 1,
                  sizeof *block->others))
        return ffd_fail_memory(r->error);
    block->others[block->other_count++] = (obj_vertex_normal){(uint32_t)vertex, (uint32_t)normal};
    return FFD_OK;
}

/* Takes corners of a face while each has the common form: a vertex with its first normal. */
static void pass_common_corners(const block_reader *r, obj_scan *scan, obj_block_users *block)
{
    const char *at = scan->at;
    _Atomic uint32_t *const firsts = r->users->firsts;
    const bool is_alone = r->document->threads == 1;
    size_t vertices = block->vertices, normals = block->normals, corners = 0;
    obj_corner_run run = {0};
    while (at < scan->last && *at == ' ') {
        byte_numbers indices;
        const char *end = ffd_obj_run_pair(&run, &indices);
        if (!end && scan->last - at > OBJ_RUN_ROOM) {
            run = ffd_obj_run_at(at + 1);
            end = ffd_obj_run_pair(&run, &indices);
        }
        if (!end || !ffd_obj_ends_any_word(end))
            break;
        /* 0 becomes a value that is too large. */
        const size_t vertex = (size_t)indices.first - 1, normal = (size_t)indices.second - 1;
        if (vertex >= r->vertices.total || normal >= r->normals.total)
            break;
        if (firsts && !is_first(&firsts[vertex], (uint32_t)normal, is_alone))
            break;
        note_greatest(&vertices, vertex);
        note_greatest(&normals, normal);
        corners++;
        at = end;
    }
    block->vertices = vertices;
    block->normals = normals;
    block->corners += corners;
    scan->at = at;
}

/* Checks the corners of a face, line or point. Indices that are not used are not checked: those of texture
   coordinates, and those of normals in a file without any `vn`. */
static ffd_status check_corners(const block_reader *r, obj_scan *scan, obj_block_users *block)
{
    const bool is_face = scan->keyword == OBJ_FACE;
    text_word word;
    obj_corner corner;
    while (true) {
        if (is_face && r->any_normals)
            pass_common_corners(r, scan, block);
        if (ffd_obj_scan_is_over(scan))
            break;
        size_t vertex;
        const bool plain = ffd_obj_scan_corner(scan, &corner);
        if (!plain && !ffd_obj_scan_word(scan, &word))
            return FFD_OK;
        if (!plain && !ffd_obj_corner(word, &corner))
            return ffd_fail_line(r->error, FFD_E_INVALID, r->document->file.name, scan->line,
                                 "not a corner (v, v/t, v//n or v/t/n): \"%.*s\"",
                                 ffd_text_display_size(word), word.first);
        TRY(check_index(r, scan, corner.vertex, r->vertices, "vertex", &vertex));
        note_greatest(&block->vertices, vertex);
        note_index(r, scan, &corner, block);
        block->corners += is_face;
        if (is_face && r->any_normals && corner.normal.text.first < corner.normal.text.last)
            TRY(add_normal(r, scan, vertex, corner.normal, block));
    }
    return FFD_OK;
}

static ffd_status read_statement(const block_reader *r, obj_scan *scan, obj_block_users *block)
{
    switch (scan->keyword) {
    case OBJ_FACE:
        return check_corners(r, scan, block);
    case OBJ_LINE:
        block->lines++;
        return check_corners(r, scan, block);
    case OBJ_POINT:
        block->points++;
        return check_corners(r, scan, block);
    case OBJ_OTHER:
        find_corners(r, scan, block);
        return FFD_OK;
    default:
        return FFD_OK;
    }
}

/* Grows the memory for first normals to this many vertices; those that it has stay. */
static bool grow_firsts(obj_users *users, size_t count)
{
    if (count <= users->first_count)
        return true;
    /* Zeros are valid atomics, and pages that no thread touches cost nothing. */
    _Atomic uint32_t *firsts = ffd_alloc_zero(count, sizeof *firsts);
    if (!firsts)
        return false;
    for (size_t i = 0; i < users->first_count; i++)
        atomic_init(&firsts[i], ffd_obj_first_normal(users, i));
    ffd_free(users->firsts);
    users->firsts = firsts;
    users->first_count = count;
    return true;
}

ffd_status ffd_obj_users_begin(const obj_document *d, size_t vertices, size_t normals, obj_users *users,
                               ffd_error *error)
{
    *users = (obj_users){.blocks = ffd_alloc_zero(d->blocks.count, sizeof *users->blocks)};
    if (!users->blocks)
        return ffd_fail_memory(error);
    if (normals > 0 && !d->only_positions)
        (void)grow_firsts(users, vertices); /* without them every block with normals is late */
    return FFD_OK;
}

void ffd_obj_users_scan(const obj_document *d, const obj_users *users, obj_scan *scan, obj_block_users *block)
{
    /* An index that counts back is out of range here: how many elements come before is not known. */
    const size_t all = OBJ_ELEMENTS_MAX, normals = users->firsts || d->only_positions ? all : 0;
    const block_reader r = {.document = d,
                            .users = users,
                            .vertices = {.total = users->firsts ? users->first_count : all},
                            .normals = {.total = normals},
                            .any_normals = true};
    if (!block->is_late)
        block->is_late = read_statement(&r, scan, block) != FFD_OK;
}

void ffd_obj_free_block_users(obj_block_users *block)
{
    ffd_free(block->others);
    *block = (obj_block_users){0};
}

static ffd_status read_block(const obj_document *d, const obj_users *users, size_t index,
                             obj_block_users *block, ffd_error *error)
{
    block_reader r = {.document = d, .users = users, .any_normals = d->normals > 0, .error = error};
    obj_walk walk;
    ffd_obj_document_walk_block(d, index, &walk);
    while (ffd_obj_walk_next(&walk)) {
        r.vertices = walk.vertices;
        r.normals = walk.normals;
        TRY(read_statement(&r, &walk.scan, block));
    }
    return FFD_OK;
}

/* Whether the block has not been read, or names what is not there. */
static bool is_to_be_read(const obj_document *d, const obj_block_users *block)
{
    return block->is_late || block->vertices > d->vertices || (d->normals > 0 && block->normals > d->normals);
}

typedef struct reader {
    const obj_document *document;
    obj_users *users;
} reader;

static void read_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const reader *r = context;
    (void)tile;
    (void)worker;
    for (size_t i = first; i < last; i++) {
        const obj_block *text = &r->document->blocks.list[i];
        obj_block_users block = {0}; /* a local copy: entries of the list share cache lines */
        if (!is_to_be_read(r->document, &r->users->blocks[i]))
            continue;
        ffd_obj_free_block_users(&r->users->blocks[i]);
        ffd_file_prefault(text->first, (size_t)(text->last - text->first));
        block.status = read_block(r->document, r->users, i, &block, NULL);
        r->users->blocks[i] = block;
        ffd_file_release_pages(&r->document->file.input, text->first, (size_t)(text->last - text->first));
    }
}

/* Reads a block that has failed again, for the error message. */
static ffd_status find_failure(const obj_document *d, const obj_users *users, size_t index, ffd_status status,
                               ffd_error *error)
{
    obj_block_users block = {0};
    if (status == FFD_E_MEMORY)
        return ffd_fail_memory(error);
    status = read_block(d, users, index, &block, error);
    ffd_obj_free_block_users(&block);
    return status ? status : ffd_file_document_changed(&d->file, error);
}

ffd_status ffd_obj_users_finish(const obj_document *d, obj_users *users, ffd_error *error)
{
    reader r = {d, users};
    if (d->normals == 0 || d->only_positions) {
        ffd_free(users->firsts);
        users->firsts = NULL;
    } else if (!grow_firsts(users, d->vertices)) {
        return ffd_fail_memory(error);
    }
    ffd_parallel_tiles(d->blocks.count, 1, d->threads, read_tile, &r);
    for (size_t i = 0; i < d->blocks.count; i++)
        if (users->blocks[i].status)
            return find_failure(d, users, i, users->blocks[i].status, error);
    return FFD_OK;
}

void ffd_obj_users_free(const obj_document *d, obj_users *users)
{
    for (size_t i = 0; users->blocks && i < d->blocks.count; i++)
        ffd_free(users->blocks[i].others);
    ffd_free(users->blocks);
    ffd_free(users->firsts);
    *users = (obj_users){0};
}
