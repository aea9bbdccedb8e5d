/* off_walk.h - the vertices and faces after an OFF header, word by word, in the order of the file. */
#ifndef FFD_IO_OFF_OFF_WALK_H
#define FFD_IO_OFF_OFF_WALK_H

#include "io/off/off_header.h"

#define OFF_NUMBERS_MAX 6

typedef struct off_walk {
    const off_header *header;
    text_scan scan;
    bool pass_line; /* the rest of the line belongs to the vertex or face that was taken last */
    size_t rest;    /* free layout: remaining words of the current vertex */
    bool in_faces;
} off_walk;

typedef struct off_vertex {
    text_word numbers[OFF_NUMBERS_MAX]; /* x y z, nx ny nz */
    /* How many numbers were found: all that off_vertex_width says, in a file that was checked. */
    size_t found;
    size_t line;
} off_vertex;

/* Begins a walk at the first vertex after the header. */
void ffd_off_walk_begin(const off_header *header, off_walk *walk);
/* Moves to the next vertex. Returns false at the end of the file. */
bool ffd_off_walk_vertex(off_walk *walk, off_vertex *vertex);
/* Moves to the next face. Returns false at the end of the file. */
bool ffd_off_walk_face(off_walk *walk);
/* Takes the next whole number of the current face: the number of its corners, then each corner. Returns false
   if the next word is not a whole number; *word is that word, or empty at the end. */
bool ffd_off_walk_whole(off_walk *walk, text_word *word, uint64_t *number);
/* Takes the next word after the numbers of the current vertex, or after the last corner of the face. Returns
   false if none is left. */
bool ffd_off_walk_rest(off_walk *walk, text_word *word);

/* Moves to the next face of a checked file and returns the number of its corners. */
size_t ffd_off_walk_face_size(off_walk *walk);
/* Returns the next corner's vertex in a checked file; UINT32_MAX if there is no number, because another
   program has changed the file since. */
uint32_t ffd_off_walk_corner_index(off_walk *walk);

#endif
