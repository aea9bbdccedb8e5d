#include "picture/image/image.h"
#include <string.h>

ffd_status ffd_image_check(uint64_t width, uint64_t height, uint64_t bytes_a_pixel,
                           const memory_budget *budget, ffd_error *error)
{
    if (width == 0 || height == 0)
        return ffd_fail(error, FFD_E_INVALID, "the image has no pixels");
    if (width > IMAGE_MOST_SIDE || height > IMAGE_MOST_SIDE || width * height > IMAGE_MOST_PIXELS)
        return ffd_fail(error, FFD_E_LIMIT,
                        "the image has %llu x %llu pixels; at most %d a side and %llu in all",
                        (unsigned long long)width, (unsigned long long)height, IMAGE_MOST_SIDE,
                        (unsigned long long)IMAGE_MOST_PIXELS);
    return budget ? ffd_budget_check(budget, width * height, bytes_a_pixel, error) : FFD_OK;
}

ffd_status ffd_image_decode(const unsigned char *bytes, size_t size, const memory_budget *budget,
                            image *result, ffd_error *error)
{
    static const unsigned char png[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    if (size >= sizeof png && memcmp(bytes, png, sizeof png) == 0)
        return ffd_png_decode(bytes, size, budget, result, error);
    if (size >= 3 && bytes[0] == 0xff && bytes[1] == 0xd8 && bytes[2] == 0xff)
        return ffd_jpeg_decode(bytes, size, budget, result, error);
    return ffd_fail(error, FFD_E_UNSUPPORTED, "the image is neither PNG nor JPEG");
}
