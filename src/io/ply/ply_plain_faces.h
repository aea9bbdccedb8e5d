/* ply_plain_faces.h - a fast path for the faces of nearly all binary PLY files: rows with one list, whose
   count is a byte and whose corners are 32-bit, besides numbers of fixed size. It is many times faster than
   reading value by value. */
#ifndef FFD_IO_PLY_PLY_PLAIN_FACES_H
#define FFD_IO_PLY_PLY_PLAIN_FACES_H

#include "base/little_endian.h"
#include "io/ply/ply_walk.h"

/* The maximum number of corners of a plain face. */
#define PLY_PLAIN_CORNERS 255

typedef struct ply_plain_faces {
    size_t before, behind; /* bytes of a row before the list, and after it */
    size_t limit;          /* corners must be less */
    unsigned count_limit;  /* counts must be less */
    bool swapped;          /* corners are big-endian */
} ply_plain_faces;

/* Whether the faces of an element are plain. vertices: the number of vertices. */
bool ffd_ply_plain_faces(ply_encoding encoding, const ply_element *element, const ply_property *list,
                         size_t vertices, ply_plain_faces *plain);

static inline uint32_t ffd_ply_swap(uint32_t value)
{
    return value >> 24 | (value >> 8 & 0xff00) | (value << 8 & 0xff0000) | value << 24;
}

/* Reads a row and its corners. Returns false, and moves nothing, if the row is not as expected. Inline,
   because it is called for every face. */
static inline bool ffd_ply_plain_face(const ply_plain_faces *plain, ply_walk *walk,
                                      uint32_t corners[PLY_PLAIN_CORNERS], size_t *count)
{
    const unsigned char *at = (const unsigned char *)walk->at + plain->before;
    const size_t left = (size_t)(walk->last - walk->at);
    uint32_t largest = 0;
    if (left <= plain->before || *at >= plain->count_limit ||
        left - plain->before - 1 < sizeof *corners * *at + plain->behind)
        return false;
    *count = *at++;
    for (size_t i = 0; i < *count; i++, at += sizeof *corners) {
        corners[i] = plain->swapped ? ffd_ply_swap(load_u32(at)) : load_u32(at);
        largest = corners[i] > largest ? corners[i] : largest;
    }
    if (*count > 0 && largest >= plain->limit)
        return false;
    walk->at = (const char *)at + plain->behind;
    return true;
}

#endif
