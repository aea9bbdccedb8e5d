/* webp.c - decodes WebP with libwebp; the only source that includes it. Simple upsampling gives the same
   pixels with every version of the library. */
#include "base/memory/memory.h"
#include "picture/image/image.h"

#ifdef FFD_HAS_WEBP

#include <webp/decode.h>

/* A decoded pixel has 4 bytes; the library holds as many for lossless images, and fewer for others. */
#define BYTES_A_PIXEL 8

static ffd_status fail(VP8StatusCode code, ffd_error *error)
{
    switch (code) {
    case VP8_STATUS_OUT_OF_MEMORY:
        return ffd_fail_memory(error);
    case VP8_STATUS_UNSUPPORTED_FEATURE:
        return ffd_fail(error, FFD_E_UNSUPPORTED, "the WebP image has a feature that is not supported");
    case VP8_STATUS_SUSPENDED:
    case VP8_STATUS_NOT_ENOUGH_DATA:
        return ffd_fail(error, FFD_E_INVALID, "the WebP image is broken: it is cut off");
    default:
        return ffd_fail(error, FFD_E_INVALID, "the WebP image is broken");
    }
}

ffd_status ffd_webp_decode(const unsigned char *bytes, size_t size, const memory_budget *budget,
                           image *result, ffd_error *error)
{
    WebPDecoderConfig config;
    *result = (image){0, 0, NULL};
    if (!WebPInitDecoderConfig(&config))
        return ffd_fail(error, FFD_E_UNSUPPORTED,
                        "libwebp has another version than the one it was built with");
    const VP8StatusCode known = WebPGetFeatures(bytes, size, &config.input);
    if (known != VP8_STATUS_OK)
        return fail(known, error);
    const uint32_t width = (uint32_t)config.input.width, height = (uint32_t)config.input.height;
    if (config.input.has_animation)
        return ffd_fail(error, FFD_E_UNSUPPORTED, "the WebP image is an animation");
    TRY(ffd_image_check(width, height, BYTES_A_PIXEL, budget, error));
    uint8_t *const pixels = ffd_alloc_zero((size_t)width * height, 4);
    if (!pixels)
        return ffd_fail_memory(error);
    config.options.no_fancy_upsampling = 1;
    config.output.colorspace = MODE_RGBA;
    config.output.is_external_memory = 1;
    config.output.u.RGBA.rgba = pixels;
    config.output.u.RGBA.stride = (int)(4 * width);
    config.output.u.RGBA.size = (size_t)4 * width * height;
    const VP8StatusCode decoded = WebPDecode(bytes, size, &config);
    WebPFreeDecBuffer(&config.output);
    if (decoded != VP8_STATUS_OK) {
        ffd_free(pixels);
        return fail(decoded, error);
    }
    *result = (image){width, height, pixels};
    return FFD_OK;
}

#else

ffd_status ffd_webp_decode(const unsigned char *bytes, size_t size, const memory_budget *budget,
                           image *result, ffd_error *error)
{
    (void)bytes;
    (void)size;
    (void)budget;
    *result = (image){0, 0, NULL};
    return ffd_fail(error, FFD_E_UNSUPPORTED, "this build has no libwebp, which reads WebP images");
}

#endif
