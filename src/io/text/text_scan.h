/* text_scan.h - the words and lines of a text file. Lines end with LF, CRLF or CR, also mixed; blanks and
   tabs separate words; a byte order mark is skipped. */
#ifndef FFD_IO_TEXT_TEXT_SCAN_H
#define FFD_IO_TEXT_TEXT_SCAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A word of the file: [first, last). */
typedef struct text_word {
    const char *first, *last;
} text_word;

typedef struct text_scan {
    const char *at, *last;
    size_t line;   /* of at, from 1 */
    bool comments; /* # starts a comment to the end of its line, also right after a word */
} text_scan;

/* Whether a text begins with a byte order mark (UTF-8). */
bool ffd_text_has_mark(const void *data, size_t size);
#define TEXT_MARK_SIZE 3
/* The size of a text without the mark by which old programs of DOS end one (Ctrl-Z, which may follow the last
   word at once), and without what is behind it, if these are blanks and line ends. */
size_t ffd_text_size(const void *data, size_t size);
/* Begins a scan of these bytes, which must stay as long as it is used. */
void ffd_text_begin(text_scan *scan, const void *data, size_t size, bool comments);
/* Takes the next word of the current line. False (and *word is empty) where there is none left. */
bool ffd_text_word(text_scan *scan, text_word *word);
/* Digits of whole numbers that are all below 2^53. */
#define TEXT_SHORT_DIGITS 15
/* Takes the next word of the current line where it is a whole number of so few digits, as nearly all are: it
   is gone over once. False: nothing is taken. */
bool ffd_text_short_whole(text_scan *scan, text_word *word, uint64_t *value);
/* Moves past the end of the current line. Returns false if the file ends with it. */
bool ffd_text_next_line(text_scan *scan);
/* Moves to the next word, in this line or a later one. False at the end of the file. */
bool ffd_text_find(text_scan *scan);

/* Whether a word is this text. */
bool ffd_text_is(text_word word, const char *text);
/* The same, without regard to case. text is in lower case. */
bool ffd_text_is_any_case(text_word word, const char *text);
/* Whether two words have the same bytes. */
bool ffd_text_same(text_word a, text_word b);
/* A number as a whole word. */
bool ffd_text_number(text_word word, double *value);
/* A whole number that is not negative, in digits; UINT64_MAX for those beyond it. */
bool ffd_text_whole(text_word word, uint64_t *value);
/* How many bytes of a word a message shows: long ones are cut, between two characters of UTF-8. */
int ffd_text_display_size(text_word word);

/* Capacity for the text of ffd_text_lines. */
#define TEXT_LINES_CAPACITY 64
/* Writes where two files differ: " (line 4)" where a and b are the same line, else " (lines 4 and 5)". */
void ffd_text_lines(size_t a, size_t b, char text[TEXT_LINES_CAPACITY]);

/* "LF", "CRLF", "CR", "mixed", or "none". */
const char *ffd_text_line_ends(const void *data, size_t size);

#endif
