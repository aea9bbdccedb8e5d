/* image.h - PNG and JPEG: decoding both, writing PNG. image.c looks at the first bytes, image_size.c at the
   size. png.c and jpeg.c use the libraries and are part of a module; image_load.c, in their place, loads it.
 */
#ifndef FFD_PICTURE_IMAGE_IMAGE_H
#define FFD_PICTURE_IMAGE_IMAGE_H

#include "base/fail.h"
#include "mesh/memory_budget.h"
#include <stddef.h>
#include <stdint.h>

/* No side is longer, and no image has more pixels: a short file can say that it is of any size. */
#define IMAGE_MOST_SIDE 32767
#define IMAGE_MOST_PIXELS ((uint64_t)1 << 27)

typedef struct image {
    uint32_t width, height;
    uint8_t *pixels; /* red, green, blue, alpha, rows from the top; ffd_free frees them */
} image;

/* Takes bytes that follow each other. */
typedef ffd_status (*image_sink)(void *context, const void *bytes, size_t size, ffd_error *error);

/* Decodes a PNG or JPEG file that is in memory. What it needs is checked against the budget (NULL: there is
   none) and the limits above before it is allocated. Errors: FFD_E_INVALID (broken, cut off),
   FFD_E_UNSUPPORTED (of another kind; CMYK), FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_image_decode(const unsigned char *bytes, size_t size, const memory_budget *budget,
                            image *result, ffd_error *error);

/* Whether decoding can take so many pixels of so many bytes in all. */
ffd_status ffd_image_check(uint64_t width, uint64_t height, uint64_t bytes_a_pixel,
                           const memory_budget *budget, ffd_error *error);

/* ffd_image_decode, of what is known to begin as a PNG file. */
ffd_status ffd_png_decode(const unsigned char *bytes, size_t size, const memory_budget *budget, image *result,
                          ffd_error *error);
/* ffd_image_decode, of what is known to begin as a JPEG file. */
ffd_status ffd_jpeg_decode(const unsigned char *bytes, size_t size, const memory_budget *budget,
                           image *result, ffd_error *error);
/* Hands the bytes of a PNG file of pixels of 3 bytes, red, green, blue, to sink. Errors: FFD_E_MEMORY, and
 * the sink's. */
ffd_status ffd_png_write(const uint8_t *pixels, uint32_t width, uint32_t height, image_sink sink,
                         void *context, ffd_error *error);

#endif
