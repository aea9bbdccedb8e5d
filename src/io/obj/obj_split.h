/* obj_split.h - which `vn` holds which new normal, where vertices that share one need different values. */
#ifndef FFD_IO_OBJ_OBJ_SPLIT_H
#define FFD_IO_OBJ_OBJ_SPLIT_H

#include "io/obj/obj_document.h"

/* Every `vn` keeps one value: the old one where a vertex still needs it, else that of the first vertex that
   uses it. Each other value of the same `vn` gets an added `vn`, once. Pairs are those of the document. */
typedef struct obj_split {
    uint32_t *keeper; /* of each `vn`: a pair that has its value; OBJ_NONE: it stays: no corner uses it, or
                         one that is not selected does */
    uint32_t *added;  /* of each added `vn`: a pair that has its value */
    size_t added_count;
    uint32_t *target; /* of each pair: its added `vn`, or OBJ_NONE: its own; NULL where none is added */
} obj_split;

/* document must have new normals. */
ffd_status ffd_obj_split_normals(const obj_document *document, obj_split *split, ffd_error *error);
/* Frees what a split holds. */
void ffd_obj_split_free(obj_split *split);

#endif
