/* png.c - decodes and writes PNG with libpng; the only source that includes it. */
#include "base/memory/memory.h"
#include "picture/image/image.h"
#include <png.h>
#include <setjmp.h>
#include <stdbool.h>
#include <string.h>

/* The context of libpng's callbacks. */
typedef struct png_task {
    jmp_buf failed;
    char message[128];
    bool is_out_of_memory;
    const unsigned char *next, *end; /* remaining bytes of the file that is read */
    image_sink sink;                 /* for writing */
    void *context;
    ffd_error *error;
    ffd_status status; /* result of the sink */
} png_task;

_Noreturn static void fail(png_structp png, png_const_charp message)
{
    png_task *const task = png_get_error_ptr(png);
    strncpy(task->message, message, sizeof task->message - 1);
    longjmp(task->failed, 1);
}

static void ignore(png_structp png, png_const_charp message)
{
    (void)png;
    (void)message;
}

static png_voidp take(png_structp png, png_alloc_size_t size)
{
    void *const block = ffd_alloc(1, size);
    png_task *const task = png_get_mem_ptr(png);
    task->is_out_of_memory |= !block;
    return block;
}

static void give_back(png_structp png, png_voidp block)
{
    (void)png;
    ffd_free(block);
}

static void read_some(png_structp png, png_bytep bytes, size_t size)
{
    png_task *const task = png_get_io_ptr(png);
    if ((size_t)(task->end - task->next) < size)
        png_error(png, "it is cut off");
    memcpy(bytes, task->next, size);
    task->next += size;
}

static void write_some(png_structp png, png_bytep bytes, size_t size)
{
    png_task *const task = png_get_io_ptr(png);
    task->status = task->sink(task->context, bytes, size, task->error);
    if (task->status)
        png_error(png, "writing failed");
}

static void flush(png_structp png)
{
    (void)png;
}

static ffd_status failure(const png_task *task, ffd_error *error)
{
    if (task->status)
        return task->status;
    if (task->is_out_of_memory)
        return ffd_fail_memory(error);
    return ffd_fail(error, FFD_E_INVALID, "the PNG image is broken: %s", task->message);
}

/* Requests conversion of all kinds of PNG to 8-bit RGBA. Returns the number of passes over the rows
   (interlacing). */
static int ask_for_colors(png_structp png, png_infop info)
{
    png_set_expand(png);
    png_set_scale_16(png);
    png_set_gray_to_rgb(png);
    png_set_filler(png, 0xff, PNG_FILLER_AFTER);
    const int passes = png_set_interlace_handling(png);
    png_read_update_info(png, info);
    return passes;
}

/* Skips chunks without pixel data, which can be large after decompression. */
static void skip_texts(png_structp png)
{
    static const png_byte names[] = "iCCP\0zTXt\0iTXt\0tEXt\0eXIf\0sPLT\0hIST";
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, names, (int)(sizeof names / 5));
    png_set_user_limits(png, IMAGE_MOST_SIDE, IMAGE_MOST_SIDE);
}

/* Local variables must not change between setjmp and longjmp; only what task and result point to may. */
static ffd_status read_pixels(png_structp png, png_infop info, png_task *task, const memory_budget *budget,
                              image *result, ffd_error *error)
{
    if (setjmp(task->failed))
        return failure(task, error);
    skip_texts(png);
    png_set_read_fn(png, task, read_some);
    png_read_info(png, info);
    const uint32_t width = png_get_image_width(png, info), height = png_get_image_height(png, info);
    TRY(ffd_image_check(width, height, 4, budget, error));
    const int passes = ask_for_colors(png, info);
    if (png_get_rowbytes(png, info) != (size_t)4 * width)
        png_error(png, "its rows have an unexpected size");
    *result = (image){width, height, ffd_alloc_zero((size_t)width * height, 4)};
    if (!result->pixels)
        return ffd_fail_memory(error);
    for (int pass = 0; pass < passes; pass++)
        for (uint32_t y = 0; y < height; y++)
            png_read_row(png, result->pixels + (size_t)4 * width * y, NULL);
    png_read_end(png, NULL);
    return FFD_OK;
}

ffd_status ffd_png_decode(const unsigned char *bytes, size_t size, const memory_budget *budget, image *result,
                          ffd_error *error)
{
    png_task task = {.next = bytes, .end = bytes + size};
    *result = (image){0, 0, NULL};
    /* png_create_* also fails with a longjmp. */
    if (setjmp(task.failed))
        return failure(&task, error);
    png_structp png =
        png_create_read_struct_2(PNG_LIBPNG_VER_STRING, &task, fail, ignore, &task, take, give_back);
    if (!png)
        return ffd_fail_memory(error);
    png_infop info = png_create_info_struct(png);
    const ffd_status status =
        info ? read_pixels(png, info, &task, budget, result, error) : ffd_fail_memory(error);
    png_destroy_read_struct(&png, &info, NULL);
    if (status) {
        ffd_free(result->pixels);
        *result = (image){0, 0, NULL};
    }
    return status;
}

static ffd_status write_pixels(png_structp png, png_infop info, png_task *task, const uint8_t *pixels,
                               uint32_t width, uint32_t height, int channels)
{
    if (setjmp(task->failed))
        return failure(task, task->error);
    png_set_write_fn(png, task, write_some, flush);
    png_set_IHDR(png, info, width, height, 8, channels == 4 ? PNG_COLOR_TYPE_RGBA : PNG_COLOR_TYPE_RGB,
                 PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png, info);
    for (uint32_t y = 0; y < height; y++)
        png_write_row(png, pixels + (size_t)channels * width * y);
    png_write_end(png, info);
    return FFD_OK;
}

ffd_status ffd_png_write(const uint8_t *pixels, uint32_t width, uint32_t height, int channels,
                         image_sink sink, void *context, ffd_error *error)
{
    png_task task = {.sink = sink, .context = context, .error = error};
    if (setjmp(task.failed))
        return failure(&task, error);
    png_structp png =
        png_create_write_struct_2(PNG_LIBPNG_VER_STRING, &task, fail, ignore, &task, take, give_back);
    if (!png)
        return ffd_fail_memory(error);
    png_infop info = png_create_info_struct(png);
    const ffd_status status =
        info ? write_pixels(png, info, &task, pixels, width, height, channels) : ffd_fail_memory(error);
    png_destroy_write_struct(&png, &info);
    return status;
}
