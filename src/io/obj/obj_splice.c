#include "io/obj/obj_splice.h"
#include "base/memory.h"
#include "base/number.h"
#include <string.h>

#define BLOCK ((size_t)256 * 1024)

ffd_status ffd_obj_splice_begin(obj_splice *splice, const void *data, file_output *output, ffd_error *error)
{
    *splice = (obj_splice){
        .output = output, .error = error, .copied = data, .block = ffd_alloc(BLOCK, sizeof *splice->block)};
    return splice->block ? FFD_OK : ffd_fail_memory(error);
}

static void flush(obj_splice *splice)
{
    if (splice->status == FFD_OK && splice->used)
        splice->status = ffd_output_write(splice->output, splice->block, splice->used, splice->error);
    splice->used = 0;
}

void ffd_obj_splice_text(obj_splice *splice, const char *text, size_t size)
{
    if (size > BLOCK - splice->used)
        flush(splice);
    if (size < BLOCK) {
        memcpy(splice->block + splice->used, text, size);
        splice->used += size;
    } else if (splice->status == FFD_OK)
        splice->status = ffd_output_write(splice->output, text, size, splice->error);
}

void ffd_obj_splice_copy(obj_splice *splice, const char *to)
{
    ffd_obj_splice_text(splice, splice->copied, (size_t)(to - splice->copied));
    splice->copied = to;
}

void ffd_obj_splice_word(obj_splice *splice, obj_word word, const char *text, size_t size)
{
    ffd_obj_splice_copy(splice, word.first);
    ffd_obj_splice_text(splice, text, size);
    splice->copied = word.last;
}

void ffd_obj_splice_number(obj_splice *splice, obj_word word, double value)
{
    char text[FFD_NUMBER_CAPACITY];
    ffd_obj_splice_word(splice, word, text, ffd_number_format(value, text));
}

ffd_status ffd_obj_splice_end(obj_splice *splice)
{
    flush(splice);
    ffd_free(splice->block);
    splice->block = NULL;
    return splice->status;
}
