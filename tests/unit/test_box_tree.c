/* test_box_tree.c - the tree of boxes compared with a linear search. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/repetitions.h"
#include "embed/frame/box_tree.h"
#include <math.h>

enum { MOST = 300 };

typedef struct seen {
    uint32_t items[MOST];
    size_t count, stop; /* stop after this many, if not 0 */
} seen;

static bool bounds_meet(const bounds *box, const bounds *query, const double slack[3])
{
    return query->hi[0] >= box->lo[0] - slack[0] && query->lo[0] <= box->hi[0] + slack[0] &&
           query->hi[1] >= box->lo[1] - slack[1] && query->lo[1] <= box->hi[1] + slack[1] &&
           query->hi[2] >= box->lo[2] - slack[2] && query->lo[2] <= box->hi[2] + slack[2];
}

static bool note(void *context, uint32_t item)
{
    seen *const s = context;
    assert_true(s->count < MOST);
    s->items[s->count++] = item;
    return s->count != s->stop;
}

/* Includes flat, equal and unbounded boxes. */
static void draw_boxes(draw *d, bounds *boxes, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (int a = 0; a < 3; a++) {
            const uint32_t kind = draw_number(d) % 16;
            const double corner = draw_between(d, -1, 1), side = draw_between(d, 0, 0.3);
            boxes[i].lo[a] = kind == 0 ? -HUGE_VAL : kind == 1 ? 0.25 : corner;
            boxes[i].hi[a] = kind == 2 ? HUGE_VAL : kind == 1 ? 0.25 : kind == 3 ? corner : corner + side;
        }
}

static bool has(const seen *s, uint32_t item)
{
    for (size_t i = 0; i < s->count; i++)
        if (s->items[i] == item)
            return true;
    return false;
}

static void no_box_that_meets_is_missed(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    size_t visited = 0, met = 0, all = 0;
    const int rounds = is_memory_checked() ? 600 : 3000;
    for (int round = 0; round < rounds; round++) {
        static bounds boxes[MOST];
        const size_t count = draw_number(&d) % (round % 2 ? 12 : MOST);
        box_tree tree;
        seen s = {.count = 0};
        bounds places;
        double slack[3];
        draw_boxes(&d, boxes, count);
        assert_true(ffd_box_tree_build(boxes, count, &tree));
        for (int a = 0; a < 3; a++) {
            places.lo[a] = draw_number(&d) % 4 ? draw_between(&d, -1.2, 1.2) : 0.25;
            places.hi[a] = places.lo[a] + (round % 3 ? 0 : draw_between(&d, 0, 0.2));
            slack[a] = draw_number(&d) % 2 ? 0 : draw_between(&d, 0, 0.1);
        }
        if (round % 3)
            assert_true(ffd_box_tree_visit(&tree, places.lo, slack, note, &s));
        else
            assert_true(ffd_box_tree_visit_box(&tree, &places, slack, note, &s));
        for (size_t i = 0; i < s.count; i++)
            for (size_t k = 0; k < i; k++)
                assert_int_not_equal(s.items[i], s.items[k]);
        for (uint32_t i = 0; i < count; i++) {
            const bool meets = bounds_meet(&boxes[i], &places, slack);
            assert_true(!meets || has(&s, i));
            met += meets;
        }
        visited += s.count;
        all += count;
        ffd_box_tree_free(&tree);
    }
    /* It also excludes most of the others. */
    assert_true(met > (size_t)rounds / 6); /* 956 to 1204 in 400 seeds of 3000 rounds */
    if (visited - met > (all - met) / 10)
        fail_msg("%zu of %zu boxes are visited, where %zu meet", visited, all, met);
}

/* Finds the box nearest to p among those that the tree offers. */
typedef struct nearest {
    const bounds *boxes;
    const double *p;
    double reach;
    size_t visited;
} nearest;

static double distance(const bounds *box, const double p[3])
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        const double beyond = fmax(fmax(box->lo[a] - p[a], p[a] - box->hi[a]), 0);
        square += beyond * beyond;
    }
    return sqrt(square);
}

static bool take_nearer(void *context, uint32_t item)
{
    nearest *const n = context;
    n->visited++;
    n->reach = fmin(n->reach, distance(&n->boxes[item], n->p));
    return true;
}

static void the_nearest_box_is_found_and_few_others_are_visited(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    size_t visited = 0, all = 0;
    for (int round = 0; round < repetitions(2000); round++) {
        static bounds boxes[MOST];
        const size_t count = 1 + draw_number(&d) % (MOST - 1);
        const double p[3] = {draw_between(&d, -3, 3), draw_between(&d, -3, 3), draw_between(&d, -3, 3)};
        const double limit = draw_number(&d) % 4 ? HUGE_VAL : draw_between(&d, 0, 2);
        double expected = limit;
        box_tree tree;
        draw_boxes(&d, boxes, count);
        for (size_t i = 0; i < count; i++)
            expected = fmin(expected, distance(&boxes[i], p));
        assert_true(ffd_box_tree_build(boxes, count, &tree));
        nearest n = {.boxes = boxes, .p = p, .reach = limit};
        assert_true(ffd_box_tree_visit_near(&tree, p, &n.reach, take_nearer, &n));
        assert_true(n.reach >= expected && n.reach <= expected);
        visited += n.visited;
        all += count;
        ffd_box_tree_free(&tree);
    }
    if (visited > all / 2)
        fail_msg("%zu of %zu boxes are visited", visited, all);
}

/* The tree's order is the same in every walk, whatever is asked for. */
static void boxes_come_in_the_order_of_the_tree(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    static bounds boxes[MOST];
    const double slack[3] = {0, 0, 0};
    const bounds everywhere = {{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
    box_tree tree;
    seen whole = {.count = 0};
    draw_boxes(&d, boxes, MOST);
    assert_true(ffd_box_tree_build(boxes, MOST, &tree));
    assert_true(ffd_box_tree_visit_box(&tree, &everywhere, slack, note, &whole));
    assert_int_equal(whole.count, MOST);
    for (int i = 0; i < 200; i++) {
        const double p[3] = {draw_between(&d, -1, 1), draw_between(&d, -1, 1), draw_between(&d, -1, 1)};
        seen some = {.count = 0};
        size_t at = 0;
        assert_true(ffd_box_tree_visit(&tree, p, slack, note, &some));
        for (size_t k = 0; k < some.count; k++, at++) {
            while (at < MOST && whole.items[at] != some.items[k])
                at++;
            assert_true(at < MOST);
        }
    }
    ffd_box_tree_free(&tree);
}

/* Each box is in the tree once, for any number of boxes. */
static void each_box_is_in_the_tree_once(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    static bounds boxes[MOST];
    const double slack[3] = {0, 0, 0};
    const bounds everywhere = {{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL}, {HUGE_VAL, HUGE_VAL, HUGE_VAL}};
    draw_boxes(&d, boxes, MOST);
    for (size_t count = 1; count <= MOST; count++) {
        box_tree tree;
        seen s = {.count = 0};
        assert_true(ffd_box_tree_build(boxes, count, &tree));
        assert_true(ffd_box_tree_visit_box(&tree, &everywhere, slack, note, &s));
        assert_int_equal(s.count, count);
        for (uint32_t i = 0; i < count; i++)
            assert_true(has(&s, i));
        ffd_box_tree_free(&tree);
    }
}

static void a_visit_stops_when_told(void **state)
{
    (void)state;
    static bounds boxes[MOST];
    const double p[3] = {0, 0, 0}, slack[3] = {0, 0, 0};
    box_tree tree;
    assert_true(ffd_box_tree_build(boxes, MOST, &tree));
    for (size_t stop = 1; stop <= MOST; stop += 37) {
        seen s = {.stop = stop};
        assert_false(ffd_box_tree_visit(&tree, p, slack, note, &s));
        assert_int_equal(s.count, stop);
    }
    ffd_box_tree_free(&tree);
}

static void a_tree_without_boxes_visits_nothing(void **state)
{
    (void)state;
    const double p[3] = {0, 0, 0}, slack[3] = {1, 1, 1};
    box_tree tree;
    seen s = {.count = 0};
    assert_true(ffd_box_tree_build(NULL, 0, &tree));
    assert_true(ffd_box_tree_visit(&tree, p, slack, note, &s));
    assert_int_equal(s.count, 0);
    ffd_box_tree_free(&tree);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(no_box_that_meets_is_missed),
        cmocka_unit_test(the_nearest_box_is_found_and_few_others_are_visited),
        cmocka_unit_test(boxes_come_in_the_order_of_the_tree),
        cmocka_unit_test(each_box_is_in_the_tree_once),
        cmocka_unit_test(a_visit_stops_when_told),
        cmocka_unit_test(a_tree_without_boxes_visits_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
