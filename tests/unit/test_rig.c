/* test_rig.c - --rig follow through the library: figures, failing memory, and jobs that share the mesh. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/job_description.h"
#include "../support/test_folder.h"
#include "base/file/input.h"
#include "base/memory/memory.h"
#include <ffd/job.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* A triangle with joints hip and knee, and another joint below the hip; all are animated. */
static const char scene[] =
    "{\"asset\": {\"version\": \"2.0\"}, \"scenes\": [{\"nodes\": [0, 1]}], \"nodes\": [{\"mesh\": 0, "
    "\"skin\":"
    " 0}, {\"name\": \"hip\", \"children\": [2, 3], \"translation\": [0.25, 0.25, 0]}, {\"name\": \"knee\","
    " \"translation\": [0.5, 0.25, 0]}, {\"name\": \"box\", \"mesh\": 1, \"translation\": [0.25, 0, 0.5]}"
    "], \"meshes\": [{\"primitives\": [{\"attributes\": {\"POSITION\": 0, \"JOINTS_0\": 1, \"WEIGHTS_0\": 2"
    "}}]}, {\"primitives\": [{\"attributes\": {\"POSITION\": 0}}]}], \"skins\": [{\"joints\": [1, 2]}], \""
    "animations\": [{\"samplers\": [{\"input\": 3, \"output\": 4}, {\"input\": 3, \"output\": 5}], \"channe"
    "ls\": [{\"sampler\": 0, \"target\": {\"node\": 1, \"path\": \"rotation\"}}, {\"sampler\": 0, "
    "\"target\": "
    "{\"node\": 2, \"path\": \"rotation\"}}, {\"sampler\": 1, \"target\": {\"path\": \"pointer\", "
    "\"extensions"
    "\": {\"KHR_animation_pointer\": {\"pointer\": \"/nodes/3/translation\"}}}}]}], \"accessors\": [{\"bu"
    "fferView\": 0, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC3\", \"min\": [0, 0, 0], \"max\": "
    "[1, 1, 0]}, {\"bufferView\": 1, \"componentType\": 5121, \"count\": 3, \"type\": \"VEC4\"}, {\"buffer"
    "View\": 2, \"componentType\": 5126, \"count\": 3, \"type\": \"VEC4\"}, {\"bufferView\": 3, \"component"
    "Type\": 5126, \"count\": 2, \"type\": \"SCALAR\", \"min\": [0], \"max\": [1]}, {\"bufferView\": 4, \"com"
    "ponentType\": 5126, \"count\": 2, \"type\": \"VEC4\"}, {\"bufferView\": 5, \"componentType\": 5126, \""
    "count\": 2, \"type\": \"VEC3\"}], \"bufferViews\": [{\"buffer\": 0, \"byteOffset\": 0, \"byteLength\": "
    "36}, {\"buffer\": 0, \"byteOffset\": 36, \"byteLength\": 12}, {\"buffer\": 0, \"byteOffset\": 48, \"b"
    "yteLength\": 48}, {\"buffer\": 0, \"byteOffset\": 96, \"byteLength\": 8}, {\"buffer\": 0, \"byteOffs"
    "et\": 104, \"byteLength\": 32}, {\"buffer\": 0, \"byteOffset\": 136, \"byteLength\": 24}], \"buffers"
    "\": [{\"byteLength\": 160, \"uri\": \"data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAP"
    "wAAAAAAAAAAAAAAAAAAgD8AAAAAAAEAAAABAAAAAQAAAACAPwAAAAAAAAAAAAAAAAAAAD8AAAA/AAAAAAAAAAAAAAA"
    "AAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAAAAAAAAAAIA/AAAAAAAAAACamRk/zcxMPwAAAAAAAAAAAAAAAAAAA"
    "AAAAIA+AAAAAA==\"}]}";

static char mesh[64], lattice[64], output[64], kept[64];
static const ffd_lattice_source lattices[] = {{.path = lattice}};

static int set_up(void **state)
{
    assert_int_equal(make_folder(state), 0);
    put_text("a.gltf", scene);
    put_text("l.json",
             "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [4, 4, 4], \"rest\": {\"box\": "
             "{\"min\": [-1, -1, -1], \"max\": [2, 2, 2]}}, \"moves\": [{\"bend\": {\"axis\": \"y\", "
             "\"toward\": [1, 0, 0], "
             "\"degrees\": 60}}]}");
    strcpy(mesh, in_folder("a.gltf"));
    strcpy(lattice, in_folder("l.json"));
    strcpy(output, in_folder("b.gltf"));
    strcpy(kept, in_folder("c.gltf"));
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    return remove_files((const char *const[]){output, kept, mesh, lattice}, 4);
}

static ffd_deform_desc describe(ffd_rig rig)
{
    ffd_deform_desc desc = describe_job(mesh, output, lattices);
    desc.rig = rig;
    return desc;
}

static void the_result_says_what_lags_and_what_follows(void **state)
{
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_deform_desc desc = describe(FFD_RIG_KEEP);
    assert_int_equal(ffd_check_run(&desc, &result, NULL), FFD_OK);
    assert_true(result.rig.is_there && result.rig.largest_lag > 0.01);
    assert_int_equal(result.rig.joints, 2);
    assert_int_equal(result.rig.moved, 0);
    assert_int_equal(result.rig.lagging_skins, 1);
    assert_int_equal(result.rig.lagging_pivots, 1);
    assert_int_equal(result.rig.lagging_sockets, 0);
    assert_true(result.rig.worst[0]);
    desc.rig = FFD_RIG_FOLLOW;
    assert_int_equal(ffd_check_run(&desc, &result, NULL), FFD_OK);
    assert_int_equal(result.rig.moved, 3);
    assert_true(result.rig.largest_lag == 0);
    assert_string_equal(result.rig.worst, "");
    (void)state;
}

static void memory_may_end_anywhere(void **state)
{
    const ffd_deform_desc desc = describe(FFD_RIG_FOLLOW);
    long failures = 0;
    (void)state;
    for (ffd_status status = FFD_E_MEMORY; status; failures++) {
        ffd_job_result result = {.struct_size = sizeof result};
        ffd_error error = {0};
        ffd_alloc_fail_after(failures);
        status = ffd_deform_run(&desc, &result, &error);
        ffd_alloc_fail_after(-1);
        if (status) {
            assert_int_equal(status, FFD_E_MEMORY);
            assert_non_null(strstr(error.message, "out of memory"));
            assert_int_not_equal(access(output, F_OK), 0);
        }
    }
    assert_true(failures > 60);
}

/* After a job with --rig follow, the next job gets its mesh from the cache without any change. */
static void a_job_after_one_that_follows_is_as_alone(void **state)
{
    file_input alone, after;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_job_cache *cache;
    (void)state;
    for (int k = 0; k < 2; k++) {
        const ffd_rig first = k ? FFD_RIG_KEEP : FFD_RIG_FOLLOW;
        ffd_deform_desc desc = describe(first == FFD_RIG_KEEP ? FFD_RIG_FOLLOW : FFD_RIG_KEEP);
        desc.output = kept;
        assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_OK);
        assert_int_equal(ffd_file_load(kept, &alone, NULL), FFD_OK);
        assert_int_equal(ffd_job_cache_create(&cache, NULL), FFD_OK);
        ffd_deform_desc before = describe(first);
        before.cache = desc.cache = cache;
        assert_int_equal(ffd_deform_run(&before, &result, NULL), FFD_OK);
        assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_OK);
        ffd_job_cache_destroy(&cache);
        assert_int_equal(ffd_file_load(kept, &after, NULL), FFD_OK);
        assert_int_equal(after.size, alone.size);
        assert_memory_equal(after.data, alone.data, alone.size);
        ffd_file_unload(&after);
        ffd_file_unload(&alone);
    }
}

static void what_cannot_follow_is_refused(void **state)
{
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_deform_desc desc = describe(FFD_RIG_FOLLOW);
    (void)state;
    desc.as_morph = "x";
    assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_E_ARGUMENT);
    desc.as_morph = NULL;
    desc.input.space = FFD_SPACE_MESH;
    assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_E_ARGUMENT);
    desc.input.space = FFD_SPACE_SCENE;
    desc.output_format = FFD_FORMAT_OBJ;
    assert_int_equal(ffd_deform_run(&desc, &result, NULL), FFD_E_ARGUMENT);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_result_says_what_lags_and_what_follows),
        cmocka_unit_test(memory_may_end_anywhere),
        cmocka_unit_test(a_job_after_one_that_follows_is_as_alone),
        cmocka_unit_test(what_cannot_follow_is_refused),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
