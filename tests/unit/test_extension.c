/* test_extension.c - the displacement of points outside a lattice: fade, gradient, continuity at the
   border. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/draw.h"
#include "../support/lattice_by_hand.h"
#include "../support/repetitions.h"
#include "base/vector/vec.h"
#include "deform/displacement.h"
#include "deform/extension.h"
#include "embed/locator.h"
#include <ffd/embedding.h>
#include <float.h>
#include <string.h>

#define POINTS 400

/* Rest volumes of several kinds, with no deformation yet. */
static const char *const volumes[] = {
    "\"size\":[4,5,6],\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,2,3]}}",
    "\"size\":[4,4,4],\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[1,1,1],\"axes\":[[0.6,0.8,0],[-0.8,0.6,"
    "0],"
    "[0,0,1]]}},\"knots\":[\"open\",\"uniform\",\"clamped\"],\"degree\":[2,3,1]",
    "\"size\":[3,3,3],\"rest\":{\"points\":[[-2,-2,-2],[0,-1.8,-2],[2,-2,-2.1],[-2.2,0,-2],[0,0,-2],[2,0.1,-"
    "2],"
    "[-2,2,-2],[0,2.3,-2],[2,2,-1.9],[-2,-2,0],[0,-2,0.1],[2,-2.1,0],[-2,0,0],[0,0.1,0],[2.4,0,0],[-2,2,0],["
    "0,2,"
    "0],[1.8,2,0],[-2,-2,2],[0,-2,2.2],[2,-2,2],[-2,0,2],[0,0,2.5],[2,0,2],[-2.1,2,2],[0,2,2],[2,2,2.2]]}",
    "\"size\":[3,3,3],\"weights\":[1,2,1,1,1,1,1,1,1,1,1,1,1,0.5,1,1,1,1,2,1,1,1,1,1,3,1,1],"
    "\"rest\":{\"box\":{\"min\":[-2,-2,-2],\"max\":[2,2,2]}}",
    "\"size\":[4,8,4],\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":[0,0,1],\"radius\":[1,2],"
    "\"height\":3}}",
};
#define VOLUMES (sizeof volumes / sizeof *volumes)

typedef struct sample {
    ffd_lattice *lattice;
    boundary *border;
} sample;

static void clear(sample *s)
{
    ffd_boundary_destroy(&s->border);
    ffd_lattice_destroy(&s->lattice);
}

static sample make(const char *members)
{
    char text[2000];
    ffd_error error = {0};
    sample s = {NULL, NULL};
    const int size = snprintf(text, sizeof text, "{\"format\":\"ffd-lattice\",\"version\":1,%s}", members);
    if (ffd_lattice_parse(text, (size_t)size, "test", &s.lattice, &error) ||
        ffd_boundary_create(s.lattice, &s.border, &error))
        fail_msg("%s %s", error.pointer, error.message);
    return s;
}

/* Moves every control point by up to `amount`. */
static sample shaken(const char *members, double amount, draw *d)
{
    sample s = make(members);
    for (size_t i = 0; i < 3 * s.lattice->count; i++)
        s.lattice->deformed[i] += draw_between(d, -amount, amount);
    assert_int_equal(finish_by_hand(s.lattice, NULL), FFD_OK);
    return s;
}

static boundary_point nearest_to(const sample *s, const double p[3])
{
    boundary_point nearest;
    assert_int_equal(ffd_boundary_find(s->border, p, HUGE_VAL, &nearest, NULL), FFD_OK);
    assert_true(nearest.found);
    return nearest;
}

static void far_point(draw *d, double p[3])
{
    double length;
    do {
        for (int a = 0; a < 3; a++)
            p[a] = draw_between(d, -1, 1);
        length = vec_length(p);
    } while (!(length > 0.1 && length <= 1));
    const double distance = draw_between(d, 4, 9);
    for (int a = 0; a < 3; a++)
        p[a] *= distance / length;
}

static void the_fade_is_the_quintic_from_one_to_zero(void **state)
{
    (void)state;
    double slope = 7;
    assert_true(ffd_extension_fade(5, 0, &slope) == 1 && slope == 0);
    assert_true(ffd_extension_fade(HUGE_VAL, 0, NULL) == 1);
    static const double radii[] = {1, 0.3, 1e-9, 1e12, 1e-300, 1e300};
    for (size_t r = 0; r < sizeof radii / sizeof *radii; r++) {
        const double radius = radii[r];
        assert_true(ffd_extension_fade(0, radius, &slope) == 1 && slope == 0);
        assert_true(ffd_extension_fade(radius, radius, &slope) == 0 && slope == 0);
        assert_true(ffd_extension_fade(2 * radius, radius, &slope) == 0 && slope == 0);
        assert_true(ffd_extension_fade(HUGE_VAL, radius, &slope) == 0 && slope == 0);
        assert_true(fabs(ffd_extension_fade(radius / 2, radius, &slope) - 0.5) <= 2 * DBL_EPSILON);
        assert_true(fabs(slope * radius + 1.875) <= 1e-14);
        double before = 1;
        for (int i = 1; i < 256; i++) {
            const long double s = i / 256.0L;
            const double weight = ffd_extension_fade(i / 256.0 * radius, radius, &slope);
            const long double expected = 1 - s * s * s * (10 - 15 * s + 6 * s * s);
            assert_true(fabsl(weight - expected) <= 4 * DBL_EPSILON);
            assert_true(weight < before && slope < 0);
            const double step = 1.0 / 16384;
            const double rise = ffd_extension_fade((i / 256.0 + step) * radius, radius, NULL) -
                                ffd_extension_fade((i / 256.0 - step) * radius, radius, NULL);
            assert_true(fabs(rise / (2 * step) - slope * radius) <= 1e-6);
            before = weight;
        }
    }
}

/* Near its end the fade has full relative precision: 10 t^3 for small t = 1 - s. */
static void the_fade_is_flat_at_its_ends(void **state)
{
    (void)state;
    double slope;
    for (int e = 3; e < 50; e++) {
        const double t = ldexp(1, -e), weight = ffd_extension_fade(1 - t, 1, &slope);
        assert_true(fabs(weight / (10 * t * t * t) - 1) <= 1.5 * t + 4 * DBL_EPSILON);
        assert_true(fabs(slope / (-30 * t * t) - 1) <= 2 * t + 4 * DBL_EPSILON);
        assert_true(1 - ffd_extension_fade(t, 1, NULL) <= 10 * t * t * t + DBL_EPSILON);
    }
}

static void the_derivative_by_uvw_agrees_with_differences(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (size_t v = 0; v < VOLUMES; v++) {
        sample s = shaken(volumes[v], 0.3, &d);
        double lo[3], hi[3];
        ffd_lattice_get_domain(s.lattice, lo, hi);
        for (int i = 0; i < 100; i++) {
            double uvw[3], delta[3], expected[3], by_uvw[9];
            for (int a = 0; a < 3; a++)
                uvw[a] = lo[a] + (hi[a] - lo[a]) * (0.3 + (draw_int(&d, 0, 400) + 0.37) / 1100);
            assert_int_equal(ffd_displacement_by_uvw(s.lattice, uvw, delta, by_uvw), 1);
            assert_int_equal(ffd_displacement(s.lattice, uvw, expected, NULL), 1);
            assert_memory_equal(delta, expected, sizeof delta);
            for (int c = 0; c < 3; c++) {
                const double kept = uvw[c], step = 1e-6 * (hi[c] - lo[c]);
                double ahead[3], behind[3];
                uvw[c] = kept + step;
                ffd_displacement(s.lattice, uvw, ahead, NULL);
                uvw[c] = kept - step;
                ffd_displacement(s.lattice, uvw, behind, NULL);
                uvw[c] = kept;
                for (int r = 0; r < 3; r++) {
                    const double slope = (ahead[r] - behind[r]) / (2 * step);
                    if (fabs(slope - by_uvw[3 * r + c]) > 1e-4 / (hi[c] - lo[c]))
                        fail_msg("volume %zu: d delta_%d / d uvw_%d is %g, not %g", v, r, c, slope,
                                 by_uvw[3 * r + c]);
                }
            }
        }
        clear(&s);
    }
}

static void an_undeformed_lattice_moves_no_far_point(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    const double zero[9] = {0};
    for (size_t v = 0; v < VOLUMES; v++) {
        sample s = make(volumes[v]);
        for (int i = 0; i < 20; i++) {
            double p[3], delta[3] = {1, 1, 1}, gradient[9] = {1};
            far_point(&d, p);
            const boundary_point nearest = nearest_to(&s, p);
            assert_int_equal(ffd_extension_displacement(s.lattice, &nearest, 0, delta, gradient), 0);
            assert_memory_equal(delta, zero, sizeof delta);
            assert_memory_equal(gradient, zero, sizeof gradient);
        }
        clear(&s);
    }
}

/* Only border points near the moved corner act. */
static void only_points_near_the_moved_corner_act(void **state)
{
    (void)state;
    sample s = make("\"size\":[6,6,6],\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[3,3,3]}},"
                    "\"moves\":[{\"at\":[-1,-1,-1],\"by\":[1,2,-4]}]");
    const double beyond[3] = {5, 5, 5}, next_to[3] = {1, 5, 5}, zero[9] = {0};
    double delta[3], gradient[9];
    boundary_point nearest = nearest_to(&s, beyond);
    assert_int_equal(ffd_extension_displacement(s.lattice, &nearest, 0, delta, gradient), 1);
    assert_true(delta[0] == 1 && delta[1] == 2 && delta[2] == -4);
    for (int i = 0; i < 9; i++)
        assert_true(gradient[i] == 0); /* the corner is the nearest point all around */
    nearest = nearest_to(&s, next_to);
    assert_int_equal(ffd_extension_displacement(s.lattice, &nearest, 0, delta, gradient), 0);
    assert_memory_equal(delta, zero, sizeof delta);
    clear(&s);
}

static void the_displacement_is_zero_from_the_falloff_on(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    const double zero[9] = {0};
    sample s = shaken(volumes[0], 0.5, &d);
    for (int i = 0; i < 100; i++) {
        double p[3], delta[3], plain[3], gradient[9];
        far_point(&d, p);
        const boundary_point nearest = nearest_to(&s, p);
        assert_int_equal(ffd_extension_displacement(s.lattice, &nearest, nearest.distance, delta, gradient),
                         0);
        assert_memory_equal(delta, zero, sizeof delta);
        assert_memory_equal(gradient, zero, sizeof gradient);
        assert_int_equal(ffd_extension_displacement(s.lattice, &nearest, 0, plain, NULL), 1);
        assert_int_equal(ffd_extension_displacement(s.lattice, &nearest, 2 * nearest.distance, delta, NULL),
                         1);
        for (int a = 0; a < 3; a++)
            assert_true(fabs(delta[a] - plain[a] / 2) <= 1e-15);
        assert_int_equal(
            ffd_extension_displacement(s.lattice, &nearest, 1.001 * nearest.distance, delta, gradient), 1);
        assert_true(vec_length(delta) <= 1e-7 * vec_length(plain));
        assert_true(vec_length(gradient) < 1e-3 && vec_length(gradient + 3) < 1e-3);
    }
    clear(&s);
}

static unsigned resting_rows(const boundary_point *nearest)
{
    unsigned rows = 0;
    for (int r = 0; r < 3; r++)
        rows |= (unsigned)(vec_length(nearest->uvw_by_p + 3 * r) == 0) << r;
    return rows;
}

/* Difference quotient of the displacement along direction c. Returns false if the points on both sides follow
   different faces or edges of the border. */
static bool difference(const sample *s, const double p[3], int c, double falloff, double column[3])
{
    const double step = 1e-6; /* its error is step^2 times a third derivative */
    double at[2][3], delta[2][3];
    const boundary_point here = nearest_to(s, p);
    for (int side = 0; side < 2; side++) {
        memcpy(at[side], p, sizeof at[side]);
        at[side][c] += side ? step : -step;
        const boundary_point nearest = nearest_to(s, at[side]);
        if (resting_rows(&nearest) != resting_rows(&here))
            return false;
        for (int a = 0; a < 3; a++)
            if (fabs(nearest.uvw[a] - here.uvw[a]) > 1e-3)
                return false;
        ffd_extension_displacement(s->lattice, &nearest, falloff, delta[side], NULL);
    }
    for (int r = 0; r < 3; r++)
        column[r] = (delta[1][r] - delta[0][r]) / (at[1][c] - at[0][c]);
    return true;
}

static void check_gradients(const char *members, double falloff, draw *d)
{
    sample s = shaken(members, 0.3, d);
    int compared = 0, moving = 0;
    const int points = repetitions(POINTS);
    for (int i = 0; i < points; i++) {
        double p[3], delta[3], gradient[9], columns[3][3];
        far_point(d, p);
        const boundary_point nearest = nearest_to(&s, p);
        const int moves = ffd_extension_displacement(s.lattice, &nearest, falloff, delta, gradient);
        bool smooth = true;
        for (int c = 0; c < 3 && smooth; c++)
            smooth = difference(&s, p, c, falloff, columns[c]);
        if (!smooth)
            continue;
        compared++;
        moving += moves;
        for (int c = 0; c < 3; c++)
            for (int r = 0; r < 3; r++)
                if (fabs(columns[c][r] - gradient[3 * r + c]) > 1e-6)
                    fail_msg("%s, point %d: d delta_%d / d p_%d is %g, not %g", members, i, r, c,
                             columns[c][r], gradient[3 * r + c]);
    }
    if (points == POINTS) { /* else too few to count */
        assert_true(compared > POINTS * 3 / 4);
        assert_true(moving > compared / 2);
    }
    clear(&s);
}

static void gradients_agree_with_differences(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (size_t v = 0; v < VOLUMES; v++) {
        check_gradients(volumes[v], 0, &d);
        check_gradients(volumes[v], 8, &d);
    }
}

/* Draws a point on a face of the domain, with the outward unit normal. */
static void draw_on_border(const sample *s, draw *d, double p[3], double outward[3])
{
    double lo[3], hi[3], uvw[3], jacobian[9], cofactor[9], growing[3];
    int direction;
    ffd_lattice_get_domain(s->lattice, lo, hi);
    do
        direction = draw_int(d, 0, 2);
    while (ffd_knots_closed(&s->lattice->knots[direction]));
    const bool end = draw_int(d, 0, 1);
    for (int a = 0; a < 3; a++)
        uvw[a] = lo[a] + (hi[a] - lo[a]) * draw_between(d, 0.1, 0.9);
    uvw[direction] = end ? hi[direction] : lo[direction];
    ffd_lattice_evaluate(s->lattice, FFD_VOLUME_REST, uvw, p, jacobian);
    mat_cofactor(jacobian, cofactor);
    for (int a = 0; a < 3; a++) {
        growing[a] = jacobian[3 * a + direction];
        outward[a] = cofactor[3 * a + direction];
    }
    const double length = vec_length(outward) * ((vec_dot(growing, outward) > 0) == end ? 1 : -1);
    for (int a = 0; a < 3; a++)
        outward[a] /= length;
}

/* On both sides of the border the displacements agree, and so do the gradients along the border. */
static void the_displacement_has_no_step_at_the_border(void **state)
{
    (void)state;
    draw d = {draw_seed()};
    for (size_t v = 0; v < VOLUMES; v++) {
        sample s = shaken(volumes[v], 0.3, &d);
        ffd_locator *locator = NULL;
        assert_int_equal(ffd_locator_create(s.lattice, &locator, NULL), FFD_OK);
        for (int i = 0; i < POINTS; i++) {
            double p[3], outward[3], side[2][3], delta[2][3], gradient[2][9];
            ffd_location found[2];
            draw_on_border(&s, &d, p, outward);
            for (int a = 0; a < 3; a++) {
                side[0][a] = p[a] - 1e-7 * outward[a];
                side[1][a] = p[a] + 1e-7 * outward[a];
            }
            assert_int_equal(ffd_locator_find(locator, side[0], 2, found, NULL), FFD_OK);
            assert_int_equal(found[0].status, FFD_VERTEX_INSIDE);
            assert_int_equal(found[1].status, FFD_VERTEX_OUTSIDE);
            const boundary_point nearest = nearest_to(&s, side[1]);
            ffd_displacement(s.lattice, found[0].uvw, delta[0], gradient[0]);
            ffd_extension_displacement(s.lattice, &nearest, 3, delta[1], gradient[1]);
            for (int r = 0; r < 3; r++) {
                const double out[2] = {vec_dot(gradient[0] + 3 * r, outward),
                                       vec_dot(gradient[1] + 3 * r, outward)};
                assert_true(fabs(delta[0][r] - delta[1][r]) <= 1e-5);
                assert_true(fabs(out[1]) <= 1e-5); /* the fade starts with slope 0 */
                for (int c = 0; c < 3; c++)
                    assert_true(fabs(gradient[0][3 * r + c] - out[0] * outward[c] - gradient[1][3 * r + c] +
                                     out[1] * outward[c]) <= 1e-4);
            }
        }
        ffd_locator_destroy(&locator);
        clear(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_fade_is_the_quintic_from_one_to_zero),
        cmocka_unit_test(the_fade_is_flat_at_its_ends),
        cmocka_unit_test(the_derivative_by_uvw_agrees_with_differences),
        cmocka_unit_test(an_undeformed_lattice_moves_no_far_point),
        cmocka_unit_test(only_points_near_the_moved_corner_act),
        cmocka_unit_test(the_displacement_is_zero_from_the_falloff_on),
        cmocka_unit_test(gradients_agree_with_differences),
        cmocka_unit_test(the_displacement_has_no_step_at_the_border),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
