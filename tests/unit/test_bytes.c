/* Classifying many bytes at a time, and parsing digits: the same results as byte by byte, at any alignment,
   in every implementation. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "base/bytes.h"
#include <stdlib.h>

#define ROUNDS 20000

static uint64_t low_one_by_one(const char *at)
{
    uint64_t found = 0;
    for (int i = 0; i < 64; i++)
        found |= (uint64_t)((unsigned char)at[i] < '!') << i;
    return found;
}

static uint32_t not_digits_one_by_one(const char *at)
{
    uint32_t found = 0;
    for (int i = 0; i < 32; i++)
        found |= (uint32_t)(at[i] < '0' || at[i] > '9') << i;
    return found;
}

/* Draws any bytes, or those near the ones that are searched for. */
static void draw_bytes(draw *d, char *bytes, size_t count)
{
    static const char near[] = "\0\x1f !\"\x7f\x80\xa0\xff/0123456789:\xb0\xb9";
    const int kind = draw_int(d, 0, 2);
    for (size_t i = 0; i < count; i++)
        bytes[i] = kind == 0   ? (char)draw_int(d, -128, 127)
                   : kind == 1 ? near[draw_int(d, 0, sizeof near - 2)]
                               : (char)draw_int(d, '/', ':');
}

static void all_ways_agree(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    char bytes[80];
    for (int round = 0; round < ROUNDS; round++) {
        const char *const at = bytes + round % 16;
        draw_bytes(&d, bytes, sizeof bytes);
        assert_int_equal(bytes_low_of_64_by_words(at), low_one_by_one(at));
        assert_int_equal(bytes_low_of_64(at), low_one_by_one(at));
        assert_int_equal(bytes_not_digits_of_32_by_words(at), not_digits_one_by_one(at));
        assert_int_equal(bytes_not_digits_of_32(at), not_digits_one_by_one(at));
        assert_int_equal(bytes_not_digits_of_64(at),
                         not_digits_one_by_one(at) | (uint64_t)not_digits_one_by_one(at + 32) << 32);
    }
}

static void number_is_that_of_its_digits(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (int round = 0; round < ROUNDS; round++) {
        const int count = draw_int(&d, 0, 16), before = draw_int(&d, 0, count);
        char *const text = malloc(17); /* so that reading past the end is detected */
        uint64_t expected = 0;
        assert_non_null(text);
        draw_bytes(&d, text, 17);
        for (int i = 0; i < 16; i++) {
            const int digit = draw_int(&d, 0, 9);
            if (i < count)
                text[i + (i >= before)] = (char)('0' + digit);
            expected = expected * 10 + (uint64_t)(i < count ? digit : 0);
        }
        assert_int_equal(bytes_digits_around_by_words(text, before, count), expected);
        assert_int_equal(bytes_digits_around(text, before, count), expected);
        free(text);
    }
}

static void two_numbers_are_each(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (int round = 0; round < ROUNDS; round++) {
        uint64_t digits[2] = {0};
        uint32_t numbers[2] = {0};
        for (int i = 0; i < 16; i++) {
            const int digit = draw_int(&d, 0, 9);
            digits[i / 8] |= (uint64_t)digit << i % 8 * 8;
            numbers[i / 8] = 10 * numbers[i / 8] + (uint32_t)digit;
        }
        const byte_numbers by_words = bytes_two_numbers_by_words(digits[0], digits[1]),
                           best = bytes_two_numbers(digits[0], digits[1]);
        assert_int_equal(by_words.first, numbers[0]);
        assert_int_equal(by_words.second, numbers[1]);
        assert_int_equal(best.first, numbers[0]);
        assert_int_equal(best.second, numbers[1]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_ways_agree),
        cmocka_unit_test(number_is_that_of_its_digits),
        cmocka_unit_test(two_numbers_are_each),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
