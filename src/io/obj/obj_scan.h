/* obj_scan.h - the statements of an OBJ file and their words.

   A statement is a keyword and its arguments on one line, which a backslash right before the line's end
   continues on the next. Where numbers are expected, blanks may come between the two: nothing else can be
   meant. A name may end with a backslash. Lines end with LF, CRLF or CR, also mixed; blanks and tabs
   separate; a byte order mark is skipped. A comment reaches from # to the end of its line and is never
   continued (its last character may well be the backslash of a Windows path). It may also follow arguments,
   even without a blank ("f 1 2 3# face"), but not the names of g, o, usemtl and mtllib, where # is a
   character like others. */
#ifndef FFD_IO_OBJ_OBJ_SCAN_H
#define FFD_IO_OBJ_OBJ_SCAN_H

#include "base/text/text_scan.h"
#include <stdbool.h>
#include <stddef.h>

typedef enum obj_keyword {
    OBJ_OTHER, /* left alone */
    OBJ_VERTEX,
    OBJ_TEXCOORD,
    OBJ_NORMAL,
    OBJ_FACE,
    OBJ_LINE,
    OBJ_POINT,
    OBJ_GROUP,
    OBJ_OBJECT,
    OBJ_MATERIAL,
    OBJ_LIBRARY
} obj_keyword;

/* Something odd that is read all the same: how often, and the line of the first time. */
typedef struct obj_oddity {
    size_t count, line;
} obj_oddity;

typedef struct obj_scan {
    const char *at, *last;
    size_t line;         /* of at, from 1 */
    bool plain;          /* [at, last) has no CR, no backslash and no #: lines end at LF alone */
    bool inside;         /* at is in a statement, not between two */
    obj_keyword keyword; /* of the statement begun last */
    text_word name;      /* the keyword as written */
    size_t keyword_line;
    obj_oddity loose;  /* continuations with blanks after the backslash */
    obj_oddity joined; /* continuations by a line that seems to be a statement of its own */
} obj_scan;

/* Whether a keyword is one of the OBJ specification, of its older versions, or of a common extension: vc
   (vertex colours), vw (weights) and t (tags of subdivision). */
bool ffd_obj_is_known(text_word name);

/* Begins a scan of these bytes, which must stay as long as it is used. */
void ffd_obj_scan_begin(obj_scan *scan, const void *data, size_t size);
/* Whether a text is plain (see obj_scan). */
bool ffd_obj_is_plain(const char *first, const char *last);
/* Moves past the current statement, if any, and its line's end. */
void ffd_obj_scan_finish(obj_scan *scan);
/* Moves to the next statement, after its keyword. False at the end of the file. */
bool ffd_obj_scan_next(obj_scan *scan);
/* Takes the next argument of the current statement. False (and *word is empty) where there is none left. */
bool ffd_obj_scan_word(obj_scan *scan, text_word *word);
/* Takes the next three, or as many as there are; returns how many. */
size_t ffd_obj_scan_words(obj_scan *scan, text_word words[3]);

/* What a character is to the scanner. */
enum { OBJ_ORDINARY = 0, OBJ_BLANK, OBJ_LINE_END, OBJ_BACKSLASH, OBJ_HASH };
extern const unsigned char ffd_obj_classes[256];

static inline int ffd_obj_class(const char *at)
{
    return ffd_obj_classes[(unsigned char)*at];
}

/* Moves past blanks and continuations, to a word, a comment or the end of the line. */
void ffd_obj_scan_pass_blanks(obj_scan *scan);

/* For readers that parse an argument without splitting off its word first. The first function returns where
   the next argument begins; the second takes it up to `end` if the word ends there, else it returns false and
   takes nothing. Inline: they are called for every number of a file. */
static inline const char *ffd_obj_scan_argument(obj_scan *scan)
{
    /* Most often there is one blank before it. */
    if (scan->last - scan->at > 1 && *scan->at == ' ' && ffd_obj_class(scan->at + 1) == OBJ_ORDINARY)
        scan->at++;
    else
        ffd_obj_scan_pass_blanks(scan);
    return scan->at;
}

/* Whether a character ends words wherever it is. */
static inline bool ffd_obj_ends_any_word(const char *at)
{
    return ffd_obj_class(at) == OBJ_BLANK || ffd_obj_class(at) == OBJ_LINE_END;
}

static inline bool ffd_obj_scan_take(obj_scan *scan, const char *end)
{
    if (end < scan->last && !ffd_obj_ends_any_word(end))
        return false;
    scan->at = end;
    return true;
}

/* Whether the statement certainly has no more arguments; false does not mean that it has some. */
static inline bool ffd_obj_scan_is_over(const obj_scan *scan)
{
    return scan->at == scan->last || ffd_obj_class(scan->at) == OBJ_LINE_END;
}

/* The line end that starts at a character, given that one does: its length, 1 or 2. */
size_t ffd_obj_line_end_size(const char *at, const char *last);

#endif
