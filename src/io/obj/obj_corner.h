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

/* Corners in 64 bytes, whose kinds are found once for all of them. */
typedef struct obj_corner_run {
    const char *text;
    uint64_t others; /* a bit for each byte that is not a digit, from the next corner on */
    int first;       /* offset of the next corner */
} obj_corner_run;

/* Bytes that must be readable from a run's start on: an index may begin with the last of the 64. */
#define OBJ_RUN_ROOM 72

static ALWAYS_INLINE obj_corner_run ffd_obj_run_at(const char *text)
{
    return (obj_corner_run){text, bytes_not_digits_of_64(text), 0};
}

/* Takes the vertex and normal index of the run's next corner, v//n or v/t/n, and the character after it.
   Returns the position of that; NULL, and the run stays, if the text is anything else, or goes on beyond the
   64 bytes. */
static ALWAYS_INLINE const char *ffd_obj_run_pair(obj_corner_run *run, byte_numbers *indices)
{
    const unsigned char *const text = (const unsigned char *)run->text;
    const uint64_t second = run->others & (run->others - 1), third = second & (second - 1);
    if (!third)
        return NULL;
    const int slash = __builtin_ctzll(run->others), other_slash = __builtin_ctzll(second),
              end = __builtin_ctzll(third), vertex = slash - run->first, normal = end - other_slash - 1;
    if (text[slash] != '/' || text[other_slash] != '/' || (unsigned)vertex - 1 >= 8 ||
        (unsigned)normal - 1 >= 8)
        return NULL;
    const uint64_t v = load_u64(text + run->first) ^ '0' * BYTES_ONES,
                   n = load_u64(text + other_slash + 1) ^ '0' * BYTES_ONES;
    *indices = bytes_two_numbers(v << (64 - 8 * vertex), n << (64 - 8 * normal));
    run->others = third & (third - 1);
    run->first = end + 1;
    return run->text + end;
}

#endif
