/* obj_corner.h - the corners of an OBJ file's faces, lines and points. */
#ifndef FFD_IO_OBJ_OBJ_CORNER_H
#define FFD_IO_OBJ_OBJ_CORNER_H

#include "base/bytes.h"
#include "io/obj/obj_scan.h"
#include <stdint.h>

/* An index of a corner: as written, from 1 or counting back from -1. Too large ones stay out of every range.
 */
typedef struct obj_index {
    int64_t value;
    text_word text; /* empty: not given */
} obj_index;

typedef struct obj_corner {
    obj_index vertex, texcoord, normal;
} obj_corner;

/* Takes a scan's next argument if it is a corner of digits and slashes only and has a vertex. Otherwise
   returns false and takes nothing; the caller then reads it as a word. */
bool ffd_obj_scan_corner(obj_scan *scan, obj_corner *corner);

/* Reads v, v/t, v//n or v/t/n; a slash with nothing after it is allowed. False for anything else. */
bool ffd_obj_corner(text_word word, obj_corner *corner);

/* Bytes that must be readable for the following functions. */
#define OBJ_CORNER_ROOM 40

/* How many digits the three indices of a corner have, and the position after the last. */
typedef struct obj_corner_form {
    int vertex, texcoord, normal, end;
} obj_corner_form;

/* Finds the two slashes of a corner whose indices have at most eight digits, the vertex at least one. All
   are found at once: a search index by index would wait for the end of the one before. Returns false if the
   text begins otherwise. */
static ALWAYS_INLINE bool ffd_obj_find_slashes(const char *at, obj_corner_form *form)
{
    uint32_t others = bytes_not_digits_of_32(at);
    int end[3];
    for (int i = 0; i < 3; i++, others &= others - 1) {
        if (!others)
            return false;
        end[i] = __builtin_ctz(others);
    }
    *form = (obj_corner_form){end[0], end[1] - end[0] - 1, end[2] - end[1] - 1, end[2]};
    return at[end[0]] == '/' && at[end[1]] == '/' && form->vertex > 0 && form->vertex <= 8 &&
           form->texcoord <= 8 && form->normal <= 8;
}

/* Reads the vertex and normal index of a corner v//n or v/t/n. Returns the position after it; NULL if the
   text is anything else. */
static ALWAYS_INLINE const char *ffd_obj_pair_at(const char *at, byte_numbers *indices)
{
    obj_corner_form form;
    if (!ffd_obj_find_slashes(at, &form) || form.normal == 0)
        return NULL;
    const unsigned char *const text = (const unsigned char *)at;
    const uint64_t vertex = load_u64(text) ^ '0' * BYTES_ONES,
                   normal = load_u64(text + form.end - form.normal) ^ '0' * BYTES_ONES;
    *indices = bytes_two_numbers(vertex << (64 - 8 * form.vertex), normal << (64 - 8 * form.normal));
    return at + form.end;
}

#endif
