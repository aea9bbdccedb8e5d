/* text_scan.h - scans the words and lines of a text file. Line ends may be any mixture of LF, CRLF and CR;
   blanks and tabs separate words; a byte order mark is skipped. */
#ifndef FFD_BASE_TEXT_TEXT_SCAN_H
#define FFD_BASE_TEXT_TEXT_SCAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A word of the file: [first, last). */
typedef struct text_word {
    const char *first, *last;
} text_word;

typedef struct text_scan {
    const char *at, *last;
    size_t line;   /* the line of at, from 1 */
    bool comments; /* # starts a comment to the end of its line, also right after a word */
} text_scan;

/* Whether a text begins with a byte order mark (UTF-8). */
bool ffd_text_has_mark(const void *data, size_t size);
#define TEXT_MARK_SIZE 3
/* Returns the size of a text without its end mark: the Ctrl-Z that old DOS programs write, which may directly
   follow the last word, and the blanks and line ends after it. */
size_t ffd_text_size(const void *data, size_t size);
/* Whether the # at `at`, in or behind a word that begins at first, is part of it: Microsoft's old libraries
   write 1.#QNAN, -1.#IND and 1.#INF for what is not a finite number. */
bool ffd_text_hash_is_of_word(const char *first, const char *at, const char *last);
/* Begins a scan of these bytes, which must outlive the scan. */
void ffd_text_begin(text_scan *scan, const void *data, size_t size, bool comments);
/* Takes the next word of the current line. Returns false, with an empty *word, if none is left. */
bool ffd_text_word(text_scan *scan, text_word *word);
/* Whole numbers of this many digits are all less than 2^53. */
#define TEXT_SHORT_DIGITS 15
/* Takes the next word of the current line if it is a whole number of at most TEXT_SHORT_DIGITS digits, as
   nearly all are, in a single pass. Otherwise returns false and takes nothing. */
bool ffd_text_short_whole(text_scan *scan, text_word *word, uint64_t *value);
/* Moves past the end of the current line. Returns false if the file ends with it. */
bool ffd_text_next_line(text_scan *scan);
/* Moves to the next word, in this line or a later one. Returns false at the end of the file. */
bool ffd_text_find(text_scan *scan);

/* Returns where a text begins in [first, last), or NULL. */
const char *ffd_find_text(const char *first, const char *last, const char *text);

/* Whether a word equals this text. */
bool ffd_text_is(text_word word, const char *text);
/* The same, without regard to case. text is in lower case. */
bool ffd_text_is_any_case(text_word word, const char *text);
/* Whether two words have the same bytes. */
bool ffd_text_same(text_word a, text_word b);
/* Reads a whole word as a number. Returns false if it is not one. */
bool ffd_text_number(text_word word, double *value);
/* Reads a whole word of digits; UINT64_MAX if the number is larger. Returns false for any other word. */
bool ffd_text_whole(text_word word, uint64_t *value);
/* Returns how many bytes of a word to show in a message: long words are cut, but not within a UTF-8
   character. */
int ffd_text_display_size(text_word word);
typedef struct text_shown {
    char text[128];
} text_shown;
/* Returns a word cut in that way, with the symbol U+2400 in the place of each NUL character. */
text_shown ffd_text_shown(text_word word);

/* Capacity for the text of ffd_text_lines. */
#define TEXT_LINES_CAPACITY 64
/* Writes the lines in which two files differ: " (line 4)" if a equals b, else " (lines 4 and 5)". */
void ffd_text_lines(size_t a, size_t b, char text[TEXT_LINES_CAPACITY]);

/* Returns "LF", "CRLF", "CR", "mixed", or "none". */
const char *ffd_text_line_ends(const void *data, size_t size);

/* Whether a character separates words of a line. */
static inline bool ffd_text_is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}

#endif
