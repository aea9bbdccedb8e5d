/* picture.h - a software renderer for meshes and cages. The pixels are the same on every machine and for any
   number of threads, because it uses only integers and + - * / and square roots in a fixed order.

   The projection is parallel: equal lengths have equal size everywhere in a picture, so displacements can be
   compared by eye, and there is no near plane. */
#ifndef FFD_PICTURE_PICTURE_H
#define FFD_PICTURE_PICTURE_H

#include "base/fail.h"
#include "mesh/memory_budget.h"
#include "picture/picture_scene.h"
#include <stdbool.h>
#include <stdint.h>

/* The greatest width and height, and the greatest number of pixels. */
#define PICTURE_MOST_SIDE 32767
#define PICTURE_MOST_PIXELS ((uint64_t)1 << 27)

/* Returns about how many bytes drawing takes, with panels of so many vertices and triangles. */
uint64_t ffd_picture_bytes(uint64_t pixels, uint64_t vertices, uint64_t triangles);
/* Draws a picture. *pixels: sRGB bytes red, green, blue, rows from the top; free with ffd_free. budget:
   limits the memory for drawing; may be NULL. Errors: FFD_E_ARGUMENT (the size), FFD_E_MEMORY,
   FFD_E_LIMIT. */
ffd_status ffd_picture_draw(const picture *of, const memory_budget *budget, uint8_t **pixels,
                            ffd_error *error);

#endif
