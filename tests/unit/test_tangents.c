/* test_tangents.c - derivatives of control points by placeholders, compared with finite differences for each
   kind of move. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/memory/memory.h"
#include "lattice/build.h"
#include "lattice/file/spec_parse.h"
#include "lattice/lattice.h"
#include "lattice/tangent/tangents.h"
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define BOX "\"size\":[4,3,5],\"rest\":{\"box\":{\"min\":[-1,0.5,-1],\"max\":[1,2,3]}}"
#define MESH "\"size\":[4,3,5],\"rest\":{\"box\":\"mesh\"}"
#define ARCS                                                                                                 \
    "\"size\":[3,3,5],\"degree\":[2,2,2],\"knots\":[\"clamped\",\"clamped\",[0,0,0,1,1,2,2,2]],"             \
    "\"rest\":{\"box\":{\"min\":[-1,-1,0],\"max\":[1,1,4]}}"

/* A value, of one number or three, and moves that contain it as {"$": "A"}. */
typedef struct sample {
    const char *rest, *moves;
    size_t size;
    double value[3];
} sample;

#define A "{\"$\":\"A\"}"
#define TWO(move) "{\"by\":[0.1,0.05,0]},{\"at\":[[1,3],\"all\",[2,4]]," move "}"

static const sample samples[] = {
    {BOX, TWO("\"by\":" A), 3, {0.3, -0.2, 0.1}},
    {BOX, TWO("\"by\":[" A ",0,{\"$\":\"-A\"}]"), 1, {0.7}},
    {BOX, TWO("\"weight\":0.3,\"to\":" A), 3, {0.3, -0.2, 0.1}},
    {BOX, TWO("\"weight\":" A ",\"to\":[1,2,3]"), 1, {0.4}},
    {BOX, TWO("\"scale\":{\"factor\":" A "}"), 1, {1.4}},
    {BOX, TWO("\"scale\":{\"factor\":" A ",\"about\":[0,1,0]}"), 3, {1.4, 0.7, 2}},
    {BOX, TWO("\"scale\":{\"factor\":2,\"about\":" A "}"), 3, {0.1, 1, 0.4}},
    {BOX, TWO("\"rotate\":{\"axis\":[1,2,2],\"degrees\":" A "}"), 1, {35}},
    {BOX, TWO("\"rotate\":{\"axis\":" A ",\"degrees\":50}"), 3, {1, 2, -0.5}},
    {BOX, TWO("\"rotate\":{\"axis\":\"y\",\"degrees\":50,\"about\":" A "}"), 3, {1, 2, -0.5}},
    {BOX, TWO("\"matrix\":[1,0,0,0.1,0,{\"$\":\"A\"},0,0,0,0.2,1,0,0,0,0,1]"), 1, {1.3}},
    {BOX, TWO("\"twist\":{\"axis\":\"z\",\"degrees\":" A "}"), 1, {80}},
    {BOX, TWO("\"twist\":{\"axis\":" A ",\"degrees\":40}"), 3, {0.2, 0.1, 1}},
    {BOX, TWO("\"taper\":{\"axis\":\"z\",\"factor\":" A "}"), 1, {0.6}},
    {BOX, TWO("\"taper\":{\"axis\":" A ",\"factor\":2}"), 3, {0.2, 0.1, 1}},
    {BOX, TWO("\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":" A "}"), 1, {75}},
    {BOX, TWO("\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":" A "}"), 1, {0.001}},
    {BOX, TWO("\"bend\":{\"axis\":" A ",\"toward\":\"x\",\"degrees\":60}"), 3, {0.1, 0.2, 1}},
    {BOX,
     TWO("\"bend\":{\"axis\":\"z\",\"toward\":" A ",\"degrees\":60,\"about\":[0.1,1,0]}"),
     3,
     {1, 0.3, 0.2}},
    {BOX, TWO("\"pull\":{\"point\":" A ",\"by\":[0.3,0.1,0],\"radius\":3}"), 3, {0.2, 1, 1}},
    {BOX, TWO("\"pull\":{\"point\":[0,1,1],\"by\":" A ",\"radius\":3}"), 3, {0.2, 1, 1}},
    {BOX, TWO("\"pull\":{\"point\":[0,1,1],\"by\":[1,0,1],\"radius\":" A "}"), 1, {2.4}},
    {BOX, TWO("\"falloff\":{\"axis\":\"z\",\"from\":" A ",\"to\":2.7},\"by\":[1,0,0]"), 1, {0.3}},
    {BOX, TWO("\"falloff\":{\"axis\":" A ",\"from\":0,\"to\":2.7},\"by\":[1,0,0]"), 3, {0.3, 0.2, 1}},
    {BOX, TWO("\"falloff\":{\"center\":" A ",\"radius\":2.7},\"by\":[1,0,0]"), 3, {0.3, 0.2, 1}},
    {BOX, TWO("\"falloff\":{\"center\":[0,1,1],\"radius\":" A "},\"by\":[1,0,0]"), 1, {2.1}},
    {BOX, TWO("\"mirror\":\"x\",\"by\":" A), 3, {0.3, -0.2, 0.1}},
    {BOX, TWO("\"mirror\":\"x\",\"rotate\":{\"axis\":\"z\",\"degrees\":" A "}"), 1, {30}},
    {BOX, TWO("\"mirror\":\"z\",\"twist\":{\"axis\":\"x\",\"degrees\":" A "}"), 1, {30}},
    {BOX,
     TWO("\"by\":" A) ",{\"rotate\":{\"axis\":\"z\",\"degrees\":20}},{\"taper\":{\"axis\":\"x\",\"factor\":0."
                      "5}}",
     3,
     {0.3, -0.2, 0.1}},
    {BOX,
     "{\"by\":[0.1,0.05,0]},{\"mirror\":{\"axis\":\"x\",\"at\":0.2},\"pull\":{\"point\":" A
     ",\"by\":[0.3,0.1,0],\"radius\":3}}",
     3,
     {0.6, 1, 1}},
    {BOX,
     "{\"by\":[0.1,0.05,0]},{\"mirror\":{\"point\":[0,1,1],\"normal\":[1,2,-2]},\"falloff\":{\"center\":[0,1,"
     "1],\"radius\":" A "},\"rotate\":{\"axis\":\"z\",\"degrees\":40}}",
     1,
     {2.5}},
    {BOX,
     "{\"drag\":[{\"point\":[0.1,1,0.4],\"by\":" A "},{\"point\":[-0.5,1.9,2],\"by\":[0,0.1,0]}]}",
     3,
     {0.3, -0.2, 0.1}},
    {BOX,
     "{\"by\":" A "},{\"mirror\":\"y\",\"drag\":[{\"point\":[0.1,1,0.4],\"by\":" A
     "}]},{\"twist\":{\"axis\":\"z\",\"degrees\":30}}",
     3,
     {0.3, -0.2, 0.1}},
    {BOX ",\"units\":\"box\"",
     "{\"radius\":0.9,\"drag\":[{\"point\":[0.5,0.5,0.2],\"by\":[0,{\"$\":\"-A\"},0]},{\"point\":[0.5,0.5,0."
     "2],\"by\":[" A ",0,0]}]}",
     1,
     {0.3}},
    {MESH ",\"units\":\"mesh\"", TWO("\"scale\":{\"factor\":2,\"about\":" A "}"), 3, {0.1, 1, 0.4}},
    {MESH, TWO("\"twist\":{\"axis\":\"z\",\"degrees\":" A "}"), 1, {80}},
    {BOX ",\"units\":\"box\"", TWO("\"by\":" A), 3, {0.3, -0.2, 0.1}},
    {BOX ",\"units\":\"box\"", TWO("\"to\":" A), 3, {0.3, -0.2, 0.1}},
    {BOX ",\"units\":\"box\"", TWO("\"scale\":{\"factor\":2,\"about\":" A "}"), 3, {0.1, 1, 0.4}},
    {BOX ",\"units\":\"box\"",
     TWO("\"matrix\":[1,0,0,0.1,0,{\"$\":\"A\"},0,0,0,0.2,1,{\"$\":\"A\"},0,0,0,1]"),
     1,
     {1.3}},
    {BOX ",\"units\":\"box\"",
     TWO("\"pull\":{\"point\":" A ",\"by\":[0.3,0.1,0],\"radius\":0.8}"),
     3,
     {0.2, 0.4, 0.6}},
    {BOX ",\"units\":\"box\"",
     TWO("\"falloff\":{\"axis\":" A ",\"from\":0.1,\"to\":0.9},\"by\":[1,0,0]"),
     3,
     {0.3, -0.2, 1}},
    {ARCS, "{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":" A ",\"exact\":true}}", 1, {100}},
    {ARCS, "{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":" A ",\"exact\":true}}", 1, {0.01}},
    {ARCS,
     "{\"scale\":{\"factor\":[1,1," A
     "]}},{\"bend\":{\"axis\":\"z\",\"toward\":\"x\",\"degrees\":80,\"exact\":true}}",
     1,
     {1.2}},
};

/* Builds the lattice with one component of the value increased by `by`. */
static ffd_lattice *built(const sample *s, size_t component, double by, bool derives)
{
    static const fit_extent extent = {{-1, 0.5, -1}, {1, 2, 3}, {-0.9, 0.6, -1}, {1, 2, 2.5}};
    double value[3];
    char text[4096], set[200];
    bool used = false;
    lattice_spec *spec;
    ffd_lattice *lattice = NULL;
    ffd_error error = {0};
    memcpy(value, s->value, sizeof value);
    value[component] += by;
    const int size = snprintf(
        text, sizeof text, "{\"format\":\"ffd-lattice\",\"version\":1,%s,\"moves\":[%s]}", s->rest, s->moves);
    if (s->size == 1)
        snprintf(set, sizeof set, "%.17g", value[0]);
    else
        snprintf(set, sizeof set, "[%.17g,%.17g,%.17g]", value[0], value[1], value[2]);
    const ffd_setting setting = {"A", set};
    const spec_settings settings = {.values = &setting, .used = &used, .count = 1, .derives = derives};
    if (ffd_spec_parse(text, (size_t)size, "t", &settings, &spec, &error) ||
        ffd_spec_build(spec, &extent, &lattice, &error))
        fail_msg("%s %s: %s", error.pointer, error.message, s->moves);
    return lattice;
}

static double weight_of(const ffd_lattice *lattice, size_t point)
{
    return lattice->deformed_weights ? lattice->deformed_weights[point] : 1;
}

/* Returns the largest derivative. Compares with (8 (f(h) - f(-h)) - (f(2h) - f(-2h))) / 12h. */
static double check_component(const sample *s, const ffd_lattice *lattice, const lattice_tangents *tangents,
                              size_t c)
{
    const double h = 1e-3 * fmax(fabs(s->value[c]), 0.3);
    ffd_lattice *near[2] = {built(s, c, h, false), built(s, c, -h, false)};
    ffd_lattice *far[2] = {built(s, c, 2 * h, false), built(s, c, -2 * h, false)};
    double largest = 0;
    for (size_t i = 0; i < 3 * lattice->count; i++) {
        const double difference = (8 * (near[0]->deformed[i] - near[1]->deformed[i]) -
                                   (far[0]->deformed[i] - far[1]->deformed[i])) /
                                  (12 * h);
        const double found = tangents->points[c * 3 * lattice->count + i];
        largest = fmax(largest, fabs(found));
        if (!(fabs(found - difference) <= 3e-9 * (1 + fabs(difference))))
            fail_msg("%s: component %zu, number %zu: %.17g instead of %.17g", s->moves, c, i, found,
                     difference);
    }
    for (size_t i = 0; i < lattice->count; i++) {
        const double difference = (8 * (weight_of(near[0], i) - weight_of(near[1], i)) -
                                   (weight_of(far[0], i) - weight_of(far[1], i))) /
                                  (12 * h);
        const double found = tangents->weights ? tangents->weights[c * lattice->count + i] : 0;
        if (!(fabs(found - difference) <= 3e-9))
            fail_msg("%s: weight %zu: %.17g instead of %.17g", s->moves, i, found, difference);
    }
    for (int i = 0; i < 2; i++) {
        ffd_lattice_destroy(&near[i]);
        ffd_lattice_destroy(&far[i]);
    }
    return largest;
}

static void tangents_are_what_differences_say(void **state)
{
    for (size_t i = 0; i < sizeof samples / sizeof *samples; i++) {
        ffd_lattice *lattice = built(&samples[i], 0, 0, true);
        lattice_tangents tangents;
        ffd_error error;
        if (ffd_lattice_tangents_find(lattice, &tangents, &error))
            fail_msg("%s", error.message);
        assert_int_equal(tangents.columns, samples[i].size);
        double largest = 0;
        for (size_t c = 0; c < samples[i].size; c++)
            largest = fmax(largest, check_component(&samples[i], lattice, &tangents, c));
        if (!(largest > 0))
            fail_msg("%s: nothing follows", samples[i].moves);
        ffd_lattice_tangents_free(&tangents);
        ffd_lattice_destroy(&lattice);
    }
    (void)state;
}

static void refuse(const char *moves, const char *value, const char *pointer)
{
    char text[1024];
    bool used = false;
    lattice_spec *spec;
    ffd_error error = {0};
    const int size = snprintf(text, sizeof text,
                              "{\"format\":\"ffd-lattice\",\"version\":1," BOX ",\"moves\":[%s]}", moves);
    const ffd_setting setting = {"A", value};
    const spec_settings settings = {.values = &setting, .used = &used, .count = 1, .derives = true};
    assert_int_equal(ffd_spec_parse(text, (size_t)size, "t", &settings, &spec, &error), FFD_E_INVALID);
    assert_string_equal(error.pointer, pointer);
    assert_non_null(strstr(error.message, "derivative"));
}

static void what_is_no_number_has_no_derivative(void **state)
{
    refuse("{\"rotate\":{\"axis\":{\"$\":\"A\"},\"degrees\":3}}", "\"x\"", "/moves/0/rotate/axis");
    refuse("{\"at\":[{\"$\":\"A\"},0,0],\"by\":[1,0,0]}", "1", "/moves/0/at/0");
    refuse("{\"within\":{\"min\":{\"$\":\"A\"},\"max\":[9,9,9]},\"by\":[1,0,0]}", "[0,0,0]",
           "/moves/0/within/min");
    refuse("{\"$\":\"A\"}", "{\"by\":[1,0,0]}", "/moves/0");
    (void)state;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tangents_are_what_differences_say),
        cmocka_unit_test(what_is_no_number_has_no_derivative),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
