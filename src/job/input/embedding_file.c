#include "job/input/embedding_file.h"
#include "base/file/input.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/text/words.h"
#include "base/vector/vec.h"
#include "io/npy/npy.h"
#include "job/input/source.h"
#include "lattice/rest_hash.h"
#include <inttypes.h>

#define TILE ((size_t)1024)
#define FORMAT_VERSION 1

/* Offsets of the footer's members. */
enum {
    POSITIONS = 0,
    LATTICE = 16,
    CONTENT = 32,
    COUNT = 48,
    VERSION = 56,
    RESERVED = 60,
    MAGIC = 64,
    FOOTER_SIZE = 72
};

static const unsigned char magic[8] = {'f', 'f', 'd', '-', 'e', 'm', 'b', 'd'};

/* Hashes */

typedef struct part_hashes {
    const mesh_document *document;
    size_t part;
    hash128 *tiles;
} part_hashes;

static void hash_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const part_hashes *work = context;
    double xyz[3 * TILE];
    (void)worker;
    ffd_source_positions(work->document, MESH_STORED, work->part, first, last - first, xyz);
    work->tiles[tile] = ffd_hash_doubles(xyz, 3 * (last - first));
}

static size_t tiles_of(const mesh_part *part)
{
    return part->repeats_positions ? 0 : part->vertex_count / TILE + (part->vertex_count % TILE != 0);
}

static hash128 hash_rounding(const mesh_rounding *rounding)
{
    double numbers[6];
    for (int a = 0; a < 3; a++) {
        numbers[a] = rounding->is_float[a];
        numbers[3 + a] = rounding->step[a];
    }
    return ffd_hash_doubles(numbers, 6);
}

/* Hashes the positions of each part in runs, appends the roundings of the parts, and writes both to list.
   Returns the number of position hashes. *roundings: the number of entries for roundings. */
static size_t hash_parts(const mesh_document *document, int threads, hash128 *list, size_t *roundings)
{
    size_t count = 0;
    bool any = false;
    *roundings = 0;
    for (size_t i = 0; i < document->part_count; i++) {
        const mesh_part *part = &document->parts[i];
        part_hashes work = {document, i, list + count};
        if (part->repeats_positions)
            continue;
        ffd_parallel_tiles(part->vertex_count, TILE, threads, hash_tile, &work);
        count += tiles_of(part);
        any = any || !ffd_rounding_is_none(&part->rounding);
    }
    for (size_t i = 0; any && i < document->part_count; i++)
        if (!document->parts[i].repeats_positions)
            list[count + (*roundings)++] = hash_rounding(&document->parts[i].rounding);
    return count;
}

ffd_status ffd_embedding_hash_positions(const mesh_document *document, int threads, hash128 *hash,
                                        ffd_error *error)
{
    size_t most = document->part_count, roundings;
    for (size_t i = 0; i < document->part_count; i++)
        most += tiles_of(&document->parts[i]);
    hash128 *list = ffd_alloc(most, sizeof *list);
    if (!list)
        return ffd_fail_memory(error);
    const size_t tiles = hash_parts(document, threads, list, &roundings);
    unsigned char count[8];
    store_u64(count, ffd_mesh_vertex_count(document));
    const hash_block blocks[] = {
        {list, tiles * sizeof *list}, {count, sizeof count}, {list + tiles, roundings * sizeof *list}};
    *hash = ffd_hash_blocks(blocks, 3);
    ffd_free(list);
    return FFD_OK;
}

hash128 ffd_embedding_hash_rest(const ffd_lattice *lattice, double snap)
{
    const hash128 parts[] = {ffd_rest_hash(lattice), ffd_hash_doubles(&snap, 1)};
    return snap > 0 ? ffd_hash(parts, sizeof parts) : parts[0];
}

/* Writing */

static bool is_little_endian(void)
{
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1;
}

/* NumPy's type string for this machine's byte order (own), or for the other one. */
static const char *descr_of(bool own)
{
    return own == is_little_endian() ? "<f8" : ">f8";
}

static void make_footer(size_t count, const hash128 *positions, const hash128 *lattice,
                        const hash128 *content, unsigned char footer[FOOTER_SIZE])
{
    memcpy(footer + POSITIONS, positions, sizeof *positions);
    memcpy(footer + LATTICE, lattice, sizeof *lattice);
    memcpy(footer + CONTENT, content, sizeof *content);
    store_u64(footer + COUNT, count);
    store_u32(footer + VERSION, FORMAT_VERSION);
    store_u32(footer + RESERVED, 0);
    memcpy(footer + MAGIC, magic, sizeof magic);
}

ffd_status ffd_embedding_write(file_output *output, const double *uvw, const uint8_t *statuses, size_t count,
                               const hash128 *positions, const hash128 *lattice, ffd_error *error)
{
    char header[NPY_HEADER_CAPACITY];
    unsigned char footer[FOOTER_SIZE];
    const size_t header_size = ffd_npy_header(descr_of(true), count, 3, header);
    const hash_block blocks[] = {{header, header_size}, {uvw, 3 * count * sizeof *uvw}, {statuses, count}};
    const hash128 content = ffd_hash_blocks(blocks, 3);
    make_footer(count, positions, lattice, &content, footer);
    for (int i = 0; i < 3; i++)
        TRY(ffd_output_write(output, blocks[i].bytes, blocks[i].size, error));
    return ffd_output_write(output, footer, FOOTER_SIZE, error);
}

/* Reading */

/* The bytes of the file before its footer. */
typedef struct file_content {
    const char *name; /* for messages */
    const unsigned char *data, *footer;
    size_t size;
    uint64_t count;
} file_content;

static ffd_status fail_damaged(const file_content *content, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_INVALID, content->name,
                         "is damaged: its content is not what ffd embed wrote");
}

static ffd_status find_footer(const file_input *input, file_content *content, ffd_error *error)
{
    if (input->size < FOOTER_SIZE ||
        memcmp(input->data + input->size - sizeof magic, magic, sizeof magic) != 0)
        return ffd_fail_file(error, FFD_E_INVALID, content->name,
                             "is not an embedding written by ffd embed, or not a whole one");
    content->data = input->data;
    content->size = input->size - FOOTER_SIZE;
    content->footer = input->data + content->size;
    content->count = load_u64(content->footer + COUNT);
    const uint32_t version = load_u32(content->footer + VERSION);
    if (version != FORMAT_VERSION)
        return ffd_fail_file(error, FFD_E_INVALID, content->name,
                             "is an embedding of format version %" PRIu32 ", this program reads version %d",
                             version, FORMAT_VERSION);
    return load_u32(content->footer + RESERVED) == 0 ? FFD_OK : fail_damaged(content, error);
}

static ffd_status check_content(const file_content *content, ffd_error *error)
{
    const hash128 hash = ffd_hash(content->data, content->size);
    return memcmp(&hash, content->footer + CONTENT, sizeof hash) == 0 ? FFD_OK : fail_damaged(content, error);
}

static ffd_status check_origin(const file_content *content, size_t count, const hash128 *positions,
                               const hash128 *lattice, ffd_error *error)
{
    if (content->count != count)
        return ffd_fail_file(error, FFD_E_INVALID, content->name,
                             "was made for another mesh: it is of %" PRIu64 " %s, not %zu", content->count,
                             ffd_plural(content->count, "vertex", "vertices"), count);
    if (memcmp(positions, content->footer + POSITIONS, sizeof *positions) != 0)
        return ffd_fail_file(error, FFD_E_INVALID, content->name,
                             "was made for another mesh: its positions, or their number type, differ");
    if (memcmp(lattice, content->footer + LATTICE, sizeof *lattice) != 0)
        return ffd_fail_file(error, FFD_E_INVALID, content->name,
                             "was made for another rest lattice, or with another {snap}");
    return FFD_OK;
}

/* Finds the arrays of file->count vertices. *own: whether the numbers have this machine's byte order. */
static ffd_status find_arrays(const file_content *content, embedding_file *file, bool *own, ffd_error *error)
{
    size_t values = 0, size = 0;
    *own = ffd_npy_starts(content->data, content->size, descr_of(true), file->count, 3, &values);
    const bool known =
        *own || ffd_npy_starts(content->data, content->size, descr_of(false), file->count, 3, &values);
    if (!known || !ffd_multiply_size(file->count, 3 * sizeof(double) + 1, &size) ||
        size != content->size - values)
        return ffd_fail_file(error, FFD_E_INVALID, content->name,
                             "does not hold float64 of the shape (%zu, 3) and as many statuses", file->count);
    /* Aligned, as the block is, and the header's length is a multiple of 64. */
    file->uvw = (const double *)(const void *)(content->data + values);
    file->statuses = content->data + values + 3 * sizeof(double) * file->count;
    return FFD_OK;
}

static ffd_status turn_bytes(embedding_file *file, ffd_error *error)
{
    const unsigned char *bytes = (const unsigned char *)file->uvw;
    file->turned = ffd_alloc(file->count, 3 * sizeof(double));
    if (!file->turned)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < 3 * file->count; i++) {
        unsigned char turned[sizeof(double)];
        for (size_t b = 0; b < sizeof turned; b++)
            turned[b] = bytes[sizeof turned * (i + 1) - 1 - b];
        memcpy(file->turned + i, turned, sizeof turned);
    }
    file->uvw = file->turned;
    return FFD_OK;
}

static ffd_status check_vertices(const embedding_file *file, const char *name, ffd_error *error)
{
    for (size_t i = 0; i < file->count; i++) {
        const unsigned s = file->statuses[i];
        if (s >= FFD_VERTEX_STATUS_COUNT)
            return ffd_fail_file(error, FFD_E_INVALID, name, "the status of vertex %zu is %u, not 0 to %d", i,
                                 s, FFD_VERTEX_STATUS_COUNT - 1);
        if ((s == FFD_VERTEX_INSIDE || s == FFD_VERTEX_MULTIPLE) && !vec_is_finite(file->uvw + 3 * i))
            return ffd_fail_file(error, FFD_E_INVALID, name,
                                 "u,v,w of vertex %zu is not finite, although its status is %u", i, s);
    }
    return FFD_OK;
}

ffd_status ffd_embedding_open(const ffd_embedding_source *source, size_t count, const hash128 *positions,
                              const hash128 *lattice, embedding_file *file, ffd_error *error)
{
    file_content content = {.name = ffd_file_display_name(source->path)};
    bool own = true;
    *file = (embedding_file){.count = count};
    ffd_status status;
    TRY_END(ffd_file_take(source->path, source->bytes, &file->input, error));
    TRY_END(find_footer(&file->input, &content, error));
    TRY_END(check_content(&content, error));
    TRY_END(check_origin(&content, count, positions, lattice, error));
    TRY_END(find_arrays(&content, file, &own, error));
    if (!own)
        TRY_END(turn_bytes(file, error));
    TRY_END(check_vertices(file, content.name, error));
end:
    if (status)
        ffd_embedding_close(file);
    return status;
}

ffd_status ffd_embedding_reuse(const ffd_embedding_source *source, const mesh_document *document,
                               const ffd_lattice *lattice, double snap, int threads, embedding_file *file,
                               ffd_error *error)
{
    hash128 positions;
    const hash128 rest = ffd_embedding_hash_rest(lattice, snap);
    TRY(ffd_embedding_hash_positions(document, threads, &positions, error));
    return ffd_embedding_open(source, (size_t)ffd_mesh_vertex_count(document), &positions, &rest, file,
                              error);
}

void ffd_embedding_locate(const embedding_file *file, size_t vertex, const ffd_lattice *lattice,
                          const double p[3], ffd_location *location)
{
    const double *uvw = file->uvw + 3 * vertex;
    double at[3];
    *location = (ffd_location){.uvw = {NAN, NAN, NAN}, .status = file->statuses[vertex]};
    if (location->status == FFD_VERTEX_OUTSIDE || location->status == FFD_VERTEX_INVALID ||
        !vec_is_finite(uvw))
        return;
    for (int a = 0; a < 3; a++)
        location->uvw[a] = ffd_knots_wrap(&lattice->knots[a], uvw[a]);
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, location->uvw, at, NULL);
    for (int a = 0; a < 3; a++)
        at[a] -= p[a];
    location->residual = vec_length(at);
}

void ffd_embedding_close(embedding_file *file)
{
    ffd_file_unload(&file->input);
    ffd_free(file->turned);
    *file = (embedding_file){0};
}
