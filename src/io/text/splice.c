#include "io/text/splice.h"
#include <string.h>

/* Bytes of a file held in memory while it is copied. */
#define PIECE ((size_t)2 * 1024 * 1024)

static const file_input *input_of(const file_splice *splice)
{
    return &splice->document->input;
}

void ffd_splice_begin(file_splice *splice, const file_document *document, const mesh_save_options *options,
                      file_output *output, ffd_error *error)
{
    const char *data = (const char *)document->input.data;
    *splice = (file_splice){.document = document,
                            .output = output,
                            .error = error,
                            .copied = data,
                            .last = data + document->input.size};
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
    while (splice->status == FFD_OK && splice->document && (size_t)(to - splice->copied) > PIECE) {
        ffd_file_prefault(splice->copied, PIECE);
        ffd_splice_bytes(splice, splice->copied, PIECE);
        splice->copied += PIECE;
        ffd_file_release_until(input_of(splice), splice->copied, &splice->released);
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
    splice->copied = last;
    ffd_file_release_until(input_of(splice), last, &splice->released);
}

/* Whether a word is not empty and follows what is copied. This only fails if another program has changed the
   file. */
static bool is_ahead(const file_splice *splice, text_word word)
{
    return word.first >= splice->copied && word.last > word.first && word.last <= splice->last;
}

static void refuse_changed(file_splice *splice)
{
    if (splice->status == FFD_OK)
        splice->status =
            splice->document ? ffd_file_document_changed(splice->document, splice->error) : FFD_E_IO;
}

void ffd_splice_replace(file_splice *splice, text_word word, const void *bytes, size_t size)
{
    if (!is_ahead(splice, word)) {
        refuse_changed(splice);
        return;
    }
    ffd_splice_copy(splice, word.first);
    ffd_splice_bytes(splice, bytes, size);
    splice->copied = word.last;
}

static size_t format(decimal_run *run, const double *value, char *text)
{
    return run ? ffd_decimal_run_format(run, value, text) : ffd_number_format(*value, text);
}

/* Copies the text between two numbers, usually a blank: copying eight bytes at a time is faster than copying
   the exact size. The buffer must have capacity for that. Returns the end of the copy. */
static char *copy_between(const file_splice *splice, const char *to, char *buffer)
{
    const size_t size = (size_t)(to - splice->copied);
    if (size <= 8 && splice->last - splice->copied >= 8)
        memcpy(buffer, splice->copied, 8);
    else
        memcpy(buffer, splice->copied, size);
    return buffer + size;
}

/* Writes straight into the text and checks its capacity only once: a mesh has millions of numbers. */
static void replace_in_text(file_splice *splice, const text_word *words, const double *numbers,
                            unsigned changes, size_t count, decimal_run *run)
{
    for (size_t i = 0; i < count; i++)
        if (!is_ahead(splice, words[i]) || (i > 0 && words[i].first < words[i - 1].last)) {
            refuse_changed(splice);
            return;
        }
    const size_t before = (size_t)(words[count - 1].last - splice->copied);
    char *const start = ffd_buffer_reserve(splice->text, before + count * FFD_NUMBER_CAPACITY), *at = start;
    if (!start)
        return;
    for (size_t i = 0; i < count; i++)
        if (changes >> i & 1) {
            at = copy_between(splice, words[i].first, at);
            at += format(run, numbers + i, at);
            splice->copied = words[i].last;
        }
    splice->text->size += (size_t)(at - start);
}

void ffd_splice_numbers(file_splice *splice, const text_word *words, const double *numbers, unsigned changes,
                        size_t count, decimal_run *run)
{
    char text[FFD_NUMBER_CAPACITY];
    if (splice->text && count > 0) {
        replace_in_text(splice, words, numbers, changes, count, run);
        return;
    }
    for (size_t i = 0; i < count; i++)
        if (changes >> i & 1)
            ffd_splice_replace(splice, words[i], text, format(run, numbers + i, text));
}

ffd_status ffd_splice_end(file_splice *splice)
{
    ffd_splice_copy(splice, splice->last);
    if (splice->text)
        return splice->text->failed ? ffd_fail_memory(splice->error) : splice->status;
    const file_input *const input = input_of(splice);
    ffd_file_release_pages(input, input->data + splice->released, input->size - splice->released);
    return splice->status;
}
