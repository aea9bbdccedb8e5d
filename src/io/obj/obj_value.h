/* obj_value.h - what a word of an OBJ statement stands for: a number, or a corner of a face, line or point.
 */
#ifndef FFD_IO_OBJ_OBJ_VALUE_H
#define FFD_IO_OBJ_OBJ_VALUE_H

#include "io/obj/obj_scan.h"
#include <stdint.h>

/* Reads a word that is a number as a whole. An exponent with its sign on the wrong side ("3.1+e2") is let
   pass and not applied: files hold it, and the readers that they are made for stop in front of it. */
bool ffd_obj_number(text_word word, double *value);

/* Takes a scan's next argument if it is a number. False, and nothing is taken, where it is anything else: it
   is then a word to be looked at. */
bool ffd_obj_scan_number(obj_scan *scan, double *value);

/* An index of a corner: as written, from 1 or counting back from -1. Too large ones stay out of every range.
 */
typedef struct obj_index {
    int64_t value;
    text_word text; /* empty: there is none */
} obj_index;

typedef struct obj_corner {
    obj_index vertex, texcoord, normal;
} obj_corner;

/* Takes a scan's next argument if it is a corner in digits and slashes alone, and its vertex is there. False,
   and nothing is taken, where it is anything else: it is then a word to be looked at. */
bool ffd_obj_scan_corner(obj_scan *scan, obj_corner *corner);

/* Reads v, v/t, v//n or v/t/n; a slash with nothing behind it is allowed. False for anything else. */
bool ffd_obj_corner(text_word word, obj_corner *corner);

#endif
