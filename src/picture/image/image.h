/* image.h - decodes PNG, JPEG and WebP, and writes PNG. image.c detects the format, image_header.c finds the
   size and image_size.c checks it. png.c, jpeg.c and webp.c use the libraries, in a module; image_load.c
   replaces them in the program and loads the module. */
#ifndef FFD_PICTURE_IMAGE_IMAGE_H
#define FFD_PICTURE_IMAGE_IMAGE_H

#include "base/fail.h"
#include "mesh/memory_budget.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Limits of images, because a short file can claim any size. */
#define IMAGE_MOST_SIDE 32767
#define IMAGE_MOST_PIXELS ((uint64_t)1 << 27)
/* Decoding takes at most this many bytes a pixel, those of the result included: for a JPEG of several scans.
 */
#define IMAGE_DECODING_BYTES 10

typedef struct image {
    uint32_t width, height;
    uint8_t *pixels; /* RGBA, rows from the top; free with ffd_free */
} image;

typedef enum image_format { IMAGE_OTHER, IMAGE_PNG, IMAGE_JPEG, IMAGE_WEBP } image_format;

/* Returns the format that the first bytes of a file show. */
image_format ffd_image_format(const unsigned char *bytes, size_t size);
/* Finds the size that the head of a file states, and does not decode it. Returns false where there is none.
 */
bool ffd_image_measure(const unsigned char *bytes, size_t size, uint32_t *width, uint32_t *height);

/* A callback that receives the next bytes. */
typedef ffd_status (*image_sink)(void *context, const void *bytes, size_t size, ffd_error *error);

/* Decodes a PNG, JPEG or WebP file in memory. Checks the limits above and the budget (NULL: none) before it
   allocates. Errors: FFD_E_INVALID (broken, truncated), FFD_E_UNSUPPORTED (another format; CMYK; an
   animation; WebP without libwebp), FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_image_decode(const unsigned char *bytes, size_t size, const memory_budget *budget,
                            image *result, ffd_error *error);

/* Checks the size of an image, with the bytes that decoding needs for each pixel, against the limits and the
   budget. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_image_check(uint64_t width, uint64_t height, uint64_t bytes_a_pixel,
                           const memory_budget *budget, ffd_error *error);

/* As ffd_image_decode, for bytes with the signature of PNG. */
ffd_status ffd_png_decode(const unsigned char *bytes, size_t size, const memory_budget *budget, image *result,
                          ffd_error *error);
/* As ffd_image_decode, for bytes with the signature of JPEG. */
ffd_status ffd_jpeg_decode(const unsigned char *bytes, size_t size, const memory_budget *budget,
                           image *result, ffd_error *error);
/* As ffd_image_decode, for bytes with the signature of WebP. */
ffd_status ffd_webp_decode(const unsigned char *bytes, size_t size, const memory_budget *budget,
                           image *result, ffd_error *error);
/* Encodes pixels as a PNG file, and passes its bytes to sink. channels: bytes of a pixel, 3 (RGB) or 4
   (RGBA). Errors: FFD_E_MEMORY, and those of the sink. */
ffd_status ffd_png_write(const uint8_t *pixels, uint32_t width, uint32_t height, int channels,
                         image_sink sink, void *context, ffd_error *error);
/* Encodes RGBA pixels, whose alpha is lost, as a JPEG file of good quality, and passes its bytes to sink.
   Errors: FFD_E_MEMORY, FFD_E_UNSUPPORTED (the library fails), and those of the sink. */
ffd_status ffd_jpeg_write(const uint8_t *pixels, uint32_t width, uint32_t height, image_sink sink,
                          void *context, ffd_error *error);

#endif
