/* obj_number.h - the numbers of an OBJ file's statements. */
#ifndef FFD_IO_OBJ_OBJ_NUMBER_H
#define FFD_IO_OBJ_OBJ_NUMBER_H

#include "io/obj/obj_scan.h"

/* Reads a word that is a number from its first to its last character. An exponent with its sign on the
   wrong side ("3.1+e2") is accepted and not applied: some files have it, and the readers that they are
   made for stop before it. */
bool ffd_obj_number(text_word word, double *value);

/* Takes a scan's next argument if it is a number. Otherwise returns false and takes nothing; the caller
   then reads it as a word. */
bool ffd_obj_scan_number(obj_scan *scan, double *value);

/* Takes a scan's next three arguments if they are numbers of the usual form: at most 16 digits, perhaps a
   minus and a point, one blank before each, and not at the very end of the text. Otherwise returns false,
   takes nothing and leaves values undefined; the caller then takes them one by one. */
bool ffd_obj_scan_numbers(obj_scan *scan, double values[3]);

#endif
