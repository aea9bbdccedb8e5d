/* strokes.h - lines and discs with antialiased edges, drawn over surfaces. */
#ifndef FFD_PICTURE_STROKES_H
#define FFD_PICTURE_STROKES_H

#include "picture/samples.h"

/* The pixels of some rows in linear light, with the depths of surfaces. */
typedef struct stroke_target {
    int32_t left, top, width, rows;
    uint64_t *pixels;      /* linear_pack */
    const samples *depths; /* samples of the same pixels; NULL: nothing hides a stroke */
} stroke_target;

typedef struct stroke {
    uint64_t color;  /* linear_pack, where the stroke begins */
    uint64_t end;    /* where it ends: in between the colours are mixed */
    uint64_t second; /* of every second stripe */
    picture_stripes stripes;
    int32_t period; /* of the stripes, in pixels */
    double half_width;
    double hidden; /* opacity of hidden parts, 0 to 1 */
} stroke;

/* Draws a stroke between two points (x, y in pixels, z the depth of samples); a disc if both are equal. */
void ffd_stroke_draw(const stroke_target *into, const stroke *with, const double from[3], const double to[3]);

#endif
