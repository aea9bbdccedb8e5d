#include "io/splice.h"
#include "base/memory.h"
#include <string.h>

#define BLOCK ((size_t)256 * 1024)

ffd_status ffd_splice_begin(file_splice *splice, const void *data, file_output *output, ffd_error *error)
{
    *splice = (file_splice){
        .output = output, .error = error, .copied = data, .block = ffd_alloc(BLOCK, sizeof *splice->block)};
    return splice->block ? FFD_OK : ffd_fail_memory(error);
}

static void flush(file_splice *splice)
{
    if (splice->status == FFD_OK && splice->used)
        splice->status = ffd_output_write(splice->output, splice->block, splice->used, splice->error);
    splice->used = 0;
}

void ffd_splice_bytes(file_splice *splice, const void *bytes, size_t size)
{
    if (size > BLOCK - splice->used)
        flush(splice);
    if (size < BLOCK) {
        memcpy(splice->block + splice->used, bytes, size);
        splice->used += size;
    } else if (splice->status == FFD_OK)
        splice->status = ffd_output_write(splice->output, bytes, size, splice->error);
}

void ffd_splice_copy(file_splice *splice, const char *to)
{
    ffd_splice_bytes(splice, splice->copied, (size_t)(to - splice->copied));
    splice->copied = to;
}

void ffd_splice_replace(file_splice *splice, const char *first, const char *last, const void *bytes,
                        size_t size)
{
    ffd_splice_copy(splice, first);
    ffd_splice_bytes(splice, bytes, size);
    splice->copied = last;
}

ffd_status ffd_splice_end(file_splice *splice)
{
    flush(splice);
    ffd_free(splice->block);
    splice->block = NULL;
    return splice->status;
}
