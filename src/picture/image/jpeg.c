/* jpeg.c - decodes and writes JPEG with libjpeg; the only source that includes it. The accurate integer DCT
   and simple upsampling give the same pixels with every version of the library. */
#include "base/memory/memory.h"
#include "picture/image/image.h"
#include <limits.h>
#include <setjmp.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include <jpeglib.h>

#include <jerror.h>

/* The most scans of a progressive image. Each scan processes all pixels, and a short file can have
   thousands. */
#define MOST_SCANS 100
/* A decoded pixel has 4 bytes; for a progressive image the library also stores coefficients of 2 bytes
   each. */
#define BYTES_A_PIXEL 4
#define COEFFICIENT_BYTES 2
/* Further memory of the library: tables and a few rows. */
#define TABLES_SIZE ((uint64_t)8 << 20)

typedef struct jpeg_task {
    struct jpeg_error_mgr manager; /* first member, because the library passes back a pointer to it */
    struct jpeg_progress_mgr progress;
    jmp_buf failed;
    char message[JMSG_LENGTH_MAX];
    bool is_out_of_memory;
} jpeg_task;

static jpeg_task *task_of(j_common_ptr jpeg)
{
    return (jpeg_task *)(void *)jpeg->err;
}

_Noreturn static void fail(j_common_ptr jpeg)
{
    jpeg_task *const task = task_of(jpeg);
    task->manager.format_message(jpeg, task->message);
    task->is_out_of_memory =
        task->manager.msg_code == JERR_OUT_OF_MEMORY || task->manager.msg_code == JERR_NO_BACKING_STORE;
    longjmp(task->failed, 1);
}

/* Turns warnings that pixels are missing, as in a truncated file, into failures. */
static void fail_on_loss(j_common_ptr jpeg, int level)
{
    static const int failures[] = {JWRN_JPEG_EOF,       JWRN_HIT_MARKER,  JWRN_HUFF_BAD_CODE,
                                   JWRN_ARITH_BAD_CODE, JWRN_MUST_RESYNC, JWRN_BOGUS_PROGRESSION};
    if (level >= 0)
        return;
    for (size_t i = 0; i < sizeof failures / sizeof *failures; i++)
        if (jpeg->err->msg_code == failures[i])
            fail(jpeg);
}

static void watch(j_common_ptr jpeg)
{
    const struct jpeg_decompress_struct *const from = (const void *)jpeg;
    if (from->input_scan_number > MOST_SCANS) {
        snprintf(task_of(jpeg)->message, JMSG_LENGTH_MAX, "it has more than %d scans", MOST_SCANS);
        longjmp(task_of(jpeg)->failed, 1);
    }
}

static void expand(const uint8_t *row, uint32_t width, uint8_t *pixels)
{
    for (uint32_t x = 0; x < width; x++) {
        memcpy(pixels + (size_t)4 * x, row + (size_t)3 * x, 3);
        pixels[(size_t)4 * x + 3] = 0xff;
    }
}

static ffd_status check(struct jpeg_decompress_struct *jpeg, const memory_budget *budget, ffd_error *error)
{
    if (jpeg->jpeg_color_space == JCS_CMYK || jpeg->jpeg_color_space == JCS_YCCK || jpeg->num_components > 3)
        return ffd_fail(error, FFD_E_UNSUPPORTED, "the JPEG image has CMYK colours");
    const uint64_t kept =
        jpeg_has_multiple_scans(jpeg) ? COEFFICIENT_BYTES * (uint64_t)jpeg->num_components : 0;
    const uint64_t pixels = (uint64_t)jpeg->image_width * jpeg->image_height;
    const ffd_status status =
        ffd_image_check(jpeg->image_width, jpeg->image_height, BYTES_A_PIXEL + kept, budget, error);
    /* Doubled, because blocks at the right and lower edges extend beyond the image. */
    const uint64_t most = 2 * kept * pixels + TABLES_SIZE;
    jpeg->mem->max_memory_to_use = most < LONG_MAX ? (long)most : LONG_MAX;
    return status;
}

/* Local variables must not change between setjmp and longjmp; only what task, result and jpeg point to
   may. */
static ffd_status read_pixels(struct jpeg_decompress_struct *jpeg, jpeg_task *task,
                              const unsigned char *bytes, size_t size, const memory_budget *budget,
                              image *result, ffd_error *error)
{
    if (setjmp(task->failed)) {
        if (task->is_out_of_memory)
            return ffd_fail_memory(error);
        return ffd_fail(error, FFD_E_INVALID, "the JPEG image is broken: %s", task->message);
    }
    jpeg_create_decompress(jpeg);
    jpeg->progress = &task->progress;
    jpeg_mem_src(jpeg, bytes, (unsigned long)size);
    jpeg_read_header(jpeg, TRUE);
    TRY(check(jpeg, budget, error));
    jpeg->out_color_space = JCS_RGB;
    jpeg->dct_method = JDCT_ISLOW;
    jpeg->do_fancy_upsampling = FALSE;
    jpeg->do_block_smoothing = FALSE;
    jpeg_start_decompress(jpeg);
    const uint32_t width = jpeg->output_width, height = jpeg->output_height;
    *result = (image){width, height, ffd_alloc_zero((size_t)width * height, 4)};
    if (!result->pixels)
        return ffd_fail_memory(error);
    const JSAMPARRAY row = jpeg->mem->alloc_sarray((j_common_ptr)jpeg, JPOOL_IMAGE, 3 * width, 1);
    while (jpeg->output_scanline < height) {
        uint8_t *const pixels = result->pixels + (size_t)4 * width * jpeg->output_scanline;
        jpeg_read_scanlines(jpeg, row, 1);
        expand(row[0], width, pixels);
    }
    jpeg_finish_decompress(jpeg);
    return FFD_OK;
}

ffd_status ffd_jpeg_decode(const unsigned char *bytes, size_t size, const memory_budget *budget,
                           image *result, ffd_error *error)
{
    struct jpeg_decompress_struct jpeg;
    jpeg_task task;
    memset(&jpeg, 0, sizeof jpeg);
    memset(&task, 0, sizeof task);
    *result = (image){0, 0, NULL};
    jpeg.err = jpeg_std_error(&task.manager);
    task.manager.error_exit = fail;
    task.manager.emit_message = fail_on_loss;
    task.progress.progress_monitor = watch;
    const ffd_status status = read_pixels(&jpeg, &task, bytes, size, budget, result, error);
    jpeg_destroy_decompress(&jpeg);
    if (status) {
        ffd_free(result->pixels);
        *result = (image){0, 0, NULL};
    }
    return status;
}

#define QUALITY 88
#define PIECE 4096

/* Where the library writes to: a piece at a time, which the sink gets. Its own memory would be lost, or freed
   twice, where it runs out while that grows. */
typedef struct jpeg_writer {
    struct jpeg_destination_mgr manager; /* first member, as in jpeg_task */
    image_sink sink;
    void *context;
    ffd_error *error;
    ffd_status status; /* of the sink */
    unsigned char piece[PIECE];
} jpeg_writer;

static jpeg_writer *writer_of(j_compress_ptr jpeg)
{
    return (jpeg_writer *)(void *)jpeg->dest;
}

static void begin_piece(j_compress_ptr jpeg)
{
    jpeg_writer *const writer = writer_of(jpeg);
    writer->manager.next_output_byte = writer->piece;
    writer->manager.free_in_buffer = PIECE;
}

static void give_piece(j_compress_ptr jpeg, size_t size)
{
    jpeg_writer *const writer = writer_of(jpeg);
    writer->status = writer->sink(writer->context, writer->piece, size, writer->error);
    if (writer->status)
        longjmp(task_of((j_common_ptr)jpeg)->failed, 1);
    begin_piece(jpeg);
}

/* Called where the piece is full, whatever free_in_buffer says. */
static boolean end_piece(j_compress_ptr jpeg)
{
    give_piece(jpeg, PIECE);
    return TRUE;
}

static void end_last_piece(j_compress_ptr jpeg)
{
    give_piece(jpeg, PIECE - writer_of(jpeg)->manager.free_in_buffer);
}

/* Local variables must not change between setjmp and longjmp. */
static ffd_status write_pixels(struct jpeg_compress_struct *jpeg, jpeg_task *task, const uint8_t *pixels,
                               ffd_error *error)
{
    if (setjmp(task->failed)) {
        if (writer_of(jpeg)->status)
            return writer_of(jpeg)->status;
        if (task->is_out_of_memory)
            return ffd_fail_memory(error);
        return ffd_fail(error, FFD_E_UNSUPPORTED, "the image cannot be written: %s", task->message);
    }
    const uint32_t width = jpeg->image_width;
    jpeg->input_components = 3;
    jpeg->in_color_space = JCS_RGB;
    jpeg_set_defaults(jpeg);
    jpeg->dct_method = JDCT_ISLOW;
    jpeg_set_quality(jpeg, QUALITY, TRUE);
    jpeg_start_compress(jpeg, TRUE);
    const JSAMPARRAY row = jpeg->mem->alloc_sarray((j_common_ptr)jpeg, JPOOL_IMAGE, 3 * width, 1);
    while (jpeg->next_scanline < jpeg->image_height) {
        const uint8_t *const from = pixels + (size_t)4 * width * jpeg->next_scanline;
        for (uint32_t x = 0; x < width; x++)
            memcpy(row[0] + (size_t)3 * x, from + (size_t)4 * x, 3);
        jpeg_write_scanlines(jpeg, row, 1);
    }
    jpeg_finish_compress(jpeg);
    return FFD_OK;
}

ffd_status ffd_jpeg_write(const uint8_t *pixels, uint32_t width, uint32_t height, image_sink sink,
                          void *context, ffd_error *error)
{
    struct jpeg_compress_struct jpeg;
    jpeg_task task;
    jpeg_writer writer = {.manager = {.init_destination = begin_piece,
                                      .empty_output_buffer = end_piece,
                                      .term_destination = end_last_piece},
                          .sink = sink,
                          .context = context,
                          .error = error};
    memset(&jpeg, 0, sizeof jpeg);
    memset(&task, 0, sizeof task);
    jpeg.err = jpeg_std_error(&task.manager);
    task.manager.error_exit = fail;
    if (setjmp(task.failed))
        return ffd_fail_memory(error);
    jpeg_create_compress(&jpeg);
    jpeg.dest = &writer.manager;
    jpeg.image_width = width;
    jpeg.image_height = height;
    const ffd_status status = write_pixels(&jpeg, &task, pixels, error);
    jpeg_destroy_compress(&jpeg);
    return status;
}
