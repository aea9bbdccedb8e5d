/* test_run_frames.c - the frames that pictures of a batch have in common, and jobs that wait for them on
   disk. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "base/file/path.h"
#include "base/memory/memory.h"
#include "batch/run_frames.h"
#include "batch/task_record.h"
#include "job/input/setting_lists.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../support/repetitions.h"

static pool_task task_of(uint64_t index, double reach, double away, ffd_up up)
{
    pool_task task = {.index = index, .job = {.line = index + 1, .look = {.up = up}}};
    static char output[] = "o.obj";
    task.job.output = output;
    task.end.frame = ffd_view_frame_none();
    ffd_bounds_widen(&task.end.frame.mesh, (double[]){-reach, -reach, -reach});
    ffd_bounds_widen(&task.end.frame.mesh, (double[]){reach, reach, reach});
    task.end.frame.displacement = reach;
    task.end.frame.away = away;
    return task;
}

static const hash128 mesh = {{1}}, other_mesh = {{2}};

static void frames_enclose_what_is_near(void **state)
{
    (void)state;
    run_frames frames = {0};
    pool_task tasks[] = {task_of(0, 1, 0, FFD_UP_Y), task_of(1, 3, 10, FFD_UP_Y),
                         task_of(2, 90, 10.0001, FFD_UP_Y), task_of(3, 7, 0, FFD_UP_Y)};
    ffd_error error;
    for (size_t i = 0; i < 4; i++)
        assert_int_equal(ffd_frames_add(&frames, &tasks[i], i == 3 ? &other_mesh : &mesh, &error), FFD_OK);
    const double expected[] = {3, 3, 90, 7};
    for (size_t i = 0; i < 4; i++) {
        ffd_frames_choose(&frames, &tasks[i]);
        assert_true(tasks[i].order.has_frame);
        assert_true(tasks[i].order.frame.mesh.max[0] == expected[i]);
        assert_true(tasks[i].order.frame.displacement == expected[i]);
        assert_int_equal(tasks[i].own_frame != NULL, i == 2);
    }
    assert_string_equal(tasks[2].own_frame, "far");
    assert_true(ffd_frames_warn(&frames, "m.jsonl", &error));
    assert_string_equal(error.message, "1 of 4 pictures is not in the common frame, but has its own: o.obj "
                                       "(line 3) lies 10 diagonals of the mesh away");
    ffd_frames_free(&frames);
    assert_false(ffd_frames_warn(&frames, "m.jsonl", &error));
}

/* The options of most jobs are the common ones; of as many, those of the first. */
static void other_options_are_those_of_fewer_jobs(void **state)
{
    (void)state;
    static const ffd_up ups[][4] = {{FFD_UP_Z, FFD_UP_Y, FFD_UP_Y, FFD_UP_X},
                                    {FFD_UP_Z, FFD_UP_Y, FFD_UP_Y, FFD_UP_Z}};
    for (size_t k = 0; k < 2; k++) {
        run_frames frames = {0};
        pool_task tasks[4];
        ffd_error error;
        for (size_t i = 4; i-- > 0;) { /* jobs end in another order than theirs */
            tasks[i] = task_of(i, (double)i + 1, 0, ups[k][i]);
            assert_int_equal(ffd_frames_add(&frames, &tasks[i], &mesh, &error), FFD_OK);
        }
        const ffd_up common = k == 0 ? FFD_UP_Y : FFD_UP_Z;
        for (size_t i = 0; i < 4; i++) {
            ffd_frames_choose(&frames, &tasks[i]);
            const bool is_common = ups[k][i] == common;
            assert_int_equal(tasks[i].own_frame == NULL, is_common);
            assert_true(tasks[i].order.frame.displacement == (!is_common ? (double)i + 1 : k == 0 ? 3 : 4));
        }
        assert_int_equal(frames.left, 2);
        ffd_frames_free(&frames);
    }
}

/* Jobs that each have a camera of their own: a look at all groups for each would take minutes. */
static void very_many_looks_of_one_mesh_are_told_apart_soon(void **state)
{
    (void)state;
    const uint64_t count = (uint64_t)repetitions(100000);
    run_frames frames = {0};
    ffd_error error;
    for (int pass = 0; pass < 2; pass++)
        for (uint64_t i = 0; i < count; i++) {
            pool_task task = task_of(i, (double)i + 1, 0, FFD_UP_Y);
            task.job.look.camera[0] = 1;
            task.job.look.camera[1] = (double)(i < 3 ? 0 : i);
            if (pass == 0)
                assert_int_equal(ffd_frames_add(&frames, &task, &mesh, &error), FFD_OK);
            else
                ffd_frames_choose(&frames, &task);
            assert_true(pass == 0 || task.order.frame.displacement == (double)(i < 3 ? 3 : i + 1));
        }
    assert_int_equal(frames.left, count - 3);
    ffd_frames_free(&frames);
}

/* The batch goes on to the ends of running jobs. */
static void without_memory_jobs_have_no_frame(void **state)
{
    (void)state;
    ffd_error error;
    for (long successes = 0;; successes++) {
        run_frames frames = {0};
        pool_task task = task_of(0, 1, 0, FFD_UP_Y);
        ffd_alloc_fail_after(successes);
        const ffd_status first = ffd_frames_add(&frames, &task, &mesh, &error);
        ffd_alloc_fail_after(-1);
        assert_true(first == FFD_OK || first == FFD_E_MEMORY);
        assert_int_equal(ffd_frames_add(&frames, &task, &mesh, &error), FFD_OK);
        ffd_frames_choose(&frames, &task);
        assert_true(task.order.frame.displacement == 1 && !task.own_frame);
        ffd_frames_free(&frames);
        if (!first)
            return;
    }
}

static void looks_differ_in_each_option(void **state)
{
    (void)state;
    ffd_view_desc plain;
    ffd_view_desc_init(&plain, sizeof plain);
    const hash128 hash = ffd_task_look_hash(&plain);
    ffd_view_desc others[] = {plain, plain, plain, plain, plain, plain, plain, plain};
    others[0].camera[2] = 1;
    others[1].width = 20;
    others[2].height = 20;
    others[3].frames = 2;
    others[4].color = FFD_VIEW_PLAIN;
    others[5].up = FFD_UP_X;
    others[6].no_cage = true;
    others[7].animation = "";
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        const hash128 other = ffd_task_look_hash(&others[i]);
        assert_false(ffd_hash_equal(&hash, &other));
        const task_look look = ffd_task_look(&others[i]);
        const ffd_view_desc back = ffd_task_look_desc(&look, others[i].animation);
        const hash128 again = ffd_task_look_hash(&back);
        assert_true(ffd_hash_equal(&other, &again));
    }
}

static void looks_that_mean_the_same_share_a_frame(void **state)
{
    (void)state;
    ffd_view_desc plain, beside, walking;
    ffd_view_desc_init(&plain, sizeof plain);
    beside = walking = plain;
    beside.camera[0] = 1;
    beside.camera[1] = 0.5;
    walking.animation = "walk";
    const ffd_view_desc *const of[] = {&plain, &plain, &plain, &beside, &walking};
    ffd_view_desc same[] = {plain, plain, plain, beside, walking};
    same[0].width = 1600;
    same[1].height = 900;
    same[2].color = FFD_VIEW_DISPLACEMENT;
    same[3].camera[0] = 3;
    same[3].camera[1] = 1.5;
    same[4].frames = 5;
    for (size_t i = 0; i < sizeof same / sizeof *same; i++) {
        const hash128 a = ffd_task_picture_hash(of[i]), b = ffd_task_picture_hash(&same[i]);
        const hash128 c = ffd_task_look_hash(of[i]), d = ffd_task_look_hash(&same[i]);
        assert_true(ffd_hash_equal(&a, &b));
        if (ffd_hash_equal(&c, &d)) /* a page may tell them apart */
            fail_msg("look %zu is that of the batch", i);
    }
    ffd_view_desc others[] = {plain, plain, plain, beside, walking};
    others[0].width = 1601;
    others[1].color = FFD_VIEW_PLAIN;
    others[2].camera[0] = -1;
    others[3].camera[1] = 0.25;
    others[4].frames = 6;
    for (size_t i = 0; i < sizeof others / sizeof *others; i++) {
        const hash128 a = ffd_task_picture_hash(of[i]), b = ffd_task_picture_hash(&others[i]);
        assert_false(ffd_hash_equal(&a, &b));
    }
}

static byte_buffer text_of(const char *text)
{
    byte_buffer buffer = {0};
    ffd_buffer_append(&buffer, text, strlen(text) + 1);
    return buffer;
}

static void fill(pool_task *task, const char *output)
{
    *task =
        (pool_task){.index = 7, .told = 3, .frame_mesh = 2, .is_made = true, .noted = true, .is_large = true};
    ffd_deform_desc_init(&task->job.desc, sizeof task->job.desc);
    task->job.line = 5;
    task->job.row = 4;
    task->job.input = ffd_text_copy("a.obj");
    task->job.output = output ? ffd_text_copy(output) : NULL;
    task->job.desc.input.path = "folder/a.obj";
    task->job.desc.output = output ? "folder/b.obj" : NULL;
    task->job.target = task->job.desc.output;
    task->job.desc.normals = FFD_NORMALS_KEEP;
    assert_true(ffd_setting_lattice_add(&task->job.desc, "l.json"));
    task->job.look = (ffd_view_desc){.width = 20, .animation = "walk"};
    task->picture = ffd_text_copy("v/o/b.png");
    task->picture_name = task->picture + 2;
    task->page = output ? ffd_text_copy("v/o/b.html") : NULL;
    task->end = (task_end){.outcome = OUTCOME_FAILED, .has_frame = true, .frame = {.displacement = 0.25}};
    task->order.drawn = mesh;
    task->drawn_as = other_mesh;
    task->log = text_of("a line\n");
    task->targets = text_of("t");
    task->failure.status = FFD_E_GATE;
    snprintf(task->failure.message, sizeof task->failure.message, "why");
}

static void expect_same(const pool_task *a, const pool_task *b)
{
    assert_int_equal(a->index, b->index);
    assert_int_equal(a->job.line, b->job.line);
    assert_int_equal(a->job.row, b->job.row);
    assert_string_equal(a->job.input, b->job.input);
    assert_int_equal(a->job.output != NULL, b->job.output != NULL);
    assert_int_equal(a->page != NULL, b->page != NULL);
    if (a->job.output) {
        assert_string_equal(a->job.output, b->job.output);
        assert_string_equal(a->job.target, b->job.target);
        assert_string_equal(a->page, b->page);
    }
    assert_string_equal(a->job.desc.input.path, b->job.desc.input.path);
    assert_string_equal(a->job.desc.lattices[0].path, b->job.desc.lattices[0].path);
    assert_int_equal(a->job.desc.normals, b->job.desc.normals);
    assert_string_equal(a->job.look.animation, b->job.look.animation);
    assert_int_equal(a->job.look.width, b->job.look.width);
    assert_string_equal(a->picture, b->picture);
    assert_string_equal(a->picture_name, b->picture_name);
    assert_ptr_equal(b->picture_name, b->picture + 2);
    assert_true(b->end.outcome == a->end.outcome && b->end.has_frame &&
                b->end.frame.displacement == a->end.frame.displacement);
    assert_true(ffd_hash_equal(&a->order.drawn, &b->order.drawn) &&
                ffd_hash_equal(&a->drawn_as, &b->drawn_as));
    assert_int_equal(a->told, b->told);
    assert_int_equal(a->frame_mesh, b->frame_mesh);
    assert_true(b->is_made && b->noted && b->is_large && !b->is_refused);
    assert_int_equal(a->log.size, b->log.size);
    assert_string_equal(a->log.data, b->log.data);
    assert_string_equal(a->targets.data, b->targets.data);
    assert_int_equal(b->entry.size, 0);
    assert_int_equal(a->failure.status, b->failure.status);
    assert_string_equal(a->failure.message, b->failure.message);
}

/* With an output and a page, and without. */
static void jobs_come_back_as_they_were(void **state)
{
    (void)state;
    for (int has_output = 0; has_output < 2; has_output++) {
        run_frames frames = {0};
        bool found;
        ffd_error error;
        pool_task *const put = ffd_alloc_zero(1, sizeof *put), *const taken =
                                                                   ffd_alloc_zero(1, sizeof *taken);
        fill(put, has_output ? "b.obj" : NULL);
        assert_int_equal(ffd_frames_put(&frames, put, &error), FFD_OK);
        assert_int_equal(ffd_frames_take(&frames, taken, &found, &error), FFD_OK);
        assert_true(found);
        expect_same(put, taken);
        ffd_task_free(put);
        ffd_task_free(taken);
        pool_task none = {0};
        assert_int_equal(ffd_frames_take(&frames, &none, &found, &error), FFD_OK);
        assert_false(found);
        ffd_frames_free(&frames);
    }
}

#define RECORDS 1000

static void put_records(record_queue *queue, size_t first, size_t count)
{
    byte_buffer record = {0};
    for (size_t i = first; i < first + count; i++) {
        record.size = 0;
        ffd_buffer_format(&record, "record %zu", i);
        record.size += i % 3 == 0 ? 0 : 1; /* of several sizes */
        assert_int_equal(ffd_records_put(queue, &record, NULL), FFD_OK);
    }
    ffd_buffer_free(&record);
}

static void take_records(record_queue *queue, size_t first, size_t count)
{
    byte_buffer record = {0};
    bool found;
    char expected[40];
    for (size_t i = first; i < first + count; i++) {
        assert_int_equal(ffd_records_take(queue, &record, &found, NULL), FFD_OK);
        assert_true(found);
        const int size = snprintf(expected, sizeof expected, "record %zu", i);
        assert_int_equal(record.size, size + (i % 3 == 0 ? 0 : 1));
        assert_memory_equal(record.data, expected, size);
    }
    ffd_buffer_free(&record);
}

/* In a file, and in memory where there is no folder for one. */
static void records_come_back_in_their_order(void **state)
{
    (void)state;
    static const char *const folders[] = {"/tmp", "/no/such/folder"};
    for (size_t k = 0; k < 2; k++) {
        record_queue queue = {0};
        byte_buffer record = {0};
        bool found;
        assert_int_equal(setenv("TMPDIR", folders[k], 1), 0);
        put_records(&queue, 0, RECORDS);
        assert_int_equal(queue.has_file, k == 0);
        assert_int_equal(queue.rest.size > 0, k == 1); /* they take no memory where there is a file */
        take_records(&queue, 0, RECORDS / 2);
        put_records(&queue, RECORDS, 5);
        take_records(&queue, RECORDS / 2, RECORDS / 2 + 5);
        assert_int_equal(ffd_records_take(&queue, &record, &found, NULL), FFD_OK);
        assert_false(found);
        ffd_buffer_free(&record);
        ffd_records_free(&queue);
        assert_true(queue.written == 0 && !queue.has_file);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(frames_enclose_what_is_near),
                                       cmocka_unit_test(other_options_are_those_of_fewer_jobs),
                                       cmocka_unit_test(very_many_looks_of_one_mesh_are_told_apart_soon),
                                       cmocka_unit_test(without_memory_jobs_have_no_frame),
                                       cmocka_unit_test(looks_differ_in_each_option),
                                       cmocka_unit_test(looks_that_mean_the_same_share_a_frame),
                                       cmocka_unit_test(jobs_come_back_as_they_were),
                                       cmocka_unit_test(records_come_back_in_their_order)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
