#include "batch/batch.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/system/interrupt.h"
#include "batch/journal.h"
#include "batch/progress.h"
#include "job/judge/result.h"
#include "job/report/depfile.h"
#include "job/report/report.h"
#include <stdio.h>
#include <string.h>

/* Jobs that are known at a time: from the first one that has not ended. What ends before it waits here for
   its turn in the report. */
#define WINDOW ((size_t)1024)

/* Jobs that wait for a worker; further ones are not read yet. */
#define AHEAD ((size_t)256)

/* Seconds between looks at the clock. */
#define LOOK 0.1

typedef struct batch_run {
    const batch_desc *desc;
    job_source *source;
    worker_pool *pool;
    job_journal *journal; /* NULL: there is none */
    ffd_report *report;   /* likewise */
    ffd_depfile *depfile; /* likewise */
    batch_progress progress;
    batch_counts counts;
    pool_task *tasks[WINDOW]; /* in their order; count of them */
    size_t count, waiting;
    bool ended;   /* the source has no more jobs */
    bool starved; /* the next one has not come yet */
    bool ending;  /* no more jobs are begun */
    bool dropped; /* some were not begun */
} batch_run;

/* Reading jobs */

static void fail_task(pool_task *task, const ffd_error *error)
{
    task->failure = *error;
    task->state = TASK_ENDED;
    task->outcome = OUTCOME_FAILED;
}

static void add_task(batch_run *run, pool_task *task)
{
    batch_job *const job = &task->job;
    run->tasks[run->count++] = task;
    if (job->error.status) {
        fail_task(task, &job->error);
        return;
    }
    task->mesh = ffd_hash(job->input, strlen(job->input));
    if (run->journal)
        task->has_record = ffd_journal_find(run->journal, job->target, &task->record);
    run->waiting++;
}

static ffd_status read_jobs(batch_run *run, ffd_error *error)
{
    run->starved = false;
    while (!run->ended && !run->ending && run->count < WINDOW && run->waiting < AHEAD) {
        line_state state;
        pool_task *const task = ffd_alloc_zero(1, sizeof *task);
        if (!task)
            return ffd_fail_memory(error);
        const ffd_status status = ffd_jobs_next(run->source, &task->job, &state, error);
        if (status || state != LINE_READ) {
            ffd_task_free(task);
            run->ended = state == LINE_NONE;
            run->starved = state == LINE_LATER;
            return status;
        }
        add_task(run, task);
    }
    return FFD_OK;
}

/* Jobs that have ended */

static void say_error(batch_run *run, const ffd_error *error)
{
    char line[2100];
    const size_t length = ffd_error_format(error, line, sizeof line - 1);
    memcpy(line + (length < sizeof line - 2 ? length : sizeof line - 2), "\n", 2);
    ffd_progress_print(&run->progress, line);
}

static void print_plan(const pool_task *task)
{
    const batch_job *const job = &task->job;
    printf("%s %s -> %s\n", task->outcome == OUTCOME_SKIPPED ? "up to date:" : "to do:", job->input,
           ffd_job_output_name(job));
}

static ffd_status report_task(batch_run *run, const pool_task *task, ffd_error *error)
{
    if (!run->report)
        return FFD_OK;
    if (task->entry.size)
        return ffd_report_add_text(run->report, task->entry.data, task->entry.size, error);
    ffd_job_result result;
    byte_buffer text = {0};
    ffd_result_clear(&result);
    result.status = task->failure.status;
    result.error = task->failure;
    const report_entry entry = {.line = task->job.line,
                                .input = task->job.input,
                                .output = ffd_job_output_name(&task->job),
                                .result = &result,
                                .stable = run->desc->pool.stable};
    ffd_report_entry_text(&entry, &text);
    const ffd_status status =
        text.failed ? ffd_fail_memory(error) : ffd_report_add_text(run->report, text.data, text.size, error);
    ffd_buffer_free(&text);
    return status;
}

/* What a job's end means at once, whichever jobs before it still run. */
static void note_end(batch_run *run, pool_task *task)
{
    uint64_t *const counts[] = {&run->counts.done, &run->counts.skipped, &run->counts.failed};
    ++*counts[task->outcome];
    task->noted = true;
    if (task->log.size && !task->log.failed) {
        ffd_buffer_append(&task->log, "", 1);
        ffd_progress_print(&run->progress, task->log.data);
    }
    if (task->failure.status)
        say_error(run, &task->failure);
    if (task->outcome == OUTCOME_FAILED && run->desc->stop)
        run->ending = true;
    if (run->journal && task->outcome == OUTCOME_DONE && task->has_record)
        ffd_journal_put(run->journal, task->job.target, &task->record);
}

/* A job that is not valid ends when those before it have: it could be the one to stop at. Once no more are
   begun it is not begun either. */
static void note_ends(batch_run *run)
{
    bool is_first = true; /* of those that have not ended */
    for (size_t i = 0; i < run->count; i++) {
        pool_task *const task = run->tasks[i];
        const bool is_valid = !task->job.error.status;
        is_first = is_first && task->state != TASK_WAITS && task->state != TASK_RUNS;
        if (task->state != TASK_ENDED || task->noted || (!is_valid && !is_first && !run->ending))
            continue;
        if (run->ending && !is_valid) {
            task->state = TASK_DROPPED;
            run->dropped = true;
        } else {
            note_end(run, task);
        }
    }
}

/* What is reported in the order of the jobs. */
static ffd_status tell_task(batch_run *run, const pool_task *task, ffd_error *error)
{
    if (run->desc->pool.dry && task->outcome != OUTCOME_FAILED)
        print_plan(task);
    if (run->depfile && task->rule.size)
        ffd_depfile_add(run->depfile, &task->rule);
    return report_task(run, task, error);
}

/* Takes the jobs that have ended, and none before them has not, out of the window. */
static ffd_status take_ended(batch_run *run, ffd_error *error)
{
    size_t taken = 0;
    ffd_status status = FFD_OK;
    for (; taken < run->count && !status; taken++) {
        pool_task *const task = run->tasks[taken];
        if (task->state != TASK_ENDED && task->state != TASK_DROPPED)
            break;
        if (task->state == TASK_ENDED)
            status = tell_task(run, task, error);
        ffd_task_free(task);
    }
    run->count -= taken;
    memmove(run->tasks, run->tasks + taken, run->count * sizeof *run->tasks);
    return status;
}

/* The whole */

static void count_waiting(batch_run *run)
{
    run->waiting = 0;
    for (size_t i = 0; i < run->count; i++)
        run->waiting += run->tasks[i]->state == TASK_WAITS;
}

static void drop_waiting(batch_run *run)
{
    run->dropped = run->dropped || !run->ended;
    for (size_t i = 0; i < run->count; i++)
        if (run->tasks[i]->state == TASK_WAITS) {
            run->tasks[i]->state = TASK_DROPPED;
            run->dropped = true;
        }
    run->waiting = 0;
}

static void heed_interrupts(batch_run *run)
{
    const interrupt_request request = ffd_interrupt_requested();
    if (request != INTERRUPT_NONE)
        run->ending = true;
    if (run->ending)
        drop_waiting(run);
    if (request == INTERRUPT_STOP)
        ffd_pool_stop(run->pool);
}

/* Where the manifest cannot be read on, or no worker be had, what was begun is finished all the same. */
static ffd_status begin_jobs(batch_run *run, ffd_error *error)
{
    ffd_status status = read_jobs(run, error);
    if (!status && !run->ending)
        status = ffd_pool_assign(run->pool, run->tasks, run->count, error);
    run->ending = run->ending || status;
    return status;
}

static ffd_status run_jobs(batch_run *run, ffd_error *error)
{
    ffd_status status = FFD_OK, first = FFD_OK;
    while (!status) {
        if (!first)
            first = begin_jobs(run, error);
        if ((ffd_pool_running(run->pool) > 0 || run->starved))
            ffd_pool_wait(run->pool, LOOK);
        note_ends(run);
        heed_interrupts(run);
        note_ends(run); /* of those that were stopped */
        status = take_ended(run, first ? NULL : error);
        count_waiting(run);
        ffd_progress_show(&run->progress, &run->counts, ffd_jobs_fraction(run->source));
        if (run->count == 0 && (run->ended || run->ending))
            break;
    }
    return first ? first : status;
}

static ffd_status open_journal(batch_run *run, ffd_error *error)
{
    const batch_desc *const desc = run->desc;
    const job_source_desc *const jobs = &desc->jobs;
    const char *const origin = jobs->manifest ? jobs->manifest : jobs->table ? jobs->table : jobs->pattern;
    char *const path = desc->journal ? ffd_text_copy(desc->journal)
                                     : ffd_journal_default_path(origin, jobs->shard, jobs->shards);
    ffd_error reason;
    if (path && desc->pool.dry && !(desc->pool.resume && ffd_file_exists(path))) {
        ffd_free(path); /* nothing is written, not even there */
        return FFD_OK;
    }
    ffd_status status =
        path ? ffd_journal_open(path, &run->journal, &reason)
             : ffd_fail(&reason, FFD_E_IO, "there is no folder for the journal (--journal names one)");
    ffd_free(path);
    if (!status)
        return FFD_OK;
    if (!desc->journal) { /* a journal only saves time */
        if (desc->pool.resume)
            say_error(run, &reason);
        return FFD_OK;
    }
    if (error)
        *error = reason;
    return status;
}

static ffd_status open_all(batch_run *run, ffd_error *error)
{
    const batch_desc *const desc = run->desc;
    pool_desc pool = desc->pool;
    ffd_status status = ffd_jobs_open(&desc->jobs, &run->source, error);
    if (!status)
        status = open_journal(run, error);
    if (!status && desc->report)
        status = ffd_report_create(desc->report, pool.stable, NULL, &run->report, error);
    if (!status && desc->depfile && !pool.dry)
        status = ffd_depfile_create(desc->depfile, &run->depfile, error);
    pool.report = run->report != NULL;
    pool.depfile = run->depfile != NULL;
    pool.records = run->journal != NULL;
    pool.origin = status ? NULL : ffd_jobs_name(run->source);
    return status ? status : ffd_pool_create(&pool, &run->pool, error);
}

static const char *remark_of(const batch_run *run)
{
    if (!run->dropped)
        return "";
    return ffd_interrupt_requested() == INTERRUPT_NONE ? "; the other jobs were not started (--stop)"
                                                       : "; interrupted, the other jobs were not started";
}

ffd_status ffd_batch_run(const batch_desc *desc, bool *failed, ffd_error *error)
{
    batch_run run = {.desc = desc};
    ffd_interrupt_watch();
    ffd_progress_begin(&run.progress, desc->quiet);
    ffd_status status = open_all(&run, error);
    if (!status) {
        status = run_jobs(&run, error);
        if (status)
            ffd_pool_stop(run.pool);
        const ffd_status reported = run.report ? ffd_report_write(run.report, status ? NULL : error) : FFD_OK;
        status = status ? status : reported;
        if (!status && run.depfile && !run.counts.failed && !run.dropped)
            status = ffd_depfile_write(run.depfile, error);
        if (!status)
            ffd_progress_end(&run.progress, &run.counts, desc->pool.dry ? "to do" : "done", remark_of(&run));
    }
    *failed = run.counts.failed > 0 || run.dropped;
    for (size_t i = 0; i < run.count; i++)
        ffd_task_free(run.tasks[i]);
    ffd_pool_destroy(&run.pool);
    ffd_report_destroy(&run.report);
    ffd_depfile_destroy(&run.depfile);
    ffd_journal_close(&run.journal);
    ffd_jobs_close(&run.source);
    return status;
}
