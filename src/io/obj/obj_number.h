/* obj_number.h - the numbers of an OBJ file's statements. */
#ifndef FFD_IO_OBJ_OBJ_NUMBER_H
#define FFD_IO_OBJ_OBJ_NUMBER_H

#include "io/obj/obj_scan.h"

/* Reads a word that is a number as a whole. An exponent with its sign on the wrong side ("3.1+e2") is
   accepted and not applied: some files have it, and the readers that they are made for stop before it. */
bool ffd_obj_number(text_word word, double *value);

/* Takes a scan's next argument if it is a number. False, and nothing is taken, where it is anything else: the
   caller then reads it as a word. */
bool ffd_obj_scan_number(obj_scan *scan, double *value);

/* Takes a scan's next three arguments if they are numbers as most are: digits, 16 at most, with a point or a
   minus or without, one blank before each, and not at the very end of the text. False, and nothing is taken,
   where they are not: the caller then takes them one by one. values are undefined then. */
bool ffd_obj_scan_numbers(obj_scan *scan, double values[3]);

#endif
