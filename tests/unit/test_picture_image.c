/* test_picture_image.c - PNG, JPEG and WebP: pixels of all variants; corrupt, truncated and too large files.

       test_picture_image CORPUS webp|no-webp      the folder tests/fuzz/corpus (make_images.py); whether the
   build has libwebp */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/memory/memory.h"
#include "picture/image/image.h"
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST_BYTES 65536

typedef struct file {
    unsigned char bytes[MOST_BYTES];
    size_t size;
} file;

static const char *corpus;
static bool has_webp;

static void load(file *f, const char *name)
{
    char path[4096];
    assert_true(snprintf(path, sizeof path, "%s/%s", corpus, name) < (int)sizeof path);
    FILE *const from = fopen(path, "rb");
    if (!from)
        fail_msg("%s is not there", path);
    f->size = fread(f->bytes, 1, MOST_BYTES, from);
    fclose(from);
}

/* The head states the size of what is decoded, and no shorter part of it does so wrongly. */
static void assert_measured(const file *f, const image *decoded)
{
    uint32_t width = 0, height = 0;
    for (size_t size = 0; size <= f->size; size++) {
        unsigned char *const copy = malloc(size > 0 ? size : 1);
        assert_non_null(copy);
        memcpy(copy, f->bytes, size);
        const bool is_measured = ffd_image_measure(copy, size, &width, &height);
        free(copy);
        assert_true(is_measured || size < f->size);
        assert_true(!is_measured || (width == decoded->width && height == decoded->height));
    }
}

typedef void (*pixel_function)(int x, int y, uint8_t pixel[4]);

static void color(int x, int y, uint8_t pixel[4])
{
    pixel[0] = (uint8_t)(23 * x);
    pixel[1] = (uint8_t)(28 * y);
    pixel[2] = (uint8_t)(255 - 12 * x - 14 * y);
    pixel[3] = 255;
}

static void color_alpha(int x, int y, uint8_t pixel[4])
{
    color(x, y, pixel);
    pixel[3] = (uint8_t)(255 - 7 * (x + y));
}

static void gray(int x, int y, uint8_t pixel[4])
{
    (void)y;
    memset(pixel, 23 * x, 3);
    pixel[3] = 255;
}

static void gray_alpha(int x, int y, uint8_t pixel[4])
{
    gray(x, y, pixel);
    pixel[3] = (uint8_t)(255 - 7 * (x + y));
}

static void two_grays(int x, int y, uint8_t pixel[4])
{
    memset(pixel, (x + y) % 2 ? 255 : 0, 3);
    pixel[3] = 255;
}

static void two_colors(int x, int y, uint8_t pixel[4])
{
    memcpy(pixel, (x + y) % 2 ? (uint8_t[]){200, 210, 220, 255} : (uint8_t[]){10, 20, 30, 0x40}, 4);
}

static void all_kinds_of_png_show_their_pixels(void **state)
{
    static const struct {
        const char *name;
        pixel_function pixel;
    } kinds[] = {
        {"png/rgb8.png", color},      {"png/rgba8.png", color_alpha},  {"png/interlaced.png", color_alpha},
        {"png/rgb16.png", color},     {"png/gray8.png", gray},         {"png/gray-alpha.png", gray_alpha},
        {"png/gray1.png", two_grays}, {"png/palette.png", two_colors}, {"png/chunks.png", color}};
    (void)state;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        file f;
        image found;
        ffd_error error;
        load(&f, kinds[i].name);
        if (ffd_image_decode(f.bytes, f.size, NULL, &found, &error))
            fail_msg("%s: %s", kinds[i].name, error.message);
        assert_true(found.width == 11 && found.height == 9);
        assert_measured(&f, &found);
        for (int p = 0; p < 99; p++) {
            uint8_t pixel[4];
            kinds[i].pixel(p % 11, p / 11, pixel);
            if (memcmp(pixel, found.pixels + 4 * p, 4) != 0)
                fail_msg("%s: another pixel at %d,%d", kinds[i].name, p % 11, p / 11);
        }
        ffd_free(found.pixels);
    }
}

/* Decodes a file of this size. Its pixels are freed by the caller. */
static image decode_sample(const char *name, int width, int height)
{
    file f;
    image found;
    ffd_error error;
    load(&f, name);
    if (ffd_image_decode(f.bytes, f.size, NULL, &found, &error))
        fail_msg("%s: %s", name, error.message);
    assert_true(found.width == (uint32_t)width && found.height == (uint32_t)height);
    assert_measured(&f, &found);
    return found;
}

/* The images were made with red across, green down and blue in fields, up to the loss of the format. */
static void all_kinds_of_jpeg_show_their_pixels(void **state)
{
    static const struct {
        const char *name;
        int width, height, tolerance;
        bool is_gray;
    } kinds[] = {{"jpeg/gray.jpg", 17, 13, 8, true},
                 {"jpeg/rgb444.jpg", 24, 16, 20, false},
                 {"jpeg/rgb420.jpg", 35, 21, 90, false},
                 {"jpeg/rgb422.jpg", 20, 9, 70, false},
                 {"jpeg/progressive.jpg", 33, 33, 80, false}};
    (void)state;
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const int width = kinds[i].width, height = kinds[i].height;
        const image found = decode_sample(kinds[i].name, width, height);
        for (int p = 0; p < width * height; p++) {
            const uint8_t *const pixel = found.pixels + 4 * p;
            const int red = p % width * 255 / width,
                      green = kinds[i].is_gray ? red : p / width * 255 / height;
            if (abs(pixel[0] - red) > kinds[i].tolerance || abs(pixel[1] - green) > kinds[i].tolerance ||
                pixel[3] != 255)
                fail_msg("%s: %d %d at %d,%d", kinds[i].name, pixel[0], pixel[1], p % width, p / width);
        }
        ffd_free(found.pixels);
    }
}

/* Lossless images, and images with red across and green down up to the loss of the format. */
static void all_kinds_of_webp_show_their_pixels(void **state)
{
    static const struct {
        const char *name;
        pixel_function pixel; /* NULL: lossy */
        int width, height;
        bool has_alpha;
    } kinds[] = {{"webp/rgba-lossless.webp", color_alpha, 11, 9, true},
                 {"webp/palette.webp", two_colors, 11, 9, true},
                 {"webp/gray-lossless.webp", gray, 11, 9, false},
                 {"webp/lossy.webp", NULL, 35, 21, false},
                 {"webp/lossy-alpha.webp", NULL, 33, 17, true}};
    (void)state;
    if (!has_webp)
        skip();
    for (size_t i = 0; i < sizeof kinds / sizeof *kinds; i++) {
        const int width = kinds[i].width, height = kinds[i].height;
        const image found = decode_sample(kinds[i].name, width, height);
        for (int p = 0; p < width * height; p++) {
            const int x = p % width, y = p / width, tolerance = kinds[i].pixel ? 0 : 12;
            uint8_t wanted[4] = {(uint8_t)(x * 255 / width), (uint8_t)(y * 255 / height), 128, 255};
            if (kinds[i].has_alpha)
                wanted[3] = (uint8_t)(255 - 7 * x);
            if (kinds[i].pixel)
                kinds[i].pixel(x, y, wanted);
            for (int c = 0; c < 4; c++)
                if (abs(found.pixels[4 * p + c] - wanted[c]) > (c == 3 ? 0 : tolerance))
                    fail_msg("%s: %d at %d,%d, not %d", kinds[i].name, found.pixels[4 * p + c], x, y,
                             wanted[c]);
        }
        ffd_free(found.pixels);
    }
}

static void a_build_without_libwebp_says_so(void **state)
{
    file f;
    image found;
    ffd_error error;
    (void)state;
    if (has_webp)
        skip();
    load(&f, "webp/lossy.webp");
    assert_int_equal(ffd_image_decode(f.bytes, f.size, NULL, &found, &error), FFD_E_UNSUPPORTED);
    assert_string_equal(error.message, "this build has no libwebp, which reads WebP images");
    assert_null(found.pixels);
}

static void expect(const file *f, size_t size, const memory_budget *budget, ffd_status wanted,
                   const char *what)
{
    image found = {1, 1, (uint8_t *)&found};
    ffd_error error = {0};
    /* A block of the exact size, so that reading past its end is detected. */
    unsigned char *const copy = malloc(size > 0 ? size : 1);
    assert_non_null(copy);
    memcpy(copy, f->bytes, size);
    const ffd_status status = ffd_image_decode(copy, size, budget, &found, &error);
    free(copy);
    if (status == FFD_OK)
        ffd_free(found.pixels);
    if (status != wanted || (status && (!error.message[0] || strchr(error.message, '\n'))))
        fail_msg("%s of %zu bytes: %d '%s'", what, size, (int)status, error.message);
}

static void what_is_cut_off_is_told(void **state)
{
    static const char *const names[] = {
        "png/rgba8.png",   "png/interlaced.png",    "png/palette.png",
        "jpeg/gray.jpg",   "jpeg/rgb420.jpg",       "jpeg/progressive.jpg",
        "webp/lossy.webp", "webp/lossy-alpha.webp", "webp/rgba-lossless.webp"};
    (void)state;
    for (size_t i = 0; i < (has_webp ? sizeof names / sizeof *names : 6); i++) {
        file f;
        load(&f, names[i]);
        for (size_t size = i < 6 ? 8 : 12; size < f.size; size++)
            expect(&f, size, NULL, FFD_E_INVALID, names[i]);
        for (size_t size = 0; size < 3; size++)
            expect(&f, size, NULL, FFD_E_UNSUPPORTED, names[i]);
    }
}

static void what_is_damaged_is_told(void **state)
{
    file f;
    (void)state;
    load(&f, "png/rgba8.png");
    for (size_t i = 8; i < f.size - 12; i++) {
        f.bytes[i] ^= 0x10;
        image found;
        ffd_error error;
        const ffd_status status = ffd_image_decode(f.bytes, f.size, NULL, &found, &error);
        /* Every chunk has a checksum. */
        assert_true(status == FFD_E_INVALID || status == FFD_E_LIMIT);
        assert_null(found.pixels);
        f.bytes[i] ^= 0x10;
    }
    load(&f, "jpeg/cmyk.jpg");
    expect(&f, f.size, NULL, FFD_E_UNSUPPORTED, "CMYK");
    load(&f, "webp/animation.webp");
    expect(&f, f.size, NULL, FFD_E_UNSUPPORTED, "an animation");
    load(&f, "jpeg/gray.jpg");
    memcpy(f.bytes, "GIF89a", 6);
    expect(&f, f.size, NULL, FFD_E_UNSUPPORTED, "GIF");
}

static void sizes_are_checked_before_memory_is_taken(void **state)
{
    file f;
    ffd_error error;
    memory_budget budget = ffd_budget_make(0);
    (void)state;
    load(&f, "png/large.png");
    expect(&f, f.size, NULL, FFD_E_LIMIT, "32767 x 32767");
    budget.taken = 0;
    budget.most = 11 * 9 * 4 - 1;
    load(&f, "png/rgb8.png");
    expect(&f, f.size, &budget, FFD_E_LIMIT, "PNG");
    budget.most++;
    expect(&f, f.size, &budget, FFD_OK, "PNG");
    load(&f, "jpeg/progressive.jpg");
    budget.most = 33 * 33 * 10 - 1;
    expect(&f, f.size, &budget, FFD_E_LIMIT, "JPEG");
    budget.most++;
    expect(&f, f.size, &budget, FFD_OK, "JPEG");
    assert_int_equal(ffd_image_check(UINT64_C(1) << 33, UINT64_C(1) << 33, 4, NULL, &error), FFD_E_LIMIT);
    assert_int_equal(ffd_image_check(0, 5, 4, NULL, &error), FFD_E_INVALID);
    assert_int_equal(ffd_image_check(32767, 4096, 4, NULL, &error), FFD_OK);
    assert_int_equal(ffd_image_check(32767, 4097, 4, NULL, &error), FFD_E_LIMIT);
    if (!has_webp)
        return;
    load(&f, "webp/lossy.webp");
    budget.most = 35 * 21 * 8 - 1;
    expect(&f, f.size, &budget, FFD_E_LIMIT, "WebP");
    budget.most++;
    expect(&f, f.size, &budget, FFD_OK, "WebP");
    load(&f, "webp/large.webp");
    expect(&f, f.size, NULL, FFD_E_LIMIT, "16383 x 16383");
}

static void memory_may_run_out_anywhere(void **state)
{
    static const char *const names[] = {"png/interlaced.png", "png/palette.png", "jpeg/progressive.jpg",
                                        "webp/lossy.webp"};
    (void)state;
    for (size_t i = 0; i < (has_webp ? 4 : 3); i++) {
        file f;
        ffd_status status;
        long successes = 0;
        load(&f, names[i]);
        do {
            image found;
            ffd_error error;
            ffd_alloc_fail_after(successes++);
            status = ffd_image_decode(f.bytes, f.size, NULL, &found, &error);
            ffd_alloc_fail_after(-1);
            assert_true(status == FFD_OK || status == FFD_E_MEMORY);
            ffd_free(found.pixels);
        } while (status);
        assert_true(successes > 1);
    }
}

static ffd_status keep(void *context, const void *bytes, size_t size, ffd_error *error)
{
    file *const f = context;
    if (size > MOST_BYTES - f->size)
        return ffd_fail(error, FFD_E_IO, "it is full");
    memcpy(f->bytes + f->size, bytes, size);
    f->size += size;
    return FFD_OK;
}

static void what_is_written_reads_back(void **state)
{
    static file f, again;
    static uint8_t pixels[3 * 40 * 30];
    image found;
    ffd_error error;
    (void)state;
    for (size_t i = 0; i < sizeof pixels; i++)
        pixels[i] = (uint8_t)(i * i / 7);
    assert_int_equal(ffd_png_write(pixels, 40, 30, 3, keep, &f, &error), FFD_OK);
    assert_int_equal(ffd_png_write(pixels, 40, 30, 3, keep, &again, &error), FFD_OK);
    assert_true(f.size == again.size && memcmp(f.bytes, again.bytes, f.size) == 0);
    assert_int_equal(ffd_image_decode(f.bytes, f.size, NULL, &found, &error), FFD_OK);
    for (size_t i = 0; i < 40 * 30; i++)
        assert_memory_equal(found.pixels + 4 * i, pixels + 3 * i, 3);
    ffd_free(found.pixels);
    f.size = MOST_BYTES - 100;
    assert_int_equal(ffd_png_write(pixels, 40, 30, 3, keep, &f, &error), FFD_E_IO);
    assert_string_equal(error.message, "it is full");
    long successes = 0;
    ffd_status status;
    do {
        f.size = 0;
        ffd_alloc_fail_after(successes++);
        status = ffd_png_write(pixels, 40, 30, 3, keep, &f, &error);
        ffd_alloc_fail_after(-1);
        assert_true(status == FFD_OK || status == FFD_E_MEMORY);
    } while (status);
}

/* What a JPEG file is passed on in. */
typedef struct pieces {
    file f;
    size_t count, largest, most; /* most: of the count */
} pieces;

static ffd_status keep_piece(void *context, const void *bytes, size_t size, ffd_error *error)
{
    pieces *const p = context;
    if (p->count == p->most)
        return ffd_fail(error, FFD_E_IO, "it is full");
    p->count++;
    p->largest = size > p->largest ? size : p->largest;
    return keep(&p->f, bytes, size, error);
}

/* Nothing of the size of the file is held on the way, and a sink that fails ends it. */
static void a_jpeg_is_passed_on_piece_by_piece(void **state)
{
    enum { SIDE = 200 };
    static pieces p, again;
    static uint8_t pixels[4 * SIDE * SIDE];
    image found;
    ffd_error error;
    (void)state;
    for (size_t i = 0; i < SIDE * SIDE; i++) {
        memset(pixels + 4 * i, (int)(i * i / 3 % 251), 3);
        pixels[4 * i + 3] = 7;
    }
    p.most = again.most = SIZE_MAX;
    assert_int_equal(ffd_jpeg_write(pixels, SIDE, SIDE, keep_piece, &p, &error), FFD_OK);
    assert_int_equal(ffd_jpeg_write(pixels, SIDE, SIDE, keep_piece, &again, &error), FFD_OK);
    assert_true(p.f.size == again.f.size && memcmp(p.f.bytes, again.f.bytes, p.f.size) == 0);
    assert_true(p.f.size > 10000 && p.count > 2);
    assert_in_range(p.largest, 1000, 5000);
    assert_int_equal(ffd_image_decode(p.f.bytes, p.f.size, NULL, &found, &error), FFD_OK);
    for (size_t i = 0; i < 4 * SIDE * SIDE; i++)
        if (i % 4 == 3 ? found.pixels[i] != 255 : abs(found.pixels[i] - pixels[i]) > 40)
            fail_msg("byte %zu: %d, expected %d", i, found.pixels[i], pixels[i]);
    ffd_free(found.pixels);
    for (again.most = 0; again.most < p.count; again.most++) {
        again.f.size = again.count = 0;
        assert_int_equal(ffd_jpeg_write(pixels, SIDE, SIDE, keep_piece, &again, &error), FFD_E_IO);
        assert_string_equal(error.message, "it is full");
    }
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_kinds_of_png_show_their_pixels),
        cmocka_unit_test(all_kinds_of_jpeg_show_their_pixels),
        cmocka_unit_test(all_kinds_of_webp_show_their_pixels),
        cmocka_unit_test(a_build_without_libwebp_says_so),
        cmocka_unit_test(what_is_cut_off_is_told),
        cmocka_unit_test(what_is_damaged_is_told),
        cmocka_unit_test(sizes_are_checked_before_memory_is_taken),
        cmocka_unit_test(memory_may_run_out_anywhere),
        cmocka_unit_test(what_is_written_reads_back),
        cmocka_unit_test(a_jpeg_is_passed_on_piece_by_piece),
    };
    if (argc != 3)
        return 2;
    corpus = argv[1];
    has_webp = strcmp(argv[2], "webp") == 0;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
