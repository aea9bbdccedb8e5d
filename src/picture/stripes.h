/* stripes.h - diagonal stripes, by which the colour-blind too tell marks from the scales of colours. */
#ifndef FFD_PICTURE_STRIPES_H
#define FFD_PICTURE_STRIPES_H

#include "picture/picture_scene.h"
#include <stdbool.h>
#include <stdint.h>

/* How much darker every second stripe of a surface is. */
#define STRIPE_DARK 0.04

/* Whether a pixel is in a second stripe. period: pixels along a row from a stripe to the next one of its
 * colour. */
bool ffd_stripes_second(picture_stripes stripes, int32_t period, int64_t x, int64_t y);

#endif
