/* strokes.h - lines and discs with smooth edges, over what surfaces have left. */
#ifndef FFD_PICTURE_STROKES_H
#define FFD_PICTURE_STROKES_H

#include "picture/samples.h"

/* Pixels of some rows in linear light, and what is in front of them. */
typedef struct stroke_target {
    int32_t left, top, width, rows;
    uint64_t *pixels;      /* linear_pack */
    const samples *depths; /* of the same pixels; NULL: nothing hides a stroke */
} stroke_target;

typedef struct stroke {
    uint64_t color; /* linear_pack */
    double half_width;
    double hidden; /* how much of it shows through what is in front of it, 0 to 1 */
} stroke;

/* A stroke from one point to another, in pixels and the depth of samples; a disc where both are the same. */
void ffd_stroke_draw(const stroke_target *into, const stroke *with, const double from[3], const double to[3]);

#endif
