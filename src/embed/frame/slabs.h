/* slabs.h - a point in the common part of two parallelepipeds, given as slabs. */
#ifndef FFD_EMBED_FRAME_SLABS_H
#define FFD_EMBED_FRAME_SLABS_H

#include <stdbool.h>

/* All d with |row . d - middle| <= half. */
typedef struct slab {
    double row[3], middle, half;
} slab;

/* Three slabs of each parallelepiped. */
#define SLABS 6

/* Finds the middle of the corners of the slabs' common part. Returns false if that is empty. */
bool ffd_slabs_find(const slab slabs[SLABS], double middle[3]);

#endif
