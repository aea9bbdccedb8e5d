/* The JSON span reader: spans, characters, refusals with their line, edits of the text. */
#include "base/memory/memory.h"
#include "json/json_edit.h"
#include "json/json_parse.h"
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static ffd_status parse(const char *text, json_tree *tree, ffd_error *error)
{
    const json_input input = {.text = text, .size = strlen(text), .name = "t.json", .rules = JSON_ALLOW_MARK};
    return ffd_json_parse(&input, tree, error);
}

static void spans_are_those_of_the_text(void **state)
{
    (void)state;
    const char *text =
        "\xef\xbb\xbf { \"a\" : [1, -2.5e3,\t\"x\\u0041\"], \"b\\/~\":{\"c\":null}, \"\":true}\n";
    json_tree tree;
    assert_int_equal(parse(text, &tree, NULL), FFD_OK);
    assert_int_equal(tree.count, 8);
    const uint32_t a = ffd_json_tree_member(&tree, 0, "a"), b = ffd_json_tree_member(&tree, 0, "b/~");
    assert_int_equal(tree.values[a].count, 3);
    double number;
    assert_true(ffd_json_tree_number(&tree, ffd_json_tree_element(&tree, a, 1), &number));
    assert_true(number >= -2500 && number <= -2500);
    const json_value *value = &tree.values[ffd_json_tree_element(&tree, a, 1)];
    assert_int_equal(value->end - value->begin, 6);
    assert_memory_equal(text + value->begin, "-2.5e3", 6);
    char *string = ffd_json_tree_string(&tree, ffd_json_tree_element(&tree, a, 2), NULL);
    assert_string_equal(string, "xA");
    ffd_free(string);
    assert_int_equal(ffd_json_tree_element(&tree, a, 3), JSON_NONE);
    assert_int_equal(ffd_json_tree_member(&tree, a, "a"), JSON_NONE);
    char pointer[64];
    ffd_json_tree_pointer(&tree, ffd_json_tree_member(&tree, b, "c"), pointer, sizeof pointer);
    assert_string_equal(pointer, "/b~1~0/c");
    ffd_json_tree_pointer(&tree, ffd_json_tree_element(&tree, a, 2), pointer, sizeof pointer);
    assert_string_equal(pointer, "/a/2");
    ffd_json_tree_pointer(&tree, 0, pointer, sizeof pointer);
    assert_string_equal(pointer, "");
    ffd_json_tree_free(&tree);
}

static void characters_are_decoded(void **state)
{
    (void)state;
    json_tree tree;
    size_t size;
    assert_int_equal(parse("\"\\\"\\\\\\/\\b\\f\\n\\r\\t\\u00e4\\ud83d\\ude00\\u0000\xc3\xa4\"", &tree, NULL),
                     FFD_OK);
    char *text = ffd_json_tree_string(&tree, 0, &size);
    assert_int_equal(size, 17);
    assert_memory_equal(text, "\"\\/\b\f\n\r\t\xc3\xa4\xf0\x9f\x98\x80\0\xc3\xa4", 18);
    ffd_free(text);
    ffd_json_tree_free(&tree);
}

/* A C string neither ends at U+0000 nor hides that it is there. */
static void nuls_are_shown(void **state)
{
    (void)state;
    json_tree tree;
    assert_int_equal(parse("{\"\\u0000a\\u0000\\u0000\":\"POSITION\\u0000\",\"POSITION\\u0000\":\"\\u0000\"}",
                           &tree, NULL),
                     FFD_OK);
    const uint32_t first = ffd_json_tree_first(&tree, 0), second = ffd_json_tree_after(&tree, first);
    char *const texts[] = {ffd_json_tree_key(&tree, first), ffd_json_tree_string(&tree, first, NULL),
                           ffd_json_tree_key(&tree, second), ffd_json_tree_string(&tree, second, NULL)};
    /* The symbol for NUL, U+2400, in octal: an "a" after \x80 would be one more digit. */
    static const char *const expected[] = {"\342\220\200a\342\220\200\342\220\200", "POSITION\342\220\200",
                                           "POSITION\342\220\200", "\342\220\200"};
    for (size_t i = 0; i < sizeof texts / sizeof *texts; i++) {
        assert_string_equal(texts[i], expected[i]);
        ffd_free(texts[i]);
    }
    assert_int_equal(ffd_json_tree_member(&tree, 0, "POSITION"), JSON_NONE);
    ffd_json_tree_free(&tree);
}

/* The decoded text, wherever the character occurs; NULL: it is refused. */
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
                json_tree tree;
                snprintf(text, sizeof text, "\"%.*s%s%.*s\"", before, "aaaaaaaaaaaaaaaaaaaa",
                         characters[c][0], behind, "~~~~~~~~~~~~~~~~~~~~");
                const ffd_status status = parse(text, &tree, NULL);
                assert_int_equal(status, characters[c][1] ? FFD_OK : FFD_E_INVALID);
                if (status)
                    continue;
                snprintf(expected, sizeof expected, "%.*s%s%.*s", before, "aaaaaaaaaaaaaaaaaaaa",
                         characters[c][1], behind, "~~~~~~~~~~~~~~~~~~~~");
                char *string = ffd_json_tree_string(&tree, 0, NULL);
                assert_string_equal(string, expected);
                ffd_free(string);
                ffd_json_tree_free(&tree);
            }
}

static void broken_text_is_refused_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *message;
    } cases[] = {
        {"", "1: not valid JSON: a value is expected, found the end of the text (column 1)"},
        {"{", "1: not valid JSON: a key in double quotes is expected, found the end of the text (column 2)"},
        {"[1,\n2,\n]", "2: not valid JSON: one comma too many (column 2)"},
        {"[1 2]", "1: not valid JSON: ',' or ']' is expected, found '2' (column 4)"},
        {"{\"a\":1,}", "1: not valid JSON: one comma too many (column 7)"},
        {"{\"a\" 1}", "1: not valid JSON: ':' is expected, found '1' (column 6)"},
        {"{\"a\":1\n \"b\":2}", "2: not valid JSON: ',' or '}' is expected, found '\"' (column 2)"},
        {"[01]", "1: not valid JSON: a number must not start with 0, found '0' (column 2)"},
        {"[1.]", "1: not valid JSON: a digit is expected, found ']' (column 4)"},
        {"[-]", "1: not valid JSON: a digit is expected, found ']' (column 3)"},
        {"[1e+]", "1: not valid JSON: a digit is expected, found ']' (column 5)"},
        {"[+1]", "1: not valid JSON: JSON has no + before a number (column 2)"},
        {"[nul]", "1: not valid JSON: a value is expected, found 'n' (column 2)"},
        {"[NaN]", "1: not valid JSON: JSON has no NaN (column 2)"},
        {"[-nan]", "1: not valid JSON: JSON has no NaN (column 3)"},
        {"[Infinity]", "1: not valid JSON: JSON has no Infinity (column 2)"},
        {"[1,-inf]", "1: not valid JSON: JSON has no Infinity (column 5)"},
        {"[True]", "1: not valid JSON: JSON has true in small letters (column 2)"},
        {"[None]", "1: not valid JSON: JSON has null in place of None (column 2)"},
        {"['a']", "1: not valid JSON: JSON has texts in double quotes only (column 2)"},
        {"{'a': 1}", "1: not valid JSON: JSON has texts in double quotes only (column 2)"},
        {"[1,,2]", "1: not valid JSON: one comma too many (column 3)"},
        {"[,1]", "1: not valid JSON: one comma too many (column 2)"},
        {"{,}", "1: not valid JSON: one comma too many (column 2)"},
        {"{\"a\":,}", "1: not valid JSON: a value is expected, found ',' (column 6)"},
        {"[1, // one\n2]", "1: not valid JSON: JSON has no comments (column 5)"},
        {"[1 /* one */]", "1: not valid JSON: JSON has no comments (column 4)"},
        {"[1\n# one\n]", "2: not valid JSON: JSON has no comments (column 1)"},
        {"[1 / 2]", "1: not valid JSON: ',' or ']' is expected, found '/' (column 4)"},
        {"[1] // one", "1: not valid JSON: JSON has no comments (column 5)"},
        {"\xff\xfe[", "1: is text in UTF-16: it must be UTF-8"},
        {"\xfe\xff", "1: is text in UTF-16: it must be UTF-8"},
        {"\"a", "1: not valid JSON: this string has no closing quote (column 1)"},
        {"\"\\x\"", "1: not valid JSON: an escape in a string is not valid, found '\\' (column 2)"},
        {"\"\\ud800\"", "1: not valid JSON: an escape in a string is not valid, found '\\' (column 2)"},
        {"\"\xc0\xaf\"", "1: not valid JSON: a string is not valid UTF-8, found byte 0xc0 (column 2)"},
        {"\"\xff\"", "1: not valid JSON: a string is not valid UTF-8, found byte 0xff (column 2)"},
        {"\"a\nb\"",
         "1: not valid JSON: a control character in a string must be escaped, found byte 0x0a (column 3)"},
        {"1 2", "1: not valid JSON: nothing may follow the value, found '2' (column 3)"},
        {"\xef\xbb\xbf[\"\xc3\xa4\" 2", "1: not valid JSON: ',' or ']' is expected, found '2' (column 6)"},
        {"{\"a\":1,\"b\":{\"x\":1,\n\"\\u0078\":2}}",
         "2: /b/x: not valid JSON: duplicate key \"\\u0078\" in an object (column 1)"},
        {"{\"\":1,\"b\":2,\"\":3}", "1: /: not valid JSON: duplicate key \"\" in an object (column 13)"},
        {"{\"a\":1,\"b\":2,\"c\":3,\"d\":4,\"e\":5,\"f\":6,\"g\":7,\"h\":8,\"\\u0061\":9}",
         "1: /a: not valid JSON: duplicate key \"\\u0061\" in an object (column 50)"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        json_tree tree;
        ffd_error error = {0};
        char line[512];
        assert_int_equal(parse(cases[i].text, &tree, &error), FFD_E_INVALID);
        ffd_error_format(&error, line, sizeof line);
        assert_memory_equal(line, "t.json:", 7);
        assert_string_equal(line + 7, cases[i].message);
        assert_null(tree.values);
    }
}

/* Rules beyond the grammar that a reader can enable. */
static void rules_are_kept(void **state)
{
    (void)state;
    static const struct {
        const char *text;
        unsigned refused_by; /* by any of these rules */
        const char *message;
    } cases[] = {
        {"\"\\u0000\"", JSON_NO_NUL, "a string must not hold the character \\u0000 (column 2)"},
        {"{\"a\\u0000\":1}", JSON_NO_NUL, "a string must not hold the character \\u0000 (column 4)"},
        {"[\"\\u0001\\\\u0000\"]", 0, NULL},
        {"[1e308,-1e308,1e-999]", 0, NULL},
        {"[1,-1e309]", JSON_DOUBLES, "the number -1e309 is too large (column 4)"},
        {"[1.8E+308]", JSON_DOUBLES, "the number 1.8E+308 is too large (column 2)"},
        {"[9223372036854775807,-9223372036854775808]", 0, NULL},
        {"9223372036854775808", JSON_INTEGERS,
         "the whole number 9223372036854775808 does not fit 64 bits (column 1)"},
        {"-9223372036854775809", JSON_INTEGERS,
         "the whole number -9223372036854775809 does not fit 64 bits (column 1)"},
        {"100000000000000000000000000000000000000000000", JSON_INTEGERS,
         "the whole number 1000000000000000000000000000000000000000 does not fit 64 bits (column 1)"},
        {"9223372036854775808.0", 0, NULL},
        {"9223372036854775808e0", 0, NULL},
    };
    static const unsigned rules[] = {0, JSON_NO_NUL, JSON_DOUBLES, JSON_INTEGERS};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
        for (size_t r = 0; r < sizeof rules / sizeof *rules; r++) {
            const json_input input = {
                .text = cases[i].text, .size = strlen(cases[i].text), .name = "t", .rules = rules[r]};
            json_tree tree;
            ffd_error error = {0};
            const ffd_status status = ffd_json_parse(&input, &tree, &error);
            assert_int_equal(status, rules[r] & cases[i].refused_by ? FFD_E_INVALID : FFD_OK);
            if (status)
                assert_string_equal(error.message + strlen("not valid JSON: "), cases[i].message);
            ffd_json_tree_free(&tree);
        }
    /* 310 digits. */
    char digits[311];
    memset(digits, '1', sizeof digits);
    json_input input = {.text = digits, .size = sizeof digits - 1, .name = "t", .rules = JSON_DOUBLES};
    json_tree tree;
    assert_int_equal(ffd_json_parse(&input, &tree, NULL), FFD_E_INVALID);
    input.size = 308;
    assert_int_equal(ffd_json_parse(&input, &tree, NULL), FFD_OK);
    ffd_json_tree_free(&tree);
    input = (json_input){.text = "\xef\xbb\xbf"
                                 "1",
                         .size = 4,
                         .name = "t"};
    assert_int_equal(ffd_json_parse(&input, &tree, NULL), FFD_E_INVALID);
    input.rules = JSON_ALLOW_MARK;
    assert_int_equal(ffd_json_parse(&input, &tree, NULL), FFD_OK);
    ffd_json_tree_free(&tree);
}

/* Lines and columns in a part of a text are those of the whole. */
static void parts_are_counted_from_the_beginning(void **state)
{
    (void)state;
    const char *const whole = "[\n 1, {\"a\": x}]";
    const json_input input = {.text = whole + 6, .size = 8, .name = "t", .whole = whole, .line = 7};
    json_tree tree;
    ffd_error error = {0};
    assert_int_equal(ffd_json_parse(&input, &tree, &error), FFD_E_INVALID);
    assert_int_equal(error.line, 8);
    assert_string_equal(error.message, "not valid JSON: a value is expected, found 'x' (column 11)");
}

static void depth_is_limited(void **state)
{
    (void)state;
    char text[2 * JSON_TREE_DEPTH + 3];
    for (int extra = 0; extra < 2; extra++) {
        const size_t depth = JSON_TREE_DEPTH + (size_t)extra;
        memset(text, '[', depth);
        memset(text + depth, ']', depth);
        text[2 * depth] = 0;
        json_tree tree;
        assert_int_equal(parse(text, &tree, NULL), extra ? FFD_E_INVALID : FFD_OK);
        ffd_json_tree_free(&tree);
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
    json_tree tree;
    json_input input = {.text = text.data, .size = text.size, .name = "t"};
    assert_int_equal(ffd_json_parse(&input, &tree, NULL), FFD_OK);
    ffd_json_tree_free(&tree);
    text.size = unique;
    ffd_buffer_text(&text, ",\"key17\":0}");
    ffd_error error = {0};
    input.text = text.data;
    input.size = text.size;
    assert_int_equal(ffd_json_parse(&input, &tree, &error), FFD_E_INVALID);
    assert_string_equal(error.pointer, "/key17");
    ffd_buffer_free(&text);
}

static void memory_may_run_out_anywhere(void **state)
{
    (void)state;
    for (long successes = 0;; successes++) {
        json_tree tree;
        ffd_error error = {0};
        ffd_alloc_fail_after(successes);
        const ffd_status status =
            parse("{\"a\":[1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17],\"b\":{}}", &tree, &error);
        ffd_alloc_fail_after(-1);
        ffd_json_tree_free(&tree);
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
    /* Those of another list come behind those at the same offset. */
    json_edits joined = {0};
    ffd_edits_format(&joined, 11, 11, ",0");
    ffd_edits_join(&joined, &edits);
    ffd_edits_sort(&joined);
    out.size = 0;
    ffd_edits_apply(&joined, text, 0, 12, &out);
    assert_int_equal(out.size, 15);
    assert_memory_equal(out.data, "[, x, 30,0,4,5]", 15);
    ffd_edits_free(&joined);
    assert_false(ffd_edits_failed(&edits));
    ffd_edits_free(&edits);
    ffd_buffer_free(&out);
}

/* Removes the children whose bits are set from an object or array of 4. */
static void check_removal(const char *text, unsigned gone, const char *expected)
{
    json_tree tree;
    json_edits edits = {0};
    byte_buffer out = {0};
    uint32_t values[4];
    size_t count = 0;
    assert_int_equal(parse(text, &tree, NULL), FFD_OK);
    for (size_t i = 0; i < 4; i++) {
        uint32_t v = ffd_json_tree_first(&tree, 0);
        for (size_t k = 0; k < i; k++)
            v = ffd_json_tree_after(&tree, v);
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
    ffd_json_tree_free(&tree);
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
        cmocka_unit_test(nuls_are_shown),
        cmocka_unit_test(a_character_is_seen_anywhere),
        cmocka_unit_test(broken_text_is_refused_with_its_line),
        cmocka_unit_test(rules_are_kept),
        cmocka_unit_test(parts_are_counted_from_the_beginning),
        cmocka_unit_test(depth_is_limited),
        cmocka_unit_test(many_members_are_compared),
        cmocka_unit_test(memory_may_run_out_anywhere),
        cmocka_unit_test(edits_replace_spans_only),
        cmocka_unit_test(members_go_with_their_commas),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
