/* picture_file.c - ffd_picture_save: writes a picture as a PNG file. */
#include "base/file/output.h"
#include "base/memory/memory.h"
#include "picture/image/image.h"
#include "picture/picture.h"

static ffd_status append(void *context, const void *bytes, size_t size, ffd_error *error)
{
    return ffd_output_write(context, bytes, size, error);
}

ffd_status ffd_picture_save(const picture *of, const memory_budget *budget, const char *path, bool force,
                            ffd_error *error)
{
    file_output *output = NULL;
    uint8_t *pixels = NULL;
    ffd_status status = ffd_output_create(&output, error);
    if (!status)
        status = ffd_output_begin(output, path, force, error);
    if (!status)
        status = ffd_picture_draw(of, budget, &pixels, error);
    if (!status)
        status = ffd_png_write(pixels, of->width, of->height, append, output, error);
    if (!status)
        status = ffd_output_commit(output, error);
    ffd_free(pixels);
    ffd_output_destroy(&output);
    return status;
}
