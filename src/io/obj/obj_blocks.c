#include "io/obj/obj_blocks.h"
#include "base/memory/memory.h"
#include "io/obj/obj_scan.h"
#include <string.h>

/* Whether the line that ends at `end` (a line end's first character) may go on in the next: a backslash in a
   comment, or with blanks after it, may not continue it, but cutting elsewhere is as good. */
static bool may_continue(const char *first, const char *end)
{
    while (end > first && ffd_obj_class(end - 1) == OBJ_BLANK)
        end--;
    return end > first && end[-1] == '\\';
}

/* Returns the position after the next line end from `at` on that surely ends a statement. */
static const char *find_cut(const char *first, const char *at, const char *last)
{
    for (; at < last; at++) {
        if (*at != '\n' && *at != '\r')
            continue;
        const char *end = *at == '\n' && at > first && at[-1] == '\r' ? at - 1 : at;
        at = end + ffd_obj_line_end_size(end, last);
        if (!may_continue(first, end))
            return at;
        at--;
    }
    return last;
}

/* Bytes at the start of a block that are searched for a line to estimate the block by. */
#define HEAD ((size_t)1024)

/* The shortest line with numbers, "v 1 2 3". A shorter line is not a basis for an estimate. */
#define SHORTEST_LINE 8

/* Estimates how many `v` or `vn` lines the block has by the length of the first one. Estimates nothing if a
   line comes before it that does not belong to the beginning of a file or an object. These bytes are in
   memory already: the search for the cut before read them. */
static void estimate(const obj_block *block, obj_blocks *blocks)
{
    const size_t size = (size_t)(block->last - block->first);
    const char *at = block->first, *const last = at + (size < HEAD ? size : HEAD);
    while (at < last) {
        const char *const end = memchr(at, '\n', (size_t)(last - at));
        if (!end)
            return;
        const size_t length = (size_t)(end + 1 - at), count = length < SHORTEST_LINE ? 0 : size / length;
        if (at[0] == 'v' && at[1] == ' ')
            blocks->vertices += count;
        else if (at[0] == 'v' && at[1] == 'n')
            blocks->normals += count;
        else if (at[0] == '#' || at[0] == 'o' || at[0] == 'g' || at[0] == 'm') {
            at = end + 1;
            continue;
        }
        return;
    }
}

/* After so many cuts the mapped pages that the search has read are released: the system reads in up to 2 MB
   (a huge page) for one byte. */
#define CUTS ((size_t)32)

ffd_status ffd_obj_blocks_cut(const file_input *input, const char *first, size_t target, obj_blocks *blocks,
                              ffd_error *error)
{
    const char *const last = (const char *)input->data + ffd_text_size(input->data, input->size);
    const size_t most = (size_t)(last - first) / target + 1;
    const char *at = first;
    *blocks = (obj_blocks){.list = ffd_alloc_zero(most, sizeof *blocks->list)};
    if (!blocks->list)
        return ffd_fail_memory(error);
    do {
        const char *wanted = (size_t)(last - at) > target ? at + target : last;
        const char *end = find_cut(first, wanted, last);
        blocks->list[blocks->count] = (obj_block){.first = at, .last = end};
        estimate(&blocks->list[blocks->count++], blocks);
        at = end;
        if (blocks->count % CUTS == 0)
            ffd_file_release_pages(input, input->data, (size_t)(at - (const char *)input->data));
    } while (at < last);
    return FFD_OK;
}

void ffd_obj_blocks_free(obj_blocks *blocks)
{
    ffd_free(blocks->list);
    *blocks = (obj_blocks){0};
}
