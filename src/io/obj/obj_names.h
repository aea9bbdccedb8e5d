/* obj_names.h - names: that of a statement, and a list of words, to count the distinct ones. */
#ifndef FFD_IO_OBJ_OBJ_NAMES_H
#define FFD_IO_OBJ_OBJ_NAMES_H

#include "io/obj/obj_scan.h"

/* The name of `o` and `usemtl`, which may hold blanks: the text from the first to the last word of the
   statement that is left; empty if there is none. */
text_word ffd_obj_names_line(obj_scan *scan);

/* Zeroed: the empty list. The words stay the caller's. */
typedef struct obj_names {
    text_word *words;
    size_t count, capacity;
} obj_names;

/* Adds a word. Returns false if memory ran out. */
bool ffd_obj_names_add(obj_names *names, text_word word);
/* Removes repeated words, which changes the order. Returns how many words are left. */
size_t ffd_obj_names_distinct(obj_names *names);
/* Frees the names. */
void ffd_obj_names_free(obj_names *names);

#endif
