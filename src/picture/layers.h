/* layers.h - surfaces that let through what is behind them: for each pixel its fragments, from the nearest to
   the farthest. What comes out does not depend on the order in which they are drawn, as long as a pixel has
   no more than there is room for. */
#ifndef FFD_PICTURE_LAYERS_H
#define FFD_PICTURE_LAYERS_H

#include <stddef.h>
#include <stdint.h>

/* The samples of a pixel. */
#define SAMPLES 4
/* The most fragments of a pixel. Of more the two farthest become one, which is seen least. */
#define LAYERS_MOST 16

typedef struct layer {
    float depth;
    uint32_t samples; /* a bit for each sample that it covers */
    uint64_t color;   /* linear_pack; in the highest 16 bits its alpha, LINEAR_ONE: opaque */
} layer;

/* The fragments of the pixels of a band. */
typedef struct layers {
    uint8_t *counts;
    layer *list; /* LAYERS_MOST for each pixel */
} layers;

/* Empties the first `pixels` pixels. */
void ffd_layers_clear(layers *of, size_t pixels);
/* Adds a fragment. Of equal depths the one that was added first is nearer. */
void ffd_layers_add(layers *of, size_t pixel, const layer *fragment);
/* Lays the fragments of a pixel over the colours of its samples. */
void ffd_layers_blend(const layers *of, size_t pixel, uint64_t *colors);

#endif
