/* samples.h - the samples of some rows of a picture: four a pixel, each with how far away it is and its
 * colour. */
#ifndef FFD_PICTURE_SAMPLES_H
#define FFD_PICTURE_SAMPLES_H

#include "picture/surface.h"
#include <math.h>

#define SAMPLES 4
/* Where they are in a pixel: no two in a row or a column, so that edges near either are smooth too. */
#define SAMPLE_X                                                                                             \
    {                                                                                                        \
        96, 224, 32, 160                                                                                     \
    }
#define SAMPLE_Y                                                                                             \
    {                                                                                                        \
        32, 96, 160, 224                                                                                     \
    }
/* No sample is nearer to the border of its pixel. */
#define SAMPLE_MARGIN 32
/* Columns of a block: as many as a band has rows. */
#define BLOCK 8
/* How far away the background is. */
#define SAMPLE_EMPTY HUGE_VALF

typedef struct samples {
    int32_t left, top; /* the first pixel */
    int32_t width, rows;
    float *depth;    /* SAMPLES a pixel */
    uint64_t *color; /* likewise: linear_pack */
    /* For each BLOCK columns of a band a depth that no sample of theirs is farther than; NULL: not known. */
    float *blocks;
} samples;

/* The pixels that have samples within [low, high], in parts of a pixel: none where *last is less than *first.
 */
static inline void samples_span(int64_t low, int64_t high, int64_t *first, int64_t *last)
{
    *first = (low + SAMPLE_MARGIN - 1) >> 8;
    *last = (high - SAMPLE_MARGIN) >> 8;
}

#endif
