/* obj_names.h - a list of words, to count the distinct ones. */
#ifndef FFD_IO_OBJ_OBJ_NAMES_H
#define FFD_IO_OBJ_OBJ_NAMES_H

#include "io/obj/obj_scan.h"

/* Zeroed: the empty list. The words stay the caller's. */
typedef struct obj_names {
    text_word *words;
    size_t count, capacity;
} obj_names;

/* False when there is no memory. */
bool ffd_obj_names_add(obj_names *names, text_word word);
/* Leaves each word once, in another order, and tells how many that are. */
size_t ffd_obj_names_distinct(obj_names *names);
/* Frees the names. */
void ffd_obj_names_free(obj_names *names);

#endif
