/* code_scan.h - scans the words of a text with the comments, brackets and strings of C. Bytes are only looked
   at where they are scanned: other parts of the file may be binary. */
#ifndef FFD_BASE_TEXT_CODE_SCAN_H
#define FFD_BASE_TEXT_CODE_SCAN_H

#include "base/text/text_scan.h"

/* Moves past blanks, line ends and comments. Returns false at the end of the text, also within a comment. */
bool ffd_code_find(text_scan *scan);
/* Takes the next word, which ends before a blank, a bracket, a semicolon, a quote or a comment. Returns
   false, and takes nothing, if a mark or the end is next. */
bool ffd_code_word(text_scan *scan, text_word *word);
/* Takes this mark: a bracket or a semicolon. Returns false, and takes nothing, if something else is next. */
bool ffd_code_mark(text_scan *scan, char mark);
/* Takes a string in double quotes, without these. Returns false, and takes nothing, if none is next, or if
   it does not end. */
bool ffd_code_string(text_scan *scan, text_word *word);

#endif
