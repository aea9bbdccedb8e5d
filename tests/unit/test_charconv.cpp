/* Numbers are parsed and printed exactly like the C++ library's <charconv>. */
#include "base/text/number.h"
#include <charconv>
#include <cmath>
#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

extern "C" {
#include "../support/draw.h"
#include "../support/repetitions.h"
#include <cmocka.h>
}

namespace
{

void read(const char *first, const char *last, double *value, const char **end)
{
    *end = ffd_number_parse(first, last, value);
}

void read(const char *first, const char *last, float *value, const char **end)
{
    *end = ffd_number_parse_float(first, last, value);
}

size_t write(double value, char *text)
{
    return ffd_number_format(value, text);
}

size_t write(float value, char *text)
{
    return ffd_number_format_float(value, text);
}

/* For numbers out of range the C++ library does not tell overflow from underflow. */
template <typename T> void check_read(const std::string &text)
{
    T expected = 0, value = -7;
    const char *const first = text.data(), *const last = first + text.size(), *end;
    const std::from_chars_result result = std::from_chars(first, last, expected);
    read(first, last, &value, &end);
    if (result.ec == std::errc::invalid_argument) {
        assert_null(end);
        return;
    }
    if (end != result.ptr)
        print_error("%s\n", text.c_str());
    assert_ptr_equal(end, result.ptr);
    if (result.ec == std::errc::result_out_of_range) {
        assert_true(std::isinf(value) || !(std::fabs(value) > 0));
        return;
    }
    if (std::memcmp(&value, &expected, sizeof value) != 0)
        print_error("%s\n", text.c_str());
    assert_memory_equal(&value, &expected, sizeof value);
}

template <typename T> void check_write(T value)
{
    char text[FFD_NUMBER_CAPACITY], expected[FFD_NUMBER_CAPACITY];
    const size_t size = write(value, text);
    const std::to_chars_result result = std::to_chars(expected, expected + sizeof expected, value);
    assert_string_equal(std::string(text, size).c_str(), std::string(expected, result.ptr).c_str());
    check_read<double>(std::string(text, size));
    check_read<float>(std::string(text, size));
}

void powers_of_two_and_their_neighbours(void **)
{
    for (int exponent = -1074; exponent < 1024; exponent++) {
        const double value = std::ldexp(1, exponent);
        for (const double near : {value, -value, std::nextafter(value, 0), std::nextafter(value, HUGE_VAL)})
            check_write(near);
    }
    for (int exponent = -149; exponent < 128; exponent++) {
        const float value = std::ldexp(1.0F, exponent);
        for (const float near :
             {value, -value, std::nextafter(value, 0.0F), std::nextafter(value, HUGE_VALF)})
            check_write(near);
    }
}

template <typename T> void check_any(uint64_t bits)
{
    T value;
    std::memcpy(&value, &bits, sizeof value);
    check_write(value);
}

void numbers_of_all_sizes(void **)
{
    draw d = {draw_seed()};
    for (int i = 0; i < repetitions(100000); i++) {
        check_any<double>(draw_bits(&d));
        check_any<float>(draw_bits(&d) >> 32);
        const double value = std::ldexp(draw_between(&d, -1, 1), draw_int(&d, -140, 60));
        check_write(value);
        check_write(static_cast<float>(value));
        check_write(static_cast<double>(draw_bits(&d) >> draw_int(&d, 0, 63)));
    }
}

void add_digits(draw *d, int most, std::string &text)
{
    for (int count = draw_int(d, 0, most); count > 0; count--)
        text += static_cast<char>('0' + (draw_int(d, 0, 3) ? draw_int(d, 0, 9) : 0));
}

void texts_of_all_lengths(void **)
{
    draw d = {draw_seed()};
    for (int i = 0; i < repetitions(200000); i++) {
        std::string text(draw_int(&d, 0, 2) ? "" : "-");
        add_digits(&d, draw_int(&d, 0, 50) ? 12 : 900, text);
        text += draw_int(&d, 0, 3) ? "." : "";
        add_digits(&d, draw_int(&d, 0, 50) ? 16 : 900, text);
        if (draw_int(&d, 0, 1))
            text +=
                "e" + std::to_string(draw_int(&d, 0, 5) ? draw_int(&d, -30, 30) : draw_int(&d, -400, 400));
        text += draw_int(&d, 0, 9) ? "" : "e";
        check_read<double>(text);
        check_read<float>(text);
    }
}

/* Exactly halfway between two numbers, and slightly above. */
void halves(void **)
{
    draw d = {draw_seed()};
    for (int i = 0; i < repetitions(20000); i++) {
        char text[FFD_NUMBER_CAPACITY + 200];
        const float value = std::ldexp(static_cast<float>(draw_between(&d, 1, 2)), draw_int(&d, -120, 100));
        const double half =
            (static_cast<double>(value) + static_cast<double>(std::nextafter(value, HUGE_VALF))) / 2;
        snprintf(text, sizeof text, "%.*e", draw_int(&d, 0, 2) ? 150 : draw_int(&d, 1, 40), half);
        check_read<float>(text);
        check_read<float>(std::to_string(draw_bits(&d) | 1) + ".5");
        /* So many digits that the text, rounded to double first, could be a tie between two floats. */
        const float near_one = static_cast<float>(draw_between(&d, 1, 8));
        snprintf(text, sizeof text, "%.15f",
                 (static_cast<double>(near_one) + static_cast<double>(std::nextafter(near_one, HUGE_VALF))) /
                     2);
        check_read<float>(text);
        const std::string whole = std::to_string((draw_bits(&d) >> 10 | (uint64_t)1 << 53) | 1);
        check_read<double>(whole);
        check_read<double>(whole + ".0");
        check_read<double>(whole + "000000000000000000000000000000001");
        check_read<double>(whole + "." + std::string(800, '0') + "1");
    }
}

void words_and_broken_texts(void **)
{
    for (const char *text : {"inf",
                             "-INF",
                             "infinity",
                             "Infinityx",
                             "infinit",
                             "nan",
                             "NaN(",
                             "nan(ab_1)",
                             "nan(a b)",
                             "-nan",
                             "na",
                             "i",
                             "",
                             "-",
                             ".",
                             "-.",
                             ".e1",
                             "1.e5",
                             "1e",
                             "1e+",
                             "1e-x",
                             "0e99999999999999999999",
                             "0x1p3",
                             "8.5e22",
                             "1.7976931348623159e308",
                             "2.4703282292062327e-324",
                             "2.4703282292062328e-324",
                             "1e99999999999999999999",
                             "1e-99999999999999999999"}) {
        check_read<double>(text);
        check_read<float>(text);
    }
}

} // namespace

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(powers_of_two_and_their_neighbours),
        cmocka_unit_test(numbers_of_all_sizes),
        cmocka_unit_test(texts_of_all_lengths),
        cmocka_unit_test(halves),
        cmocka_unit_test(words_and_broken_texts),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
