/* letters.h - short texts in a picture. Letters are strokes through the dots of a small matrix, so they are
   smooth at any size. */
#ifndef FFD_PICTURE_LETTERS_H
#define FFD_PICTURE_LETTERS_H

#include "picture/strokes.h"

/* Distance of consecutive letters and height of a line, in dots. */
#define LETTER_STEP 6
#define LETTER_ROWS 7

/* Returns the width of a text in dots. */
double ffd_letters_width(const char *text);
/* Draws a UTF-8 text with its upper left dot at (x, y). dot: pixels for a dot. Characters other than ASCII
   become '?'. */
void ffd_letters_draw(const stroke_target *into, const char *text, double x, double y, double dot,
                      uint64_t color);

#endif
