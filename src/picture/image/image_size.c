/* image_size.c - checks the size of an image. */
#include "picture/image/image.h"

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
