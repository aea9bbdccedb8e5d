/* image_module.h - the function table of the module with libpng, libjpeg and libwebp. image_module.c is part
   of the module, image_load.c of the program that loads it. */
#ifndef FFD_PICTURE_IMAGE_IMAGE_MODULE_H
#define FFD_PICTURE_IMAGE_IMAGE_MODULE_H

#include "base/system/module.h"
#include "picture/image/image.h"
#include <ffd/version.h>

#define IMAGE_IDENTITY                                                                                       \
    {                                                                                                        \
        "ffd-image.so", FFD_VERSION, 5                                                                       \
    }

typedef struct image_module {
    module_head head;
    ffd_status (*png_decode)(const unsigned char *bytes, size_t size, const memory_budget *budget,
                             image *result, ffd_error *error);
    ffd_status (*jpeg_decode)(const unsigned char *bytes, size_t size, const memory_budget *budget,
                              image *result, ffd_error *error);
    ffd_status (*webp_decode)(const unsigned char *bytes, size_t size, const memory_budget *budget,
                              image *result, ffd_error *error);
    ffd_status (*png_write)(const uint8_t *pixels, uint32_t width, uint32_t height, int channels,
                            image_sink sink, void *context, ffd_error *error);
    ffd_status (*jpeg_write)(const uint8_t *pixels, uint32_t width, uint32_t height, image_sink sink,
                             void *context, ffd_error *error);
} image_module;

#endif
