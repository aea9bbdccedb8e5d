/* test_cancel.c - a job that is cancelled ends soon, in whatever step it is: no step goes on for a large part
   of the job without a look at the caller. What is done is told of the step that takes long. The clock is one
   that goes on by itself, so that each look asks him. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "../support/job_description.h"
#include "../support/repetitions.h"
#include "../support/test_folder.h"
#include "base/system/clock.h"
#include <ffd/job.h>
#include <pthread.h>
#include <stdatomic.h>
#include <time.h>

/* Vertices of one side; where memory is checked, which takes long, the times are not judged. */
#define SIDE (is_memory_checked() ? 40 : 180)
/* Of the processor time of a job: between two looks, and after it was cancelled. Where a step has no look it
   is a fifth and more. */
#define MOST 0.2

double ffd_clock_seconds(void)
{
    static atomic_int calls;
    return atomic_fetch_add(&calls, 1);
}

void ffd_clock_sleep(double seconds)
{
    (void)seconds;
}

static double used(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

typedef struct watcher {
    int looks, cancels_at, cancel;
    double begin, last, longest;
    double cancelled; /* when */
    double done;
    int in_pass,
        after_pass; /* looks while vertices are deformed, by what is done, and between them and 0.9 */
} watcher;

static bool look(void *user, double done)
{
    watcher *const w = user;
    const double now = used();
    if (now - w->last > w->longest) {
        w->longest = now - w->last;
        w->done = done;
    }
    w->last = now;
    w->in_pass += done > 0.1 && done < 0.69;
    w->after_pass += done >= 0.69 && done < 0.89;
    if (++w->looks == w->cancels_at) {
        w->cancelled = now;
        w->cancel = 1;
    }
    return true;
}

static int make_meshes(void **state)
{
    assert_int_equal(make_folder(state), 0);
    put_text(
        "l.json",
        "{\"format\": \"ffd-lattice\", \"version\": 1, \"size\": [4, 4, 4], \"rest\": {\"box\": \"mesh\"}, "
        "\"moves\": [{\"at\": [1, 1, 1], \"by\": [3, 2, 1]}]}");
    FILE *const file = fopen(in_folder("m.obj"), "w");
    assert_non_null(file);
    const int side = SIDE;
    for (int i = 0; i < side * side; i++)
        fprintf(file, "v %d.25 %d.5 %d\nvn 0.%06d 0 1\n", i % side, i / side, i % 7, i);
    for (int i = 0; i < side * (side - 1); i++)
        if (i % side < side - 1)
            fprintf(file, "f %d//%d %d//%d %d//%d\nf %d//%d %d//%d %d//%d\n", i + 1, i + 1, i + 2, i + 2,
                    i + 1 + side, i + 1 + side, i + 2, i + 2, i + 2 + side, i + 2 + side, i + 1 + side,
                    i + 1 + side);
    return fclose(file);
}

static ffd_status run_job(const ffd_deform_desc *desc, ffd_job_result *result, ffd_error *error)
{
    if (!desc->output)
        return ffd_check_run(desc, result, error);
    if (!strstr(desc->output, ".png"))
        return ffd_deform_run(desc, result, error);
    ffd_deform_desc job = *desc;
    job.output = NULL;
    ffd_view_desc view;
    ffd_view_desc_init(&view, sizeof view);
    view.job = &job;
    view.output = desc->output;
    view.force = true;
    return ffd_view_run(&view, result, error);
}

/* Returns the processor time of a job. */
static double run(const char *from, const char *to, ffd_normals normals, watcher *w)
{
    char input[200], output[200], lattice[200];
    strcpy(input, in_folder(from));
    strcpy(lattice, in_folder("l.json"));
    const ffd_lattice_source source = {.path = lattice};
    ffd_deform_desc desc = describe_job(input, to ? strcpy(output, in_folder(to)) : NULL, &source);
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    desc.normals = normals;
    desc.progress = look;
    desc.progress_user = w;
    desc.cancel = &w->cancel;
    w->begin = w->last = used();
    const ffd_status status = run_job(&desc, &result, &error);
    const double end = used();
    w->longest = end - w->last > w->longest ? end - w->last : w->longest;
    assert_int_equal(status, w->cancels_at ? FFD_E_CANCELLED : FFD_OK);
    return end - w->begin;
}

/* Whether steps take the shares of the time that they take for users: not with a checker of memory, nor with
   an emulator (tests/run.sh), for which each step is slower by another factor. */
static bool is_as_timed(void)
{
    return !is_memory_checked() && !getenv("FFD_EMULATED");
}

/* The jobs leave their outputs for the next ones. */
static void no_step_is_deaf(void **state)
{
    static const struct {
        const char *from, *to;
        ffd_normals normals;
    } jobs[] = {{"m.obj", "a.glb", 0},
                {"m.obj", "a.off", 0},
                {"m.obj", "a.ply", 0},
                {"m.obj", "a.stl", 0},
                {"a.glb", "b.obj", 0},
                {"a.off", "b.off", 0},
                {"a.ply", "b.off", 0},
                {"a.stl", "b.ply", 0},
                {"m.obj", "b.obj", FFD_NORMALS_RECOMPUTE},
                {"a.glb", "b.glb", FFD_NORMALS_RECOMPUTE},
                {"a.stl", NULL, 0},
                {"m.obj", NULL, 0},
                {"m.obj", "a.png", 0}};
    (void)state;
    for (size_t i = 0; i < sizeof jobs / sizeof *jobs; i++) {
        watcher whole = {.cancels_at = 0};
        const double all = run(jobs[i].from, jobs[i].to, jobs[i].normals, &whole);
        print_message("%s to %s: %d looks, at most %.2f of %.3f s between, at %.2f\n", jobs[i].from,
                      jobs[i].to ? jobs[i].to : "figures", whole.looks, whole.longest / all, all, whole.done);
        assert_true(!is_as_timed() || whole.longest <= MOST * all);
        const char *const copy = jobs[i].to && strstr(jobs[i].to, ".png") ? "c.png" : "c.obj";
        for (int part = 1; part < 4; part++) {
            watcher w = {.cancels_at = whole.looks * part / 4};
            const double end = run(jobs[i].from, jobs[i].to ? copy : NULL, jobs[i].normals, &w) + w.begin;
            print_message("  cancelled at look %d: %.2f\n", w.cancels_at, (end - w.cancelled) / all);
            assert_true(!is_as_timed() || end - w.cancelled <= MOST * all);
            assert_int_not_equal(access(in_folder(copy), F_OK), 0);
        }
    }
}

/* The lattice goes round the mesh: a first pass over the vertices finds their box. */
static void finding_a_box_is_not_deforming(void **state)
{
    (void)state;
    watcher w = {.cancels_at = 0};
    run("m.obj", "b.obj", 0, &w);
    print_message("%d looks in the pass, %d after it\n", w.in_pass, w.after_pass);
    assert_true(is_memory_checked() || w.in_pass > 4 * w.after_pass); /* else there are too few */
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(no_step_is_deaf),
                                       cmocka_unit_test(finding_a_box_is_not_deforming)};
    return cmocka_run_group_tests_name("cancel", tests, make_meshes, remove_folder);
}
