#include "base/memory/memory.h"
#include "json/json_edit.h"
#include "json/json_span.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static ffd_status parse(const char *text, json_span *tree, ffd_error *error)
{
    return ffd_json_span_parse(text, strlen(text), "t.json", tree, error);
}

static void spans_are_those_of_the_text(void **state)
{
    (void)state;
    const char *text =
        "\xef\xbb\xbf { \"a\" : [1, -2.5e3,\t\"x\\u0041\"], \"b\\/~\":{\"c\":null}, \"\":true}\n";
    json_span tree;
    assert_int_equal(parse(text, &tree, NULL), FFD_OK);
    assert_int_equal(tree.count, 8);
    const uint32_t a = ffd_json_span_member(&tree, 0, "a"), b = ffd_json_span_member(&tree, 0, "b/~");
    assert_int_equal(tree.values[a].count, 3);
    double number;
    assert_true(ffd_json_span_number(&tree, ffd_json_span_element(&tree, a, 1), &number));
    assert_true(number >= -2500 && number <= -2500);
    const json_value *value = &tree.values[ffd_json_span_element(&tree, a, 1)];
    assert_int_equal(value->end - value->begin, 6);
    assert_memory_equal(text + value->begin, "-2.5e3", 6);
    char *string = ffd_json_span_string(&tree, ffd_json_span_element(&tree, a, 2), NULL);
    assert_string_equal(string, "xA");
    ffd_free(string);
    assert_int_equal(ffd_json_span_element(&tree, a, 3), JSON_NONE);
    assert_int_equal(ffd_json_span_member(&tree, a, "a"), JSON_NONE);
    char pointer[64];
    ffd_json_span_pointer(&tree, ffd_json_span_member(&tree, b, "c"), pointer, sizeof pointer);
    assert_string_equal(pointer, "/b~1~0/c");
    ffd_json_span_pointer(&tree, ffd_json_span_element(&tree, a, 2), pointer, sizeof pointer);
    assert_string_equal(pointer, "/a/2");
    ffd_json_span_pointer(&tree, 0, pointer, sizeof pointer);
    assert_string_equal(pointer, "");
    ffd_json_span_free(&tree);
}

static void characters_are_decoded(void **state)
{
    (void)state;
    json_span tree;
    size_t size;
    assert_int_equal(parse("\"\\\"\\\\\\/\\b\\f\\n\\r\\t\\u00e4\\ud83d\\ude00\\u0000\xc3\xa4\"", &tree, NULL),
                     FFD_OK);
    char *text = ffd_json_span_string(&tree, 0, &size);
    assert_int_equal(size, 17);
    assert_memory_equal(text, "\"\\/\b\f\n\r\t\xc3\xa4\xf0\x9f\x98\x80\0\xc3\xa4", 18);
    ffd_free(text);
    ffd_json_span_free(&tree);
}

/* Wherever it stands among others: what it is decoded to; NULL: it is refused. */
static void a_character_is_seen_anywhere(void **state)
{
    (void)state;
    static const char *const characters[][2] = {
        {"\\n", "\n"}, {"\\\"", "\""},   {"\\\\", "\\"}, {"\\u00e9", "\xc3\xa9"},
        {" ", " "},    {"\x7f", "\x7f"}, {"!", "!"},     {"\xc3\xa9", "\xc3\xa9"},
        {"]", "]"},    {"\x1f", NULL},   {"\xff", NULL}, {"\xc3", NULL},
        {"\\q", NULL}, {"\n", NULL},     {"[", "["},     {"\xe2\x82\xac", "\xe2\x82\xac"},
    };
    for (size_t c = 0; c < sizeof characters / sizeof *characters; c++)
        for (int before = 0; before < 20; before++)
            for (int behind = 0; behind < 20; behind++) {
                char text[80], expected[80];
                json_span tree;
                snprintf(text, sizeof text, "\"%.*s%s%.*s\"", before, "aaaaaaaaaaaaaaaaaaaa",
                         characters[c][0], behind, "~~~~~~~~~~~~~~~~~~~~");
                const ffd_status status = parse(text, &tree, NULL);
                assert_int_equal(status, characters[c][1] ? FFD_OK : FFD_E_INVALID);
                if (status)
                    continue;
                snprintf(expected, sizeof expected, "%.*s%s%.*s", before, "aaaaaaaaaaaaaaaaaaaa",
                         characters[c][1], behind, "~~~~~~~~~~~~~~~~~~~~");
                char *string = ffd_json_span_string(&tree, 0, NULL);
                assert_string_equal(string, expected);
                ffd_free(string);
                ffd_json_span_free(&tree);
            }
}

static void broken_text_is_refused_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", "t.json:1: JSON: a value is expected, found end of text"},
        {"{", "t.json:1: JSON: a string is expected, found end of text"},
        {"[1,\n2,\n]", "t.json:3: JSON: a value is expected, found ']'"},
        {"[1 2]", "t.json:1: JSON: ',' or ']' is expected, found '2'"},
        {"{\"a\":1,}", "t.json:1: JSON: a string is expected, found '}'"},
        {"{\"a\" 1}", "t.json:1: JSON: ':' is expected, found '1'"},
        {"{\"a\":1\n \"b\":2}", "t.json:2: JSON: ',' or '}' is expected, found '\"'"},
        {"[01]", "t.json:1: JSON: a number starts with a needless 0, found '0'"},
        {"[1.]", "t.json:1: JSON: a digit is expected, found ']'"},
        {"[-]", "t.json:1: JSON: a digit is expected, found ']'"},
        {"[1e+]", "t.json:1: JSON: a digit is expected, found ']'"},
        {"[+1]", "t.json:1: JSON: a value is expected, found '+'"},
        {"[nul]", "t.json:1: JSON: a value is expected, found 'n'"},
        {"[NaN]", "t.json:1: JSON: a value is expected, found 'N'"},
        {"\"a", "t.json:1: JSON: a string is not ended, found '\"'"},
        {"\"\\x\"", "t.json:1: JSON: a string holds what is no UTF-8 character or escape, found '\\'"},
        {"\"\\ud800\"", "t.json:1: JSON: a string holds what is no UTF-8 character or escape, found '\\'"},
        {"\"\xc0\xaf\"",
         "t.json:1: JSON: a string holds what is no UTF-8 character or escape, found byte 0xc0"},
        {"\"\xff\"", "t.json:1: JSON: a string holds what is no UTF-8 character or escape, found byte 0xff"},
        {"\"a\nb\"", "t.json:1: JSON: a string holds what is no UTF-8 character or escape, found byte 0x0a"},
        {"1 2", "t.json:1: JSON: the text goes on behind its value, found '2'"},
        {"{\"a\":1,\"b\":{\"x\":1,\"\\u0078\":2}}", "t.json:/b/x: the key stands twice in its object"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        json_span tree;
        ffd_error error = {0};
        char line[512];
        assert_int_equal(parse(cases[i].text, &tree, &error), FFD_E_INVALID);
        ffd_error_format(&error, line, sizeof line);
        assert_string_equal(line, cases[i].message);
        assert_null(tree.values);
    }
}

static void depth_is_limited(void **state)
{
    (void)state;
    char text[2 * JSON_SPAN_DEPTH + 3];
    for (int extra = 0; extra < 2; extra++) {
        const size_t depth = JSON_SPAN_DEPTH + (size_t)extra;
        memset(text, '[', depth);
        memset(text + depth, ']', depth);
        text[2 * depth] = 0;
        json_span tree;
        assert_int_equal(parse(text, &tree, NULL), extra ? FFD_E_INVALID : FFD_OK);
        ffd_json_span_free(&tree);
    }
}

static void many_members_are_compared(void **state)
{
    (void)state;
    byte_buffer text = {0};
    for (int i = 0; i < 5000; i++)
        ffd_buffer_format(&text, "%c\"key%d\":%d", i ? ',' : '{', i, i);
    const size_t unique = text.size;
    ffd_buffer_text(&text, "}");
    json_span tree;
    assert_int_equal(ffd_json_span_parse(text.data, text.size, "t", &tree, NULL), FFD_OK);
    ffd_json_span_free(&tree);
    text.size = unique;
    ffd_buffer_text(&text, ",\"key17\":0}");
    ffd_error error = {0};
    assert_int_equal(ffd_json_span_parse(text.data, text.size, "t", &tree, &error), FFD_E_INVALID);
    assert_string_equal(error.pointer, "/key17");
    ffd_buffer_free(&text);
}

static void memory_may_run_out_anywhere(void **state)
{
    (void)state;
    for (long successes = 0;; successes++) {
        json_span tree;
        ffd_error error = {0};
        ffd_alloc_fail_after(successes);
        const ffd_status status =
            parse("{\"a\":[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17],\"b\":{}}", &tree, &error);
        ffd_alloc_fail_after(-1);
        ffd_json_span_free(&tree);
        if (status == FFD_OK) {
            assert_true(successes > 0);
            return;
        }
        assert_int_equal(status, FFD_E_MEMORY);
        assert_int_equal(error.status, FFD_E_MEMORY);
    }
}

static void edits_replace_spans_only(void **state)
{
    (void)state;
    const char *text = "[10, 20, 30]";
    json_edits edits = {0};
    byte_buffer out = {0};
    ffd_edits_format(&edits, 11, 11, ",%d", 4);
    ffd_edits_format(&edits, 11, 11, ",%d", 5);
    ffd_edits_replace(&edits, 5, 7, "x", 1);
    ffd_edits_replace(&edits, 1, 3, "", 0);
    ffd_edits_sort(&edits);
    ffd_edits_apply(&edits, text, 0, 12, &out);
    assert_int_equal(out.size, 13);
    assert_memory_equal(out.data, "[, x, 30,4,5]", 13);
    out.size = 0;
    ffd_edits_apply(&edits, text, 4, 8, &out);
    assert_int_equal(out.size, 3);
    assert_memory_equal(out.data, " x,", 3);
    assert_false(ffd_edits_failed(&edits));
    ffd_edits_free(&edits);
    ffd_buffer_free(&out);
}

/* Takes out of an object or array of 4 the children whose bits are set. */
static void check_removal(const char *text, unsigned gone, const char *expected)
{
    json_span tree;
    json_edits edits = {0};
    byte_buffer out = {0};
    uint32_t values[4];
    size_t count = 0;
    assert_int_equal(parse(text, &tree, NULL), FFD_OK);
    for (size_t i = 0; i < 4; i++) {
        uint32_t v = ffd_json_span_first(&tree, 0);
        for (size_t k = 0; k < i; k++)
            v = ffd_json_span_after(&tree, v);
        if (gone >> i & 1)
            values[count++] = v;
    }
    ffd_edits_remove(&edits, &tree, 0, values, count);
    ffd_edits_sort(&edits);
    ffd_edits_apply(&edits, text, 0, (uint32_t)strlen(text), &out);
    char *made = ffd_buffer_finish(&out);
    assert_string_equal(made, expected);
    ffd_free(made);
    ffd_edits_free(&edits);
    ffd_json_span_free(&tree);
}

static void members_go_with_their_commas(void **state)
{
    (void)state;
    static const char *const object = "{ \"a\":1, \"b\" : [2,3],\"c\":{\"d\":4} ,\"e\":null }";
    static const char *const array = "[ 1, \"b\" ,[3],4 ]";
    check_removal(object, 0, object);
    check_removal(object, 1, "{ \"b\" : [2,3],\"c\":{\"d\":4} ,\"e\":null }");
    check_removal(object, 2, "{ \"a\":1,\"c\":{\"d\":4} ,\"e\":null }");
    check_removal(object, 3, "{ \"c\":{\"d\":4} ,\"e\":null }");
    check_removal(object, 6, "{ \"a\":1 ,\"e\":null }");
    check_removal(object, 8, "{ \"a\":1, \"b\" : [2,3],\"c\":{\"d\":4} }");
    check_removal(object, 9, "{ \"b\" : [2,3],\"c\":{\"d\":4} }");
    check_removal(object, 11, "{ \"c\":{\"d\":4} }");
    check_removal(object, 15, "{  }");
    check_removal(array, 1, "[ \"b\" ,[3],4 ]");
    check_removal(array, 10, "[ 1 ,[3] ]");
    check_removal(array, 14, "[ 1 ]");
    check_removal(array, 15, "[  ]");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(spans_are_those_of_the_text),
        cmocka_unit_test(characters_are_decoded),
        cmocka_unit_test(a_character_is_seen_anywhere),
        cmocka_unit_test(broken_text_is_refused_with_its_line),
        cmocka_unit_test(depth_is_limited),
        cmocka_unit_test(many_members_are_compared),
        cmocka_unit_test(memory_may_run_out_anywhere),
        cmocka_unit_test(edits_replace_spans_only),
        cmocka_unit_test(members_go_with_their_commas),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
