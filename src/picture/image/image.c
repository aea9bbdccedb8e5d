#include "picture/image/image.h"
#include <string.h>

image_format ffd_image_format(const unsigned char *bytes, size_t size)
{
    static const unsigned char png[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    if (size >= sizeof png && memcmp(bytes, png, sizeof png) == 0)
        return IMAGE_PNG;
    if (size >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff)
        return IMAGE_JPEG;
    if (size >= 12 && memcmp(bytes, "RIFF", 4) == 0 && memcmp(bytes + 8, "WEBP", 4) == 0)
        return IMAGE_WEBP;
    return IMAGE_OTHER;
}

ffd_status ffd_image_decode(const unsigned char *bytes, size_t size, const memory_budget *budget,
                            image *result, ffd_error *error)
{
    switch (ffd_image_format(bytes, size)) {
    case IMAGE_PNG:
        return ffd_png_decode(bytes, size, budget, result, error);
    case IMAGE_JPEG:
        return ffd_jpeg_decode(bytes, size, budget, result, error);
    case IMAGE_WEBP:
        return ffd_webp_decode(bytes, size, budget, result, error);
    default:
        return ffd_fail(error, FFD_E_UNSUPPORTED, "the image is neither PNG, JPEG nor WebP");
    }
}
