/* test_buffer_count.c - counts the external buffers of a glTF without parsing its JSON into a tree. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "io/gltf/file/gltf_buffer.h"
#include <string.h>

static size_t count(const char *text)
{
    return ffd_gltf_count_buffer_files(text, strlen(text));
}

static void buffers_with_a_uri_count(void **state)
{
    assert_int_equal(count("{\"buffers\":[{\"uri\":\"a.bin\"},{\"byteLength\":3, \"uri\" : \"b.bin\"}]}"), 2);
    assert_int_equal(count("{ \"buffers\" : [ { \"uri\":\n\t\"a\" } ] , \"images\":[{\"uri\":\"p.png\"}]}"),
                     1);
    assert_int_equal(
        count("{\"buffers\":[{},{\"uri\":\"DATA:x;base64,AA\"},{\"uri\":\"data:,\"},{\"uri\":\"c\"}]}"), 1);
    assert_int_equal(count("{\"images\":[{\"uri\":\"p.png\"}],\"buffers\":[{\"uri\":\"\"}]}"), 1);
    (void)state;
}

/* Words that are values, keys of other objects, or quotes inside strings. */
static void what_looks_like_one_does_not(void **state)
{
    assert_int_equal(count("{\"x\":\"buffers\",\"images\":[{\"uri\":\"p\"}]}"), 0);
    assert_int_equal(count("{\"extras\":{\"buffers\":[{\"uri\":\"p\"}]}}"), 0);
    assert_int_equal(count("{\"buffers\":[{\"name\":\"uri\",\"extras\":{\"uri\":\"x\"}}]}"), 0);
    assert_int_equal(count("{\"buffers\":[{\"name\":\"\\\"uri\\\":\\\"x\",\"uri\":\"uri\"}]}"), 1);
    assert_int_equal(count("{\"buffers\":[{\"name\":\"a\\\\\",\"uri\":\"x\"}]}"), 1);
    assert_int_equal(count("{\"buffers\":[{\"uri\":3},{\"uri\":[\"x\"]},{\"uri\":{\"y\":\"z\"}}]}"), 0);
    assert_int_equal(count("{\"buffers\":{\"uri\":\"x\"}}"), 0);
    (void)state;
}

/* Any text ends, and is not read past its end. */
static void texts_that_are_cut_off(void **state)
{
    static const char whole[] =
        "{\"buffers\":[{\"name\":\"\\\\\\\"\",\"uri\":\"a\"},{\"uri\":\"b\"}]}]]]}}\"\\";
    for (size_t size = 0; size < sizeof whole; size++) {
        char cut[sizeof whole];
        memcpy(cut, whole, size);
        assert_in_range(ffd_gltf_count_buffer_files(cut, size), 0, 2);
    }
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(buffers_with_a_uri_count),
        cmocka_unit_test(what_looks_like_one_does_not),
        cmocka_unit_test(texts_that_are_cut_off),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
