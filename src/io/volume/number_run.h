/* number_run.h - tuples of numbers that follow each other in a file, such as the points of a mesh: as words
   of a text, or in binary. */
#ifndef FFD_IO_VOLUME_NUMBER_RUN_H
#define FFD_IO_VOLUME_NUMBER_RUN_H

#include "base/fail.h"
#include "base/text/number_type.h"
#include "io/text/splice.h"

/* The most numbers of a tuple. */
#define RUN_WIDTH_MAX 16

typedef struct number_run {
    number_type type;
    bool is_text, is_big; /* is_big: in binary, the highest byte first */
    size_t count;         /* tuples */
    size_t width;         /* numbers of a tuple, at most RUN_WIDTH_MAX */
    size_t before;        /* what is skipped in front of a tuple: words of its line, or bytes */
    size_t stride;        /* in binary: bytes from one tuple to the next */
    bool has_lines;       /* in text: each tuple has a line of its own, whose other words are skipped */
    char comment;         /* begins comments, which are skipped; 0: there are none. Only with has_lines */
    bool is_bracketed;    /* in text: each tuple is in parentheses, with comments as those of C */
    /* A text is read from first to last at most. In binary all tuples lie in between. */
    const char *first, *last;
    size_t line; /* that of first */
} number_run;

/* Words of a text, one tuple after the other. */
typedef struct run_walk {
    const number_run *run;
    text_scan scan;
} run_walk;

/* Begins a walk at the first tuple of a text. */
void ffd_run_begin(const number_run *run, run_walk *walk);
/* Takes the words of the next tuple. Returns how many were found: fewer than its width where its line, its
   parentheses or the text end, and where a parenthesis is missing. */
size_t ffd_run_words(run_walk *walk, text_word words[RUN_WIDTH_MAX]);

/* Checks that the tuples fit into the bytes of the run, before memory is taken for them. what: names one in
   messages ("point"). Errors: FFD_E_INVALID. */
ffd_status ffd_run_check(const number_run *run, const char *file, const char *what, ffd_error *error);
/* Reads all numbers; values NULL: only moves past them. Sets *last to the end of the last word or tuple, and
 *line to its line. Errors: FFD_E_INVALID for a text that is not a number, or ends too early. */
ffd_status ffd_run_read(const number_run *run, const char *file, const char *what, double *values,
                        const char **last, size_t *line, ffd_error *error);
/* Reads all numbers of a run that was read before, each rounded to its type. Returns false if it is broken
   now, because another program has changed the file. */
bool ffd_run_load(const number_run *run, double *values);

/* Copies the bytes of the tuples [first, last) of a run in binary to block, with new numbers where their bits
   differ, as ffd_run_splice does. */
void ffd_run_patch(const number_run *run, size_t first, size_t last, const double *before,
                   const double *after, size_t columns, char *block);
/* Copies the file up to the end of a run, with new numbers where their bits differ. before and after have
   `columns` numbers for each tuple, of which the first ones are in the file. The failure is that of the
   splice. */
void ffd_run_splice(const number_run *run, const double *before, const double *after, size_t columns,
                    file_splice *splice);

#endif
