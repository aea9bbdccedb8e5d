/* The lattice file: its content, refusals and their messages, and that writing and reading round-trip. */
#include "base/memory/memory.h"
#include "lattice/file/spec_text.h"
#include "lattice/lattice.h"
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "../support/message.h"
#include "../support/repetitions.h"
#include "../support/test_folder.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))
#define HEAD "{\"format\":\"ffd-lattice\",\"version\":1,"
#define SIZE HEAD "\"size\":[2,2,2],"
#define UNIT "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1]}}"
#define BOX SIZE UNIT
#define EIGHT "[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0,0,1],[1,0,1],[0,1,1],[1,1,1]"
#define CYLINDER(text) SIZE "\"rest\":{\"cylinder\":{" text "}}}"
#define MOVE(text) BOX ",\"moves\":[" text "]}"

static ffd_status parse(const char *text, ffd_lattice **lattice, ffd_error *error)
{
    return ffd_lattice_parse(text, strlen(text), "f.json", lattice, error);
}

/* A file that uses every part of the format. */
static const char rich[] = HEAD "\"size\":[4,5,3],\"degree\":[3,2,1],"
                                "\"knots\":[[0,0,0,0,1,1,1,1],{\"closed\":[0,1,2,3.5,4,5]},\"unclamped\"],"
                                "\"rest\":{\"cylinder\":{\"center\":[1,2,3],\"axis\":[1,2,2],\"zero\":[1,0,0]"
                                ",\"radius\":[0.5,2],\"height\":7,"
                                "\"angle\":[-90,270]}},"
                                "\"weights\":[1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,"
                                "1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,"
                                "1,1,1,1,1,1,1,1,1,1,1,2],"
                                "\"units\":\"box\","
                                "\"moves\":[{\"by\":[0.1,0.2,-0.3]},{\"at\":[-1,[1,-2],\"all\"],\"weight\":0."
                                "3,\"rotate\":{\"axis\":[1,1,1],"
                                "\"degrees\":33,\"about\":[0.1,0.2,0.3]}},{\"within\":{\"min\":[0,0,0],"
                                "\"max\":[1,1,0.5]},\"twist\":{\"axis\":\"y\","
                                "\"degrees\":-45}},{\"taper\":{\"axis\":\"z\",\"factor\":0.7}},{\"bend\":{"
                                "\"axis\":\"x\",\"toward\":[1,1,0],"
                                "\"degrees\":20}},{\"scale\":{\"factor\":[1,2,3]}},{\"at\":[0,0,0],\"to\":[0."
                                "5,0.5,0.5]},{\"matrix\":[1,0,0,0.1,0,1,"
                                "0,0,0,0,1,0,0,0,0,1]}]}";

/* Likewise for moves that depend on the rest position, or need a special rest volume. */
static const char soft[] = HEAD
    "\"size\":[2,2,5],\"degree\":[1,1,2],\"knots\":[\"clamped\",\"clamped\",[0,0,0,1,1,2,2,2]],"
    "\"rest\":{\"box\":{\"min\":[0,0,-1],\"max\":[1,2,4]}},\"units\":\"box\",\"moves\":["
    "{\"at\":[\"all\",\"all\",[2,4]],\"mirror\":\"z\",\"bend\":{\"axis\":\"z\",\"toward\":\"x\","
    "\"degrees\":33,\"about\":[0.5,0.5,0.5],\"exact\":true}},"
    "{\"falloff\":{\"axis\":[0,2,0],\"from\":1,\"to\":0.25},\"mirror\":\"y\",\"pull\":{\"point\":[0.5,0.5,"
    "1],\"by\":[0,0,0.1],\"radius\":0.7}},"
    "{\"falloff\":{\"center\":[0,0,0],\"radius\":2},\"mirror\":\"x\",\"weight\":0.5,\"rotate\":{\"axis\":"
    "\"z\",\"degrees\":5}}]}";

/* All forms shown in data/schema/lattice.md. */
static void every_documented_form_is_accepted(void **state)
{
    (void)state;
    static const char *const texts[] = {
        HEAD "\"size\":[4,4,4],\"degree\":[3,3,3],\"knots\":[\"clamped\",\"clamped\",\"clamped\"],\"rest\":{"
             "\"box\":{"
             "\"min\":[0,0,0],\"max\":[1,2,3],\"spacing\":\"greville\",\"axes\":[[1,0,0],[0,1,0],[0,0,1]]}}}",
        HEAD "\"size\":[4,4,4],\"rest\":{\"box\":\"mesh\",\"margin\":0.05}}",
        HEAD "\"size\":[4,4,4],\"rest\":{\"box\":\"mesh\"}}",
        HEAD "\"size\":[2,6,2],\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":[0,0,1],\"zero\":[1,0,0],"
             "\"radius\":"
             "[0.5,1],\"height\":2,\"angle\":[0,360]}}}",
        HEAD "\"size\":[2,6,2],\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":[0,0,1],\"radius\":[0,1],"
             "\"height\":2,"
             "\"angle\":[10,100]}}}",
        SIZE "\"rest\":{\"points\":[" EIGHT "]}}",
        SIZE "\"rest\":{\"points\":[" EIGHT
             "]},\"weights\":[1,2,1,1,1,1,1,0.5],\"deformed\":{\"points\":[" EIGHT
             "],\"weights\":[1,1,1,1,1,1,1,3]},\"units\":\"world\",\"moves\":[]}",
        HEAD "\"size\":[3,3,3],\"degree\":[1,2,2],\"knots\":[\"unclamped\",\"periodic\",[0,0,0,1,1,1]],"
             "\"rest\":{\"points\":["
             "[1,0,0],[2,0,0],[3,0,0],[-1,1,0],[-2,2,0],[-3,3,0],[-1,-1,0],[-2,-2,0],[-3,-3,0],"
             "[1,0,1],[2,0,1],[3,0,1],[-1,1,1],[-2,2,1],[-3,3,1],[-1,-1,1],[-2,-2,1],[-3,-3,1],"
             "[1,0,2],[2,0,2],[3,0,2],[-1,1,2],[-2,2,2],[-3,3,2],[-1,-1,2],[-2,-2,2],[-3,-3,2]]}}",
        HEAD "\"size\":[3,3,3],\"knots\":[\"uniform\",\"open\",[0,0,0,1,1,1]]," UNIT "}",
        "\xef\xbb\xbf" BOX "}",
        BOX ",\"deformed\":{}}",
        HEAD "\"size\":[2.0,2e0,2]," UNIT "}",
        SIZE "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[100000000000000000000000,1,1]}}}",
        rich,
        soft,
    };
    for (size_t i = 0; i < COUNT(texts); i++) {
        ffd_lattice *lattice;
        ffd_error error;
        if (parse(texts[i], &lattice, &error))
            fail_msg("%s\n%s", message_of(&error), texts[i]);
        ffd_lattice_destroy(&lattice);
    }
}

static void omitted_values_have_their_defaults(void **state)
{
    (void)state;
    ffd_lattice *l;
    ffd_error error;
    size_t size[3];
    int degree[3];
    assert_int_equal(parse(HEAD "\"size\":[2,3,9]," UNIT "}", &l, &error), FFD_OK);
    ffd_lattice_get_size(l, size);
    ffd_lattice_get_degree(l, degree);
    assert_true(size[0] == 2 && size[1] == 3 && size[2] == 9);
    assert_true(degree[0] == 1 && degree[1] == 2 && degree[2] == 3);
    assert_true(l->knots[2].kind == KNOTS_CLAMPED);
    ffd_lattice_destroy(&l);

    /* A full turn closes v unless knots are given; a partial turn does not. */
    static const struct turn {
        const char *text;
        knot_kind kind;
    } turns[] = {
        {"\"angle\":[0,360]}}}", KNOTS_CLOSED},
        {"\"angle\":[33.3,393.3]}}}", KNOTS_CLOSED},
        {"\"angle\":[0,359]}}}", KNOTS_CLAMPED},
        {"\"angle\":[0,360]}},\"knots\":[\"clamped\",\"clamped\",\"clamped\"]}", KNOTS_CLAMPED},
        {"\"angle\":[0,360]}},\"knots\":[\"clamped\",\"open\",\"clamped\"]}", KNOTS_OPEN},
        {"\"angle\":[0,360]}},\"knots\":[\"clamped\",\"closed\",\"clamped\"]}", KNOTS_CLOSED},
    };
    for (size_t i = 0; i < COUNT(turns); i++) {
        char text[1024];
        snprintf(
            text, sizeof text,
            HEAD
            "\"size\":[2,8,2],\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[1,2],"
            "\"height\":1,%s",
            turns[i].text);
        assert_int_equal(parse(text, &l, &error), FFD_OK);
        assert_int_equal(l->knots[1].kind, turns[i].kind);
        ffd_lattice_destroy(&l);
    }
    /* The default of zero: the coordinate axis least along axis, made perpendicular. */
    assert_int_equal(
        parse(CYLINDER("\"center\":[0,0,0],\"axis\":[3,0,4],\"radius\":[1,2],\"height\":1,\"angle\":[0,90]"),
              &l, &error),
        FFD_OK);
    assert_true(l->spec->zero[0] == 0 && l->spec->zero[1] == 1 && l->spec->zero[2] == 0);
    ffd_lattice_destroy(&l);
    assert_int_equal(
        parse(CYLINDER("\"center\":[0,0,0],\"axis\":[1,2,2],\"radius\":[1,2],\"height\":1,\"angle\":[0,90]"),
              &l, &error),
        FFD_OK);
    assert_true(fabs(l->spec->zero[0] - 8 / sqrt(72)) <= 1e-15 &&
                fabs(l->spec->zero[1] + 2 / sqrt(72)) <= 1e-15);
    ffd_lattice_destroy(&l);
}

typedef struct refusal {
    const char *text;
    ffd_status status;
    const char *words;
} refusal;

static void check_refusals(const refusal *refusals, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        ffd_lattice *lattice = (ffd_lattice *)&lattice;
        ffd_error error;
        const ffd_status status = parse(refusals[i].text, &lattice, &error);
        if (status != refusals[i].status || error.status != status || lattice ||
            strcmp(message_of(&error), refusals[i].words) != 0)
            fail_msg("%s\nstatus %d, %s\nexpected %d, %s", refusals[i].text, status,
                     status ? message_of(&error) : "", refusals[i].status, refusals[i].words);
        /* Without an error record the status is the same. */
        assert_int_equal(parse(refusals[i].text, &lattice, NULL), status);
    }
}

static void invalid_json_is_refused_with_its_line(void **state)
{
    (void)state;
    static const refusal refusals[] = {
        {"", FFD_E_INVALID,
         "f.json:1: not valid JSON: a value is expected, found the end of the text (column 1)"},
        {"\xef\xbb\xbf", FFD_E_INVALID,
         "f.json:1: not valid JSON: a value is expected, found the end of the text (column 1)"},
        {"{\n\"size\": [1,\n2,]}", FFD_E_INVALID, "f.json:3: not valid JSON: one comma too many (column 2)"},
        {"{\n\"a\":1,\n\n\"a\":2}", FFD_E_INVALID,
         "f.json:4: /a: not valid JSON: duplicate key \"a\" in an object (column 1)"},
        {"{\"a\": 1e999}", FFD_E_INVALID,
         "f.json:1: not valid JSON: the number 1e999 is too large (column 7)"},
        {"{\"a\": NaN}", FFD_E_INVALID, "f.json:1: not valid JSON: JSON has no NaN (column 7)"},
        {"{} x", FFD_E_INVALID,
         "f.json:1: not valid JSON: nothing may follow the value, found 'x' (column 4)"},
        {"[1]", FFD_E_INVALID, "f.json:1: a lattice is an object, not an array of 1"},
    };
    check_refusals(refusals, COUNT(refusals));
    /* Unlimited depth is refused by the reader, and does not overflow the stack. */
    char *deep = malloc(1000001);
    memset(deep, '[', 1000000);
    deep[1000000] = 0;
    ffd_lattice *lattice;
    ffd_error error;
    assert_int_equal(parse(deep, &lattice, &error), FFD_E_INVALID);
    assert_int_equal(error.line, 1);
    free(deep);
}

static void bad_versions_sizes_degrees_and_weights_are_refused(void **state)
{
    (void)state;
    static const refusal refusals[] = {
        {"{}", FFD_E_INVALID, "f.json:1: \"format\" is missing"},
        {"{\"format\":\"ffd-latice\"}", FFD_E_INVALID,
         "f.json:1: /format: unknown word \"ffd-latice\"; the nearest known one is \"ffd-lattice\""},
        {"{\"format\":7}", FFD_E_INVALID,
         "f.json:1: /format: must be a word like \"ffd-lattice\", not the number 7"},
        {"{\"format\":\"ffd-lattice\"}", FFD_E_INVALID, "f.json:1: \"version\" is missing"},
        {"{\"format\":\"ffd-lattice\",\"version\":2,\"news\":1}", FFD_E_UNSUPPORTED,
         "f.json:1: /version: version 2 is newer than 1, the newest known here"},
        /* In a later version, what is a placeholder now may mean something else. */
        {"{\"format\":\"ffd-lattice\",\"moves\":[{\"$\":\"A\"}],\"version\":2}", FFD_E_UNSUPPORTED,
         "f.json:1: /version: version 2 is newer than 1, the newest known here"},
        {"{\"format\":\"ffd-lattice\",\"version\":0}", FFD_E_INVALID,
         "f.json:1: /version: version 0 does not exist; the only version is 1"},
        {"{\"format\":\"ffd-lattice\",\"version\":\"1\"}", FFD_E_INVALID,
         "f.json:1: /version: must be a whole number, not the text \"1\""},
        {HEAD "\"sise\":[2,2,2]," UNIT "}", FFD_E_INVALID,
         "f.json:1: /sise: unknown key \"sise\"; the nearest known one is \"size\""},
        {HEAD "\"a/b~c\":1}", FFD_E_INVALID,
         "f.json:1: /a~1b~0c: unknown key \"a/b~c\"; known ones are \"format\", \"version\", \"size\", "
         "\"degree\", \"knots\", \"rest\", \"weights\", "
         "\"deformed\", \"units\", \"moves\", \"parameters\", \"keys\", \"comment\", \"name\""},
        {HEAD UNIT "}", FFD_E_INVALID, "f.json:1: \"size\" is missing"},
        {HEAD "\"size\":[2,2,2]}", FFD_E_INVALID, "f.json:1: \"rest\" is missing"},
        {HEAD "\"size\":4," UNIT "}", FFD_E_INVALID,
         "f.json:1: /size: must be an array of 3 sizes, not the number 4"},
        {HEAD "\"size\":[2,2]," UNIT "}", FFD_E_INVALID,
         "f.json:1: /size: must be an array of 3 sizes, not an array of 2"},
        {HEAD "\"size\":[2,1,2]," UNIT "}", FFD_E_INVALID,
         "f.json:1: /size/1: is 1, but a direction has at least 2 control points: a plane needs two layers "
         "that move alike: \"size\": [5, 5, 2], \"degree\": [3, 3, 1], and \"at\": [i, j, \"all\"]"},
        {HEAD "\"size\":[2,2.5,2]," UNIT "}", FFD_E_INVALID,
         "f.json:1: /size/1: must be a whole number, not the number 2.5"},
        {HEAD "\"size\":[2,true,2]," UNIT "}", FFD_E_INVALID,
         "f.json:1: /size/1: must be a whole number, not true"},
        {HEAD "\"size\":[1000,1000,1000]," UNIT "}", FFD_E_LIMIT,
         "f.json:1: /size/2: size 1000 makes more than 67108864 control points"},
        {HEAD "\"size\":[9007199254740992,9007199254740992,9007199254740992]," UNIT "}", FFD_E_LIMIT,
         "f.json:1: /size/0: size 9007199254740992 makes more than 67108864 control points"},
        {HEAD "\"size\":[1e300,2,2]," UNIT "}", FFD_E_INVALID,
         "f.json:1: /size/0: must be a whole number, not the number 1e+300"},
        {BOX ",\"degree\":[1,0,1]}", FFD_E_INVALID,
         "f.json:1: /degree/1: degree 0 is not between 1 and 14: degree 1 between two layers that move alike "
         "does the same"},
        {BOX ",\"degree\":[1,1,15]}", FFD_E_INVALID,
         "f.json:1: /degree/2: degree 15 is not between 1 and 14: as many control points of a lower degree "
         "each move a smaller part"},
        {BOX ",\"degree\":[2,1,1]}", FFD_E_INVALID,
         "f.json:1: /degree/0: degree 2 needs at least 3 control points, not 2"},
        {BOX ",\"degree\":[1,1]}", FFD_E_INVALID,
         "f.json:1: /degree: must be an array of 3 degrees, not an array of 2"},
        {BOX ",\"units\":\"boxes\"}", FFD_E_INVALID,
         "f.json:1: /units: unknown word \"boxes\"; the nearest known one is \"box\""},
        {BOX ",\"weights\":[1,1]}", FFD_E_INVALID,
         "f.json:1: /weights: must be an array of 8 weights, not an array of 2"},
        {BOX ",\"weights\":[1,1,1,0,1,1,1,1]}", FFD_E_INVALID,
         "f.json:1: /weights/3: weight 0 is not positive"},
        {BOX ",\"weights\":[1,1,1,1,-2.5,1,1,1]}", FFD_E_INVALID,
         "f.json:1: /weights/4: weight -2.5 is not positive"},
        {BOX ",\"weights\":null}", FFD_E_INVALID,
         "f.json:1: /weights: must be an array of 8 weights, not null"},
        {BOX ",\"deformed\":[]}", FFD_E_INVALID, "f.json:1: /deformed: must be an object, not an array of 0"},
        {BOX ",\"deformed\":{\"point\":[]}}", FFD_E_INVALID,
         "f.json:1: /deformed/point: unknown key \"point\"; the nearest known one is \"points\""},
        {BOX ",\"deformed\":{\"points\":[[0,0,0]]}}", FFD_E_INVALID,
         "f.json:1: /deformed/points: must be an array of 8 points, not an array of 1"},
        {BOX ",\"deformed\":{\"weights\":[1,1,1,1,1,1,1,-1]}}", FFD_E_INVALID,
         "f.json:1: /deformed/weights/7: weight -1 is not positive"},
    };
    check_refusals(refusals, COUNT(refusals));
}

static void bad_knots_are_refused(void **state)
{
    (void)state;
    static const refusal refusals[] = {
        {BOX ",\"knots\":\"clamped\"}", FFD_E_INVALID,
         "f.json:1: /knots: must be an array of 3 knot vectors, not the text \"clamped\""},
        {BOX ",\"knots\":[\"clamped\",\"clamp\",\"clamped\"]}", FFD_E_INVALID,
         "f.json:1: /knots/1: unknown word \"clamp\"; the nearest known one is \"clamped\""},
        {BOX ",\"knots\":[\"clamped\",\"closed\",\"clamped\"]}", FFD_E_INVALID,
         "f.json:1: /knots/1: direction v of a box cannot be closed: its points do not form a ring"},
        {BOX ",\"knots\":[{\"closed\":[0,1,2]},\"open\",\"clamped\"]}", FFD_E_INVALID,
         "f.json:1: /knots/0: direction u of a box cannot be closed: its points do not form a ring"},
        {BOX ",\"knots\":[{\"closd\":[0,1,2]},\"open\",\"clamped\"]}", FFD_E_INVALID,
         "f.json:1: /knots/0/closd: unknown key \"closd\"; the nearest known one is \"closed\""},
        {BOX ",\"knots\":[[0,0,1],\"open\",\"clamped\"]}", FFD_E_INVALID,
         "f.json:1: /knots/0: must be an array of 4 knots, not an array of 3"},
        {BOX ",\"knots\":[[0,0,\"1\",1],\"open\",\"clamped\"]}", FFD_E_INVALID,
         "f.json:1: /knots/0/2: must be a number, not the text \"1\""},
        {BOX ",\"knots\":[\"open\",\"open\",[0,0,1,0.5]]}", FFD_E_INVALID,
         "f.json:1: /knots/2: direction w: knot 3 is 0.5, less than knot 2, 1"},
        {BOX ",\"knots\":[\"open\",\"open\",[0,1,1,2]]}", FFD_E_INVALID,
         "f.json:1: /knots/2: direction w: the domain is empty, knot 1 and knot 2 are both 1"},
        {HEAD "\"size\":[2,3,2],\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[0,1],"
              "\"height\":1,"
              "\"angle\":[0,90]}},\"knots\":[\"open\",\"closed\",\"open\"]}",
         FFD_E_INVALID,
         "f.json:1: /knots/1: a cylinder from 0 to 90 degrees cannot be closed: it is not a full turn"},
        {HEAD "\"size\":[2,3,2],\"rest\":{\"cylinder\":{\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[0,1],"
              "\"height\":1}},"
              "\"knots\":[\"closed\",\"closed\",\"open\"]}",
         FFD_E_INVALID, "f.json:1: /knots/0: direction u of a cylinder cannot be closed, only v can"},
        {SIZE "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1],\"spacing\":\"uniform\"}},\"knots\":["
              "\"clamped\",\"open\","
              "\"clamped\"]}",
         FFD_E_INVALID,
         "f.json:1: /rest/box/spacing: uniform spacing needs clamped knots, which direction v does not have"},
        {SIZE "\"rest\":{\"points\":[" EIGHT "]},\"knots\":[{\"closed\":[0,1]},\"open\",\"clamped\"]}",
         FFD_E_INVALID, "f.json:1: /knots/0/closed: must be an array of 3 breakpoints, not an array of 2"},
    };
    check_refusals(refusals, COUNT(refusals));
}

static void bad_rest_volumes_are_refused(void **state)
{
    (void)state;
    static const refusal refusals[] = {
        {SIZE "\"rest\":[]}", FFD_E_INVALID, "f.json:1: /rest: must be an object, not an array of 0"},
        {SIZE "\"rest\":{}}", FFD_E_INVALID,
         "f.json:1: /rest: needs exactly one of \"box\", \"cylinder\", \"points\""},
        {SIZE "\"rest\":{\"box\":\"mesh\",\"points\":[]}}", FFD_E_INVALID,
         "f.json:1: /rest: needs exactly one of \"box\", \"cylinder\", \"points\""},
        {SIZE "\"rest\":{\"bocks\":{}}}", FFD_E_INVALID,
         "f.json:1: /rest/bocks: unknown key \"bocks\"; known ones are \"box\", \"cylinder\", \"points\", "
         "\"margin\", \"comment\", \"name\""},
        {SIZE "\"rest\":{\"box\":\"mseh\"}}", FFD_E_INVALID,
         "f.json:1: /rest/box: unknown word \"mseh\"; the nearest known one is \"mesh\""},
        {SIZE "\"rest\":{\"box\":\"mesh\",\"margin\":-0.1}}", FFD_E_INVALID,
         "f.json:1: /rest/margin: margin -0.1 is less than 0"},
        {SIZE "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1]},\"margin\":0.1}}", FFD_E_INVALID,
         "f.json:1: /rest/margin: a margin goes only with a box round meshes"},
        {SIZE "\"rest\":{\"box\":{\"max\":[1,1,1]}}}", FFD_E_INVALID,
         "f.json:1: /rest/box: \"min\" is missing"},
        {SIZE "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1]}}}", FFD_E_INVALID,
         "f.json:1: /rest/box/max: must be an array of 3 numbers, not an array of 2"},
        {SIZE "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,null,1]}}}", FFD_E_INVALID,
         "f.json:1: /rest/box/max/1: must be a number, not null"},
        {SIZE "\"rest\":{\"box\":{\"min\":[0,2,0],\"max\":[1,2,1]}}}", FFD_E_INVALID,
         "f.json:1: /rest/box: max 2 of direction v is not more than min 2"},
        {SIZE "\"rest\":{\"box\":{\"min\":[-1e308,0,0],\"max\":[1e308,1,1]}}}", FFD_E_INVALID,
         "f.json:1: /rest/box: the side from -1e+308 to 1e+308 is too large for a double"},
        {SIZE "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1],\"spacing\":\"even\"}}}", FFD_E_INVALID,
         "f.json:1: /rest/box/spacing: unknown word \"even\"; known ones are \"greville\", \"uniform\""},
        {SIZE "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1],\"axes\":[[1,0,0],[0,2,0],[0,0,1]]}}}",
         FFD_E_INVALID, "f.json:1: /rest/box/axes: axis 1 has the length 2, not 1"},
        {SIZE "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1],\"axes\":[[1,0,0],[0.6,0.8,0],[0,0,1]]}}}",
         FFD_E_INVALID,
         "f.json:1: /rest/box/axes: axes 0 and 1 are not perpendicular: their dot product is 0.6"},
        {SIZE "\"rest\":{\"box\":{\"min\":[0,0,0],\"max\":[1,1,1],\"axes\":[[1,0,0],[0,1,0]]}}}",
         FFD_E_INVALID, "f.json:1: /rest/box/axes: must be an array of 3 axes, not an array of 2"},
        {SIZE "\"rest\":{\"points\":[[0,0,0]]}}", FFD_E_INVALID,
         "f.json:1: /rest/points: must be an array of 8 points, not an array of 1"},
        {SIZE "\"rest\":{\"points\":[[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0,0,1],[1,0],[0,1,1],[1,1,1]]}}",
         FFD_E_INVALID, "f.json:1: /rest/points/5: must be an array of 3 numbers, not an array of 2"},
        {CYLINDER("\"axis\":\"z\",\"radius\":[0,1],\"height\":1"), FFD_E_INVALID,
         "f.json:1: /rest/cylinder: \"center\" is missing"},
        {CYLINDER("\"center\":[0,0,0],\"axis\":\"w\",\"radius\":[0,1],\"height\":1"), FFD_E_INVALID,
         "f.json:1: /rest/cylinder/axis: unknown word \"w\"; known ones are \"x\", \"y\", \"z\""},
        {CYLINDER("\"center\":[0,0,0],\"axis\":[0,0,0],\"radius\":[0,1],\"height\":1"), FFD_E_INVALID,
         "f.json:1: /rest/cylinder/axis: must not be 0 0 0: that is not a direction"},
        {CYLINDER("\"center\":[0,0,0],\"axis\":\"z\",\"zero\":[0,0,5],\"radius\":[0,1],\"height\":1"),
         FFD_E_INVALID, "f.json:1: /rest/cylinder/zero: is parallel to the axis, which it must not be"},
        {CYLINDER("\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[1,1],\"height\":1"), FFD_E_INVALID,
         "f.json:1: /rest/cylinder/radius: radii 1 and 1 are not 0 <= r0 < r1"},
        {CYLINDER("\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[-1,1],\"height\":1"), FFD_E_INVALID,
         "f.json:1: /rest/cylinder/radius: radii -1 and 1 are not 0 <= r0 < r1"},
        {CYLINDER("\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[0,1],\"height\":0"), FFD_E_INVALID,
         "f.json:1: /rest/cylinder/height: height 0 is not more than 0"},
        {CYLINDER("\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[0,1],\"height\":1,\"angle\":[0,361]"),
         FFD_E_INVALID,
         "f.json:1: /rest/cylinder/angle: 0 to 361 degrees is not an angle of more than 0, at most 360"},
        {CYLINDER("\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[0,1],\"height\":1,\"angle\":[90,90]"),
         FFD_E_INVALID,
         "f.json:1: /rest/cylinder/angle: 90 to 90 degrees is not an angle of more than 0, at most 360"},
        {CYLINDER("\"center\":[0,0,0],\"axis\":\"z\",\"radius\":[0,1],\"heigth\":1"), FFD_E_INVALID,
         "f.json:1: /rest/cylinder/heigth: unknown key \"heigth\"; the nearest known one is \"height\""},
    };
    check_refusals(refusals, COUNT(refusals));
}

static const refusal bad_moves[] = {
    {BOX ",\"moves\":{}}", FFD_E_INVALID, "f.json:1: /moves: must be an array of moves, not an object"},
    {MOVE("7"), FFD_E_INVALID, "f.json:1: /moves/0: must be an object, not the number 7"},
    {MOVE("{}"), FFD_E_INVALID,
     "f.json:1: /moves/0: has no action: by, to, scale, rotate, matrix, twist, taper, bend, pull, "
     "drag or jitter"},
    {MOVE("{\"at\":[0,0,0],\"by\":[0,0,0],\"to\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0: has two actions, \"by\" and \"to\"; a move has one"},
    {MOVE("{\"by\":[0,0,1]},{\"att\":[0,0,0],\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/1/att: unknown key \"att\"; the nearest known one is \"at\""},
    {MOVE("{\"at\":[0,0,0],\"within\":{},\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0: has both \"at\" and \"within\"; a move selects its points by one of them"},
    {MOVE("{\"at\":[0,2,0],\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/at/1: index 2 is outside 0 to 1 (or -2 to -1)"},
    {MOVE("{\"at\":[0,0,-3],\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/at/2: index -3 is outside 0 to 1 (or -2 to -1)"},
    {MOVE("{\"at\":[[0,5],0,0],\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/at/0/1: index 5 is outside 0 to 1 (or -2 to -1)"},
    {MOVE("{\"at\":[[-1,0],0,0],\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/at/0: the range from 1 to 0 is empty"},
    {MOVE("{\"at\":[[0],0,0],\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/at/0: must be an array of 2 indices, not an array of 1"},
    {MOVE("{\"at\":[0.5,0,0],\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/at/0: must be a whole number, not the number 0.5"},
    {MOVE("{\"at\":[\"any\",0,0],\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/at/0: is the text \"any\", not an index (0, \"first\" or \"bottom\": the first "
     "layer; -1, \"last\" or \"top\": the last), a "
     "range "
     "[lo, hi] or \"all\""},
    {MOVE("{\"at\":[0,0],\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/at: must be an array of 3 selections, not an array of 2"},
    {MOVE("{\"within\":{\"min\":[0,0,0]},\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/within: \"max\" is missing"},
    {MOVE("{\"within\":{\"min\":[0,3,0],\"max\":[1,2,1]},\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/within: max 2 is less than min 3"},
    {MOVE("{\"weight\":1.5,\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/weight: weight 1.5 is not between 0 and 1"},
    {MOVE("{\"by\":[0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/by: must be an array of 3 numbers, not an array of 2"},
    {MOVE("{\"scale\":{\"about\":[0,0,0]}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/scale: \"factor\" is missing"},
    {MOVE("{\"scale\":{\"factor\":\"2\"}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/scale/factor: must be a number, not the text \"2\""},
    {MOVE("{\"rotate\":{\"axis\":\"z\",\"angle\":3}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/rotate/angle: unknown key \"angle\"; use \"degrees\""},
    {MOVE("{\"translation\":[0,0,1]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/translation: unknown key \"translation\"; use \"by\""},
    {MOVE("{\"rotation\":{}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/rotation: unknown key \"rotation\"; use \"rotate\""},
    {MOVE("{\"by\":[0,0,0],\"coment\":\"\"}"), FFD_E_INVALID,
     "f.json:1: /moves/0/coment: unknown key \"coment\"; the nearest known one is \"comment\""},
    {MOVE("{\"by\":[0,0,0],\"name\":null}"), FFD_E_INVALID,
     "f.json:1: /moves/0/name: must be a text, not null"},
    {MOVE("{\"by\":{\"$\":\"A\",\"comment\":7}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/by/comment: must be a text, not the number 7"},
    {MOVE("{\"by\":{\"$\":\"A\",\"comment\":\"\"}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/by: the placeholder \"A\" has no value (set A=VALUE)"},
    {MOVE("{\"by\":[0,0,0],\"comment\":{\"$\":\"A\"}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/comment: the placeholder \"A\" has no value (set A=VALUE)"},
    {MOVE("{\"rotate\":{\"axis\":\"z\"}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/rotate: \"degrees\" is missing"},
    {MOVE("{\"matrix\":[1,2,3]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/matrix: must be an array of 16 numbers, not an array of 3"},
    {MOVE("{\"matrix\":[1,0,0,0,0,1,0,0,0,0,1,0,5,0,0,1]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/matrix: the last row is 5 0 0 1, not 0 0 0 1"},
    {MOVE("{\"bend\":{\"axis\":\"x\",\"toward\":[-2,0,0],\"degrees\":3}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/bend/toward: is parallel to the axis, which it must not be"},
    {MOVE("{\"pull\":{\"point\":[0,0,0],\"by\":[0,0,1]}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/pull: \"radius\" is missing"},
    {MOVE("{\"pull\":{\"point\":[0,0,0],\"by\":[0,0,1],\"radius\":0}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/pull/radius: radius 0 is not more than 0"},
    {MOVE("{\"pull\":{\"center\":[0,0,0],\"by\":[0,0,1],\"radius\":1}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/pull/center: unknown key \"center\"; use \"point\""},
    {MOVE("{\"pull\":{\"point\":[0,0,0],\"by\":2,\"radius\":1}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/pull/by: must be an array of 3 numbers, not the number 2"},
    {MOVE("{\"pull\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/pull: must be an object, not an array of 3; write "
     "{\"pull\": {\"point\": [x, y, z], \"by\": [0,0,0], \"radius\": r}}"},
    {MOVE("{\"falloff\":{},\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/falloff: is empty; a falloff has axis, from and to, or center and radius"},
    {MOVE("{\"falloff\":{\"to\":1,\"radius\":1},\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/falloff: has both \"to\" and \"radius\"; a falloff has axis, from and to, or "
     "center "
     "and radius"},
    {MOVE("{\"falloff\":{\"axis\":\"x\",\"to\":1},\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/falloff: \"from\" is missing"},
    {MOVE("{\"falloff\":{\"axis\":\"x\",\"from\":1,\"to\":1},\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/falloff: from and to are both 1: there is nothing to fall off between"},
    {MOVE("{\"falloff\":{\"axis\":[0,0,0],\"from\":0,\"to\":1},\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/falloff/axis: must not be 0 0 0: that is not a direction"},
    {MOVE("{\"falloff\":{\"center\":[0,0,0],\"radius\":-1},\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/falloff/radius: radius -1 is not more than 0"},
    {MOVE("{\"falloff\":0.5,\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/falloff: must be an object, not the number 0.5"},
    {MOVE("{\"mirror\":\"u\",\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/mirror: unknown word \"u\"; known ones are \"x\", \"y\", \"z\""},
    {MOVE("{\"mirror\":[1,0,0],\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/mirror: must be \"x\", \"y\", \"z\", or a plane by axis and at, or point and "
     "normal, not an array of 3"},
    {MOVE("{\"reflect\":\"x\",\"by\":[0,0,0]}"), FFD_E_INVALID,
     "f.json:1: /moves/0/reflect: unknown key \"reflect\"; use \"mirror\""},
    {MOVE("{\"taper\":{\"axis\":\"x\",\"factor\":null}}"), FFD_E_INVALID,
     "f.json:1: /moves/0/taper/factor: must be a number, not null"},
    {SIZE "\"rest\":{\"points\":[[0,0,0],[1,0,0],[0,1,0],[1,1,0],[0,0,0],[1,0,0],[0,1,0],[1,1,0]]},"
          "\"units\":\"box\","
          "\"moves\":[{\"by\":[0,0,1]}]}",
     FFD_E_INVALID, "f.json:1: /units: the rest points lie in a plane: there is no box to take fractions of"},
};

static void bad_moves_are_refused(void **state)
{
    (void)state;
    check_refusals(bad_moves, COUNT(bad_moves));
}

static void check_same_points(const ffd_lattice *a, const ffd_lattice *b)
{
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->rest, b->rest, 3 * a->count * sizeof(double));
    assert_memory_equal(a->deformed, b->deformed, 3 * a->count * sizeof(double));
    assert_int_equal(a->rest_weights != NULL, b->rest_weights != NULL);
    if (a->rest_weights) {
        assert_memory_equal(a->rest_weights, b->rest_weights, a->count * sizeof(double));
        assert_memory_equal(a->deformed_weights, b->deformed_weights, a->count * sizeof(double));
    }
    for (int c = 0; c < 3; c++) {
        assert_int_equal(a->knots[c].functions, b->knots[c].functions);
        assert_memory_equal(a->knots[c].t, b->knots[c].t,
                            (a->knots[c].functions + (size_t)a->knots[c].degree + 1) * sizeof(double));
    }
}

/* parse(text(spec)) is exactly the same lattice, and its text is the same. */
static void written_text_reads_back_to_the_bit(void **state)
{
    (void)state;
    static const char *const texts[] = {
        rich,
        soft,
        BOX "}",
        HEAD "\"size\":[3,3,3],\"knots\":[\"uniform\",\"open\",[0,0,0,1,1,1]]," UNIT "}",
        SIZE "\"rest\":{\"box\":{\"min\":[-0.1,0,0],\"max\":[0.2,1e-7,3e22],\"spacing\":\"uniform\",\"axes\":"
             "[[0.6,0.8,0],"
             "[-0.8,0.6,0],[0,0,1]]}}}",
        SIZE "\"rest\":{\"points\":[" EIGHT
             "]},\"weights\":[1,2,1,1,1,1,1,0.5],\"deformed\":{\"points\":[" EIGHT
             "],\"weights\":[1,1,1,1,1,1,1,3]},\"units\":\"world\",\"moves\":[]}",
        SIZE "\"rest\":{\"cylinder\":{\"center\":[0.1,0.2,0.3],\"axis\":[0.3,-5,1.1],\"radius\":[0,0.7],"
             "\"height\":0.1,"
             "\"angle\":[12.5,100]}}}",
    };
    for (size_t i = 0; i < COUNT(texts); i++) {
        ffd_lattice *first, *second;
        ffd_error error;
        size_t size, size_again;
        assert_int_equal(parse(texts[i], &first, &error), FFD_OK);
        char *const text = ffd_spec_text(first->spec, &size);
        assert_non_null(text);
        if (ffd_lattice_parse(text, size, "again.json", &second, &error))
            fail_msg("%s\n%s", message_of(&error), text);
        check_same_points(first, second);
        char *const text_again = ffd_spec_text(second->spec, &size_again);
        assert_string_equal(text, text_again);
        assert_int_equal(size, strlen(text));
        assert_true(size == size_again && text[size - 1] == '\n');
        ffd_free(text);
        ffd_free(text_again);
        ffd_lattice_destroy(&first);
        ffd_lattice_destroy(&second);
    }
}

static void text_is_written_in_a_fixed_layout(void **state)
{
    (void)state;
    ffd_lattice *l;
    size_t size;
    assert_int_equal(
        parse(HEAD
              "\"size\":[4,4,4],\"rest\":{\"box\":\"mesh\",\"margin\":0.1},\"moves\":[{\"at\":[-1,\"all\",0],"
              "\"by\":[0.1,0,0],\"weight\":0.5}]}",
              &l, NULL),
        FFD_OK);
    char *const text = ffd_spec_text(l->spec, &size);
    assert_string_equal(text, "{\n"
                              "  \"format\": \"ffd-lattice\",\n"
                              "  \"version\": 1,\n"
                              "  \"size\": [4, 4, 4],\n"
                              "  \"degree\": [3, 3, 3],\n"
                              "  \"knots\": [\"clamped\", \"clamped\", \"clamped\"],\n"
                              "  \"rest\": {\n"
                              "    \"box\": \"mesh\",\n"
                              "    \"margin\": 0.1\n"
                              "  },\n"
                              "  \"moves\": [\n"
                              "    {\"at\": [3, [0, 3], 0], \"weight\": 0.5, \"by\": [0.1, 0, 0]}\n"
                              "  ]\n"
                              "}\n");
    ffd_free(text);
    ffd_lattice_destroy(&l);
}

/* The rest volume can be loaded without the values that the moves need. With all values the moves are
   applied. */
static void the_rest_needs_no_values(void **state)
{
    (void)state;
    const ffd_setting values[] = {{"A", "1"}, {"C", "1"}, {"B", "0.5"}};
    const char *const path = in_folder("values.json");
    put_text("values.json",
             MOVE("{\"by\":[{\"$\":\"A\",\"name\":\"a\"},0,0]},{\"by\":{\"$\":\"B\"},\"weight\":7}"));
    ffd_lattice *l;
    ffd_error error;
    bool used[3] = {false};
    assert_int_equal(ffd_lattice_load_rest(path, values, 2, used, &l, &error), FFD_OK);
    assert_true(used[0] && !used[1]);
    assert_memory_equal(l->rest, l->deformed, 3 * l->count * sizeof *l->rest);
    ffd_lattice_destroy(&l);
    assert_int_equal(ffd_lattice_load_set(path, values, 2, used, &l, &error), FFD_E_INVALID);
    assert_string_equal(error.pointer, "/moves/1/by");
    /* With all values, the moves are read and checked. */
    assert_int_equal(ffd_lattice_load_rest(path, values, 3, used, &l, &error), FFD_E_INVALID);
    assert_string_equal(error.pointer, "/moves/1/weight");
}

static void a_saved_file_loads_and_is_kept_unless_forced(void **state)
{
    (void)state;
    const char *const path = in_folder("saved.json");
    ffd_lattice *saved, *loaded;
    ffd_error error;
    assert_int_equal(parse(rich, &saved, &error), FFD_OK);
    assert_int_equal(ffd_lattice_save(saved, path, false, &error), FFD_OK);
    assert_int_equal(ffd_lattice_save(saved, path, false, &error), FFD_E_EXISTS);
    assert_int_equal(ffd_lattice_save(saved, path, true, &error), FFD_OK);
    assert_int_equal(ffd_lattice_load(path, &loaded, &error), FFD_OK);
    check_same_points(saved, loaded);
    ffd_lattice_destroy(&saved);
    ffd_lattice_destroy(&loaded);
    unlink(path);
    assert_int_equal(ffd_lattice_load(path, &loaded, &error), FFD_E_IO);
    assert_null(loaded);
    assert_string_equal(error.file, path);
}

/* Each allocation fails once: the status is right, and nothing leaks (checked by sanitizers). */
static void fail_each_allocation(const char *file, long least)
{
    long successes = 0;
    for (;; successes++) {
        ffd_lattice *lattice;
        ffd_error error;
        ffd_alloc_fail_after(successes);
        const ffd_status status = parse(file, &lattice, &error);
        ffd_alloc_fail_after(-1);
        if (!status) {
            ffd_lattice_destroy(&lattice);
            break;
        }
        assert_int_equal(status, FFD_E_MEMORY);
        assert_null(lattice);
        assert_string_equal(message_of(&error), "f.json: out of memory");
    }
    assert_true(successes > least);
}

static void every_failed_allocation_is_reported(void **state)
{
    (void)state;
    fail_each_allocation(rich, 15);
    fail_each_allocation(soft, 20);
    ffd_lattice *lattice;
    assert_int_equal(parse(rich, &lattice, NULL), FFD_OK);
    size_t size;
    ffd_alloc_fail_after(0);
    assert_null(ffd_spec_text(lattice->spec, &size));
    ffd_alloc_fail_after(-1);
    ffd_lattice_destroy(&lattice);
}

/* Any prefix of a file, and any file with one changed byte, is read or refused with a message. */
static void broken_text_is_read_or_refused_with_a_message(void **state)
{
    (void)state;
    char text[sizeof rich];
    for (size_t length = 0; length < sizeof rich - 1; length++) {
        ffd_lattice *lattice;
        ffd_error error;
        assert_int_equal(ffd_lattice_parse(rich, length, "f.json", &lattice, &error), FFD_E_INVALID);
        assert_true(error.line == 1);
    }
    static const char bytes[] = "0-9]}\",e[{\0\xff";
    for (size_t i = 0; i < sizeof rich - 1; i += (size_t)stride(7))
        for (size_t b = 0; b < sizeof bytes - 1; b++) {
            ffd_lattice *lattice;
            ffd_error error;
            memcpy(text, rich, sizeof rich);
            text[i] = bytes[b];
            const ffd_status status = ffd_lattice_parse(text, sizeof rich - 1, "f.json", &lattice, &error);
            assert_true((status == FFD_OK) == (lattice != NULL));
            assert_true(!status || (error.message[0] && strcmp(error.file, "f.json") == 0));
            ffd_lattice_destroy(&lattice);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_documented_form_is_accepted),
        cmocka_unit_test(omitted_values_have_their_defaults),
        cmocka_unit_test(invalid_json_is_refused_with_its_line),
        cmocka_unit_test(bad_versions_sizes_degrees_and_weights_are_refused),
        cmocka_unit_test(bad_knots_are_refused),
        cmocka_unit_test(bad_rest_volumes_are_refused),
        cmocka_unit_test(bad_moves_are_refused),
        cmocka_unit_test(written_text_reads_back_to_the_bit),
        cmocka_unit_test(text_is_written_in_a_fixed_layout),
        cmocka_unit_test(the_rest_needs_no_values),
        cmocka_unit_test(a_saved_file_loads_and_is_kept_unless_forced),
        cmocka_unit_test(every_failed_allocation_is_reported),
        cmocka_unit_test(broken_text_is_read_or_refused_with_a_message),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
