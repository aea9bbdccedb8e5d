/* run_drawing.c - the pictures of jobs that have ended: when they are drawn, and what the journal has of
   them. */
#include "base/memory/memory.h"
#include "batch/batch_run.h"
#include <string.h>

/* Pictures read ahead that wait for a worker. */
#define AHEAD ((size_t)256)

/* What the journal has of a picture, beside its bytes and what they show. */
typedef struct drawn_note {
    hash128 shown; /* what it shows, but for its frame */
    view_frame frame;
} drawn_note;

/* Hashes what a picture shows, but for its frame: what the job is made of, and the look. */
static hash128 hash_shown(const pool_task *task, const job_record *record)
{
    const hash128 parts[] = {record->inputs, ffd_task_look_hash(&task->job.look)};
    return ffd_hash(parts, sizeof parts);
}

/* A picture that is drawn before the others are known has no frame with them. */
static view_frame frame_of(const batch_run *run, const pool_task *task)
{
    return run->frames.wait ? task->order.frame : ffd_view_frame_none();
}

void ffd_run_find_drawn(batch_run *run, pool_task *task)
{
    const hash128 shown = hash_shown(task, &task->order.record);
    const view_frame none = ffd_view_frame_none();
    const hash128 alone = ffd_frame_hash(&shown, &none);
    byte_buffer known = {0};
    job_record drawn;
    drawn_note note;
    if (ffd_journal_find(run->journal, &task->picture_target, &drawn, &known) && known.size == sizeof note) {
        memcpy(&note, known.data, sizeof note);
        const bool is_known = memcmp(&note.frame, &none, sizeof none) != 0; /* not after a pattern's run */
        task->order.has_drawn = ffd_hash_equal(&note.shown, &shown) &&
                                (run->frames.are_common ? is_known : ffd_hash_equal(&drawn.inputs, &alone));
        task->order.drawn = drawn.outputs;
        task->order.frame = note.frame;
        task->drawn_as = drawn.inputs;
    }
    ffd_buffer_free(&known);
}

void ffd_run_put_drawn(const batch_run *run, const pool_task *task)
{
    const view_frame frame = frame_of(run, task);
    drawn_note note;
    if (!run->journal || !task->end.has_drawn || task->end.outcome != OUTCOME_DONE)
        return;
    memset(&note, 0, sizeof note);
    note.shown = hash_shown(task, &task->end.record);
    note.frame = run->frames.wait ? task->end.frame : frame;
    const job_record record = {ffd_frame_hash(&note.shown, &frame), task->end.drawn};
    ffd_journal_put(run->journal, &task->picture_target, &record, (const char *)&note, sizeof note);
}

/* Whether the picture that is there is the one to be drawn. */
static bool is_drawn(const pool_task *task)
{
    const hash128 shown = hash_shown(task, &task->end.record);
    const hash128 wanted = ffd_frame_hash(&shown, &task->order.frame);
    return task->end.has_picture && ffd_hash_equal(&wanted, &task->drawn_as);
}

/* Orders the picture of a job that has waited. */
static void order_picture(batch_run *run, pool_task *task)
{
    task->noted = false;
    ffd_frames_choose(&run->frames, task);
    if (is_drawn(task))
        return;
    task->end.has_picture = false;
    run->dropped = run->dropped || run->ending;
    if (run->ending)
        return;
    task->order.draws = true;
    task->order.scans = false;
    task->order.record = task->end.record;
    task->state = TASK_WAITS;
    task->was_returned = false;
    run->waiting++;
}

ffd_status ffd_run_take_waiting(batch_run *run, ffd_error *error)
{
    while (!run->ended && run->count < BATCH_WINDOW && run->waiting < AHEAD) {
        bool found;
        pool_task *const task = ffd_alloc_zero(1, sizeof *task);
        const ffd_status status =
            task ? ffd_frames_take(&run->frames, task, &found, error) : ffd_fail_memory(error);
        run->ended = status || !found; /* what cannot be read any more is lost */
        if (run->ended) {
            ffd_task_free(task);
            return status;
        }
        run->tasks[run->count++] = task;
        if (task->is_made)
            order_picture(run, task);
    }
    return FFD_OK;
}
