#include "io/obj/obj_blocks.h"
#include "base/memory.h"
#include "io/obj/obj_scan.h"
#include <string.h>

/* Whether the line that ends at `end` (a line end's first character) may go on in the next: a backslash in a
   comment does not continue it, but cutting elsewhere is as good. */
static bool may_continue(const char *first, const char *end)
{
    return end > first && end[-1] == '\\';
}

/* The place behind the next line end from `at` on that surely ends a statement. */
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

/* Bytes of a line with three numbers, without its end. */
#define SHORTEST_LINE ((size_t)7)
#define LONGEST_LINE ((size_t)256)

/* Counts the lines of the block as if all were like the first. That one is in memory: it is where the cut
   before was looked for. */
static void estimate(const obj_block *block, obj_blocks *blocks)
{
    const size_t size = (size_t)(block->last - block->first);
    const size_t seen = size < LONGEST_LINE ? size : LONGEST_LINE;
    const char *end = NULL;
    if (seen > SHORTEST_LINE && block->first[0] == 'v')
        end = memchr(block->first + SHORTEST_LINE, '\n', seen - SHORTEST_LINE);
    const size_t count = end ? size / (size_t)(end + 1 - block->first) : 0;
    if (count > 0 && block->first[1] == ' ')
        blocks->vertices += count;
    else if (count > 0 && block->first[1] == 'n')
        blocks->normals += count;
}

/* So many cuts until the pages that they were looked for in are given back: the system brings up to 2 MB in
   for a byte. */
#define CUTS ((size_t)32)

ffd_status ffd_obj_blocks_cut(const file_input *input, const char *first, size_t target, obj_blocks *blocks,
                              ffd_error *error)
{
    const char *const last = (const char *)input->data + input->size;
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
            ffd_file_forget(input, input->data, (size_t)(at - (const char *)input->data));
    } while (at < last);
    return FFD_OK;
}

void ffd_obj_blocks_free(obj_blocks *blocks)
{
    ffd_free(blocks->list);
    *blocks = (obj_blocks){0};
}
