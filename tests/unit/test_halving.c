/* The longest spans are halved first, as by looking at all of them each time; also very many in a short time.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/repetitions.h"
#include "spline/halving.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST 96

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Halves the first of the longest spans of all in a round, then the next one of those that were there. */
static void halve_slowly(double *t, size_t count, size_t wanted)
{
    while (wanted > 0) {
        double longest = 0;
        for (size_t i = 0; i + 1 < count; i++)
            longest = fmax(longest, t[i + 1] - t[i]);
        for (size_t i = 0; i + 1 < count && wanted > 0; i++)
            if (t[i + 1] - t[i] >= (1 - 1e-9) * longest) {
                memmove(t + i + 2, t + i + 1, (count - i - 1) * sizeof *t);
                t[i + 1] = 0.5 * t[i] + 0.5 * t[i + 2];
                count++;
                wanted--;
                i++;
            }
    }
}

/* Lengths of which many are equal, or differ by rounding, with repeated and graded knots. */
static size_t draw_knots(draw *d, double *t)
{
    static const double lengths[] = {1, 1, 0.5, 0.25, 1.0 / 3, 2.0 / 3, 0, 0x1p-30};
    const size_t count = (size_t)draw_int(d, 2, 24);
    t[0] = draw_between(d, -9, 9);
    for (size_t i = 1; i < count; i++)
        t[i] = t[i - 1] + (draw_int(d, 0, 3) ? lengths[draw_int(d, 0, 7)] : draw_unit(d));
    t[count - 1] += 0.125; /* not all empty */
    return count;
}

static void the_longest_spans_come_first(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (int round = 0; round < repetitions(2000); round++) {
        double t[MOST], expected[MOST];
        const size_t count = draw_knots(&d, t), wanted = (size_t)draw_int(&d, 1, MOST - 25);
        size_t found;
        memcpy(expected, t, count * sizeof *t);
        halve_slowly(expected, count, wanted);
        assert_int_equal(ffd_halve_spans(t, 0, count - 1, wanted, t + count, &found, NULL), FFD_OK);
        assert_int_equal(found, wanted);
        qsort(t, count + wanted, sizeof *t, compare);
        if (memcmp(t, expected, (count + wanted) * sizeof *t) != 0)
            fail_msg("round %d: %zu knots, %zu new ones", round, count, wanted);
    }
}

static void only_the_given_spans_are_halved(void **state)
{
    (void)state;
    const double t[] = {0, 100, 101, 103, 200};
    double middles[2];
    size_t found;
    assert_int_equal(ffd_halve_spans(t, 1, 3, 2, middles, &found, NULL), FFD_OK);
    assert_int_equal(found, 2);
    assert_true(middles[0] == 102 && middles[1] == 100.5);
}

static void a_span_of_neighbours_has_no_middle(void **state)
{
    (void)state;
    const double t[] = {1, 1 + 0x1p-51};
    double middles[8];
    size_t found;
    assert_int_equal(ffd_halve_spans(t, 0, 1, 8, middles, &found, NULL), FFD_OK);
    assert_int_equal(found, 1);
    assert_true(middles[0] == 1 + 0x1p-52);
}

/* A look at all spans for each of them would take minutes. */
static void very_many_spans_are_halved_soon(void **state)
{
    (void)state;
    draw d = {3};
    const size_t count = (size_t)repetitions(400000);
    double *const t = calloc(2 * count, sizeof *t), longest = 0;
    size_t found;
    assert_non_null(t);
    for (size_t i = 1; i < count; i++)
        t[i] = t[i - 1] + 1 + draw_unit(&d);
    assert_int_equal(ffd_halve_spans(t, 0, count - 1, count - 1, t + count, &found, NULL), FFD_OK);
    assert_int_equal(found, count - 1);
    qsort(t, 2 * count - 1, sizeof *t, compare);
    for (size_t i = 0; i + 2 < 2 * count; i++)
        longest = fmax(longest, t[i + 1] - t[i]);
    assert_true(longest <= 1);
    free(t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_longest_spans_come_first),
        cmocka_unit_test(only_the_given_spans_are_halved),
        cmocka_unit_test(a_span_of_neighbours_has_no_middle),
        cmocka_unit_test(very_many_spans_are_halved_soon),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
