/* test_number.c - parsing and printing of numbers. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/repetitions.h"
#include "base/text/decimal.h"
#include "base/text/number.h"
#include "base/text/size.h"
#include <float.h>
#include <locale.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct number_case {
    const char *text;
    double value;
    size_t length; /* bytes read; 0: refused */
} number_case;

static void the_longest_number_at_the_start_is_read(void **state)
{
    static const number_case cases[] = {
        {"0", 0, 1},
        {"-0", -0.0, 2},
        {"+1.5", 1.5, 4},
        {"1e3x", 1000, 3},
        {".5", 0.5, 2},
        {"5.", 5, 2},
        {"1.5.2", 1.5, 3},
        {"1e", 1, 1},
        {"1e+", 1, 1},
        {"-1E-2", -0.01, 5},
        {"0x10", 0, 1},
        {"", 0, 0},
        {"-", 0, 0},
        {"+-1", 0, 0},
        {"e5", 0, 0},
        {".", 0, 0},
        {"1,5", 1, 1},
        {"1e400", HUGE_VAL, 5},
        {"-1e400", -HUGE_VAL, 6},
        {"1e-400", 0, 6},
        {"0.1", 0.1, 3},
        {"4.9e-324", 4.9406564584124654e-324, 8},
        {"inf", HUGE_VAL, 3},
        {"123456789012345678901234567890e-400", 0, 35},
        {"0.00000000000000000000000000000000001e400", HUGE_VAL, 41},
        {"9007199254740993", 9007199254740992.0, 16},
        {"1.7976931348623157e308", DBL_MAX, 22},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *text = cases[i].text;
        double value = -7;
        const char *end = ffd_number_parse(text, text + strlen(text), &value);
        if (!cases[i].length) {
            assert_null(end);
            continue;
        }
        assert_non_null(end);
        assert_int_equal(end - text, cases[i].length);
        assert_true(value == cases[i].value);
        assert_int_equal(signbit(value) != 0, signbit(cases[i].value) != 0);
    }
    double value = 0;
    assert_non_null(ffd_number_parse("nan", &"nan"[3], &value));
    (void)state;
}

/* A float is rounded once, from the text: through double 1.0000000596046448 would become 1. */
static void a_float_is_rounded_once_from_its_text(void **state)
{
    static const struct {
        const char *text;
        float value;
        size_t length; /* bytes read; 0: refused */
    } cases[] = {
        {"0.1", 0.1F, 3},
        {"-0", -0.0F, 2},
        {"+1.5x", 1.5F, 4},
        {"1.000000059604644775390625", 1, 26},
        {"1.00000005960464477539062500000000000001", 1 + FLT_EPSILON, 40},
        {"3.4028234663852886e38", FLT_MAX, 21},
        {"3.4028236e38", HUGE_VALF, 12},
        {"-1e39", -HUGE_VALF, 5},
        {"1e-46", 0, 5},
        {"1e-45", 1.401298464324817e-45F, 5},
        {"1e-310", 0, 6},
        {"inf", HUGE_VALF, 3},
        {"x", 0, 0},
        {"+-1", 0, 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        const char *text = cases[i].text;
        float value = -7;
        const char *end = ffd_number_parse_float(text, text + strlen(text), &value);
        if (!cases[i].length) {
            assert_null(end);
            continue;
        }
        assert_ptr_equal(end, text + cases[i].length);
        assert_memory_equal(&value, &cases[i].value, sizeof value);
    }
}

static void reading_stops_at_the_end_given(void **state)
{
    const char text[] = "12345";
    double value = 0;
    assert_ptr_equal(ffd_number_parse(text, text + 2, &value), text + 2);
    assert_true(value == 12);
    (void)state;
}

static const char *format(double value)
{
    static char text[FFD_NUMBER_CAPACITY + 1];
    text[ffd_number_format(value, text)] = 0;
    return text;
}

static void known_numbers_have_their_shortest_text(void **state)
{
    assert_string_equal(format(0.1), "0.1");
    assert_string_equal(format(1), "1");
    assert_string_equal(format(-0.0), "-0");
    assert_string_equal(format(1e300), "1e+300");
    assert_string_equal(format(0.001), "0.001");
    assert_string_equal(format(1.0 / 3), "0.3333333333333333");
    assert_string_equal(format(5e-324), "5e-324");
    char text[FFD_NUMBER_CAPACITY];
    const size_t length = ffd_number_format_float(0.1f, text);
    assert_int_equal(length, 3);
    assert_memory_equal(text, "0.1", 3);
    (void)state;
}

/* Any double round-trips, also in a locale with a decimal comma if there is one. */
static void any_double_comes_back_as_itself(void **state)
{
    draw d = {draw_seed()};
    setlocale(LC_ALL, "de_DE.UTF-8");
    for (int i = 0; i < repetitions(200000); i++) {
        const uint64_t bits = draw_bits(&d);
        double value, back = 0;
        memcpy(&value, &bits, sizeof value);
        if (!isfinite(value))
            continue;
        char text[FFD_NUMBER_CAPACITY];
        const size_t length = ffd_number_format(value, text);
        assert_true(length < FFD_NUMBER_CAPACITY);
        assert_ptr_equal(ffd_number_parse(text, text + length, &back), text + length);
        assert_memory_equal(&back, &value, sizeof value);
    }
    (void)state;
}

/* Finds the shortest text by trial: increasing digits until it reads back, in the shorter of both forms. Not
   for powers of two, whose neighbours are at different distances: the nearest number with that many digits
   may not read back, while one beside it does. */
static void write_by_trial(double value, char *text, size_t capacity)
{
    char digits[40];
    int count = 0;
    do
        snprintf(digits, sizeof digits, "%.*e", count++, value);
    while (strtod(digits, NULL) != value);
    const int exponent = atoi(strchr(digits, 'e') + 1);
    snprintf(text, capacity, "%.*f", count - 1 > exponent ? count - 1 - exponent : 0, value);
    if (strlen(digits) < strlen(text))
        snprintf(text, capacity, "%s", digits);
}

/* Draws a double as meshes have them: any bits, few digits, few bits, and their neighbours. */
static double draw_coordinate(draw *d)
{
    double value = ldexp(draw_between(d, -2, 2), draw_int(d, -60, 51));
    const int kind = draw_int(d, 0, 3);
    if (kind == 0)
        value = (double)(draw_bits(d) % 1000000) * pow(10, draw_int(d, -12, 3));
    else if (kind == 1)
        value = ldexp((double)(draw_bits(d) % 1024), draw_int(d, -50, 40));
    const int side = draw_int(d, 0, 3);
    return side == 0 ? nextafter(value, -HUGE_VAL) : side == 1 ? nextafter(value, HUGE_VAL) : value;
}

static void text_is_the_shortest_that_reads_back(void **state)
{
    draw d = {draw_seed()};
    setlocale(LC_ALL, "C");
    for (int i = 0; i < repetitions(300000); i++) {
        char expected[400];
        int exponent;
        const double value = draw_coordinate(&d);
        if (fabs(frexp(value, &exponent)) == 0.5)
            continue;
        write_by_trial(value, expected, sizeof expected);
        assert_string_equal(format(value), expected);
    }
    (void)state;
}

static size_t draw_digits(draw *d, int most, char *text)
{
    const int count = draw_int(d, 0, most);
    const uint64_t zeros = draw_bits(d);
    for (int i = 0; i < count; i++)
        text[i] = zeros >> (i % 64) & 1 ? '0' : (char)('0' + draw_int(d, 0, 9));
    return (size_t)count;
}

/* Texts of all lengths are parsed like the C library does. */
static void texts_read_as_the_c_library_reads_them(void **state)
{
    draw d = {draw_seed()};
    setlocale(LC_ALL, "C");
    for (int i = 0; i < repetitions(300000); i++) {
        char text[80] = "-", *end;
        size_t size = (size_t)draw_int(&d, 0, 1);
        size += draw_digits(&d, 22, text + size);
        if (draw_int(&d, 0, 3))
            text[size++] = '.';
        size += draw_digits(&d, 22, text + size);
        if (draw_int(&d, 0, 5) == 0)
            size += (size_t)snprintf(text + size, 8, "e%d", draw_int(&d, -30, 30));
        snprintf(text + size, 8, "%s", draw_int(&d, 0, 1) ? ",1" : ".1");
        double value = 0;
        const char *const read = ffd_number_parse(text, text + size + 2, &value);
        const double expected = strtod(text, &end);
        if (end == text) {
            assert_null(read);
            continue;
        }
        assert_ptr_equal(read, end);
        assert_memory_equal(&value, &expected, sizeof value);
    }
    (void)state;
}

/* Draws a number as meshes have them, or any. */
static double any_number(draw *d)
{
    switch (draw_int(d, 0, 6)) {
    case 6: /* around the limits between both forms */
        return draw_int(d, -12, 12) * pow(10, draw_int(d, -10, 8)) + draw_int(d, 0, 1) / 8.0;
    case 0:
        return draw_int(d, -1000, 1000) / 16.0;
    case 1:
        return draw_int(d, -1000000, 1000000) / 1e4;
    case 2:
        return ldexp(draw_between(d, -1, 1), draw_int(d, -90, 60));
    case 3:
        return (float)draw_between(d, -10, 10);
    case 4: {
        static const double odd[] = {0,           -0.0, 1, -0.5, 1e300, -5e-324, HUGE_VAL, 4503599627370495.5,
                                     1e15 + 0.125};
        return odd[draw_int(d, 0, 8)];
    }
    default:
        return draw_between(d, -10, 10);
    }
}

/* In an array, any subset of numbers gets the same texts as one at a time. */
static void a_run_gives_each_number_the_text_it_has_alone(void **state)
{
    enum { MOST = 200 };
    draw d = {draw_seed()};
    for (int round = 0; round < 5000; round++) {
        const int count = draw_int(&d, 1, MOST), step = draw_int(&d, 1, 12), skipped = draw_int(&d, 0, 3);
        double *const values =
            malloc((size_t)count * sizeof *values); /* so that reading past the end is detected */
        decimal_run run;
        assert_non_null(values);
        for (int i = 0; i < count; i++)
            values[i] = any_number(&d);
        ffd_decimal_run_begin(&run, values + count);
        for (int i = 0; i<count; i += step> 9 ? draw_int(&d, 1, step) : 1) {
            char expected[FFD_NUMBER_CAPACITY], text[FFD_NUMBER_CAPACITY];
            const int wanted = draw_int(&d, 0, 40) ? i : draw_int(&d, 0, count - 1);
            if (skipped && draw_int(&d, 0, skipped))
                continue;
            const size_t size = ffd_number_format(values[wanted], expected);
            assert_int_equal(ffd_decimal_run_format(&run, &values[wanted], text), size);
            assert_memory_equal(text, expected, size);
        }
        free(values);
    }
    (void)state;
}

static void sizes_have_a_unit_or_none(void **state)
{
    static const struct {
        const char *text;
        uint64_t bytes; /* 0: refused */
    } sizes[] = {
        {"1", 1},
        {"4096", 4096},
        {"1K", 1000},
        {"700M", 700000000},
        {"4G", 4000000000},
        {"1.5G", 1500000000},
        {".5K", 500},
        {"1e3M", 1000000000},
        {"1e-3K", 1},
        {"9223372036854774784", 9223372036854774784u}, /* the last double below 2^63 */
        {"9223372036854775808", 0},
        {"9223372037G", 0},
        {"0", 0},
        {"0.5", 0},
        {"-1", 0},
        {"-1G", 0},
        {"", 0},
        {"M", 0},
        {"1k", 0},
        {"1MB", 0},
        {"1 M", 0},
        {" 1", 0},
        {"1M ", 0},
        {"1e", 0},
        {"1eM", 0},
        {"0x10", 0},
        {"inf", 0},
        {"nan", 0},
        {"infG", 0},
        {"1e400", 0},
    };
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        uint64_t bytes = 0;
        if (ffd_size_parse(sizes[i].text, &bytes) != (sizes[i].bytes != 0) || bytes != sizes[i].bytes)
            fail_msg("\"%s\": %llu bytes", sizes[i].text, (unsigned long long)bytes);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_longest_number_at_the_start_is_read),
        cmocka_unit_test(a_float_is_rounded_once_from_its_text),
        cmocka_unit_test(reading_stops_at_the_end_given),
        cmocka_unit_test(known_numbers_have_their_shortest_text),
        cmocka_unit_test(any_double_comes_back_as_itself),
        cmocka_unit_test(text_is_the_shortest_that_reads_back),
        cmocka_unit_test(texts_read_as_the_c_library_reads_them),
        cmocka_unit_test(a_run_gives_each_number_the_text_it_has_alone),
        cmocka_unit_test(sizes_have_a_unit_or_none),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
