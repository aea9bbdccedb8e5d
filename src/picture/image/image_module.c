#include "picture/image/image_module.h"
#include "base/system/deadline.h"

FFD_API extern const image_module ffd_module;

const image_module ffd_module = {
    {IMAGE_IDENTITY, NULL, ffd_spell_members, ffd_deadline_ask},
    ffd_png_decode,
    ffd_jpeg_decode,
    ffd_webp_decode,
    ffd_png_write,
    ffd_jpeg_write,
};
