#include "io/splice.h"
#include <string.h>

/* Of a file, in memory while it is copied. */
#define PIECE ((size_t)2 * 1024 * 1024)

void ffd_splice_begin(file_splice *splice, const file_input *input, const mesh_save_options *options,
                      file_output *output, ffd_error *error)
{
    const char *data = (const char *)input->data;
    *splice = (file_splice){
        .input = input, .output = output, .error = error, .copied = data, .last = data + input->size};
    splice->status = ffd_output_begin(output, options->path, options->force, error);
}

void ffd_splice_begin_part(file_splice *splice, const char *first, const char *last, byte_buffer *text,
                           ffd_error *error)
{
    *splice = (file_splice){.error = error, .copied = first, .last = last, .text = text};
}

void ffd_splice_bytes(file_splice *splice, const void *bytes, size_t size)
{
    if (splice->text)
        ffd_buffer_append(splice->text, bytes, size);
    else if (splice->status == FFD_OK)
        splice->status = ffd_output_write(splice->output, bytes, size, splice->error);
}

void ffd_splice_copy(file_splice *splice, const char *to)
{
    while (splice->status == FFD_OK && splice->input && (size_t)(to - splice->copied) > PIECE) {
        ffd_file_bring_in(splice->copied, PIECE);
        ffd_splice_bytes(splice, splice->copied, PIECE);
        ffd_file_forget(splice->input, splice->copied, PIECE);
        splice->copied += PIECE;
    }
    ffd_splice_bytes(splice, splice->copied, (size_t)(to - splice->copied));
    splice->copied = to;
}

void ffd_splice_part(file_splice *splice, const char *first, const char *last, const byte_buffer *text)
{
    ffd_splice_copy(splice, first);
    if (text)
        ffd_splice_bytes(splice, text->data, text->size);
    else
        ffd_splice_bytes(splice, first, (size_t)(last - first));
    ffd_file_forget(splice->input, first, (size_t)(last - first));
    splice->copied = last;
}

void ffd_splice_replace(file_splice *splice, text_word word, const void *bytes, size_t size)
{
    ffd_splice_copy(splice, word.first);
    ffd_splice_bytes(splice, bytes, size);
    splice->copied = word.last;
}

static size_t format(decimal_run *run, const double *value, char *text)
{
    return run ? ffd_decimal_run_format(run, value, text) : ffd_number_format(*value, text);
}

/* Straight into the text: a mesh has millions of them. */
static void replace_in_text(file_splice *splice, text_word word, const double *value, decimal_run *run)
{
    const size_t before = (size_t)(word.first - splice->copied);
    char *const room = ffd_buffer_room(splice->text, before + FFD_NUMBER_CAPACITY);
    if (!room)
        return;
    if (before == 1)
        *room = *splice->copied;
    else
        memcpy(room, splice->copied, before);
    splice->text->size += before + format(run, value, room + before);
    splice->copied = word.last;
}

static void replace_number(file_splice *splice, text_word word, const double *value, decimal_run *run)
{
    char text[FFD_NUMBER_CAPACITY];
    if (splice->text)
        replace_in_text(splice, word, value, run);
    else
        ffd_splice_replace(splice, word, text, format(run, value, text));
}

void ffd_splice_numbers(file_splice *splice, const text_word *words, const double *numbers, unsigned changes,
                        size_t count, decimal_run *run)
{
    for (size_t i = 0; i < count; i++)
        if (changes >> i & 1)
            replace_number(splice, words[i], numbers + i, run);
}

ffd_status ffd_splice_end(file_splice *splice)
{
    ffd_splice_copy(splice, splice->last);
    if (splice->text)
        return splice->text->failed ? ffd_fail_memory(splice->error) : FFD_OK;
    return splice->status;
}
