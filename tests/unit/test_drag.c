/* test_drag.c - drags of a lattice file: the places go where they are told, with the least change, compared
   with a slow solution by the normal equations in long double. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/memory/memory.h"
#include "lattice/drag.h"
#include "lattice/lattice.h"
#include <ffd/embedding.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#define COUNT(array) (sizeof(array) / sizeof *(array))
#define BOX "\"size\":[5,4,6],\"rest\":{\"box\":{\"min\":[-1,0,2],\"max\":[1,3,5]}}"
#define RATIONAL                                                                                             \
    "\"size\":[3,2,2],\"degree\":[2,1,1],\"weights\":[1,2,1,1,0.5,1,3,1,1,1,1,2],"                           \
    "\"rest\":{\"points\":[[0,0,0],[1,0,0.2],[2,0,0],[0,1,0],[1,1,0],[2,1.2,0],[0,0,1],[1,0,1],[2,0,1],"     \
    "[0,1,1],[1,1,1.3],[2,1,1]]}"
#define RING                                                                                                 \
    "\"size\":[2,8,2],\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[1,2],"           \
    "\"height\":2}}"

static ffd_status parse(const char *rest, const char *moves, ffd_lattice **lattice, ffd_error *error)
{
    char text[8192];
    const int size = snprintf(text, sizeof text,
                              "{\"format\":\"ffd-lattice\",\"version\":1,%s,\"moves\":[%s]}", rest, moves);
    return ffd_lattice_parse(text, (size_t)size, "t.json", lattice, error);
}

static ffd_lattice *make(const char *rest, const char *moves)
{
    ffd_lattice *lattice;
    ffd_error error = {0};
    if (parse(rest, moves, &lattice, &error))
        fail_msg("%s: %s %s", moves, error.pointer, error.message);
    return lattice;
}

/* Fills basis with the function of each control point at a place of the rest volume, by evaluating the volume
   with one of them displaced. */
static void basis_at(const ffd_lattice *lattice, const double place[3], double *basis)
{
    ffd_locator *locator;
    ffd_location location;
    lattice_basis at;
    double *const field = ffd_alloc_zero(lattice->count, 3 * sizeof *field), value[3];
    assert_int_equal(ffd_locator_create(lattice, &locator, NULL), FFD_OK);
    assert_int_equal(ffd_locator_locate(locator, place, 1, NULL, &location, sizeof location, NULL), FFD_OK);
    assert_int_equal(location.status, FFD_VERTEX_INSIDE);
    ffd_lattice_basis(lattice, location.uvw, &at);
    for (size_t i = 0; i < lattice->count; i++) {
        field[3 * i] = 1;
        ffd_lattice_sum_rational(lattice, &at, field, lattice->deformed_weights, value, NULL);
        basis[i] = value[0];
        field[3 * i] = 0;
    }
    ffd_free(field);
    ffd_locator_destroy(&locator);
}

/* Solves G x = y by elimination with pivoting, in long double. */
static void eliminate(long double *g, long double *x, size_t n)
{
    for (size_t j = 0; j < n; j++) {
        size_t best = j;
        for (size_t i = j + 1; i < n; i++)
            best = fabsl(g[i * n + j]) > fabsl(g[best * n + j]) ? i : best;
        for (size_t c = 0; c < n; c++) {
            const long double kept = g[j * n + c];
            g[j * n + c] = g[best * n + c];
            g[best * n + c] = kept;
        }
        const long double kept = x[j];
        x[j] = x[best];
        x[best] = kept;
        for (size_t i = 0; i < n; i++) {
            const long double factor = i == j ? 0 : g[i * n + j] / g[j * n + j];
            for (size_t c = 0; c < n; c++)
                g[i * n + c] -= factor * g[j * n + c];
            x[i] -= factor * x[j];
        }
    }
    for (size_t j = 0; j < n; j++)
        x[j] /= g[j * n + j];
}

/* Checks the displacements of the lattice against B^T (B B^T)^-1 y. */
static void check_least(const ffd_lattice *lattice, const double *places, const double *by, size_t n,
                        const char *what)
{
    double *const basis = ffd_alloc(n, lattice->count * sizeof *basis);
    long double g[16], x[4];
    for (size_t i = 0; i < n; i++)
        basis_at(lattice, places + 3 * i, basis + i * lattice->count);
    for (size_t c = 0; c < 3; c++) {
        for (size_t i = 0; i < n; i++) {
            x[i] = by[3 * i + c];
            for (size_t j = 0; j < n; j++) {
                g[i * n + j] = 0;
                for (size_t p = 0; p < lattice->count; p++)
                    g[i * n + j] +=
                        (long double)basis[i * lattice->count + p] * basis[j * lattice->count + p];
            }
        }
        eliminate(g, x, n);
        for (size_t p = 0; p < lattice->count; p++) {
            long double expected = 0;
            for (size_t i = 0; i < n; i++)
                expected += x[i] * basis[i * lattice->count + p];
            if (!(fabsl(expected - lattice->difference[3 * p + c]) < 1e-13L))
                fail_msg("%s: point %zu, %c: %.17g, expected %.17Lg", what, p, "xyz"[c],
                         lattice -> difference[3 * p + c], expected);
        }
    }
    ffd_free(basis);
}

static void places_go_by_their_vectors_with_the_least_change(void **state)
{
    (void)state;
    static const double box[] = {0.3, 1, 3, -0.9, 2.9, 2.1, 1, 0, 5}, bent[] = {0.8, 0.4, 0.5, 1.7, 0.9, 0.2};
    static const double ring[] = {1.5, 0, 0, -1.2, 0.5, 0.9};
    static const double by[] = {0.1, 0.2, -0.3, 0, 0.5, 0, 1, -1, 0.25};
    static const struct {
        const char *rest;
        const double *places;
        size_t count;
    } cases[] = {{BOX, box, 3}, {RATIONAL, bent, 2}, {RING, ring, 2}};
    for (size_t k = 0; k < COUNT(cases); k++) {
        char moves[1024] = "{\"drag\":[";
        for (size_t i = 0; i < cases[k].count; i++) {
            const double *const p = cases[k].places + 3 * i, *const v = by + 3 * i;
            snprintf(moves + strlen(moves), sizeof moves - strlen(moves),
                     "%s{\"point\":[%.17g,%.17g,%.17g],\"by\":[%g,%g,%g]}", i ? "," : "", p[0], p[1], p[2],
                     v[0], v[1], v[2]);
        }
        strcat(moves, "]}");
        ffd_lattice *l = make(cases[k].rest, moves);
        check_least(l, cases[k].places, by, cases[k].count, cases[k].rest);
        assert_true(l->missed.miss == 0);
        ffd_lattice_destroy(&l);
    }
}

/* The moves before do not matter: the place goes further from where it is. */
static void a_drag_adds_to_the_moves_before(void **state)
{
    (void)state;
    ffd_lattice *alone = make(BOX, "{\"drag\":[{\"point\":[0.3,1,3],\"by\":[0.5,0,0]}]}");
    ffd_lattice *later = make(BOX, "{\"by\":[4,0,0]},{\"drag\":[{\"point\":[0.3,1,3],\"by\":[0.5,0,0]}]}");
    for (size_t i = 0; i < 3 * alone->count; i++)
        assert_true(fabs(later->difference[i] - alone->difference[i] - (i % 3 == 0 ? 4 : 0)) < 1e-14);
    ffd_lattice_destroy(&alone);
    ffd_lattice_destroy(&later);
}

static size_t count_moved(const ffd_lattice *l)
{
    size_t count = 0;
    for (size_t i = 0; i < l->count; i++)
        count += l->moved[i] != 0;
    return count;
}

static void only_what_is_selected_and_near_changes(void **state)
{
    (void)state;
    /* A place at the corner: one control point acts. */
    ffd_lattice *l = make(BOX, "{\"drag\":[{\"point\":[1,3,5],\"by\":[0.5,0,0]}]}");
    assert_int_equal(count_moved(l), 1);
    ffd_lattice_destroy(&l);
    l = make(BOX, "{\"drag\":[{\"point\":[0,1.5,3.5],\"by\":[0.5,0,0]}]}");
    const size_t all = count_moved(l);
    ffd_lattice_destroy(&l);
    l = make(BOX, "{\"radius\":1.2,\"drag\":[{\"point\":[0,1.5,3.5],\"by\":[0.5,0,0]}]}");
    const size_t near = count_moved(l);
    assert_true(near > 0 && near < all);
    for (size_t i = 0; i < l->count; i++) {
        const double *const p = l->rest + 3 * i;
        const double away = sqrt(p[0] * p[0] + (p[1] - 1.5) * (p[1] - 1.5) + (p[2] - 3.5) * (p[2] - 3.5));
        assert_true(!l->moved[i] || away <= 1.2);
    }
    assert_true(l->missed.miss == 0);
    ffd_lattice_destroy(&l);
    /* Control points on which no place depends: nothing moves, and all is missed. */
    l = make(BOX, "{\"at\":[0,0,0],\"drag\":[{\"point\":[1,3,5],\"by\":[0.5,0,0]}]}");
    assert_int_equal(count_moved(l), 0);
    assert_true(l->missed.miss == 0.5 && l->missed.asked == 0.5 && l->missed.place[0] == 1);
    ffd_lattice_destroy(&l);
}

/* One place that is to go two ways goes half of each; one that is named twice goes once. */
static void what_contradicts_is_met_by_least_squares(void **state)
{
    (void)state;
    ffd_lattice *once = make(BOX, "{\"drag\":[{\"point\":[0.3,1,3],\"by\":[0.5,0.25,0]}]}");
    ffd_lattice *l =
        make(BOX, "{\"drag\":[{\"point\":[0.3,1,3],\"by\":[1,0.5,0]},{\"point\":[0.3,1,3],\"by\":[0,0,0]}]}");
    for (size_t i = 0; i < 3 * l->count; i++)
        assert_true(fabs(l->difference[i] - once->difference[i]) < 1e-14);
    assert_true(fabs(l->missed.miss - sqrt(0.3125)) < 1e-14);
    ffd_lattice_destroy(&l);
    l = make(
        BOX,
        "{\"drag\":[{\"point\":[0.3,1,3],\"by\":[0.5,0.25,0]},{\"point\":[0.3,1,3],\"by\":[0.5,0.25,0]}]}");
    for (size_t i = 0; i < 3 * l->count; i++)
        assert_true(fabs(l->difference[i] - once->difference[i]) < 1e-14);
    assert_true(l->missed.miss == 0);
    ffd_lattice_destroy(&l);
    ffd_lattice_destroy(&once);
    /* Nine places in a cell of eight control points, a ninth of whose wishes cannot be met. */
    char moves[1024] = "{\"drag\":[";
    for (int i = 0; i < 9; i++)
        snprintf(moves + strlen(moves), sizeof moves - strlen(moves),
                 "%s{\"point\":[%g,%g,%g],\"by\":[%d,0,0]}", i ? "," : "", 0.1 + 0.1 * i, i % 2 ? 0.2 : 0.7,
                 i % 3 * 0.3 + 0.1, i * i % 5);
    strcat(moves, "]}");
    l = make("\"size\":[2,2,2],\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1]}}", moves);
    assert_true(l->missed.miss > 1e-6);
    ffd_lattice_destroy(&l);
}

static void mirrored_places_join_the_list(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        {"{\"mirror\":{\"axis\":\"x\",\"at\":0.1},\"drag\":[{\"point\":[0.3,1,3],\"by\":[0.5,0.25,0]}]}",
         "{\"drag\":[{\"point\":[0.3,1,3],\"by\":[0.5,0.25,0]},{\"point\":[-0.1,1,3],\"by\":[-0.5,0.25,0]}]"
         "}"},
        {"{\"mirror\":\"y\",\"drag\":[{\"point\":[0.3,1,3],\"by\":[0.5,0.25,0]}]}",
         "{\"drag\":[{\"point\":[0.3,1,3],\"by\":[0.5,0.25,0]},{\"point\":[0.3,2,3],\"by\":[0.5,-0.25,0]}]}"},
        {"{\"mirror\":{\"point\":[0,1,3],\"normal\":[3,4,0]},\"drag\":[{\"point\":[0.5,1,3],\"by\":[1,0,0.5]}"
         "]}",
         "{\"drag\":[{\"point\":[0.5,1,3],\"by\":[1,0,0.5]},{\"point\":[0.14,0.52,3],\"by\":[0.28,-0.96,0.5]}"
         "]}"}};
    for (size_t i = 0; i < COUNT(pairs); i++) {
        ffd_lattice *a = make(BOX, pairs[i][0]), *b = make(BOX, pairs[i][1]);
        for (size_t c = 0; c < 3 * a->count; c++)
            if (!(fabs(a->difference[c] - b->difference[c]) < 1e-14))
                fail_msg("%s: %.17g, %.17g", pairs[i][0], a->difference[c], b->difference[c]);
        ffd_lattice_destroy(&a);
        ffd_lattice_destroy(&b);
    }
    /* A place on the plane is to go two ways across it. */
    ffd_lattice *l = make(
        BOX, "{\"mirror\":{\"axis\":\"x\",\"at\":0.3},\"drag\":[{\"point\":[0.3,1,3],\"by\":[0.5,0.25,0]}]}");
    assert_true(fabs(l->missed.miss - 0.5) < 1e-14);
    ffd_lattice_destroy(&l);
}

static void drags_that_cannot_be_are_refused_with_their_place(void **state)
{
    (void)state;
    static const struct {
        const char *move, *words;
    } refusals[] = {
        {"{\"drag\":[{\"point\":[0,1,3],\"by\":[0,0,0]},\n{\"point\":[3,1,3],\"by\":[0,0,0]}]}",
         "t.json:2: /moves/0/drag/1/point: the place 3 1 3 is not inside the volume at rest, but outside"},
        {"{\"mirror\":{\"axis\":\"x\",\"at\":1},\"drag\":[{\"point\":[0,1,3],\"by\":[0,0,0]}]}",
         "t.json:1: /moves/0/drag/0/point: the mirror image 2 1 3 is not inside the volume at rest, but "
         "outside"},
        {"{\"radius\":0.001,\"drag\":[{\"point\":[0.3,1,3],\"by\":[0,0,0]}]}",
         "t.json:1: /moves/0: no control point that it selects rests within 0.001 of a place"},
        {"{\"weight\":1,\"drag\":[{\"point\":[0,1,3],\"by\":[0,0,0]}]}",
         "t.json:1: /moves/0/weight: a drag has no \"weight\": its places move by exactly what it says"},
        {"{\"falloff\":{\"center\":[0,0,0],\"radius\":1},\"drag\":[{\"point\":[0,1,3],\"by\":[0,0,0]}]}",
         "t.json:1: /moves/0/falloff: a drag has no \"falloff\": its places move by exactly what it says"},
        {"{\"radius\":0,\"drag\":[{\"point\":[0,1,3],\"by\":[0,0,0]}]}",
         "t.json:1: /moves/0/radius: radius 0 is not more than 0"},
        {"{\"radius\":1,\"by\":[0,0,0]}", "t.json:1: /moves/0/radius: a radius beside the action is one of "
                                          "\"drag\"; that of a pull or a falloff is "
                                          "within it"},
        {"{\"drag\":[]}",
         "t.json:1: /moves/0/drag: must be an array of {\"point\": [..], \"by\": [..]}, not an array of 0"},
        {"{\"drag\":[{\"point\":[0,1,3],\"by\":[1e308,0,0]}]},{\"drag\":[{\"point\":[0,1,3],\"by\":[1e308,0,"
         "0]}]}",
         NULL},
    };
    for (size_t i = 0; i < COUNT(refusals); i++) {
        ffd_lattice *l;
        ffd_error error;
        char line[600];
        assert_int_equal(parse(BOX, refusals[i].move, &l, &error), FFD_E_INVALID);
        ffd_error_format(&error, line, sizeof line);
        if (refusals[i].words)
            assert_string_equal(line, refusals[i].words);
        assert_int_equal(parse(BOX, refusals[i].move, &l, NULL), FFD_E_INVALID);
    }
    char *const many = ffd_alloc(60 * (FFD_MAX_DRAGGED + 2), 1);
    assert_non_null(many);
    if (!many) /* cmocka has ended the test here; gcc with sanitizers does not see it */
        return;
    for (size_t count = FFD_MAX_DRAGGED; count <= FFD_MAX_DRAGGED + 1; count++) {
        ffd_lattice *l = NULL;
        size_t used =
            (size_t)sprintf(many, "{\"format\":\"ffd-lattice\",\"version\":1," BOX ",\"moves\":[{\"drag\":[");
        for (size_t i = 0; i < count; i++)
            used += (size_t)sprintf(many + used, "%s{\"point\":[%.3f,1,3],\"by\":[0,1,0]}", i ? "," : "",
                                    1e-3 * (double)(i % 900));
        used += (size_t)sprintf(many + used, "]}]}");
        const ffd_status status = ffd_lattice_parse(many, used, "m.json", &l, NULL);
        assert_int_equal(status, count > FFD_MAX_DRAGGED ? FFD_E_LIMIT : FFD_OK);
        assert_true(!l || l->missed.miss == 0);
        ffd_lattice_destroy(&l);
    }
    ffd_free(many);
}

/* What is written reads back the same, and a copy is independent of the lattice. */
static void drags_are_written_and_copied(void **state)
{
    (void)state;
    ffd_lattice *l = make(BOX, "{\"by\":[0,1,0]},{\"at\":[\"all\",\"top\",\"all\"],\"mirror\":{\"point\":[0,"
                               "1,3],\"normal\":[0,0,2]},"
                               "\"radius\":2.5,\"drag\":[{\"point\":[0.3,2.9,3],\"by\":[0.5,0,0]},"
                               "{\"point\":[-0.3,2.9,3.5],\"by\":[0,0,1]}]}");
    ffd_lattice *copy, *back;
    char *text, *again;
    size_t size, again_size;
    assert_int_equal(ffd_lattice_copy(l, &copy, NULL), FFD_OK);
    assert_int_equal(ffd_lattice_text(l, &text, &size, NULL), FFD_OK);
    assert_non_null(strstr(
        text, "{\"at\": [[0, 4], 3, [0, 5]], \"mirror\": {\"point\": [0, 1, 3], \"normal\": [0, 0, 1]}, "
              "\"radius\": 2.5, \"drag\": [{\"point\": [0.3, 2.9, 3], \"by\": [0.5, 0, 0]}, "));
    assert_int_equal(ffd_lattice_parse(text, size, "t.json", &back, NULL), FFD_OK);
    assert_memory_equal(back->deformed, l->deformed, 3 * l->count * sizeof *l->deformed);
    ffd_lattice_destroy(&l);
    assert_int_equal(ffd_lattice_text(copy, &again, &again_size, NULL), FFD_OK);
    assert_string_equal(text, again);
    ffd_free(text);
    ffd_free(again);
    ffd_lattice_destroy(&copy);
    ffd_lattice_destroy(&back);
}

/* Squares of such vectors overflow, or are 0. */
static void vectors_of_any_size_are_met(void **state)
{
    static const int exponents[] = {660, 540, -540, -900};
    (void)state;
    ffd_lattice *const one = make(BOX, "{\"drag\":[{\"point\":[0.3,1,3],\"by\":[0.3,0,-0.7]},"
                                       "{\"point\":[0.25,1,3.5],\"by\":[0,0.1,0]}]}");
    for (size_t i = 0; i < COUNT(exponents); i++) {
        char moves[300];
        snprintf(
            moves, sizeof moves,
            "{\"drag\":[{\"point\":[0.3,1,3],\"by\":[%.17g,0,%.17g]},{\"point\":[0.25,1,3.5],\"by\":[0,%.17g,"
            "0]}]}",
            ldexp(0.3, exponents[i]), ldexp(-0.7, exponents[i]), ldexp(0.1, exponents[i]));
        ffd_lattice *l = make(BOX, moves);
        for (size_t c = 0; c < 3 * l->count; c++)
            if (!(fabs(ldexp(l->difference[c], -exponents[i]) - one->difference[c]) <= 0))
                fail_msg("2^%d, number %zu: %g, expected %g", exponents[i], c,
                         ldexp(l->difference[c], -exponents[i]), one->difference[c]);
        ffd_lattice_destroy(&l);
    }
    ffd_lattice *l = one;
    ffd_lattice_destroy(&l);
}

static void a_failed_allocation_is_reported(void **state)
{
    (void)state;
    ffd_status status = FFD_E_MEMORY;
    for (long n = 0; status == FFD_E_MEMORY; n++) {
        ffd_lattice *l = NULL;
        ffd_alloc_fail_after(n);
        status = parse(BOX, "{\"mirror\":\"x\",\"drag\":[{\"point\":[0.3,1,3],\"by\":[0.5,0,0]}]}", &l, NULL);
        ffd_alloc_fail_after(-1);
        assert_true(status == FFD_OK ? l != NULL && n > 20 : status == FFD_E_MEMORY && !l);
        ffd_lattice_destroy(&l);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(places_go_by_their_vectors_with_the_least_change),
        cmocka_unit_test(a_drag_adds_to_the_moves_before),
        cmocka_unit_test(only_what_is_selected_and_near_changes),
        cmocka_unit_test(what_contradicts_is_met_by_least_squares),
        cmocka_unit_test(mirrored_places_join_the_list),
        cmocka_unit_test(drags_that_cannot_be_are_refused_with_their_place),
        cmocka_unit_test(drags_are_written_and_copied),
        cmocka_unit_test(vectors_of_any_size_are_met),
        cmocka_unit_test(a_failed_allocation_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
