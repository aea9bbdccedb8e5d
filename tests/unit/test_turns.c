/* test_turns.c - no point at which a displacement turns space inside out is passed over: moves are scaled
   until det F falls just below 0 at some of the points, which are those of a small box, of a cell, or of
   several cells of one or more blocks. Nor is one at which it collapses space, where det F is a rounding. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "../support/repetitions.h"
#include "base/vector/vec.h"
#include "deform/collapse.h"
#include "deform/displacement.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define LATTICES 1000
#define POINTS 48
#define GRIDS 20

typedef struct sample {
    size_t count;
    double uvw[3 * DISPLACEMENT_BATCH], delta[3 * DISPLACEMENT_BATCH], gradient[9 * DISPLACEMENT_BATCH];
    double rest_gradient[9 * DISPLACEMENT_BATCH]; /* with the moves as drawn */
    uint8_t moves[DISPLACEMENT_BATCH];
    uint32_t which[DISPLACEMENT_BATCH];
    turn_list turns;
    displacement_scratch scratch;
} sample;

static void set_count(size_t count, sample *s)
{
    s->count = count;
    for (size_t n = 0; n < count; n++)
        s->which[n] = (uint32_t)n;
}

/* How the control points of a random lattice move. */
typedef struct random_moves {
    int layers; /* the direction along which whole layers move, all by multiples of one vector; -1: each point
                   moves by itself */
    int rows, row; /* a row of the layers, which alone moves if row is not negative; across which direction */
    double by[3], steps[64];
} random_moves;

static random_moves draw_moves(draw *d)
{
    random_moves moves = {.layers = draw_int(d, -1, 2), .row = draw_int(d, -2, 2)};
    moves.rows = (moves.layers + draw_int(d, 1, 2)) % 3;
    for (int a = 0; a < 3; a++)
        moves.by[a] = draw_between(d, -1, 1);
    const int lone = draw_int(d, -2, 1); /* the only layer that moves */
    for (int i = 0; i < 64; i++)
        moves.steps[i] = lone < 0 || i == lone ? draw_between(d, -1, 1) : 0;
    return moves;
}

static double draw_move(draw *d, const random_moves *moves, const size_t index[3], size_t a)
{
    if (moves->layers < 0)
        return draw_between(d, -1, 1);
    const bool rests = moves->row >= 0 && index[moves->rows] != (size_t)moves->row;
    return rests ? 0 : moves->steps[index[moves->layers]] * moves->by[a];
}

/* Returns a lattice without control points: clamped, or closed along direction closed. Along layers, of which
   bounds are exact if they are quadratic, it has more cells. */
static ffd_lattice *random_knots(draw *d, int layers, int closed)
{
    knot_vector knots[3];
    for (int a = 0; a < 3; a++) {
        const int degree = layers >= 0 ? 2 : draw_int(d, 0, 2) ? 3 : draw_int(d, 1, 5);
        const int most = a != layers ? 3 : a == closed ? 50 : 9;
        const size_t points = (size_t)(degree + 1 + draw_int(d, 0, most));
        assert_int_equal(ffd_knots_make(a == closed ? KNOTS_CLOSED : KNOTS_CLAMPED, degree, points, NULL, 0,
                                        "uvw"[a], &knots[a], NULL),
                         FFD_OK);
    }
    return lattice_of_knots(knots);
}

/* A box, or bent, or a ring. */
static ffd_lattice *random_lattice(draw *d, bool is_box, const random_moves *moves)
{
    const int closed = is_box ? -1 : draw_int(d, 0, 1) ? moves->layers : draw_int(d, -3, 2);
    ffd_lattice *lattice = random_knots(d, moves->layers, closed);
    const double bend = is_box || draw_int(d, 0, 1) ? 0 : draw_between(d, 0, 0.3);
    for (size_t n = 0; n < lattice->count; n++) {
        const size_t index[3] = {n % lattice->size[0], n / lattice->size[0] % lattice->size[1],
                                 n / lattice->size[0] / lattice->size[1]};
        double at[3] = {(double)index[0], (double)index[1], (double)index[2]};
        if (closed >= 0) {
            const int across = (closed + 1) % 3;
            const double angle = 2 * acos(-1) * at[closed] / (double)lattice->size[closed];
            const double radius = 3 + at[across];
            at[closed] = radius * sin(angle);
            at[across] = radius * cos(angle);
        }
        for (size_t a = 0; a < 3; a++) {
            lattice->rest[3 * n + a] = at[a] + draw_between(d, -bend, bend);
            lattice->deformed[3 * n + a] = lattice->rest[3 * n + a] + draw_move(d, moves, index, a);
        }
    }
    if (is_box) {
        /* Any frame will do for F. */
        lattice->form = REST_BOX_AFFINE;
        for (int i = 0; i < 9; i++)
            lattice->frame[i] = draw_between(d, -1, 1) + (i % 4 == 0 ? 4 : 0);
    }
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
    return lattice;
}

/* Points in a box of some size in one cell, or in a row of cells along the layers, often the last ones;
   neighbours mostly beside each other. */
static void random_points(draw *d, const ffd_lattice *lattice, int layers, sample *s)
{
    const double size = ldexp(1, -draw_int(d, 0, 6));
    const bool is_row = layers >= 0 && draw_int(d, 0, 1);
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const int last = (int)knots->span_count - 1,
                  span = is_row && draw_int(d, 0, 1) ? last : draw_int(d, 0, last);
        const bool is_along = is_row && a == layers;
        const double begin = knots->t[knots->spans[!is_along ? span : span > 7 ? span - 7 : 0]];
        const double end = knots->t[knots->spans[span] + 1];
        const double side = (is_along ? 1 : size) * (end - begin), first = draw_between(d, begin, end - side);
        for (size_t n = 0; n < POINTS; n++)
            s->uvw[3 * n + (size_t)a] = draw_between(d, first, first + side);
    }
    set_count(POINTS, s);
}

static double determinant_of(const double gradient[9], double scale)
{
    double f[9];
    for (int i = 0; i < 9; i++)
        f[i] = scale * gradient[i] + (i % 4 == 0);
    return mat_determinant(f);
}

/* Returns the least of many scales of the moves with det F < 0 at a point; 0 if there is none. */
static double turning_scale(const sample *s)
{
    for (double scale = 0.01; scale < 30; scale *= 1.005)
        for (size_t n = 0; n < s->count; n++)
            if (determinant_of(s->rest_gradient + 9 * n, scale) < 0)
                return scale;
    return 0;
}

static void scale_moves(ffd_lattice *lattice, double scale)
{
    for (size_t i = 0; i < 3 * lattice->count; i++)
        lattice->deformed[i] = lattice->rest[i] + scale * lattice->difference[i];
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
}

/* Displaces the points of a sample, and lists those at which the lattice may turn. */
static void displace(const ffd_lattice *lattice, ffd_isa isa, sample *s)
{
    const displacement_batch batch = {.uvw = s->uvw,
                                      .stride = 3 * sizeof *s->uvw,
                                      .which = s->which,
                                      .count = s->count,
                                      .delta = s->delta,
                                      .gradient = s->gradient,
                                      .turns = &s->turns,
                                      .only_turns = true,
                                      .moves = s->moves};
    s->turns.count = 0;
    ffd_displacement_scratch_clear(&s->scratch);
    ffd_displacements(lattice, isa, &batch, &s->scratch);
}

static size_t found, passed_over; /* points that turn; others whose gradient was not needed */

static void check_points(const ffd_lattice *lattice, ffd_isa isa, sample *s)
{
    bool is_listed[DISPLACEMENT_BATCH] = {false};
    displace(lattice, isa, s);
    for (size_t k = 0; k < s->turns.count; k++)
        is_listed[s->turns.points[k]] = true;
    for (size_t n = 0; n < s->count; n++) {
        double delta[3], gradient[9];
        ffd_displacement(lattice, s->uvw + 3 * n, delta, gradient);
        const bool turns = determinant_of(gradient, 1) < 0;
        if (turns && !is_listed[n])
            fail_msg("point %zu turns (det F is %g), which is not found", n, determinant_of(gradient, 1));
        found += turns;
        passed_over += !is_listed[n];
    }
}

static void no_turn_is_passed_over(void **state)
{
    draw d = {draw_seed()};
    sample *s = calloc(1, sizeof *s);
    assert_non_null(s);
    for (int i = 0; i < repetitions(LATTICES); i++) {
        const random_moves moves = draw_moves(&d);
        ffd_lattice *lattice = random_lattice(&d, i % 2, &moves);
        random_points(&d, lattice, moves.layers, s);
        for (size_t n = 0; n < POINTS; n++)
            ffd_displacement(lattice, s->uvw + 3 * n, s->delta, s->rest_gradient + 9 * n);
        const double scale = turning_scale(s);
        if (scale > 0) {
            scale_moves(lattice, scale);
            check_points(lattice, FFD_ISA_AUTO, s);
            scale_moves(lattice, 0.7); /* of what it was last */
            check_points(lattice, i % 3 ? FFD_ISA_AUTO : FFD_ISA_SCALAR, s);
            scale_moves(lattice, draw_between(&d, 2, 9)); /* whole cells may turn */
            check_points(lattice, FFD_ISA_AUTO, s);
        }
        ffd_lattice_destroy(&lattice);
    }
    free(s);
    assert_true((found > 0 && passed_over > 0) || is_memory_checked());
    (void)state;
}

/* A lattice of many blocks, all with points; a few control points beside each other move much. */
static void no_block_is_taken_for_another(void **state)
{
    draw d = {draw_seed()};
    sample *s = calloc(1, sizeof *s);
    assert_non_null(s);
    found = passed_over = 0;
    for (int i = 0; i < repetitions(GRIDS); i++) {
        const lattice_kinds kinds = {{KNOTS_CLAMPED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {2, 2, 2}, {10, 12, 11}};
        ffd_lattice *lattice = lattice_of_kinds(&kinds);
        const int first[3] = {draw_int(&d, 0, 9), draw_int(&d, 0, 11), draw_int(&d, 0, 10)};
        for (size_t n = 0; n < lattice->count; n++) {
            const int index[3] = {(int)(n % 10), (int)(n / 10 % 12), (int)(n / 120)};
            bool is_moved = true;
            for (int a = 0; a < 3; a++)
                is_moved = is_moved && index[a] - first[a] >= 0 && index[a] - first[a] < 2;
            for (size_t a = 0; a < 3; a++) {
                lattice->rest[3 * n + a] = index[a];
                lattice->deformed[3 * n + a] = index[a] + draw_between(&d, -1, 1) * (is_moved ? 4 : 0.05);
            }
        }
        assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
        set_count(DISPLACEMENT_BATCH, s);
        for (size_t k = 0; k < 3 * s->count; k++)
            s->uvw[k] = draw_between(&d, 0, 1);
        check_points(lattice, FFD_ISA_AUTO, s);
        ffd_lattice_destroy(&lattice);
    }
    free(s);
    assert_true((found > 0 && passed_over > 0) || is_memory_checked());
    (void)state;
}

/* Moves the control points towards a plane, an axis or a point, through or near `through`: `left` of their
   distances is left. flat: the dimensions that are lost. */
static void flatten(draw *d, int flat, bool is_aligned, const double through[3], double left,
                    ffd_lattice *lattice)
{
    double across[3][3];
    for (int a = 0; a < 3; a++)
        across[0][a] = is_aligned ? (a == 1) : draw_between(d, -1, 1);
    const double least[3] = {across[0][1], across[0][2], across[0][0] + 0.5};
    vec_cross(across[0], least, across[1]);
    vec_cross(across[0], across[1], across[2]);
    for (size_t n = 0; n < lattice->count; n++) {
        double *const q = lattice->deformed + 3 * n;
        memcpy(q, lattice->rest + 3 * n, 3 * sizeof *q);
        for (int f = 0; f < flat; f++) {
            const double *const v = across[f];
            const double from[3] = {q[0] - through[0], q[1] - through[1], q[2] - through[2]};
            const double off = (1 - left) * vec_dot(from, v) / vec_dot(v, v);
            for (int a = 0; a < 3; a++)
                q[a] -= off * v[a];
        }
    }
    assert_int_equal(finish_by_hand(lattice, NULL), FFD_OK);
}

static void stay_in_place(const double g[3], double out[3])
{
    memcpy(out, g, 3 * sizeof *out);
}

/* Puts the control points of a box to where its frame says, and moves those of any lattice. */
static void place(ffd_lattice *lattice, const double by[3])
{
    if (lattice->form == REST_BOX_AFFINE)
        lattice_map(lattice, stay_in_place);
    for (size_t n = 0; n < lattice->count; n++) {
        double *const p = lattice->rest + 3 * n;
        if (lattice->form == REST_BOX_AFFINE)
            mat_apply(lattice->frame, p, p);
        for (int a = 0; a < 3; a++)
            p[a] += by[a];
    }
}

/* Lists the points at which a lattice may turn, and counts those of them at which it collapses space. */
static size_t count_collapses(const ffd_lattice *lattice, ffd_isa isa, sample *s)
{
    size_t collapses = 0;
    displace(lattice, isa, s);
    for (size_t k = 0; k < s->turns.count; k++) {
        const size_t n = s->turns.points[k];
        collapses += ffd_collapses(lattice, s->uvw + 3 * n, NULL, 0, s->gradient + 9 * n);
    }
    return collapses;
}

/* Whether the rest volume has a place for every point: not where random points lie so that it has none. */
static bool is_solid(const ffd_lattice *lattice, const sample *s)
{
    double point[3], jacobian[9], least = HUGE_VAL;
    for (size_t n = 0; n < s->count; n++) {
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, s->uvw + 3 * n, point, jacobian);
        least = lesser_of(least, fabs(mat_determinant(jacobian)));
    }
    return least > 1;
}

/* In boxes and bent lattices, also far from the origin, where det F is a larger rounding. What is 1e-6 times
   as flat as before, or far from the origin 1e-2 times, has a sign that means something. */
static void no_collapse_is_passed_over(void **state)
{
    draw d = {draw_seed()};
    sample *s = calloc(1, sizeof *s);
    int solid = 0;
    assert_non_null(s);
    for (int i = 0; i < repetitions(LATTICES); i++) {
        const random_moves moves = draw_moves(&d);
        const bool is_far = draw_int(&d, 0, 1);
        const ffd_isa isa = i % 3 ? FFD_ISA_AUTO : FFD_ISA_SCALAR;
        double away[3], through[3];
        ffd_lattice *lattice = random_lattice(&d, i % 2, &moves);
        for (int a = 0; a < 3; a++) {
            away[a] = is_far ? draw_between(&d, -1, 1) * 1e5 : 0;
            through[a] = away[a] + draw_between(&d, -1, 4);
        }
        place(lattice, away);
        random_points(&d, lattice, moves.layers, s);
        const int flat = draw_int(&d, 1, 3);
        flatten(&d, flat, i % 5 == 0, through, 0, lattice);
        if (!is_solid(lattice, s)) {
            ffd_lattice_destroy(&lattice);
            continue;
        }
        const size_t collapses = count_collapses(lattice, isa, s);
        solid++;
        if (collapses != s->count)
            fail_msg("%zu of %zu points collapse (%d dimensions)", collapses, s->count, flat);
        flatten(&d, flat, i % 5 == 0, through, is_far ? 1e-2 : 1e-6, lattice);
        assert_int_equal(count_collapses(lattice, isa, s), 0);
        ffd_lattice_destroy(&lattice);
    }
    free(s);
    assert_true(solid > repetitions(LATTICES) / 2);
    (void)state;
}

/* Of a ring of five points, from any of them on; no cell reaches further than twice round. */
static void a_block_goes_round_more_than_once(void **state)
{
    const lattice_kinds ring = {{KNOTS_CLOSED, KNOTS_CLAMPED, KNOTS_CLAMPED}, {2, 1, 1}, {5, 2, 2}};
    ffd_lattice *lattice = lattice_of_kinds(&ring);
    double points[3 * 9 * 2 * 2];
    for (size_t n = 0; n < 3 * lattice->count; n++)
        lattice->rest[n] = (double)n;
    for (size_t from = 0; from < 5; from++)
        for (size_t count = 2; from + count <= 10 && count <= 9; count++) {
            const size_t first[3] = {from, 0, 0}, counts[3] = {count, 2, 2};
            ffd_lattice_block_points(lattice, lattice->rest, first, counts, points);
            for (size_t i = 0; i < count * 4; i++)
                for (size_t c = 0; c < 3; c++)
                    assert_true(points[3 * i + c] ==
                                (double)(3 * (i / count * 5 + (from + i % count) % 5) + c));
        }
    ffd_lattice_destroy(&lattice);
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_block_goes_round_more_than_once), cmocka_unit_test(no_turn_is_passed_over),
        cmocka_unit_test(no_block_is_taken_for_another), cmocka_unit_test(no_collapse_is_passed_over)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
