/* samples.h - the samples of some rows of a picture: four for each pixel, each with a depth and a colour. */
#ifndef FFD_PICTURE_SAMPLES_H
#define FFD_PICTURE_SAMPLES_H

#include "picture/layers.h"
#include "picture/surface.h"
#include <math.h>

/* Positions of the samples in a pixel, in subpixels (rotated grid): no two share a row or a column, so nearly
   horizontal and vertical edges are smooth too. */
#define SAMPLE_X                                                                                             \
    {                                                                                                        \
        96, 224, 32, 160                                                                                     \
    }
#define SAMPLE_Y                                                                                             \
    {                                                                                                        \
        32, 96, 160, 224                                                                                     \
    }
/* The least distance of a sample from the border of its pixel. */
#define SAMPLE_MARGIN 32
/* Columns of a block; it is as high as a band. */
#define BLOCK 8
/* Depth of the background. */
#define SAMPLE_EMPTY HUGE_VALF

typedef struct samples {
    int32_t left, top; /* position of the first pixel */
    int32_t width, rows;
    float *depth;    /* SAMPLES for each pixel */
    uint64_t *color; /* SAMPLES for each pixel, as linear_pack */
    /* For each block of a band an upper bound of the depth of its samples; NULL: unknown. */
    float *blocks;
    layers *layers; /* of see-through surfaces; NULL: these are drawn as if they were opaque */
} samples;

/* Finds the pixels with samples in [low, high], in subpixels; none if *last < *first. */
static inline void samples_between(int64_t low, int64_t high, int64_t *first, int64_t *last)
{
    *first = (low + SAMPLE_MARGIN - 1) >> 8;
    *last = (high - SAMPLE_MARGIN) >> 8;
}

#endif
