/* letters.h - short texts in a picture. The letters are strokes through the dots of a small matrix, so that
   they are smooth in any size. */
#ifndef FFD_PICTURE_LETTERS_H
#define FFD_PICTURE_LETTERS_H

#include "picture/strokes.h"

/* Dots that a letter is apart from the next one, and lines are high. */
#define LETTER_STEP 6
#define LETTER_ROWS 7

/* How wide a text is, in dots. */
double ffd_letters_width(const char *text);
/* Draws a text whose upper left dot is at (x, y), with a dot of so many pixels. Of UTF-8, what is not ASCII
   becomes
   '?'. */
void ffd_letters_draw(const stroke_target *into, const char *text, double x, double y, double dot,
                      uint64_t color);

#endif
