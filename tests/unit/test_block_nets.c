/* test_block_nets.c - whether blocks make up one continuous displacement, by the control points of their
 * faces. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/memory/memory.h"
#include "job/chain/block_nets.h"
#include "job/chain/chain_boxes.h"
#include "job/chain/chain_load.h"
#include "job/chain/seams.h"
#include <ffd/lattice.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { N = 3, TEXT = 1 << 15 };

/* A block of N^3 control points from low to high, whose control points move by a field of their places. */
typedef struct block {
    double low[3], high[3];
    int axes[3];      /* which axis u, v and w run along */
    bool reversed[3]; /* from high to low */
    double bump;      /* added to the displacement of the control point nearest to `at` */
    double at[3];
    double weight;      /* of that control point; 0: no weights */
    const char *degree; /* NULL: the default */
} block;

static void field(const double p[3], double by[3])
{
    by[0] = 0.1 * sin(3 * p[1] + p[2]);
    by[1] = 0.15 * cos(2 * p[0] - p[2]);
    by[2] = 0.2 * sin(p[0] + 2 * p[1] + 3 * p[2]);
}

static void place_of(const block *b, const int index[3], double p[3])
{
    for (int d = 0; d < 3; d++) {
        const double part = index[d] / (N - 1.0), t = b->reversed[d] ? 1 - part : part;
        p[b->axes[d]] = b->low[b->axes[d]] * (1 - t) + b->high[b->axes[d]] * t;
    }
}

static ffd_lattice *make(const block *b)
{
    static char text[TEXT], points[TEXT / 4], offsets[TEXT / 4], weights[TEXT / 4];
    size_t p_at = 0, o_at = 0, w_at = 0;
    ffd_lattice *lattice;
    ffd_error error = {0};
    for (int k = 0; k < N; k++)
        for (int j = 0; j < N; j++)
            for (int i = 0; i < N; i++) {
                double p[3], by[3];
                const int index[3] = {i, j, k};
                place_of(b, index, p);
                field(p, by);
                const bool is_at =
                    fabs(p[0] - b->at[0]) + fabs(p[1] - b->at[1]) + fabs(p[2] - b->at[2]) < 1e-9;
                const char *const comma = p_at ? "," : "";
                p_at += (size_t)snprintf(points + p_at, sizeof points - p_at, "%s[%.17g,%.17g,%.17g]", comma,
                                         p[0], p[1], p[2]);
                o_at += (size_t)snprintf(offsets + o_at, sizeof offsets - o_at, "%s[%.17g,%.17g,%.17g]",
                                         comma, by[0], by[1], by[2] + (is_at ? b->bump : 0));
                w_at += (size_t)snprintf(weights + w_at, sizeof weights - w_at, "%s%g", comma,
                                         is_at && b->weight > 0 ? b->weight : 1);
            }
    const int length = snprintf(
        text, sizeof text,
        "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[%d,%d,%d]%s%s,\"rest\":{\"points\":[%s]},"
        "\"deformed\":{\"offsets\":[%s]}%s%s%s}",
        N, N, N, b->degree ? ",\"degree\":" : "", b->degree ? b->degree : "", points, offsets,
        b->weight > 0 ? ",\"weights\":[" : "", b->weight > 0 ? weights : "", b->weight > 0 ? "]" : "");
    assert_true(length > 0 && length < TEXT);
    if (ffd_lattice_parse(text, (size_t)length, "test.json", &lattice, &error))
        fail_msg("%s %s", error.pointer, error.message);
    return lattice;
}

static bool join(size_t count, const block *blocks)
{
    lattice_chain chain = {.blocks = true, .count = count};
    bool joined;
    chain.links = ffd_alloc_zero(count, sizeof *chain.links);
    assert_non_null(chain.links);
    for (size_t l = 0; l < count; l++) {
        chain.links[l].lattice = make(&blocks[l]);
        assert_int_equal(ffd_locator_create(chain.links[l].lattice, &chain.links[l].locator, NULL), FFD_OK);
    }
    assert_int_equal(ffd_chain_boxes(&chain, NULL), FFD_OK);
    assert_int_equal(ffd_seams_find(&chain, NULL), FFD_OK);
    assert_int_equal(ffd_blocks_join(&chain, &joined, NULL), FFD_OK);
    ffd_chain_free(&chain);
    return joined;
}

/* Degree 1, so that control points at equal distances make a box. */
#define LINEAR .degree = "[1,1,1]"
static const block left = {.high = {1, 1, 1}, .axes = {0, 1, 2}, .at = {9, 9, 9}, LINEAR};
static const block right = {.low = {1, 0, 0}, .high = {2, 1, 1}, .axes = {0, 1, 2}, .at = {9, 9, 9}, LINEAR};

static void faces_that_move_alike_join(void **state)
{
    const block far = {.low = {2, 0, 0}, .high = {3.5, 1, 1}, .axes = {0, 1, 2}, .at = {9, 9, 9}, LINEAR};
    assert_true(join(2, (const block[]){left, right}));
    assert_true(join(3, (const block[]){far, left, right}));
    assert_false(join(2, (const block[]){left, far})); /* a gap */
    (void)state;
}

static void however_their_directions_run(void **state)
{
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    for (int order = 0; order < 6; order++)
        for (int signs = 0; signs < 8; signs++) {
            block turned = right;
            memcpy(turned.axes, orders[order], sizeof turned.axes);
            for (int d = 0; d < 3; d++)
                turned.reversed[d] = signs >> d & 1;
            assert_true(join(2, (const block[]){left, turned}));
            assert_true(join(2, (const block[]){turned, left}));
            turned.at[0] = 1; /* a corner of the common face */
            turned.at[1] = 1;
            turned.at[2] = 0;
            turned.bump = 1e-3;
            assert_false(join(2, (const block[]){left, turned}));
            turned.bump = 0;
            turned.weight = 1.5;
            assert_false(join(2, (const block[]){left, turned}));
            turned.weight = 0;
            turned.at[0] = 2; /* beyond it */
            turned.bump = 1e-3;
            assert_true(join(2, (const block[]){left, turned}));
        }
    (void)state;
}

static void faces_that_are_not_one_do_not_join(void **state)
{
    block half = right, shifted = right, deep = right, finer = right, adjacent = right;
    half.high[1] = 0.5;
    shifted.low[1] = 0.25;
    shifted.high[1] = 1.25;
    deep.low[0] = 0.5;
    finer.degree = "[1,2,1]";
    assert_false(join(2, (const block[]){left, half}));
    assert_false(join(2, (const block[]){left, shifted}));
    assert_false(join(2, (const block[]){left, deep}));
    assert_false(join(2, (const block[]){left, finer}));
    /* Two that have an edge in common, and a third that is beside both. */
    adjacent.low[1] = 1;
    adjacent.high[1] = 2;
    assert_false(join(2, (const block[]){left, adjacent}));
    assert_true(join(3, (const block[]){left, adjacent, right}));
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faces_that_move_alike_join),
        cmocka_unit_test(however_their_directions_run),
        cmocka_unit_test(faces_that_are_not_one_do_not_join),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
