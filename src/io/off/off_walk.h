/* off_walk.h - the vertices and faces after an OFF header, word by word, in the order of the file. */
#ifndef FFD_IO_OFF_OFF_WALK_H
#define FFD_IO_OFF_OFF_WALK_H

#include "io/off/off_header.h"

#define OFF_NUMBERS_MAX 6

typedef struct off_walk {
    const off_header *header;
    text_scan scan;
    bool pass_line; /* what is left of the line belongs to what was taken last */
    size_t rest;    /* free layout: words of the current vertex that are left */
    bool in_faces;
} off_walk;

typedef struct off_vertex {
    text_word numbers[OFF_NUMBERS_MAX]; /* x y z, nx ny nz */
    size_t found;                       /* of off_header_numbers; all in a file that was read */
    size_t line;
} off_vertex;

/* Begins a walk at the first vertex after the header. */
void ffd_off_walk_begin(const off_header *header, off_walk *walk);
/* Goes to the next vertex. False at the end of the file. */
bool ffd_off_walk_vertex(off_walk *walk, off_vertex *vertex);
/* Goes to the next face. False at the end of the file. */
bool ffd_off_walk_face(off_walk *walk);
/* Takes the next whole number of the current face: that of its corners, then each corner. False: it is not
   one, and *word is what is there; empty: nothing. */
bool ffd_off_walk_whole(off_walk *walk, text_word *word, uint64_t *number);
/* Takes the next word after the numbers of the current vertex, or after the last corner of the face. */
bool ffd_off_walk_rest(off_walk *walk, text_word *word);

/* In a file that was read: goes to the next face and takes the number of its corners. */
size_t ffd_off_walk_face_size(off_walk *walk);
/* Likewise: takes the number of a corner's vertex. */
uint32_t ffd_off_walk_corner_index(off_walk *walk);

#endif
