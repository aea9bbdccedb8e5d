/* picture.h - draws meshes and cages into an image, by the processor alone: the same pixels on every machine
   and for any number of threads, since all is decided by integers and by + - * / and square roots in a fixed
   order.

   The projection is parallel: equal lengths are equal wherever they are in a picture, so that what moved can
   be measured by eye, and no mesh is too near to be seen. */
#ifndef FFD_PICTURE_PICTURE_H
#define FFD_PICTURE_PICTURE_H

#include "base/fail.h"
#include "mesh/memory_budget.h"
#include "picture/picture_scene.h"
#include <stdbool.h>
#include <stdint.h>

/* The largest width and height, and the most pixels. */
#define PICTURE_MOST_SIDE 32767
#define PICTURE_MOST_PIXELS ((uint64_t)1 << 27)

/* Draws into *pixels, which ffd_free frees: red, green, blue, rows from the top, sRGB. The budget may be
   NULL; what drawing takes is checked against it. Errors: FFD_E_ARGUMENT (the size), FFD_E_MEMORY,
   FFD_E_LIMIT. */
ffd_status ffd_picture_draw(const picture *of, const memory_budget *budget, uint8_t **pixels,
                            ffd_error *error);

#endif
