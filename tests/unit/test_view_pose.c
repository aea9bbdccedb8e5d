/* test_view_pose.c - positions of vertices at a time of an animation: skins, nodes, morph targets, before and
   after. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/gltf_file.h"
#include "../support/gltf_text.h"
#include "view/view_pose.h"
#include <math.h>

#define H 0.70710678118654752440f
#define NEAR 2e-7

/* An upper arm that moves up by 4 in 2 seconds, and a lower arm at (1, 0, 0) that turns about z from 0 to 90
   degrees. Its default pose, 90 degrees, is not that of the inverse bind matrices. The upper arm carries a
   mesh without skin, scaled by 2, with a morph target whose weight goes from 0 to 1. */
static const struct {         /* with the index of the first float of each */
    float positions[12];      /* 0 */
    float inverse_binds[32];  /* 12 */
    float weights[16];        /* 44 */
    float offsets[12];        /* 60 */
    float times[2];           /* 72 */
    float translations[6];    /* 74 */
    float turns[8];           /* 80 */
    float target_weights[2];  /* 88 */
    unsigned char joints[16]; /* 90 */
} data = {
    .positions = {0, 0, 0, 1, 0, 0, 2, 0, 0, 1, 1, 0},
    .inverse_binds = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, 0, 1,
                      1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1},
    .weights = {1, 0, 0, 0, 1, 1, 0, 0, 3, 0, 0, 0, 0, 0, 0, 0},
    .offsets = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1},
    .times = {0, 2},
    .translations = {0, 0, 0, 0, 0, 4},
    .turns = {0, 0, 0, 1, 0, 0, H, H},
    .target_weights = {0, 1},
    /* The last vertex, whose weights are all 0, follows its first joint. */
    .joints = {0, 1, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0},
};

#define ACCESSOR(at, count, type)                                                                            \
    "{\"bufferView\":0,\"byteOffset\":" #at ",\"componentType\":5126,\"count\":" #count ",\"type\":\"" type  \
    "\"}"
#define SAMPLER(output) "{\"input\":4,\"output\":" #output "}"
#define CHANNEL(sampler, node, path)                                                                         \
    "{\"sampler\":" #sampler ",\"target\":{\"node\":" #node ",\"path\":\"" path "\"}}"

#define NEXT(at, count, type) "," ACCESSOR(at, count, type)
#define ACCESSORS                                                                                            \
    ACCESSOR(0, 4, "VEC3")                                                                                   \
    NEXT(48, 2, "MAT4")                                                                                      \
    NEXT(176, 4, "VEC4")                                                                                     \
    NEXT(240, 4, "VEC3")                                                                                     \
    NEXT(288, 2, "SCALAR") NEXT(296, 2, "VEC3") NEXT(320, 2, "VEC4") NEXT(352, 2, "SCALAR")
#define JOINTS ",{\"bufferView\":0,\"byteOffset\":360,\"componentType\":5121,\"count\":4,\"type\":\"VEC4\"}"
#define MESHES                                                                                               \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":8,\"WEIGHTS_0\":2}}]},"       \
    "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":3}]}]}]"
#define NODES                                                                                                \
    "\"nodes\":[{\"mesh\":0,\"skin\":0},{\"children\":[2,3],\"translation\":[0,0,7]},"                       \
    "{\"translation\":[1,0,0],\"rotation\":[0,0,0.70710678118654752,0.70710678118654752]},"                  \
    "{\"mesh\":1,\"translation\":[0,5,0],\"scale\":[2,2,2]},{\"children\":[]}]"
#define SKINS "\"skins\":[{\"joints\":[1,2],\"inverseBindMatrices\":1}]"
#define NEXT_SAMPLER(output) "," SAMPLER(output)
#define NEXT_CHANNEL(sampler, node, path) "," CHANNEL(sampler, node, path)
#define SAMPLERS SAMPLER(5) NEXT_SAMPLER(6) NEXT_SAMPLER(7)
#define CHANNELS                                                                                             \
    CHANNEL(0, 1, "translation")                                                                             \
    NEXT_CHANNEL(1, 2, "rotation") NEXT_CHANNEL(2, 3, "weights") NEXT_CHANNEL(0, 4, "translation")

static char *make_text(void)
{
    return gltf_text(&data, sizeof data,
                     "\"accessors\":[" ACCESSORS JOINTS "]," MESHES "," NODES "," SKINS
                     ",\"animations\":[{\"samplers\":[" SAMPLERS "],\"channels\":[" CHANNELS "]}]");
}

typedef struct fixture {
    char *text;
    mesh_document *document;
    view_scene scene;
} fixture;

static void open_fixture(fixture *f)
{
    mesh_skeleton *skeleton = NULL;
    f->text = make_text();
    f->scene = (view_scene){0};
    assert_int_equal(
        open_bytes(f->text, strlen(f->text), "t.gltf", FFD_FORMAT_GLTF, FFD_SPACE_SCENE, &f->document, NULL),
        FFD_OK);
    assert_int_equal(gltf->rig->read_skeleton(f->document, false, &skeleton, NULL), FFD_OK);
    assert_int_equal(skeleton->animation_count, 1);
    assert_int_equal(skeleton->load(skeleton, 0, NULL), FFD_OK);
    f->scene.rigs[0].skeleton = f->scene.rigs[1].skeleton = skeleton;
    f->scene.animations = ffd_alloc_zero(1, sizeof *f->scene.animations);
    f->scene.animation_count = 1;
    f->scene.vertex_count = skeleton->vertex_count;
}

static void close_fixture(fixture *f)
{
    ffd_view_scene_free(&f->scene);
    gltf->close(f->document);
    free(f->text);
}

/* Checks the eight vertices at a time; those of the skin come first. */
static void check_pose(const fixture *f, int side, double time, const double expected[8][3])
{
    double *found;
    assert_int_equal(ffd_view_pose(&f->scene, side, 0, time, &found, NULL), FFD_OK);
    for (size_t i = 0; i < 24; i++)
        if (!(fabs(found[i] - expected[i / 3][i % 3]) <= NEAR * 8))
            fail_msg("side %d at %g: coordinate %zu of vertex %zu is %.9g, not %.9g", side, time, i % 3,
                     i / 3, found[i], expected[i / 3][i % 3]);
    ffd_free(found);
}

static void vertices_follow_their_joints_and_nodes(void **state)
{
    (void)state;
    fixture f;
    open_fixture(&f);
    const mesh_skeleton *const s = f.scene.rigs[0].skeleton;
    assert_int_equal(s->vertex_count, 8);
    assert_int_equal(s->node_count, 3); /* the first node represents the skin; the last one moves nothing */
    assert_int_equal(gltf->rig->read_anchors(s, MESH_STORED, false, &f.scene.rigs[0].anchors, NULL), FFD_OK);
    assert_int_equal(f.scene.rigs[0].anchors.target_count, 1);
    const double h = sqrt(0.5), c = cos(acos(-1) / 8), d = sin(acos(-1) / 8);
    check_pose(&f, 0, 0,
               (const double[8][3]){
                   {0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}, {0, 5, 0}, {2, 5, 0}, {4, 5, 0}, {2, 7, 0}});
    check_pose(
        &f, 0, 1,
        (const double[8][3]){
            {0, 0, 2}, {1, 0, 2}, {1 + h, h, 2}, {1 - h, h, 2}, {0, 5, 3}, {2, 5, 3}, {4, 5, 3}, {2, 7, 3}});
    check_pose(&f, 0, 0.5,
               (const double[8][3]){{0, 0, 1},
                                    {1, 0, 1},
                                    {1 + c, d, 1},
                                    {1 - d, c, 1},
                                    {0, 5, 1.5},
                                    {2, 5, 1.5},
                                    {4, 5, 1.5},
                                    {2, 7, 1.5}});
    close_fixture(&f);
}

static void a_deformed_mesh_moves_as_its_file_would(void **state)
{
    (void)state;
    fixture f;
    open_fixture(&f);
    const mesh_skeleton *const s = f.scene.rigs[0].skeleton;
    assert_int_equal(deform(f.document, add_one, false, NULL), FFD_OK); /* x in the file's own space */
    assert_int_equal(gltf->rig->read_anchors(s, MESH_STORED, true, &f.scene.rigs[1].anchors, NULL), FFD_OK);
    assert_false(f.scene.rigs[1].anchors.keeps_offsets);
    const double h = sqrt(0.5);
    check_pose(&f, 1, 1,
               (const double[8][3]){{1, 0, 2},
                                    {1.5 + h / 2, h / 2, 2},
                                    {1 + 2 * h, 2 * h, 2},
                                    {1, 2 * h, 2},
                                    {2, 5, 3},
                                    {4, 5, 3},
                                    {6, 5, 3},
                                    {4, 7, 3}});
    close_fixture(&f);
}

static void without_its_animation_a_side_stands_still(void **state)
{
    (void)state;
    fixture f;
    double *found;
    open_fixture(&f);
    double rest[24] = {0};
    rest[23] = 7;
    f.scene.after = rest;
    f.scene.animations[0].of[1] = RIG_NONE;
    assert_int_equal(ffd_view_pose(&f.scene, 1, 0, 1, &found, NULL), FFD_OK);
    assert_memory_equal(found, rest, sizeof rest);
    ffd_free(found);
    f.scene.after = NULL;
    close_fixture(&f);
}

static void memory_that_runs_out_is_said(void **state)
{
    (void)state;
    fixture f;
    open_fixture(&f);
    ffd_status status = FFD_E_MEMORY;
    const uint64_t before = f.document->budget.taken;
    for (long successes = 0; status == FFD_E_MEMORY; successes++) {
        mesh_skeleton *skeleton = NULL;
        view_scene scene = {0};
        double *positions = NULL;
        ffd_alloc_fail_after(successes);
        status = gltf->rig->read_skeleton(f.document, false, &skeleton, NULL);
        scene.rigs[0].skeleton = skeleton;
        if (!status)
            status = skeleton->load(skeleton, 0, NULL);
        if (!status)
            status = gltf->rig->read_anchors(skeleton, MESH_STORED, false, &scene.rigs[0].anchors, NULL);
        scene.animations = f.scene.animations;
        scene.vertex_count = 8;
        if (!status)
            status = ffd_view_pose(&scene, 0, 0, 1, &positions, NULL);
        ffd_alloc_fail_after(-1);
        ffd_free(positions);
        scene.animations = NULL;
        ffd_view_scene_free(&scene);
        assert_int_equal(f.document->budget.taken, before);
        assert_true(successes < 200);
    }
    assert_int_equal(status, FFD_OK);
    close_fixture(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(vertices_follow_their_joints_and_nodes),
        cmocka_unit_test(a_deformed_mesh_moves_as_its_file_would),
        cmocka_unit_test(without_its_animation_a_side_stands_still),
        cmocka_unit_test(memory_that_runs_out_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
