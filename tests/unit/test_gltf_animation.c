/* test_gltf_animation.c - animations of glTF: listing, refusals, values between keys, poses. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/gltf_file.h"
#include "../support/gltf_text.h"
#include "io/gltf/model/gltf_pose.h"
#include <math.h>

#define H 0.70710678118654752440f /* sine of 45 degrees */
#define NEAR 1e-6                 /* of float32 */

/* The data of the accessors below, with the index of the first float of each. */
static const struct {
    float times[3];          /* 0 */
    float translations[9];   /* 3 */
    float turns[12];         /* 12: about z by 0, 90 and 180 degrees; the last one has the opposite sign */
    float spline[27];        /* 24: in-tangent, value, out-tangent */
    float weights[6];        /* 51: of two morph targets */
    float falling_times[3];  /* 57 */
    float infinite_times[3]; /* 60 */
    float broken_translations[9]; /* 63 */
    float four_times[4];          /* 72 */
    unsigned char tail[20];       /* 76 */
} data = {
    .times = {0, 1, 3},
    .translations = {0, 0, 0, 2, 4, 6, 2, 8, 0},
    .turns = {0, 0, 0, 1, 0, 0, H, H, 0, 0, -1, 0},
    /* x = t^3 - 2t + 1; y = t^2, from 1 on 2 - t; z = 2t. The outermost tangents are unused. */
    .spline = {99, 99, 99, 1, 0, 0, -2, 0, 2, 1, 2, 2, 0, 1, 2, 1, -1, 2, 25, -1, 2, 22, -1, 6, 99, 99, 99},
    .weights = {0, 1, 1, 0, 0.5f, 0.25f},
    .falling_times = {0, 2, 1},
    .infinite_times = {0, INFINITY, 3},
    .broken_translations = {0, 0, 0, 0, NAN, 0, 0, 0, 0},
    .four_times = {0, 1, 1, 2},
    /* Sparse indices 0 and 2. From byte 4 on, normalized shorts 32767, 0, 0, 0 and 0, 0, 16384, -32768. */
    .tail = {2, 0, 0, 0, 0xff, 0x7f, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x40, 0, 0x80},
};

#define ACCESSOR(at, count, type)                                                                            \
    "{\"bufferView\":0,\"byteOffset\":" #at ",\"componentType\":5126,\"count\":" #count ",\"type\":\"" type  \
    "\"}"
#define NEXT(at, count, type) "," ACCESSOR(at, count, type)
#define NORMALIZED(at, count)                                                                                \
    ",{\"bufferView\":0,\"byteOffset\":" #at ",\"componentType\":5122,\"normalized\":true,\"count\":" #count \
    ",\"type\":\"VEC4\"}"
/* Zeros, with the second translation as the last element. */
#define SPARSE                                                                                               \
    ",{\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"sparse\":{\"count\":1,"                        \
    "\"indices\":{\"bufferView\":0,\"byteOffset\":304,\"componentType\":5121},"                              \
    "\"values\":{\"bufferView\":0,\"byteOffset\":24}}}"
/* Accessors 0 to 13; 9 is NORMALIZED, 10 is SPARSE. */
#define ACCESSORS                                                                                            \
    ACCESSOR(0, 3, "SCALAR")                                                                                 \
    NEXT(12, 3, "VEC3")                                                                                      \
    NEXT(48, 3, "VEC4")                                                                                      \
    NEXT(96, 9, "VEC3")                                                                                      \
    NEXT(204, 6, "SCALAR")                                                                                   \
    NEXT(228, 3, "SCALAR")                                                                                   \
    NEXT(240, 3, "SCALAR")                                                                                   \
    NEXT(252, 3, "VEC3")                                                                                     \
    NEXT(288, 4, "SCALAR")                                                                                   \
    NORMALIZED(308, 2) SPARSE NEXT(0, 0, "SCALAR") NEXT(0, 1, "MAT4") NEXT(4, 2, "SCALAR")

#define MESH                                                                                                 \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":1},\"targets\":[{\"POSITION\":1},"           \
    "{\"POSITION\":10}]}],\"weights\":[0.5,0.25]}]"
#define NODES                                                                                                \
    "\"nodes\":[{\"children\":[1,2]},{\"mesh\":0,\"translation\":[2,0,0]},"                                  \
    "{\"matrix\":[0,2,0,0,-2,0,0,0,0,0,2,0,5,6,7,1]},{\"mesh\":0,\"weights\":[1,2]}]"

/* Makes a file with these animations. Free it with free(), after closing the document. */
static char *file_with(const char *animations)
{
    char members[16000];
    assert_in_range(snprintf(members, sizeof members,
                             "\"accessors\":[" ACCESSORS "]," MESH "," NODES ",\"animations\":[%s]",
                             animations),
                    1, sizeof members - 1);
    return gltf_text(&data, sizeof data, members);
}

static gltf_document *open_text(const char *text)
{
    mesh_document *document = NULL;
    ffd_error error = {0};
    if (open_bytes(text, strlen(text), "t.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &document, &error))
        fail_msg("%s", error.message);
    return (gltf_document *)document;
}

#define CHANNEL(sampler, node, path)                                                                         \
    "{\"sampler\":" #sampler ",\"target\":{\"node\":" #node ",\"path\":\"" path "\"}}"
#define SAMPLER(input, output, interpolation)                                                                \
    "{\"input\":" #input ",\"output\":" #output ",\"interpolation\":\"" interpolation "\"}"
#define POINTER(sampler, pointer)                                                                            \
    "{\"sampler\":" #sampler ",\"target\":{\"path\":\"pointer\",\"extensions\":{\"KHR_animation_pointer\":"  \
    "{\"pointer\":" pointer "}}}}"
#define ANIMATION(samplers, channels) "{\"samplers\":[" samplers "],\"channels\":[" channels "]}"

#define NEXT_CHANNEL(sampler, node, path) "," CHANNEL(sampler, node, path)
#define NEXT_POINTER(pointer) "," POINTER(0, pointer)
#define SAMPLERS SAMPLER(0, 1, "STEP") ",{\"input\":0,\"output\":99}"
#define CHANNELS                                                                                             \
    CHANNEL(0, 1, "translation")                                                                             \
    NEXT_CHANNEL(1, 7, "scale")                                                                              \
    NEXT_POINTER("\"/nodes/2/scale\"")                                                                       \
    NEXT_POINTER("\"/materials/0/alphaCutoff\"")                                                             \
    NEXT_POINTER("\"/nodes/9/scale\"") NEXT_POINTER("3") NEXT_CHANNEL(5, 1, "size") ",7,{}"

static void channels_say_where_they_come_from(void **state)
{
    (void)state;
    char *const text =
        file_with("{\"name\":\"W\\u00e4lk\",\"samplers\":[" SAMPLERS "],\"channels\":[" CHANNELS "]}");
    gltf_document *const d = open_text(text);
    gltf_animations list;
    const uint64_t before = d->base.budget.taken;
    assert_int_equal(ffd_gltf_list_animations(d, &list, NULL), FFD_OK);
    assert_int_equal(list.count, 1);
    const gltf_animation *const a = list.list;
    assert_string_equal(a->name, "W\xc3\xa4lk");
    assert_int_equal(a->sampler_count, 2);
    assert_int_equal(a->samplers[0].input, 0);
    assert_int_equal(a->samplers[0].output, 1);
    assert_int_equal(a->samplers[0].interpolation, GLTF_STEP);
    assert_int_equal(a->samplers[1].output, GLTF_NONE);
    assert_int_equal(a->samplers[1].interpolation, GLTF_LINEAR);
    assert_int_equal(a->channel_count, 9);
    static const struct {
        size_t sampler, node;
        gltf_path path;
        const char *pointer, *fault;
    } expected[] = {
        {0, 1, GLTF_TRANSLATION, NULL, NULL},
        {1, GLTF_NONE, GLTF_NO_PATH, NULL, "/animations/0/channels/1/target/node"},
        {0, 2, GLTF_SCALE, "/nodes/2/scale", NULL},
        {0, GLTF_NONE, GLTF_NO_PATH, "/materials/0/alphaCutoff", NULL},
        {0, GLTF_NONE, GLTF_NO_PATH, "/nodes/9/scale",
         "/animations/0/channels/4/target/extensions/KHR_animation_pointer/pointer"},
        {0, GLTF_NONE, GLTF_NO_PATH, NULL,
         "/animations/0/channels/5/target/extensions/KHR_animation_pointer/pointer"},
        {GLTF_NONE, GLTF_NONE, GLTF_NO_PATH, NULL, "/animations/0/channels/6/target/path"},
        {GLTF_NONE, GLTF_NONE, GLTF_NO_PATH, NULL, "/animations/0/channels/7"},
        {GLTF_NONE, GLTF_NONE, GLTF_NO_PATH, NULL, "/animations/0/channels/8"},
    };
    for (size_t c = 0; c < a->channel_count; c++) {
        const gltf_channel *const channel = &a->channels[c];
        char place[200] = "";
        if (channel->fault != JSON_NONE)
            ffd_json_tree_pointer(&d->tree, channel->fault, place, sizeof place);
        assert_int_equal(channel->sampler, expected[c].sampler);
        assert_int_equal(channel->node, expected[c].node);
        assert_int_equal(channel->path, expected[c].path);
        assert_string_equal(channel->pointer ? channel->pointer : "",
                            expected[c].pointer ? expected[c].pointer : "");
        assert_string_equal(place, expected[c].fault ? expected[c].fault : "");
    }
    assert_int_equal(a->pointer_count, 2);
    ffd_gltf_free_animations(d, &list);
    assert_int_equal(d->base.budget.taken, before);
    gltf->close(&d->base);
    free(text);
}

/* Loads the animation of a file that has exactly one. */
static ffd_status load(const char *animations, char **text, gltf_document **d, gltf_animations *list,
                       ffd_error *error)
{
    *text = file_with(animations);
    *d = open_text(*text);
    assert_int_equal(ffd_gltf_list_animations(*d, list, error), FFD_OK);
    assert_int_equal(list->count, 1);
    return ffd_gltf_load_animation(*d, list->list, error);
}

static void unload(char *text, gltf_document *d, gltf_animations *list)
{
    ffd_gltf_free_animations(d, list);
    gltf->close(&d->base);
    free(text);
}

static void check_refused(const char *animation, const char *message)
{
    char *text, line[1024];
    gltf_document *d;
    gltf_animations list;
    ffd_error error = {0};
    const ffd_status status = load(animation, &text, &d, &list, &error);
    ffd_error_format(&error, line, sizeof line);
    assert_string_equal(line, message);
    assert_int_equal(status, FFD_E_INVALID);
    assert_int_equal(list.list->taken, 0);
    assert_null(list.list->samplers[0].times);
    unload(text, d, &list);
}

static void broken_samplers_are_refused_when_they_are_wanted(void **state)
{
    (void)state;
    check_refused(ANIMATION(SAMPLER(0, 1, "LINEAR"), CHANNEL(1, 1, "scale")),
                  "t.gltf:1: /animations/0/channels/0/sampler: the channel's sampler is none of the 1");
    check_refused(ANIMATION("{\"output\":1}", CHANNEL(0, 1, "scale")),
                  "t.gltf:1: /animations/0/samplers/0: the sampler's input is none of the 14 accessors");
    check_refused(
        ANIMATION("{\"input\":0,\"output\":1.5}", CHANNEL(0, 1, "scale")),
        "t.gltf:1: /animations/0/samplers/0/output: the sampler's output is none of the 14 accessors");
}

static void broken_keys_are_refused_when_they_are_wanted(void **state)
{
    (void)state;
    static const struct {
        int input, output;
        const char *interpolation;
        int node;
        const char *path, *message; /* of the error, below the sampler */
    } cases[] = {
        {1, 1, "LINEAR", 1, "scale", "input: accessor 1 does not hold times (SCALAR of floats)"},
        {11, 1, "LINEAR", 1, "scale", "input: accessor 11 has no times"},
        {0, 1, "SPLINE", 1, "scale",
         "interpolation: an interpolation is \"STEP\", \"LINEAR\" or \"CUBICSPLINE\""},
        {0, 12, "LINEAR", 1, "scale",
         "output: accessor 12 does not hold values of an animation (SCALAR, VEC3 or VEC4 of floats or of "
         "normalized integers)"},
        {8, 1, "LINEAR", 1, "scale", "output: accessor 1 has 3 elements for 4 times, not 1 each"},
        {0, 1, "CUBICSPLINE", 1, "scale", "output: accessor 1 has 3 elements for 3 times, not 3 each"},
        {8, 4, "LINEAR", 1, "weights",
         "output: accessor 4 has 6 elements for 4 times, not 1 or a multiple of it each"},
        {0, 11, "LINEAR", 1, "weights", "output: accessor 11 has no elements"},
        {0, 2, "LINEAR", 1, "scale", "output: accessor 2 is not a VEC3, for a scale"},
        {0, 1, "LINEAR", 1, "rotation", "output: accessor 1 is not a VEC4, for a rotation"},
        {0, 1, "LINEAR", 1, "weights", "output: accessor 1 is not a SCALAR, for weights"},
        {5, 1, "LINEAR", 1, "scale", "input: time 2 of accessor 5, 1, is before the one before it, 2"},
        {6, 1, "LINEAR", 1, "scale", "input: time 1 of accessor 6 is not finite"},
        {0, 7, "LINEAR", 1, "scale", "output: element 1 of accessor 7 is not finite"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char animation[400], message[400];
        snprintf(animation, sizeof animation,
                 "{\"samplers\":[{\"input\":%d,\"output\":%d,\"interpolation\":\"%s\"}],\"channels\":"
                 "[{\"sampler\":0,\"target\":{\"node\":%d,\"path\":\"%s\"}}]}",
                 cases[i].input, cases[i].output, cases[i].interpolation, cases[i].node, cases[i].path);
        snprintf(message, sizeof message, "t.gltf:1: /animations/0/samplers/0/%s", cases[i].message);
        check_refused(animation, message);
    }
}

static void what_drives_no_node_is_not_checked(void **state)
{
    (void)state;
    char *text;
    gltf_document *d;
    gltf_animations list;
    /* Weights of no morph target, and of another number than the two of node 1. */
    assert_int_equal(
        load(
            ANIMATION(
                SAMPLER(5, 7, "LINEAR") "," SAMPLER(8, 4, "X") "," SAMPLER(5, 0, "LINEAR"),
                CHANNEL(0, 9, "scale") "," POINTER(1, "\"/materials/0/alphaCutoff\"") "," CHANNEL(
                    1, 0,
                    "weights") "," POINTER(0,
                                           "\"/nodes/0/weights\"") "," CHANNEL(2, 1,
                                                                               "weights") "," POINTER(2,
                                                                                                      "\"/"
                                                                                                      "nodes/"
                                                                                                      "1/"
                                                                                                      "weight"
                                                                                                      "s\"")),
            &text, &d, &list, NULL),
        FFD_OK);
    assert_true(list.list->begin == 0 && list.list->end == 0);
    unload(text, d, &list);
}

/* Checks the value at a time, in a file with a single animation of this single sampler. */
static void check_value(const char *sampler, const char *channel, double time, size_t count,
                        const double *expected)
{
    char *text, animation[400];
    gltf_document *d;
    gltf_animations list;
    double value[4];
    snprintf(animation, sizeof animation, "{\"samplers\":[%s],\"channels\":[%s]}", sampler, channel);
    assert_int_equal(load(animation, &text, &d, &list, NULL), FFD_OK);
    assert_int_equal(list.list->samplers[0].width, count);
    ffd_gltf_sample(list.list->samplers, list.list->channels[0].path == GLTF_ROTATION, time, value);
    for (size_t i = 0; i < count; i++)
        if (!(fabs(value[i] - expected[i]) <= NEAR))
            fail_msg("%s at %g: number %zu is %.9g, not %.9g", sampler, time, i, value[i], expected[i]);
    unload(text, d, &list);
}

static void values_between_keys_follow_the_interpolation(void **state)
{
    (void)state;
    const char *const move = CHANNEL(0, 1, "translation"), *const weigh = CHANNEL(0, 1, "weights");
    check_value(SAMPLER(0, 1, "LINEAR"), move, 0.25, 3, (const double[]){0.5, 1, 1.5});
    check_value(SAMPLER(0, 1, "LINEAR"), move, 2.5, 3, (const double[]){2, 7, 1.5});
    check_value(SAMPLER(0, 1, "LINEAR"), move, -1, 3, (const double[]){0, 0, 0});
    check_value(SAMPLER(0, 1, "LINEAR"), move, 4, 3, (const double[]){2, 8, 0});
    check_value(SAMPLER(0, 1, "STEP"), move, 0.999, 3, (const double[]){0, 0, 0});
    check_value(SAMPLER(0, 1, "STEP"), move, 1, 3, (const double[]){2, 4, 6});
    check_value(SAMPLER(0, 1, "STEP"), move, 3, 3, (const double[]){2, 8, 0});
    check_value(SAMPLER(0, 4, "LINEAR"), weigh, 2, 2, (const double[]){0.75, 0.125});
    check_value(SAMPLER(0, 10, "LINEAR"), move, 2, 3, (const double[]){1, 2, 3}); /* sparse */
    for (double t = 0; t <= 3; t += 0.25)
        check_value(SAMPLER(0, 3, "CUBICSPLINE"), move, t, 3,
                    (const double[]){t * t * t - 2 * t + 1,
                                     t < 1   ? t * t
                                     : t < 3 ? 2 - t
                                             : -1,
                                     2 * t});
    check_value(SAMPLER(0, 3, "CUBICSPLINE"), move, -5, 3, (const double[]){1, 0, 0});
    check_value(SAMPLER(0, 3, "CUBICSPLINE"), move, 5, 3, (const double[]){22, -1, 6});
}

static void rotations_take_the_shorter_arc(void **state)
{
    (void)state;
    const char *const turn = CHANNEL(0, 1, "rotation");
    for (double t = 0; t <= 3; t += 0.25) {
        const double half = (t < 1 ? 90 * t : 45 + 45 * t) / 2 * acos(-1) / 180, sign = t < 3 ? 1 : -1;
        check_value(SAMPLER(0, 2, "LINEAR"), turn, t, 4,
                    (const double[]){0, 0, sign * sin(half), sign * cos(half)});
    }
    /* Normalized shorts: -32768 is -1. */
    check_value(SAMPLER(13, 9, "STEP"), turn, 9, 4, (const double[]){0, 0, 16384 / 32767.0, -1});
    check_value(SAMPLER(13, 9, "STEP"), turn, 1, 4, (const double[]){1, 0, 0, 0});
    double q[4];
    const double a[4] = {0, 0, 0, 1}, b[4] = {0, 0, 1e-9, 1};
    ffd_gltf_slerp(a, b, 0.5, q); /* an angle whose sine underflows */
    assert_true(q[2] == 0.5e-9 && q[3] == 1);
}

static void turns_of_splines_are_normalized(void **state)
{
    (void)state;
    double times[] = {0, 2}, value[4];
    double values[24] = {[7] = 1, [18] = 1}; /* no turn, then a half turn about z; tangents are 0 */
    const gltf_animation_sampler sampler = {
        .interpolation = GLTF_CUBICSPLINE, .key_count = 2, .width = 4, .times = times, .values = values};
    ffd_gltf_sample(&sampler, true, 1, value);
    assert_true(fabs(value[2] - sqrt(0.5)) < 1e-15 && fabs(value[3] - sqrt(0.5)) < 1e-15);
    ffd_gltf_sample(&sampler, false, 1, value);
    assert_true(value[2] == 0.5 && value[3] == 0.5);
}

static void of_two_keys_at_one_time_the_last_one_counts(void **state)
{
    (void)state;
    double times[] = {0, 1, 1, 2}, values[] = {0, 2, 10, 20}, value;
    const gltf_animation_sampler sampler = {
        .interpolation = GLTF_LINEAR, .key_count = 4, .width = 1, .times = times, .values = values};
    ffd_gltf_sample(&sampler, false, 0.5, &value);
    assert_true(value == 1);
    ffd_gltf_sample(&sampler, false, 1, &value);
    assert_true(value == 10);
    ffd_gltf_sample(&sampler, false, 1.5, &value);
    assert_true(value == 15);
}

static void assert_place(const double *world, double x, double y, double z)
{
    if (!(fabs(world[9] - x) <= NEAR && fabs(world[10] - y) <= NEAR && fabs(world[11] - z) <= NEAR))
        fail_msg("the node is at %g %g %g, not %g %g %g", world[9], world[10], world[11], x, y, z);
}

static void a_pose_has_all_nodes_and_weights(void **state)
{
    (void)state;
    char *text;
    gltf_document *d;
    gltf_animations list;
    gltf_pose pose;
    assert_int_equal(
        load(ANIMATION(SAMPLER(0, 2, "LINEAR") "," SAMPLER(0, 4, "LINEAR") "," SAMPLER(0, 1, "LINEAR"),
                       CHANNEL(0, 0, "rotation") "," CHANNEL(1, 1, "weights") "," CHANNEL(
                           2, 2, "translation") "," CHANNEL(0, 9, "scale")),
             &text, &d, &list, NULL),
        FFD_OK);
    assert_true(list.list->begin == 0 && list.list->end == 3);
    assert_int_equal(ffd_gltf_make_pose(d, &pose, NULL), FFD_OK);
    assert_memory_equal(pose.world, d->world, 4 * 12 * sizeof(double));
    assert_int_equal(pose.first_weight[4], 4);
    assert_true(pose.weights[0] == 0.5 && pose.weights[1] == 0.25); /* of the mesh */
    assert_true(pose.weights[2] == 1 && pose.weights[3] == 2);      /* of the node */
    ffd_gltf_set_pose(d, list.list, 1, &pose);
    assert_place(pose.world + 12, 0, 2, 0);
    assert_place(pose.world + 24, -4, 2, 6);
    /* Scaled by 2 and turned by 90 degrees about z: once by the matrix, and once more. */
    static const double linear[9] = {-2, 0, 0, 0, -2, 0, 0, 0, 2};
    for (int i = 0; i < 9; i++)
        assert_true(fabs(pose.world[24 + i] - linear[i]) <= NEAR);
    assert_true(pose.weights[0] == 1 && pose.weights[1] == 0);
    assert_true(pose.weights[2] == 1 && pose.weights[3] == 2);
    ffd_gltf_set_pose(d, NULL, 1, &pose);
    assert_memory_equal(pose.world, d->world, 4 * 12 * sizeof(double));
    ffd_gltf_free_pose(&pose);
    unload(text, d, &list);
}

static void memory_that_runs_out_is_said(void **state)
{
    (void)state;
    char *const text = file_with("{\"name\":\"a\",\"samplers\":[" SAMPLER(
        0, 1, "LINEAR") "],\"channels\":[" CHANNEL(0, 1, "scale") "," POINTER(0, "\"/nodes/2/scale\"") "]}");
    gltf_document *const d = open_text(text);
    ffd_status status = FFD_E_MEMORY;
    for (long successes = 0; status == FFD_E_MEMORY; successes++) {
        gltf_animations list;
        gltf_pose pose = {0};
        const uint64_t before = d->base.budget.taken;
        ffd_alloc_fail_after(successes);
        status = ffd_gltf_list_animations(d, &list, NULL);
        if (status == FFD_OK)
            status = ffd_gltf_load_animation(d, list.list, NULL);
        if (status == FFD_OK)
            status = ffd_gltf_make_pose(d, &pose, NULL);
        ffd_alloc_fail_after(-1);
        ffd_gltf_free_pose(&pose);
        ffd_gltf_free_animations(d, &list);
        if (status == FFD_OK)
            assert_int_equal(d->base.budget.taken, before);
        assert_true(successes < 100);
    }
    assert_int_equal(status, FFD_OK);
    gltf->close(&d->base);
    free(text);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(channels_say_where_they_come_from),
        cmocka_unit_test(broken_samplers_are_refused_when_they_are_wanted),
        cmocka_unit_test(broken_keys_are_refused_when_they_are_wanted),
        cmocka_unit_test(what_drives_no_node_is_not_checked),
        cmocka_unit_test(values_between_keys_follow_the_interpolation),
        cmocka_unit_test(rotations_take_the_shorter_arc),
        cmocka_unit_test(turns_of_splines_are_normalized),
        cmocka_unit_test(of_two_keys_at_one_time_the_last_one_counts),
        cmocka_unit_test(a_pose_has_all_nodes_and_weights),
        cmocka_unit_test(memory_that_runs_out_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
