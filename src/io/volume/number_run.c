#include "io/volume/number_run.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/text/code_scan.h"
#include "io/text/vectors.h"
#include <string.h>

/* Bytes that are copied and patched at a time. */
#define BLOCK ((size_t)65536)

void ffd_run_begin(const number_run *run, run_walk *walk)
{
    walk->run = run;
    walk->scan = (text_scan){.at = run->first, .last = run->last, .line = run->line};
}

/* Moves to the next line with a word that is no comment. */
static bool find_line(run_walk *walk)
{
    while (ffd_text_find(&walk->scan)) {
        if (!walk->run->comment || *walk->scan.at != walk->run->comment)
            return true;
        if (!ffd_text_next_line(&walk->scan))
            break;
    }
    return false;
}

static bool take_word(run_walk *walk, text_word *word)
{
    if (!walk->run->has_lines && !ffd_text_find(&walk->scan))
        return false;
    if (!ffd_text_word(&walk->scan, word))
        return false;
    const char *const comment =
        walk->run->comment ? memchr(word->first, walk->run->comment, (size_t)(word->last - word->first))
                           : NULL;
    if (comment) { /* the rest of the line is one */
        walk->scan.at = comment;
        word->last = comment;
        return comment > word->first;
    }
    return true;
}

/* Takes the words between two parentheses. */
static size_t take_bracketed(run_walk *walk, text_word words[RUN_WIDTH_MAX])
{
    size_t found = 0;
    if (!ffd_code_mark(&walk->scan, '('))
        return 0;
    while (found < walk->run->width && ffd_code_word(&walk->scan, &words[found]))
        found++;
    return found == walk->run->width && !ffd_code_mark(&walk->scan, ')') ? found - 1 : found;
}

size_t ffd_run_words(run_walk *walk, text_word words[RUN_WIDTH_MAX])
{
    const number_run *const run = walk->run;
    size_t found = 0;
    text_word word;
    if (run->is_bracketed)
        return take_bracketed(walk, words);
    if (run->has_lines && !find_line(walk))
        return 0;
    for (size_t i = 0; i < run->before; i++)
        if (!take_word(walk, &word))
            return 0;
    while (found < run->width && take_word(walk, &words[found]))
        found++;
    if (run->has_lines && found == run->width)
        ffd_text_next_line(&walk->scan);
    return found;
}

ffd_status ffd_run_check(const number_run *run, const char *file, const char *what, ffd_error *error)
{
    const uint64_t left = (uint64_t)(run->last - run->first);
    /* The shortest number is a digit and a blank, which the last one does not need. */
    const uint64_t most = run->is_text ? (left + 1) / (2 * run->width) : left / run->stride;
    if (run->count <= most)
        return FFD_OK;
    return ffd_fail_line(error, FFD_E_INVALID, file, run->line,
                         "the file ends too early: %zu bytes are left for %zu %ss", (size_t)left, run->count,
                         what);
}

static ffd_status refuse(const number_run *run, const run_walk *walk, const char *file, const char *what,
                         size_t tuple, const text_word *word, ffd_error *error)
{
    if (word)
        return ffd_fail_line(error, FFD_E_INVALID, file, walk->scan.line,
                             "%s %zu (counted from 0) has \"%s\", which is not a number", what, tuple,
                             ffd_text_shown(*word).text);
    if (walk->scan.at < walk->scan.last)
        return ffd_fail_line(error, FFD_E_INVALID, file, walk->scan.line,
                             "%s %zu (counted from 0) needs %zu numbers%s", what, tuple, run->width,
                             run->is_bracketed ? " in parentheses" : "");
    return ffd_fail_line(error, FFD_E_INVALID, file, walk->scan.line, "the file ends after %zu of %zu %ss",
                         tuple, run->count, what);
}

static ffd_status read_text(const number_run *run, const char *file, const char *what, double *values,
                            const char **last, size_t *line, ffd_error *error)
{
    text_word words[RUN_WIDTH_MAX];
    run_walk walk;
    ffd_run_begin(run, &walk);
    for (size_t i = 0; i < run->count; i++) {
        run_walk before = walk;
        TRY(ffd_deadline_check_at(i, error));
        if (ffd_run_words(&walk, words) < run->width)
            return refuse(run, &walk, file, what, i, NULL, error);
        for (size_t a = 0; a < run->width; a++) {
            double value;
            if (ffd_type_read(run->type, words[a], values ? &values[i * run->width + a] : &value))
                continue;
            find_line(&before);
            return refuse(run, &before, file, what, i, &words[a], error);
        }
    }
    *last = walk.scan.at;
    *line = walk.scan.line;
    return FFD_OK;
}

ffd_status ffd_run_read(const number_run *run, const char *file, const char *what, double *values,
                        const char **last, size_t *line, ffd_error *error)
{
    TRY(ffd_run_check(run, file, what, error));
    if (run->is_text)
        return read_text(run, file, what, values, last, line, error);
    if (values)
        ffd_run_load(run, values);
    *last = run->first + run->count * run->stride;
    *line = run->line;
    return FFD_OK;
}

static bool load_text(const number_run *run, double *values)
{
    text_word words[RUN_WIDTH_MAX];
    run_walk walk;
    ffd_run_begin(run, &walk);
    for (size_t i = 0; i < run->count; i++) {
        if (ffd_deadline_passed_at(i) || ffd_run_words(&walk, words) < run->width)
            return false;
        for (size_t a = 0; a < run->width; a++)
            if (!ffd_type_read(run->type, words[a], &values[i * run->width + a]))
                return false;
    }
    return true;
}

bool ffd_run_load(const number_run *run, double *values)
{
    const size_t size = ffd_type_size(run->type);
    if (run->is_text)
        return load_text(run, values);
    for (size_t i = 0; i < run->count; i++)
        for (size_t a = 0; a < run->width; a++)
            values[i * run->width + a] =
                ffd_type_load(run->type, run->is_big, run->first + i * run->stride + run->before + a * size);
    return true;
}

static void splice_text(const number_run *run, const double *before, const double *after, size_t columns,
                        file_splice *splice)
{
    text_word words[RUN_WIDTH_MAX];
    char text[FFD_NUMBER_CAPACITY];
    run_walk walk;
    ffd_run_begin(run, &walk);
    for (size_t i = 0; i < run->count && splice->status == FFD_OK; i++) {
        if (ffd_run_words(&walk, words) < run->width) {
            splice->status = ffd_fail(splice->error, FFD_E_IO, "the file was changed while it was read");
            return;
        }
        const unsigned changes = ffd_vectors_changes(before + i * columns, after + i * columns, columns);
        for (size_t a = 0; a < columns && a < run->width; a++)
            if (changes >> a & 1)
                ffd_splice_replace(splice, words[a], text,
                                   ffd_type_format(run->type, after[i * columns + a], text));
    }
}

void ffd_run_patch(const number_run *run, size_t first, size_t last, const double *before,
                   const double *after, size_t columns, char *block)
{
    const size_t size = ffd_type_size(run->type);
    memcpy(block, run->first + first * run->stride, (last - first) * run->stride);
    for (size_t i = first; i < last; i++) {
        const unsigned changes = ffd_vectors_changes(before + i * columns, after + i * columns, columns);
        for (size_t a = 0; a < columns && a < run->width; a++)
            if (changes >> a & 1)
                ffd_type_store(run->type, run->is_big, after[i * columns + a],
                               block + (i - first) * run->stride + run->before + a * size);
    }
}

static void splice_binary(const number_run *run, const double *before, const double *after, size_t columns,
                          file_splice *splice)
{
    const size_t step = run->stride < BLOCK ? BLOCK / run->stride : 1;
    char *const block = ffd_alloc(step, run->stride);
    if (!block) {
        splice->status = ffd_fail_memory(splice->error);
        return;
    }
    ffd_splice_copy(splice, run->first);
    for (size_t first = 0; first < run->count && splice->status == FFD_OK; first += step) {
        const size_t last = run->count - first < step ? run->count : first + step;
        ffd_run_patch(run, first, last, before, after, columns, block);
        ffd_splice_bytes(splice, block, (last - first) * run->stride);
        splice->copied = run->first + last * run->stride;
    }
    ffd_free(block);
}

void ffd_run_splice(const number_run *run, const double *before, const double *after, size_t columns,
                    file_splice *splice)
{
    if (run->is_text)
        splice_text(run, before, after, columns, splice);
    else if (splice->status == FFD_OK)
        splice_binary(run, before, after, columns, splice);
}
