/* test_array.c - array loops give the same bits with each instruction set of this processor, equal to a plain
   loop. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "base/vector/array_kernel.h"
#include <math.h>
#include <string.h>

#define ROUNDS 3000
#define MOST 67 /* points */

static const double odd[] = {0, -0.0, 5e-324, -1e-310, 1e308, -1e308, 3.5e38, -1e-46, HUGE_VAL, -HUGE_VAL};

static double number(draw *d, bool finite)
{
    const int choice = draw_int(d, 0, 60);
    if (choice == 60 && !finite)
        return NAN;
    return choice < (finite ? 8 : 10) ? odd[choice] : draw_between(d, -3, 3);
}

static const array_kernel *next_kernel(ffd_isa *isa)
{
    while (++*isa <= FFD_ISA_NEON)
        if (ffd_isa_available(*isa))
            return ffd_array_kernel(*isa);
    return NULL;
}

/* Equal bits, except that any two NaNs are equal. */
static bool is_same(double a, double b)
{
    return isnan(a) ? isnan(b) : memcmp(&a, &b, sizeof a) == 0;
}

static void floats_are_read_and_rounded(void **state)
{
    draw d = {draw_seed()};
    for (int round = 0; round < ROUNDS; round++) {
        const size_t count = (size_t)draw_int(&d, 0, 3 * MOST);
        unsigned char bytes[4 * 3 * MOST + 3];
        double values[3 * MOST];
        float rounded[3 * MOST];
        const size_t at = (size_t)draw_int(&d, 0, 3);
        for (size_t i = 0; i < count; i++) {
            values[i] = number(&d, false);
            rounded[i] = (float)values[i];
            memcpy(bytes + at + 4 * i, &rounded[i], sizeof *rounded);
        }
        ffd_isa isa = FFD_ISA_AUTO;
        for (const array_kernel *kernel; (kernel = next_kernel(&isa));) {
            double read[3 * MOST + 1] = {0};
            float made[3 * MOST + 1] = {0};
            kernel->read_floats(bytes + at, count, read);
            kernel->round(values, count, made);
            for (size_t i = 0; i < count; i++) {
                assert_true(is_same(read[i], rounded[i]) && is_same(made[i], rounded[i]));
            }
            assert_true(read[count] == 0 && made[count] == 0);
        }
    }
    (void)state;
}

/* At any alignment, and without writing past the end. */
static void check_span(const array_kernel *kernel, const uint32_t *values, size_t count)
{
    uint32_t least, greatest, low = UINT32_MAX, high = 0;
    for (size_t i = 0; i < count; i++) {
        low = values[i] < low ? values[i] : low;
        high = values[i] > high ? values[i] : high;
    }
    if (count == 0)
        return;
    kernel->span(values, count, &least, &greatest);
    assert_true(least == low && greatest == high);
}

static void whole_numbers_are_read(void **state)
{
    draw d = {draw_seed()};
    for (int round = 0; round < ROUNDS; round++) {
        const size_t count = (size_t)draw_int(&d, 0, MOST), at = (size_t)draw_int(&d, 0, 3);
        const int shift = draw_int(&d, 0, 31);
        unsigned char bytes[4 * MOST + 3];
        uint32_t values[MOST], largest = 0;
        for (size_t i = 0; i < count; i++) {
            values[i] = ((uint32_t)draw_int(&d, 0, 65535) << 16 | (uint32_t)draw_int(&d, 0, 65535)) >> shift;
            largest = values[i] > largest ? values[i] : largest;
            for (size_t b = 0; b < 4; b++)
                bytes[at + 4 * i + b] = (unsigned char)(values[i] >> (8 * b));
        }
        ffd_isa isa = FFD_ISA_AUTO;
        for (const array_kernel *kernel; (kernel = next_kernel(&isa));) {
            uint32_t read[MOST + 1] = {0};
            assert_true(kernel->read_u32(bytes + at, count, read) == largest);
            assert_memory_equal(read, values, count * sizeof *read);
            assert_true(read[count] == 0);
            check_span(kernel, values, count);
        }
    }
    (void)state;
}

static void magnitudes_are_of_finite_numbers(void **state)
{
    draw d = {draw_seed()};
    for (int round = 0; round < ROUNDS; round++) {
        const size_t count = (size_t)draw_int(&d, 0, MOST);
        const bool tame = draw_int(&d, 0, 1);
        double numbers[MOST], greatest = 0;
        for (size_t i = 0; i < count; i++) {
            numbers[i] = number(&d, tame);
            greatest = isfinite(numbers[i]) ? fmax(greatest, fabs(numbers[i])) : greatest;
        }
        ffd_isa isa = FFD_ISA_AUTO;
        for (const array_kernel *kernel; (kernel = next_kernel(&isa));)
            assert_true(kernel->magnitude(numbers, count) == greatest);
    }
    (void)state;
}

static void boxes_are_widened(void **state)
{
    draw d = {draw_seed()};
    for (int round = 0; round < ROUNDS; round++) {
        const size_t count = (size_t)draw_int(&d, 0, MOST);
        const bool tame = draw_int(&d, 0, 3);
        double points[3 * MOST], min[3] = {-1, 0, HUGE_VAL}, max[3] = {1, 0, -HUGE_VAL}, low[3], high[3];
        bool finite = true;
        for (size_t i = 0; i < 3 * count; i++) {
            points[i] = number(&d, tame);
            finite = finite && isfinite(points[i]);
        }
        memcpy(low, min, sizeof low);
        memcpy(high, max, sizeof high);
        for (size_t i = 0; i < 3 * count && finite; i++) {
            low[i % 3] = fmin(low[i % 3], points[i]);
            high[i % 3] = fmax(high[i % 3], points[i]);
        }
        ffd_isa isa = FFD_ISA_AUTO;
        double bits[6];
        for (const array_kernel *kernel; (kernel = next_kernel(&isa));) {
            double box[6];
            memcpy(box, min, sizeof min);
            memcpy(box + 3, max, sizeof max);
            assert_int_equal(kernel->widen(points, count, box, box + 3), finite);
            for (int a = 0; a < 3; a++)
                assert_true(box[a] == low[a] && box[3 + a] == high[a]);
            if (isa == FFD_ISA_SCALAR)
                memcpy(bits, box, sizeof bits);
            assert_memory_equal(box, bits, sizeof bits);
        }
    }
    (void)state;
}

static void points_are_displaced(void **state)
{
    draw d = {draw_seed()};
    for (int round = 0; round < ROUNDS; round++) {
        const size_t count = (size_t)draw_int(&d, 0, MOST);
        const bool tame = draw_int(&d, 0, 3);
        const double largest = draw_int(&d, 0, 1) ? 4 : 1e300;
        double points[3 * MOST + 1], vectors[3 * MOST], expected[3 * MOST + 1];
        uint8_t others[MOST] = {0};
        size_t unfit = count;
        for (size_t i = 0; i < 3 * count; i++) {
            points[i] = number(&d, tame);
            vectors[i] = draw_int(&d, 0, 2) ? 0 : draw_int(&d, 0, 5) ? number(&d, tame) : 1e-30;
            expected[i] = vectors[i] != 0 ? points[i] + vectors[i] : points[i];
            if (vectors[i] == 0 || expected[i] == points[i])
                continue;
            others[i / 3] = 1;
            if (!(fabs(expected[i]) <= largest) && i / 3 < unfit)
                unfit = i / 3;
        }
        points[3 * count] = expected[3 * count] = 7;
        ffd_isa isa = FFD_ISA_AUTO;
        for (const array_kernel *kernel; (kernel = next_kernel(&isa));) {
            double moved[3 * MOST + 1], added[3 * MOST + 1];
            uint8_t changed[MOST];
            memcpy(moved, points, sizeof moved);
            memcpy(added, points, sizeof added);
            assert_int_equal(kernel->displace(vectors, count, largest, moved, changed), unfit);
            kernel->add(vectors, 3 * count, added);
            assert_memory_equal(changed, others, count);
            for (size_t i = 0; i <= 3 * count; i++) {
                assert_true(is_same(moved[i], expected[i]) && is_same(added[i], expected[i]));
            }
        }
    }
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(floats_are_read_and_rounded),
        cmocka_unit_test(whole_numbers_are_read),
        cmocka_unit_test(magnitudes_are_of_finite_numbers),
        cmocka_unit_test(boxes_are_widened),
        cmocka_unit_test(points_are_displaced),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
