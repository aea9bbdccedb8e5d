/* test_image_file.c - recognizes image files by name and by content. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "mesh/resource/image_file.h"
#include <string.h>

static void names_of_images(void **state)
{
    (void)state;
    static const char *const images[] = {"a.png",  "b/C.JPG", "x.jpeg", "x.webp", "x.avif", "x.ktx2",
                                         "x.ktx",  "x.basis", "x.dds",  "x.bmp",  "x.gif",  "x.tif",
                                         "x.TIFF", "x.tga",   "x.hdr",  "x.exr"};
    static const char *const others[] = {"Makefile", "png", "a.png.sh", "a.svg", "a.png/run", "", "a.bin"};
    for (size_t i = 0; i < sizeof images / sizeof *images; i++)
        assert_true(ffd_image_has_name(images[i]));
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        assert_false(ffd_image_has_name(others[i]));
}

static void hidden_names(void **state)
{
    (void)state;
    assert_true(ffd_image_is_hidden(".a.png"));
    assert_true(ffd_image_is_hidden("a/.b/c.png"));
    assert_true(ffd_image_is_hidden("../c.png"));
    assert_false(ffd_image_is_hidden("a.b/c.d.png"));
}

static bool has_content(const char *bytes, size_t size)
{
    return ffd_image_has_content((const unsigned char *)bytes, size);
}

#define IS_IMAGE(text) has_content(text, sizeof(text) - 1)

static void contents_of_images(void **state)
{
    (void)state;
    assert_true(IS_IMAGE("\x89PNG\r\n\x1a\n"));
    assert_true(IS_IMAGE("\xff\xd8\xff\xe0"));
    assert_true(IS_IMAGE("RIFF\1\0\0\0WEBP"));
    assert_true(IS_IMAGE("\0\0\0\x20"
                         "ftypavif"));
    assert_true(IS_IMAGE("\xabKTX 20\xbb\r\n\x1a\n"));
    assert_true(IS_IMAGE("\xabKTX 11\xbb\r\n\x1a\n"));
    assert_true(IS_IMAGE("sB\x13\0"));
    assert_true(IS_IMAGE("DDS |"));
    assert_true(IS_IMAGE("BM...."));
    assert_true(IS_IMAGE("GIF89a"));
    assert_true(IS_IMAGE("II*\0"));
    assert_true(IS_IMAGE("MM\0*"));
    assert_true(IS_IMAGE("#?RADIANCE\n"));
    assert_true(IS_IMAGE("v/1\1\2"));
    /* Targa: no colour map, true colour, 32 bits; the same compressed. */
    assert_true(IS_IMAGE("\0\0\2\0\0\0\0\0\0\0\0\0\4\0\4\0\x20\0"));
    assert_true(IS_IMAGE("\0\0\12\0\0\0\0\0\0\0\0\0\4\0\4\0\x18\0"));
}

static void other_contents(void **state)
{
    (void)state;
    assert_false(IS_IMAGE(""));
    assert_false(IS_IMAGE("\x89PNG\r\n\x1a"));
    assert_false(IS_IMAGE("RIFF\1\0\0\0WAVE"));
    assert_false(IS_IMAGE("#!/bin/sh\necho owned"));
    assert_false(IS_IMAGE("\x7f"
                          "ELF\2\1\1\0\0\0\0\0\0\0\0\0\2\0"));
    assert_false(IS_IMAGE("all: install\n\tcp a b\n"));
    assert_false(IS_IMAGE("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_of_images),
        cmocka_unit_test(hidden_names),
        cmocka_unit_test(contents_of_images),
        cmocka_unit_test(other_contents),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
