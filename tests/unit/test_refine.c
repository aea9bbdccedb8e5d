/* Refined lattices are the same map: random lattices of all kinds, presets that stay presets, bits that stay.
 */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_text.h"
#include "../support/repetitions.h"
#include "base/memory/memory.h"
#include "lattice/lattice.h"
#include <ffd/author.h>
#include <float.h>
#include <math.h>
#include <stdlib.h>

#define MOST_KNOTS 64

/* Knots of a direction, with repeated and graded ones. closed: breakpoints. */
static size_t random_knots(draw *d, int degree, size_t size, bool closed, double knots[MOST_KNOTS])
{
    const size_t count = closed ? size + 1 : size + (size_t)degree + 1;
    const double grade = ldexp(1, draw_int(d, 0, 1) * draw_int(d, 1, 20));
    double at = draw_between(d, -2, 2);
    int run = 1;
    for (size_t i = 0; i < count; i++) {
        knots[i] = at;
        /* Ends are simple, so that the domain is not empty and no seam is too thick. */
        const bool repeats =
            run < degree - 1 && i > 0 && i + 2 < count && i != (size_t)degree && draw_int(d, 0, 3) == 0;
        run = repeats ? run + 1 : 1;
        at += repeats ? 0 : draw_unit(d) * (i % 3 == 0 ? 1 : 1 / grade) + 1e-7;
    }
    return count;
}

typedef struct random_parts {
    double knots[3][MOST_KNOTS];
    double *rest, *offsets, *weights, *moved;
} random_parts;

static ffd_lattice *random_lattice(draw *d, int number, random_parts *parts)
{
    ffd_lattice_arrays arrays;
    ffd_lattice *lattice;
    ffd_error error = {0};
    size_t count = 1;
    ffd_lattice_arrays_init(&arrays, sizeof arrays);
    for (int a = 0; a < 3; a++) {
        const int degree = number % 6 == 5 && a == number % 3 ? draw_int(d, 5, 12) : draw_int(d, 1, 3);
        arrays.degree[a] = degree;
        arrays.size[a] = (size_t)(degree + 2 + draw_int(d, 0, 4));
        arrays.knots[a] = (ffd_knots)draw_int(d, FFD_KNOTS_CLAMPED, FFD_KNOTS_CLOSED);
        if (draw_int(d, 0, 1)) {
            const bool closed = arrays.knots[a] == FFD_KNOTS_CLOSED;
            arrays.knot_count[a] = random_knots(d, degree, arrays.size[a], closed, parts->knots[a]);
            arrays.knot_values[a] = parts->knots[a];
        }
        count *= arrays.size[a];
    }
    parts->rest = malloc(3 * count * sizeof(double));
    parts->offsets = malloc(3 * count * sizeof(double));
    parts->weights = malloc(count * sizeof(double));
    parts->moved = malloc(count * sizeof(double));
    assert_true(parts->rest && parts->offsets && parts->weights && parts->moved);
    const double far = number % 4 == 0 ? 1e6 : 0;
    for (size_t i = 0; i < count; i++) {
        const bool still = draw_int(d, 0, 2) > 0;
        for (size_t c = 0; c < 3; c++) {
            parts->rest[3 * i + c] = far + draw_between(d, -1, 1);
            parts->offsets[3 * i + c] = still ? 0 : draw_between(d, -1, 1);
        }
        parts->weights[i] = draw_between(d, 0.5, 2);
        parts->moved[i] = still ? parts->weights[i] : draw_between(d, 0.5, 2);
    }
    arrays.rest = parts->rest;
    if (number % 3 > 0)
        arrays.rest_weights = parts->weights;
    if (ffd_lattice_from_arrays(&arrays, &lattice, &error) ||
        ffd_lattice_set_offsets(lattice, NULL, count, parts->offsets, &error) ||
        (number % 3 == 2 && ffd_lattice_set_weights(lattice, NULL, count, parts->moved, &error)))
        fail_msg("lattice %d: %s", number, error.message);
    return lattice;
}

static void free_parts(random_parts *parts)
{
    free(parts->rest);
    free(parts->offsets);
    free(parts->weights);
    free(parts->moved);
}

static double largest_coordinate(const ffd_lattice *lattice)
{
    double largest = 0;
    for (size_t i = 0; i < 3 * lattice->count; i++)
        largest = fmax(largest, fmax(fabs(lattice->rest[i]), fabs(lattice->deformed[i])));
    return largest;
}

/* Compares the maps at random places; `share` of the promise is allowed to each refinement, and one of it to
   the evaluations. */
static void assert_same_map(draw *d, int number, const ffd_lattice *before, const ffd_lattice *after)
{
    double lo[3], hi[3];
    int degree[3];
    ffd_lattice_get_domain(before, lo, hi);
    ffd_lattice_get_degree(after, degree);
    const double ratio = before->rest_weights ? 4 : 1;
    const double promise =
        4 * DBL_EPSILON * (degree[0] + degree[1] + degree[2]) * largest_coordinate(before) * ratio;
    for (int i = 0; i < 20; i++) {
        double uvw[3], x[3], y[3];
        for (int a = 0; a < 3; a++)
            uvw[a] = draw_between(d, lo[a], hi[a]);
        for (int volume = FFD_VOLUME_REST; volume <= FFD_VOLUME_DEFORMED; volume++) {
            ffd_lattice_evaluate(before, (ffd_volume)volume, uvw, x, NULL);
            ffd_lattice_evaluate(after, (ffd_volume)volume, uvw, y, NULL);
            for (int c = 0; c < 3; c++)
                if (!(fabs(x[c] - y[c]) <= 2 * promise))
                    fail_msg("lattice %d at %.17g %.17g %.17g: volume %d, %c is %.17g, not %.17g: off by "
                             "%.3g of %.3g",
                             number, uvw[0], uvw[1], uvw[2], volume, "xyz"[c], y[c], x[c], fabs(x[c] - y[c]),
                             promise);
        }
    }
}

static void a_refined_lattice_is_the_same_map(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (int i = 0; i < repetitions(300); i++) {
        random_parts parts;
        double insert[3][4], lo[3], hi[3];
        ffd_refine_desc desc;
        ffd_lattice *refined, *const lattice = random_lattice(&d, i, &parts);
        ffd_error error = {0};
        ffd_refine_desc_init(&desc, sizeof desc);
        ffd_lattice_get_domain(lattice, lo, hi);
        for (int a = 0; a < 3; a++) {
            const int raise = draw_int(&d, 0, 5);
            desc.degree[a] =
                raise < 3 ? lattice->knots[a].degree + raise % (15 - lattice->knots[a].degree) : 0;
            desc.insert[a] = insert[a];
            desc.insert_count[a] = (size_t)draw_int(&d, 0, 2);
            for (size_t k = 0; k < desc.insert_count[a]; k++)
                insert[a][k] = draw_between(&d, lo[a], hi[a]);
        }
        desc.size[i % 3] = 3 * lattice->size[i % 3] + 20;
        if (ffd_lattice_refine(lattice, &desc, &refined, &error))
            fail_msg("lattice %d: %s", i, error.message);
        assert_int_equal(refined->size[i % 3], 3 * lattice->size[i % 3] + 20);
        assert_same_map(&d, i, lattice, refined);
        ffd_lattice_destroy(&refined);
        ffd_lattice *at_rest = lattice;
        memset(parts.offsets, 0, 3 * lattice->count * sizeof *parts.offsets);
        assert_int_equal(ffd_lattice_set_offsets(at_rest, NULL, lattice->count, parts.offsets, NULL), FFD_OK);
        if (i % 3 < 2) {
            assert_int_equal(ffd_lattice_refine(at_rest, &desc, &refined, &error), FFD_OK);
            for (size_t k = 0; k < 3 * refined->count; k++)
                assert_true(refined->difference[k] == 0);
            ffd_lattice_destroy(&refined);
        }
        ffd_lattice_destroy(&at_rest);
        free_parts(&parts);
    }
}

static ffd_lattice *refine(const ffd_lattice *lattice, const ffd_refine_desc *desc)
{
    ffd_lattice *refined;
    ffd_error error = {0};
    if (ffd_lattice_refine(lattice, desc, &refined, &error))
        fail_msg("%s", error.message);
    return refined;
}

#define WEIGHTED "\"size\":[9,2,2],\"degree\":[3,1,1],\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[3,1,1]}}"

/* An inserted knot changes the control points over whose functions it lies, and no others, also where
   division by a weight would round. */
static void control_points_without_a_new_knot_keep_their_bits(void **state)
{
    (void)state;
    static const double half = 0.5;
    draw d = {7};
    ffd_lattice *lattice = make(WEIGHTED, "");
    double weights[36], offsets[108];
    for (int i = 0; i < 36; i++)
        weights[i] = draw_between(&d, 0.3, 3);
    for (int i = 0; i < 108; i++)
        offsets[i] = draw_between(&d, -1, 1);
    for (int pass = 0; pass < 2; pass++) {
        ffd_refine_desc desc;
        ffd_refine_desc_init(&desc, sizeof desc);
        desc.insert[0] = &half;
        desc.insert_count[0] = 1;
        assert_int_equal(ffd_lattice_set_offsets(lattice, NULL, 36, offsets, NULL), FFD_OK);
        ffd_lattice *refined = refine(lattice, &desc);
        assert_int_equal(refined->size[0], 10);
        for (size_t line = 0; line < 4; line++)
            for (size_t i = 0; i < 10; i++) {
                /* 1/2 is a knot already: 2 points are new. */
                const bool is_new = i == 4 || i == 5;
                const size_t old = 9 * line + (i < 4 ? i : i - 1), at = 10 * line + i;
                const bool same =
                    memcmp(refined->difference + 3 * at, lattice->difference + 3 * old, 24) == 0 &&
                    (!lattice->rest_weights ||
                     (refined->rest_weights[at] == lattice->rest_weights[old] &&
                      refined->deformed_weights[at] == lattice->deformed_weights[old]));
                if (same == is_new)
                    fail_msg("pass %d: control point %zu of line %zu is %s", pass, i, line,
                             same ? "kept" : "new");
            }
        ffd_lattice_destroy(&refined);
        assert_int_equal(ffd_lattice_set_weights(lattice, NULL, 36, weights, NULL), FFD_OK);
    }
    ffd_lattice_destroy(&lattice);
}

static void assert_text_has(const ffd_lattice *lattice, const char *part)
{
    char *text;
    size_t size;
    assert_int_equal(ffd_lattice_text(lattice, &text, &size, NULL), FFD_OK);
    if (!strstr(text, part))
        fail_msg("\"%s\" is not in %s", part, text);
    ffd_free(text);
}

static void boxes_and_presets_stay(void **state)
{
    (void)state;
    ffd_refine_desc desc;
    ffd_refine_desc_init(&desc, sizeof desc);
    ffd_lattice *lattice = make("\"size\":[4,5,4],\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[3,1,1]}}",
                                "{\"at\":[1,1,1],\"by\":[1,0,0]}");
    desc.size[0] = 5; /* clamped again: the one inner knot is at 1/2 */
    ffd_lattice *refined = refine(lattice, &desc);
    assert_text_has(refined, "\"knots\": [\"clamped\", \"clamped\", \"clamped\"]");
    assert_text_has(refined, "\"box\"");
    assert_text_has(refined, "\"offsets\"");
    assert_int_equal(refined->form, REST_BOX_AFFINE);
    ffd_lattice_destroy(&refined);
    ffd_lattice_destroy(&lattice);
    /* Not laid round a mesh yet, and without anything that needs positions. */
    lattice = make("\"size\":[4,4,4],\"rest\":{\"box\":\"mesh\",\"margin\":0.25}", "");
    refined = refine(lattice, &desc);
    assert_text_has(refined, "\"box\": \"mesh\"");
    assert_text_has(refined, "\"margin\": 0.25");
    ffd_lattice_destroy(&refined);
    ffd_lattice_destroy(&lattice);
}

/* The mesh of a box that is not laid yet is found beside the file that names it. */
static void boxes_round_meshes_keep_these(void **state)
{
    (void)state;
    static const char text[] = "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[4,4,4],"
                               "\"rest\":{\"box\":{\"meshes\":[\"a.obj\",\"b.obj\"]},\"margin\":0.25}}";
    const char *const path = "refine-meshes.json";
    FILE *const file = fopen(path, "w");
    ffd_lattice *lattice;
    ffd_refine_desc desc;
    char *before, *after;
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0 && fclose(file) == 0);
    assert_int_equal(ffd_lattice_load(path, &lattice, NULL), FFD_OK);
    ffd_refine_desc_init(&desc, sizeof desc);
    desc.size[2] = 9;
    ffd_lattice *refined = refine(lattice, &desc);
    assert_text_has(refined, "\"a.obj\"");
    assert_text_has(refined, "\"b.obj\"");
    assert_text_has(refined, "\"margin\": 0.25");
    assert_int_equal(ffd_lattice_get_mesh_count(refined), 2);
    for (size_t i = 0; i < 2; i++) {
        assert_int_equal(ffd_lattice_get_mesh(lattice, i, &before, NULL), FFD_OK);
        assert_int_equal(ffd_lattice_get_mesh(refined, i, &after, NULL), FFD_OK);
        assert_string_equal(before, after);
        ffd_free(before);
        ffd_free(after);
    }
    ffd_lattice_destroy(&refined);
    ffd_lattice_destroy(&lattice);
    remove(path);
}

/* Else it would depend on the system's qsort which of 0 and -0 comes first. */
static void zeros_among_knots_have_one_sign(void **state)
{
    (void)state;
    static const double zeros[] = {-0.0, 0.0};
    ffd_lattice *lattice =
        make("\"size\":[5,2,2],\"degree\":[2,1,1],\"knots\":[[-1,-1,-1,-0.0,0.5,1,1,1],"
             "\"clamped\",\"clamped\"],\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[3,1,1]}}",
             "");
    for (int i = 0; i < 2; i++) {
        ffd_refine_desc desc;
        ffd_refine_desc_init(&desc, sizeof desc);
        desc.insert[0] = &zeros[i];
        desc.insert_count[0] = 1;
        ffd_lattice *refined = refine(lattice, &desc);
        assert_text_has(refined, "[-1, -1, -1, 0, 0, 0.5, 1, 1, 1]");
        ffd_lattice_destroy(&refined);
    }
    ffd_lattice_destroy(&lattice);
}

static void assert_refused(const ffd_lattice *lattice, const ffd_refine_desc *desc, ffd_status expected,
                           const char *why)
{
    ffd_lattice *refined;
    ffd_error error = {0};
    assert_int_equal(ffd_lattice_refine(lattice, desc, &refined, &error), expected);
    assert_string_equal(message_of(&error), why);
    assert_null(refined);
}

#define RING "[2,0,0],[1,2,0],[-1,2,0],[-2,0,0],[-1,-2,0],[1,-2,0]"

static void wishes_that_cannot_be_met_are_refused(void **state)
{
    (void)state;
    static const double beyond[] = {1.5}, often[] = {0.5, 0.5, 0.5, 0.5}, start[] = {0};
    ffd_refine_desc desc;
    ffd_refine_desc_init(&desc, sizeof desc);
    ffd_lattice *lattice = make("\"size\":[4,5,4],\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[3,1,1]}}", "");
    assert_refused(lattice, &desc, FFD_E_ARGUMENT,
                   "nothing would change: size, insert and degree are as they are");
    desc.size[1] = 4;
    assert_refused(lattice, &desc, FFD_E_ARGUMENT,
                   "size 4 along v is less than the 5 control points that are there");
    desc.size[1] = (size_t)1 << 40;
    assert_refused(lattice, &desc, FFD_E_LIMIT,
                   "size: 1099511627776 control points along v are more than 67108864");
    desc.size[0] = FFD_MAX_CONTROL_POINTS / 16; /* too many with the others: said before memory is taken */
    desc.size[1] = 0;
    ffd_alloc_fail_after(0);
    assert_refused(lattice, &desc, FFD_E_LIMIT, "the lattice would have more than 67108864 control points");
    ffd_alloc_fail_after(-1);
    desc.size[0] = 0;
    desc.size[1] = 0;
    desc.degree[2] = 2;
    assert_refused(lattice, &desc, FFD_E_ARGUMENT, "degree 2 along w is not between the 3 that it is and 14");
    desc.degree[2] = 15;
    assert_refused(
        lattice, &desc, FFD_E_ARGUMENT,
        "degree 15 along w is not between the 3 that it is and 14: as many control points of a lower degree "
        "each move a smaller part");
    desc.degree[2] = 0;
    desc.insert[0] = beyond;
    desc.insert_count[0] = 1;
    assert_refused(lattice, &desc, FFD_E_ARGUMENT, "insert u: the knot 1.5 is outside of the domain, 0 to 1");
    desc.insert[0] = often;
    desc.insert_count[0] = 4;
    assert_refused(lattice, &desc, FFD_E_ARGUMENT,
                   "insert u: the knot 0.5 would be there 4 times; degree 3 allows 3 inside it");
    desc.insert[0] = start;
    desc.insert_count[0] = 1;
    assert_refused(lattice, &desc, FFD_E_ARGUMENT,
                   "insert u: the knot 0 would be there 5 times; degree 3 allows 4 at an end of the domain");
    desc.insert_count[0] = SIZE_MAX; /* nobody has so many */
    assert_refused(lattice, &desc, FFD_E_LIMIT,
                   "size: 18446744073709551615 control points along u are more than 67108864");
    desc.insert_count[0] = 1;
    ffd_lattice_destroy(&lattice);
    /* The ends of a period are one knot: it is there 3 times already, at 0 and at 4. */
    lattice =
        make("\"size\":[6,2,2],\"degree\":[3,1,1],"
             "\"knots\":[{\"closed\":[0,0,1,2,3,4,4]},\"clamped\",\"clamped\"],\"rest\":{\"points\":[" RING
             "," RING "," RING "," RING "]}",
             "");
    assert_refused(lattice, &desc, FFD_E_ARGUMENT,
                   "insert u: the knot 0 would be there 4 times; degree 3 allows 3 inside it");
    ffd_lattice_destroy(&lattice);
    lattice = make("\"size\":[4,4,4],\"rest\":{\"box\":\"mesh\"}", "{\"at\":[1,1,1],\"by\":[1,0,0]}");
    desc.insert[0] = often;
    assert_refused(lattice, &desc, FFD_E_INVALID,
                   "the box of the lattice is that of a mesh, and its moves need positions (meshes)");
    ffd_lattice_destroy(&lattice);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_refined_lattice_is_the_same_map),
        cmocka_unit_test(control_points_without_a_new_knot_keep_their_bits),
        cmocka_unit_test(boxes_and_presets_stay),
        cmocka_unit_test(boxes_round_meshes_keep_these),
        cmocka_unit_test(zeros_among_knots_have_one_sign),
        cmocka_unit_test(wishes_that_cannot_be_met_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
