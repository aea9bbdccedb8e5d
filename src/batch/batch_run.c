#include "batch/batch_run.h"
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/place.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/system/interrupt.h"
#include "base/system/processors.h"
#include "base/text/words.h"
#include "batch/measure.h"
#include "batch/own_files.h"
#include "job/report/report_file.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Jobs read ahead that wait for a worker. */
#define AHEAD ((size_t)256)

/* Meshes with more bytes are read by one worker only. */
#define MOST_SHARED ((uint64_t)1 << 28)

/* The longest wait for a worker, in seconds. */
#define POLL 0.1

/* Reading jobs */

/* A job that was added after the jobs were counted has no row. */
static void check_row(const batch_run *run, batch_job *job)
{
    const row_array *const array = &run->rows.array;
    if (!job->error.status && run->desc->given->positions && job->row >= array->rows)
        ffd_fail_file(&job->error, FFD_E_INVALID, job->input,
                      "came after the jobs were counted: %s has %" PRIu64 " rows", array->path, array->rows);
}

static void add_task(batch_run *run, pool_task *task)
{
    batch_job *const job = &task->job;
    file_stamp stamp; /* of the mesh */
    run->tasks[run->count++] = task;
    task->index = run->jobs++;
    check_row(run, job);
    if (job->error.status) {
        ffd_run_fail_task(task);
        return;
    }
    task->mesh = ffd_hash(job->input, strlen(job->input));
    task->is_large = ffd_file_stamp(job->desc.input.path, &stamp) && stamp.size > MOST_SHARED;
    task->has_mesh_name = !job->target || ffd_format_from_name(job->target) != FFD_FORMAT_AUTO;
    task->state = TASK_ORDERED;
    run->waiting++;
}

/* The most jobs that are read ahead. A caller is asked for no more than workers need: the next job may depend
   on those that have ended. */
static size_t count_ahead(const batch_run *run)
{
    const job_source_desc *const jobs = &run->desc->jobs;
    const int workers = run->desc->pool.workers;
    if (!jobs->next || jobs->repeats)
        return AHEAD;
    const size_t wanted = (size_t)(workers > 0 ? workers : ffd_processor_count());
    return wanted < AHEAD ? wanted : AHEAD;
}

static ffd_status read_jobs(batch_run *run, ffd_error *error)
{
    const size_t ahead = count_ahead(run);
    run->starved = false;
    while (!run->ended && !run->ending && run->count < BATCH_WINDOW && run->waiting < ahead) {
        line_state state;
        pool_task *const task = ffd_alloc_zero(1, sizeof *task);
        if (!task)
            return ffd_fail_memory(error);
        const ffd_status status = ffd_run_next_job(run, &task->job, &state, error);
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

/* The whole */

static void drop_waiting(batch_run *run)
{
    run->dropped = run->dropped || !run->ended;
    for (size_t i = 0; i < run->count; i++)
        if (ffd_task_is_pending(run->tasks[i])) {
            run->tasks[i]->state = run->tasks[i]->is_made ? TASK_ENDED : TASK_DROPPED;
            run->dropped = true;
        }
    run->waiting = 0;
}

static void check_interrupts(batch_run *run)
{
    const bool stops = run->cancelled || ffd_interrupt_requested();
    run->ending = run->ending || stops;
    if (run->ending)
        drop_waiting(run);
    if (stops)
        ffd_pool_stop(run->pool);
}

/* With --stop a job that is not valid ends the run before those after it begin. */
static ffd_status heed_invalid(batch_run *run, ffd_error *error)
{
    if (!run->desc->given->stop || run->frames.are_drawn)
        return FFD_OK;
    TRY(ffd_run_note_ends(run, error));
    if (run->ending)
        drop_waiting(run);
    return FFD_OK;
}

/* If the rest of the manifest cannot be read, or no worker can be started, the running jobs are still
   finished. */
static ffd_status begin_jobs(batch_run *run, ffd_error *error)
{
    ffd_status status;
    TRY_END(run->frames.are_drawn ? ffd_run_take_waiting(run, error) : read_jobs(run, error));
    if (!run->frames.are_drawn)
        TRY_END(ffd_run_claim_tasks(run, error));
    TRY_END(heed_invalid(run, error));
    if (!run->ending)
        TRY_END(ffd_pool_assign(run->pool, run->tasks, run->count, error));
end:
    run->ending = run->ending || status;
    return status;
}

/* Waits for jobs to end. Free workers get their next jobs before the ends are handled, unless an end may stop
   the run (--stop). */
static ffd_status wait_for_ends(batch_run *run, ffd_error *error)
{
    if (ffd_pool_running(run->pool) > 0 || run->starved)
        ffd_pool_wait(run->pool, run->starved ? ffd_jobs_descriptor(run->source) : -1, POLL);
    if (run->ending || run->desc->given->stop || ffd_interrupt_requested())
        return FFD_OK;
    const ffd_status status = ffd_pool_assign(run->pool, run->tasks, run->count, error);
    run->ending = status;
    return status;
}

/* Says once that jobs wait for memory, while processors are idle. */
static void log_memory_shortage(batch_run *run)
{
    const pool_shortage *const shortage = ffd_pool_shortage(run->pool);
    ffd_error note;
    if (!shortage || run->logged_shortage || run->desc->given->quiet)
        return;
    run->logged_shortage = true;
    ffd_fail_file(&note, FFD_E_LIMIT, ffd_jobs_name(run->source),
                  "%d %s at a time on %d processors: the cgroup allows %" PRIu64
                  " MB of memory, and %s may take %" PRIu64 " MB ({input.memory}); {workers} sets the number",
                  shortage->running, ffd_plural((uint64_t)shortage->running, "job", "jobs"),
                  shortage->processors, shortage->limit / 1000000, shortage->name,
                  shortage->needed / 1000000);
    ffd_run_log_error(run, &note);
}

/* Handles the ends of jobs, and drops those that wait if the run ends. */
static ffd_status take_ends(batch_run *run, ffd_error *error)
{
    TRY(ffd_run_note_ends(run, error));
    check_interrupts(run);
    if (run->ending)
        TRY(ffd_run_note_ends(run, error)); /* of those that were just stopped */
    return ffd_run_take_ended(run, error);
}

/* Returns false if the caller wants the batch to end. Where pictures wait, they are one half of it. */
static bool show_progress(batch_run *run)
{
    const ffd_batch_result *const told = &run->counts, *const made = &run->made;
    const double jobs = (double)(made->done + made->skipped + made->failed),
                 ended = (double)(told->done + told->skipped + told->failed);
    double fraction = ffd_run_fraction(run);
    if (run->frames.are_drawn)
        fraction = jobs > 0 ? 0.5 + 0.5 * ended / jobs : 1;
    else if (run->frames.wait && fraction > 0)
        fraction *= 0.5;
    run->progress.draws = run->frames.are_drawn;
    return ffd_progress_show(&run->progress, run->frames.are_drawn ? told : made, fraction);
}

/* Whether all jobs, or all pictures, have ended. Jobs that wait for pictures are all told of. */
static bool is_over(const batch_run *run)
{
    return run->count == 0 && (run->ended || (run->ending && !run->frames.are_drawn));
}

static ffd_status run_jobs(batch_run *run, ffd_error *error)
{
    ffd_status status = FFD_OK, first = FFD_OK;
    while (!status) {
        run->ending = run->ending || run->cancelled || ffd_interrupt_requested();
        const ffd_status begun =
            !first || run->frames.are_drawn ? begin_jobs(run, first ? NULL : error) : FFD_OK;
        first = first ? first : begun;
        const ffd_status waited = wait_for_ends(run, first ? NULL : error);
        first = first ? first : waited;
        log_memory_shortage(run);
        status = take_ends(run, first ? NULL : error);
        run->cancelled = !show_progress(run) || run->cancelled;
        if (is_over(run))
            break;
    }
    return first ? first : status;
}

/* Draws the pictures that have waited for the last job. If the jobs could not all be run for another reason
   than that one has failed, they are told of without pictures. */
static ffd_status draw_pictures(batch_run *run, ffd_status made, ffd_error *error)
{
    run->frames.are_drawn = true;
    run->frames.all_made = run->ended && !run->dropped;
    run->ended = run->starved = false;
    run->ending = made;
    return run_jobs(run, error);
}

static ffd_status run_all(batch_run *run, ffd_error *error)
{
    const ffd_status made = run_jobs(run, error);
    const ffd_status drawn = run->frames.wait ? draw_pictures(run, made, made ? NULL : error) : FFD_OK;
    return made ? made : drawn;
}

/* Returns the path of the file that the jobs come from; NULL: they come from elsewhere. */
static const char *file_of_jobs(const job_source_desc *jobs)
{
    const char *const file = jobs->next ? NULL : jobs->manifest ? jobs->manifest : jobs->table;
    return file && !ffd_file_is_stream(file) ? file : NULL;
}

/* Finds the folder that the names in the journal are relative to: the root if the current one was removed. */
static ffd_status find_base(batch_run *run, ffd_error *error)
{
    const char *const file = file_of_jobs(&run->desc->jobs);
    char *const folder = ffd_path_folder(file ? file : "");
    run->base = folder ? ffd_path_resolve(folder) : NULL;
    ffd_free(folder);
    if (!run->base)
        run->base = ffd_text_copy("/");
    if (!run->base)
        return ffd_fail_memory(error);
    run->files.base = run->base;
    if (run->desc->given->positions)
        run->rows.file = ffd_place_relative(&run->files.places, run->base, run->desc->given->positions);
    return FFD_OK;
}

static ffd_status name_journal(batch_run *run)
{
    const job_source_desc *const jobs = &run->desc->jobs;
    const char *const given = run->desc->given->journal;
    const char *const origin = jobs->next       ? ffd_jobs_name(run->source)
                               : jobs->manifest ? jobs->manifest
                               : jobs->table    ? jobs->table
                                                : jobs->pattern;
    run->journal_path =
        given ? ffd_text_copy(given) : ffd_journal_default_path(origin, jobs->shard, jobs->shards);
    return run->journal_path ? FFD_OK : FFD_E_IO;
}

static ffd_status open_journal(batch_run *run, ffd_error *error)
{
    const batch_desc *const desc = run->desc;
    ffd_error reason;
    ffd_status status = name_journal(run);
    const char *const path = run->journal_path;
    const bool is_dry = desc->pool.wishes.dry; /* it writes nothing, not even a journal */
    if (path && is_dry && !(desc->pool.wishes.resume && ffd_file_exists(path)))
        return FFD_OK;
    if (status)
        status = ffd_fail(&reason, FFD_E_IO, "there is no folder for the journal ({journal} names one)");
    else if (is_dry)
        status = ffd_journal_read(path, &run->journal, &reason);
    else if (desc->given->journal)
        status = ffd_journal_open(path, &run->journal, &reason);
    else
        status = ffd_journal_open_default(path, &run->journal, &reason);
    if (!status)
        return FFD_OK;
    if (!desc->given->journal) { /* the default journal is optional: it only saves time */
        if (desc->pool.wishes.resume)
            ffd_run_log_error(run, &reason);
        return FFD_OK;
    }
    if (error)
        *error = reason;
    return status;
}

/* Reserves the files of the run itself, so that no job writes them: those that it writes, and where its jobs
   come from. */
static ffd_status claim_own(batch_run *run, ffd_error *error)
{
    const job_source_desc *const jobs = &run->desc->jobs;
    const char *const origin = jobs->manifest ? jobs->manifest : jobs->table;
    const char *const own[] = {run->desc->given->report,
                               run->desc->given->depfile,
                               run->desc->given->journal,
                               run->desc->given->positions,
                               run->rows.list,
                               run->view ? ffd_run_view_page(run->view) : NULL};
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        if (own[i] && !ffd_output_is_stream(own[i]))
            TRY(ffd_run_reserve(&run->files, own[i], error));
    if (origin && !ffd_file_is_stream(origin))
        TRY(ffd_run_keep(&run->files, origin, error));
    return FFD_OK;
}

/* Whether there is a file of its own that the run may replace whatever it holds: the array, before the first
   job, or the index. */
static bool replaces_files(const batch_run *run)
{
    const batch_desc *const desc = run->desc;
    return (desc->force && desc->given->positions && ffd_file_exists(desc->given->positions)) ||
           (run->view && ffd_file_exists(ffd_run_view_page(run->view)));
}

static ffd_status open_view(batch_run *run, ffd_error *error)
{
    const batch_desc *const desc = run->desc;
    const run_view_desc view = {.folder = desc->given->view,
                                .out_dir = desc->jobs.out_dir,
                                .name = ffd_jobs_name(run->source),
                                .shard = desc->jobs.shard,
                                .shards = desc->jobs.shards,
                                .force = desc->force || desc->jobs.resume,
                                .dry = desc->pool.wishes.dry,
                                .pages = desc->given->pages};
    /* The files that a pattern matches are meshes of one job each. */
    run->frames.are_common = desc->jobs.manifest || desc->jobs.table || desc->jobs.next;
    run->frames.wait = run->frames.are_common && !desc->pool.wishes.dry;
    return ffd_run_view_create(&view, &run->view, error);
}

/* Without a readable mesh the number of vertices is unknown, so the array cannot be made. */
static void log_kept_array(batch_run *run)
{
    const char *const path = run->desc->given->positions;
    ffd_error note;
    if (!path || run->rows.is_there || run->desc->given->quiet || ffd_interrupt_requested() ||
        ffd_jobs_count(run->source) == 0 || !ffd_file_exists(path))
        return;
    ffd_fail_file(&note, FFD_E_INVALID, path, "stays as it is: no mesh could be read");
    ffd_run_log_error(run, &note);
}

/* The signals of a process are those of its program. */
static void watch(const batch_run *run)
{
    if (run->desc->given->is_program)
        ffd_interrupt_watch();
}

static ffd_status open_all(batch_run *run, ffd_error *error)
{
    const batch_desc *const desc = run->desc;
    pool_desc pool = desc->pool;
    /* Until workers exist, a signal may end the program in the default way. */
    if (desc->given->shared_box) {
        watch(run);
        TRY(ffd_batch_measure(&desc->jobs, &pool, desc->given->depfile && !pool.wishes.dry, &run->box,
                              &run->box_files, error));
    }
    if (desc->given->positions) {
        watch(run);
        TRY(ffd_run_rows_open(&run->rows, desc, error));
    }
    TRY(ffd_jobs_open(&desc->jobs, &run->source, error));
    if (desc->given->view) /* its folder is made: other files of the run may be there */
        TRY(open_view(run, error));
    TRY(find_base(run, error));
    TRY(open_journal(run, error));
    watch(run);
    if (desc->given->depfile && !pool.wishes.dry)
        TRY(ffd_depfile_create(desc->given->depfile, &run->depfile, error));
    run->files.manifest = ffd_run_manifest(run);
    TRY(claim_own(run, error));
    TRY(ffd_run_expect(run, replaces_files(run), error));
    if (desc->given->report)
        TRY(ffd_report_create(desc->given->report, pool.wishes.stable, NULL, &run->report, error));
    if (desc->given->positions)
        TRY(ffd_run_rows_place(&run->rows, desc, error));
    /* The report of a job that waits for its picture is made when that is drawn, from its result. The index
       needs the JSON pointer of a failure. */
    pool.wishes.frames = run->frames.wait;
    pool.wishes.result = pool.wishes.result || run->view;
    pool.wishes.report = (run->report || run->view || run->rows.report) && !run->frames.wait;
    pool.wishes.quality = pool.wishes.quality || run->report || run->view;
    pool.draws = run->view != NULL;
    pool.rows = desc->given->positions ? &run->rows.array : NULL;
    pool.wishes.depfile = run->depfile != NULL;
    pool.wishes.records = run->journal != NULL;
    pool.box = desc->given->shared_box ? &run->box : NULL;
    pool.wishes.reports_empty_scan = run->files.comes_once;
    pool.journal =
        run->journal || (pool.wishes.dry && run->journal_path && ffd_file_exists(run->journal_path))
            ? run->journal_path
            : NULL;
    pool.base = run->base;
    pool.origin = ffd_jobs_name(run->source);
    return ffd_pool_create(&pool, &run->pool, error);
}

static const char *remark_of(const batch_run *run)
{
    if (!run->dropped)
        return "";
    if (run->frames.all_made)
        return ffd_interrupt_requested() ? "; interrupted, the other pictures were not drawn"
                                         : "; the other pictures were not drawn ({stop})";
    return ffd_interrupt_requested() ? "; interrupted, the other jobs were not started"
                                     : "; the other jobs were not started ({stop})";
}

static void log_line(void *user, ffd_log_level level, const char *line)
{
    byte_buffer text = {0};
    (void)level; /* all lines are warnings */
    ffd_buffer_format(&text, "%s\n", line);
    char *const whole = ffd_buffer_finish(&text);
    if (whole)
        ffd_progress_print(user, whole);
    ffd_free(whole);
}

/* Logs how often meshes were read and searched, with --verbose. */
static void log_counts(batch_run *run)
{
    char line[200];
    const pool_counts counts = ffd_pool_counts(run->pool);
    snprintf(line, sizeof line,
             "%" PRIu64 " %s: meshes read %" PRIu64 " %s, u,v,w looked for %" PRIu64 " %s\n", counts.workers,
             ffd_plural(counts.workers, "worker", "workers"), counts.jobs.reads,
             ffd_plural(counts.jobs.reads, "time", "times"), counts.jobs.searches,
             ffd_plural(counts.jobs.searches, "time", "times"));
    if (run->desc->pool.wishes.verbose)
        ffd_progress_print(&run->progress, line);
}

/* Warns of flaws of the table. */
static void warn_of_flaws(batch_run *run)
{
    const mesh_log log = {log_line, &run->progress};
    if (!run->desc->given->quiet)
        ffd_flaws_warn(ffd_jobs_flaws(run->source), ffd_jobs_name(run->source), &log);
}

/* As `ffd deform` does of several inputs. */
static void log_boxes(batch_run *run)
{
    ffd_error note;
    if (run->desc->given->quiet || run->boxed.count < 2)
        return;
    ffd_fail_file(
        &note, FFD_E_INVALID, ffd_jobs_name(run->source),
        "the lattice's box was laid round each of %zu meshes by itself: parts that meet need one box round "
        "all of them ({shared_box})",
        run->boxed.count);
    ffd_run_log_error(run, &note);
}

/* An empty manifest is valid, but seldom intended. */
static void warn_of_empty_manifest(batch_run *run)
{
    ffd_error note;
    if (run->desc->given->quiet || !run->ended || ffd_jobs_count(run->source) > 0)
        return;
    ffd_fail_file(&note, FFD_E_INVALID, ffd_jobs_name(run->source), "has no jobs");
    ffd_run_log_error(run, &note);
}

/* Writes the depfile, with one common rule that makes all outputs depend on the files of the shared box. */
static ffd_status write_depfile(batch_run *run, ffd_error *error)
{
    byte_buffer rule = {0};
    ffd_status status = FFD_OK;
    if (run->outputs.count)
        TRY_END(ffd_depfile_rule(&run->outputs, &run->box_files, &rule, error));
    ffd_depfile_add(run->depfile, &rule);
end:
    ffd_buffer_free(&rule);
    return status ? status : ffd_depfile_write(run->depfile, error);
}

static ffd_status refuse_cancelled(ffd_error *error)
{
    return ffd_fail(error, FFD_E_CANCELLED, "the caller has ended the batch");
}

/* Pictures that are not compared with the others are named. */
static void log_own_frames(batch_run *run)
{
    ffd_error note;
    if (!run->desc->given->quiet && ffd_frames_warn(&run->frames, ffd_jobs_name(run->source), &note))
        ffd_run_log_error(run, &note);
}

static ffd_status run_and_report(batch_run *run, ffd_error *error)
{
    ffd_status status = run_all(run, error);
    if (!status && run->cancelled)
        status = refuse_cancelled(error);
    if (status)
        ffd_pool_stop(run->pool);
    ffd_report *const reports[] = {run->report, run->rows.report};
    for (int i = 0; i < 2; i++) {
        const ffd_status reported = reports[i] ? ffd_report_write(reports[i], status ? NULL : error) : FFD_OK;
        status = status ? status : reported;
    }
    const ffd_status shown = run->view ? ffd_run_view_write(run->view, status ? NULL : error) : FFD_OK;
    status = status ? status : shown;
    if (!status && run->depfile && !run->counts.failed && !run->dropped)
        status = write_depfile(run, error);
    warn_of_flaws(run);
    log_boxes(run);
    log_own_frames(run);
    if (!status) {
        warn_of_empty_manifest(run);
        log_kept_array(run);
    }
    log_counts(run);
    if (!status)
        ffd_progress_end(&run->progress, &run->counts, run->desc->pool.wishes.dry ? "to do" : "done",
                         SPELLED(remark_of(run)));
    return status;
}

ffd_status ffd_batch_do(const batch_desc *desc, ffd_batch_result *result, ffd_error *error)
{
    batch_run run = {.desc = desc};
    ffd_progress_begin(&run.progress, desc->given);
    ffd_status status;
    TRY_END(ffd_batch_check_own_files(desc, error));
    TRY_END(open_all(&run, error));
    TRY_END(run_and_report(&run, error));
end:
    *result = run.counts;
    result->struct_size = sizeof *result;
    result->is_complete = !status && !run.dropped;
    for (size_t i = 0; i < run.count; i++)
        ffd_task_free(run.tasks[i]);
    ffd_pool_destroy(&run.pool);
    ffd_files_free(&run.meshes);
    ffd_intern_free(&run.boxed);
    ffd_report_destroy(&run.report);
    ffd_depfile_destroy(&run.depfile);
    ffd_run_view_destroy(&run.view);
    ffd_frames_free(&run.frames);
    ffd_run_rows_close(&run.rows);
    ffd_journal_close(&run.journal);
    ffd_free(run.journal_path);
    ffd_free(run.base);
    ffd_jobs_close(&run.source);
    ffd_paths_free(&run.box_files);
    ffd_paths_free(&run.outputs);
    ffd_run_files_free(&run.files);
    ffd_run_drop_early(&run);
    return status;
}
