/* plot3d.c - Plot3D grids as text: how many blocks there are, the three counts of each, then of each block
   all x, all y and all z, the first direction the fastest. A grid of one block may leave out the 1. */
#include "base/memory/memory.h"
#include "base/text/buffer.h"
#include "lattice/formats/number_text.h"
#include "lattice/formats/readers.h"
#include "lattice/formats/written_text.h"
#include <inttypes.h>
#include <string.h>

typedef struct plot3d_block {
    size_t size[3];
    uint64_t count, first; /* of its points; of the numbers before it in the file */
} plot3d_block;

typedef struct plot3d_reader {
    const file_input *file;
    const char *name;
    uint64_t words, blocks; /* in the file; blocks: 0: not known yet */
    plot3d_block block;     /* the one that is read */
    ffd_error *error;
} plot3d_reader;

static text_scan begin(const plot3d_reader *r)
{
    text_scan scan;
    ffd_text_begin(&scan, r->file->data, ffd_text_size(r->file->data, r->file->size), false);
    return scan;
}

/* Text has no zeros. */
static ffd_status refuse_binary(const plot3d_reader *r)
{
    const size_t looked_at = r->file->size < 4096 ? r->file->size : 4096;
    return memchr(r->file->data, 0, looked_at)
               ? ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name,
                               "is a binary Plot3D file; text is supported (formatted)")
               : FFD_OK;
}

static uint64_t count_words(const plot3d_reader *r)
{
    text_scan scan = begin(r);
    text_word word;
    uint64_t count = 0;
    while (ffd_next_word(&scan, &word))
        count++;
    return count;
}

/* Takes the counts of a block. Returns false if they are not counts, or their product is too large. */
static bool take_counts(text_scan *scan, plot3d_block *block)
{
    text_word word;
    uint64_t count;
    block->count = 1;
    for (int a = 0; a < 3; a++) {
        if (!ffd_next_word(scan, &word) || !ffd_text_whole(word, &count) || count == 0 ||
            count > UINT64_C(1) << 40 || block->count > (UINT64_C(1) << 40) / count)
            return false;
        block->size[a] = (size_t)count;
        block->count *= count;
    }
    return true;
}

/* Whether the file is one of `blocks` blocks, whose counts begin at the scan, behind `head` words. wanted:
   the block that is read. *points: of all blocks. */
static bool has_blocks(plot3d_reader *r, text_scan scan, uint64_t head, uint64_t blocks, uint64_t wanted,
                       uint64_t per_point)
{
    uint64_t numbers = head + 3 * blocks;
    if (blocks == 0 || blocks > r->words / 3)
        return false;
    for (uint64_t b = 0; b < blocks; b++) {
        plot3d_block block;
        if (!take_counts(&scan, &block) || block.count > r->words)
            return false;
        block.first = numbers;
        if (b == wanted)
            r->block = block;
        numbers += per_point * block.count;
        if (numbers > r->words)
            return false;
    }
    return numbers == r->words;
}

/* Finds the blocks: with their number in front, or one without it. */
static ffd_status find_blocks(plot3d_reader *r, uint64_t wanted)
{
    const text_scan all = begin(r);
    text_scan behind = all;
    text_word word;
    uint64_t blocks = 0;
    const bool is_count = ffd_next_word(&behind, &word) && ffd_text_whole(word, &blocks);
    r->words = count_words(r);
    if (is_count && has_blocks(r, behind, 1, blocks, wanted, 3))
        r->blocks = blocks;
    else if (has_blocks(r, all, 0, 1, 0, 3))
        r->blocks = 1;
    else if ((is_count && has_blocks(r, behind, 1, blocks, 0, 4)) || has_blocks(r, all, 0, 1, 0, 4))
        return ffd_fail_file(r->error, FFD_E_UNSUPPORTED, r->name,
                             "has an IBLANK number for each point, which is not supported");
    else
        return ffd_fail_file(r->error, FFD_E_INVALID, r->name,
                             "has %" PRIu64 " numbers, which are not those of Plot3D: the number of blocks, "
                             "the counts of each, then all x, all y and all z",
                             r->words);
    return FFD_OK;
}

/* Finds the block that is meant. */
static ffd_status choose(plot3d_reader *r, const char *block)
{
    uint64_t wanted = 0;
    const text_word word = {block, block ? block + strlen(block) : NULL};
    if (block && !ffd_text_whole(word, &wanted))
        return ffd_fail_file(r->error, FFD_E_ARGUMENT, r->name,
                             "has numbered blocks, none \"%.80s\" ({block})", block);
    TRY(find_blocks(r, wanted));
    if (!block && r->blocks > 1)
        return ffd_fail_file(
            r->error, FFD_E_UNSUPPORTED, r->name,
            "has %" PRIu64 " blocks, which are several lattices: choose one, from 0 ({block})", r->blocks);
    if (wanted >= r->blocks)
        return ffd_fail_file(r->error, FFD_E_ARGUMENT, r->name,
                             "has no block %" PRIu64 ": there are %" PRIu64 ", from 0 ({block})", wanted,
                             r->blocks);
    return FFD_OK;
}

/* Reads the points of the block; the caller frees *points. */
static ffd_status read_points(const plot3d_reader *r, double **points)
{
    text_scan scan = begin(r);
    text_word word;
    *points = ffd_alloc((size_t)r->block.count, 3 * sizeof **points);
    if (!*points)
        return ffd_fail_memory(r->error);
    for (uint64_t i = 0; i < r->block.first; i++)
        ffd_next_word(&scan, &word);
    for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < r->block.count; i++)
            TRY(ffd_next_number(&scan, r->name, &(*points)[3 * i + c], r->error));
    return FFD_OK;
}

ffd_status ffd_lattice_read_plot3d(const file_input *file, const char *name, const format_wish *wish,
                                   lattice_spec **spec, ffd_error *error)
{
    plot3d_reader r = {.file = file, .name = name, .error = error};
    double *points = NULL;
    ffd_status status;
    *spec = NULL;
    TRY_END(refuse_binary(&r));
    TRY_END(choose(&r, wish->block));
    TRY_END(ffd_format_check_size(r.block.size, name, wish, error));
    TRY_END(read_points(&r, &points));
    if (wish->finds_order)
        TRY_END(ffd_points_order(&points, 1, r.block.size, true, name, wish, error));
    TRY_END(ffd_format_begin_of(r.block.size, name, wish, &points, spec, error));
end:
    ffd_free(points);
    return status;
}

ffd_status ffd_lattice_write_plot3d(const ffd_lattice *lattice, file_output *output, ffd_error *error)
{
    byte_buffer text = {0};
    ffd_status status = FFD_OK;
    ffd_buffer_format(&text, "1\n%zu %zu %zu\n", lattice->size[0], lattice->size[1], lattice->size[2]);
    for (size_t n = 0; n < 3 * lattice->count && !status; n++) {
        ffd_buffer_number(&text, lattice->rest[3 * (n % lattice->count) + n / lattice->count]);
        ffd_buffer_append(&text, "\n", 1);
        status = ffd_text_written(&text, n + 1 == 3 * lattice->count, output, error);
    }
    ffd_buffer_free(&text);
    return status;
}
