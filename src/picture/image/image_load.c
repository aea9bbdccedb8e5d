/* image_load.c - decodes and writes images with the module, which is loaded on first use. */
#include "picture/image/image_module.h"

static module images = {IMAGE_IDENTITY, "images", NULL};

static ffd_status load(const image_module **table, ffd_error *error)
{
    const module_head *head;
    const ffd_status status = ffd_module_load(&images, &head, error);
    *table = status ? NULL : (const image_module *)head;
    return status;
}

ffd_status ffd_png_decode(const unsigned char *bytes, size_t size, const memory_budget *budget, image *result,
                          ffd_error *error)
{
    const image_module *table;
    TRY(load(&table, error));
    return table->png_decode(bytes, size, budget, result, error);
}

ffd_status ffd_jpeg_decode(const unsigned char *bytes, size_t size, const memory_budget *budget,
                           image *result, ffd_error *error)
{
    const image_module *table;
    TRY(load(&table, error));
    return table->jpeg_decode(bytes, size, budget, result, error);
}

ffd_status ffd_webp_decode(const unsigned char *bytes, size_t size, const memory_budget *budget,
                           image *result, ffd_error *error)
{
    const image_module *table;
    TRY(load(&table, error));
    return table->webp_decode(bytes, size, budget, result, error);
}

ffd_status ffd_png_write(const uint8_t *pixels, uint32_t width, uint32_t height, int channels,
                         image_sink sink, void *context, ffd_error *error)
{
    const image_module *table;
    TRY(load(&table, error));
    return table->png_write(pixels, width, height, channels, sink, context, error);
}

ffd_status ffd_jpeg_write(const uint8_t *pixels, uint32_t width, uint32_t height, image_sink sink,
                          void *context, ffd_error *error)
{
    const image_module *table;
    TRY(load(&table, error));
    return table->jpeg_write(pixels, width, height, sink, context, error);
}
