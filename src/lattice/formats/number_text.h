/* number_text.h - texts of numbers with white space between them, as the files of other programs have them.
 */
#ifndef FFD_LATTICE_FORMATS_NUMBER_TEXT_H
#define FFD_LATTICE_FORMATS_NUMBER_TEXT_H

#include "base/fail.h"
#include "base/text/text_scan.h"
#include <math.h>

/* Takes the next word of the file, in this line or a later one. Returns false, with an empty word, at its
   end. */
static inline bool ffd_next_word(text_scan *scan, text_word *word)
{
    *word = (text_word){scan->at, scan->at};
    return ffd_text_find(scan) && ffd_text_word(scan, word);
}

/* Takes the next word as a finite number. Errors: FFD_E_INVALID, with the line. */
static inline ffd_status ffd_next_number(text_scan *scan, const char *name, double *number, ffd_error *error)
{
    text_word word;
    if (!ffd_next_word(scan, &word))
        return ffd_fail_file(error, FFD_E_INVALID, name, "ends where a number is expected");
    if (!ffd_text_number(word, number) || !isfinite(*number))
        return ffd_fail_line(error, FFD_E_INVALID, name, scan->line, "\"%s\" is not a finite number",
                             ffd_text_shown(word).text);
    return FFD_OK;
}

#endif
