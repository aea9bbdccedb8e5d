/* batch_ends.c - handles ended jobs of a batch: prints, counts, records and reports them. */
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "batch/batch_run.h"
#include "batch/manifest/settings.h"
#include "job/figures/figure_values.h"
#include "job/report/report.h"
#include "job/report/report_file.h"
#include <ffd/program.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

const char *ffd_run_manifest(const batch_run *run)
{
    const job_source_desc *const jobs = &run->desc->jobs;
    return jobs->manifest || jobs->next || jobs->table ? ffd_jobs_name(run->source) : NULL;
}

void ffd_run_log_error(batch_run *run, const ffd_error *error)
{
    char line[2100];
    const size_t length = ffd_error_format(error, line, sizeof line - 1);
    memcpy(line + (length < sizeof line - 2 ? length : sizeof line - 2), "\n", 2);
    ffd_progress_print(&run->progress, line);
}

/* Appends an error and a line break. */
static void append_error(const ffd_error *error, byte_buffer *text)
{
    char line[2048];
    ffd_error_format(error, line, sizeof line);
    ffd_buffer_text(text, line);
    ffd_buffer_text(text, "\n");
}

/* Appends "FILE:LINE: ". */
static void append_place(const batch_job *job, const char *manifest, byte_buffer *text)
{
    ffd_error place;
    char line[2048];
    ffd_fail_line(&place, FFD_E_INVALID, manifest, (size_t)job->line, "%s", "");
    ffd_error_format(&place, line, sizeof line);
    ffd_buffer_text(text, line);
}

/* Appends "NAME=VALUE, NAME=VALUE: ", with control characters replaced. */
static void append_settings(const batch_job *job, byte_buffer *text)
{
    const size_t before = text->size;
    ffd_settings_show(&job->desc, text);
    if (text->size == before)
        return;
    ffd_make_one_line(text->data + before, text->size - before);
    ffd_buffer_text(text, ": ");
}

/* Appends the lines of a job's log from an offset on, and its failure, each preceded by its place in the
   manifest (NULL: there is none) and its values of placeholders. */
static void append_lines(const pool_task *task, const char *manifest, size_t from, byte_buffer *text)
{
    byte_buffer lines = {0}, lead = {0};
    if (task->log.size > from)
        ffd_buffer_append(&lines, task->log.data + from, task->log.size - from);
    if (task->failure.status)
        append_error(&task->failure, &lines);
    if (lines.size == 0) {
        text->failed = text->failed || lines.failed;
        ffd_buffer_free(&lines);
        return;
    }
    if (manifest)
        append_place(&task->job, manifest, &lead);
    const size_t place = lead.size;
    append_settings(&task->job, &lead);
    for (const char *line = lines.data, *const end = line + lines.size, *next; line < end; line = next) {
        next = memchr(line, '\n', (size_t)(end - line));
        next = next ? next + 1 : end;
        /* An error of the manifest line has its place already. */
        if (!place || (size_t)(next - line) < place || memcmp(line, lead.data, place) != 0)
            ffd_buffer_append(text, lead.data, lead.size);
        ffd_buffer_append(text, line, (size_t)(next - line));
    }
    text->failed = text->failed || lines.failed || lead.failed;
    ffd_buffer_free(&lines);
    ffd_buffer_free(&lead);
}

static const row_array *rows_of(const batch_run *run)
{
    return run->desc->given->positions ? &run->rows.array : NULL;
}

/* Appends a job's report entry, if no worker has made it. */
static void append_entry(const batch_run *run, const pool_task *task, byte_buffer *text)
{
    const batch_job *const job = &task->job;
    const row_array *const rows = rows_of(run);
    ffd_job_result result, *morphs = NULL;
    byte_buffer set = {0};
    path_list outputs = {0};
    ffd_result_clear(&result);
    if (task->result.size >= sizeof result)
        ffd_run_take_result(task, &result, &morphs);
    const bool listed = !ffd_run_list_outputs(run, task, &outputs, NULL);
    if (task->failure.status) {
        result.error = task->failure;
        result.status = task->failure.status;
    }
    ffd_settings_json(&job->desc, &set);
    const bool skipped = task->end.outcome == OUTCOME_SKIPPED;
    const bool is_known = task->end.outcome != OUTCOME_FAILED && !task->result.size && task->figures.size;
    ffd_run_name_picture(task, &result);
    const report_entry entry = {.line = job->line,
                                .input = job->input,
                                .output = ffd_job_output_name(job),
                                .outputs = &outputs,
                                .positions = rows ? rows->path : NULL,
                                .row = job->row,
                                .set = set.failed ? NULL : set.data,
                                .result = &result,
                                .figures = is_known ? task->figures.data : NULL,
                                .skipped = skipped,
                                .stable = run->desc->pool.wishes.stable};
    ffd_report_entry_text(&entry, text);
    text->failed = text->failed || set.failed || !listed;
    ffd_buffer_free(&set);
    ffd_paths_free(&outputs);
    ffd_free(morphs);
}

/* Bits of a state that fit into the table: its numbers have 39 bits, and one says whether a warning was
   given. */
#define STATE_BITS 38
#define TOLD 1u

/* Records the state of the mesh that an ended job has read, so that outputs of two states are not mixed
   without a warning: appends one to the job's log, once for each mesh, if an earlier job has read another
   state. Errors: FFD_E_MEMORY. */
static ffd_status note_state(file_table *states, pool_task *task, ffd_error *error)
{
    uint64_t known;
    if (!task->end.has_state)
        return FFD_OK;
    const uint64_t state = load_u64(task->end.state.bytes) >> (64 - STATE_BITS) << 1;
    if (!ffd_files_find(states, &task->mesh, &known))
        return ffd_files_put(states, &task->mesh, state, error);
    if (known & TOLD || known == state)
        return FFD_OK;
    const size_t before = task->log.size;
    ffd_buffer_format(&task->log,
                      "%s: has changed while the run reads it: jobs before this one have read another state",
                      task->job.input);
    ffd_make_one_line(task->log.data + before, task->log.size - before);
    ffd_buffer_text(&task->log, "\n");
    return task->log.failed ? ffd_fail_memory(error)
                            : ffd_files_put(states, &task->mesh, known | TOLD, error);
}

/* rows: of positions, or NULL. */
static void print_plan(const pool_task *task, const row_array *rows)
{
    const batch_job *const job = &task->job;
    const char *const output = ffd_job_output_name(job);
    printf("%s %s -> ", task->end.outcome == OUTCOME_SKIPPED ? "up to date:" : "to do:", job->input);
    if (output)
        printf("%s%s", output, rows ? ", " : "\n");
    if (rows)
        printf("%s row %" PRIu64 "\n", rows->path, job->row);
}

/* Makes the report entry of a job whose worker has not made it. */
static ffd_status complete_entry(const batch_run *run, pool_task *task, ffd_error *error)
{
    if (!task->entry.size)
        append_entry(run, task, &task->entry);
    return task->entry.failed ? ffd_fail_memory(error) : FFD_OK;
}

static ffd_status report_task(const batch_run *run, ffd_report *report, pool_task *task, ffd_error *error)
{
    TRY(complete_entry(run, task, error));
    return ffd_report_add_text(report, task->index, task->entry.data, task->entry.size, error);
}

static ffd_status show_task(batch_run *run, pool_task *task, ffd_error *error)
{
    TRY(complete_entry(run, task, error));
    return ffd_run_view_add(run->view, task, &task->entry, error);
}

/* Prints what was logged of a job since the last time. */
static ffd_status print_log(batch_run *run, pool_task *task, ffd_error *error)
{
    byte_buffer lines = {0};
    append_lines(task, ffd_run_manifest(run), task->told, &lines);
    ffd_buffer_append(&lines, "", 1);
    task->told = task->log.size;
    ffd_status status;
    TRY_END(lines.failed ? ffd_fail_memory(error) : FFD_OK);
    ffd_progress_print(&run->progress, lines.data);
end:
    ffd_buffer_free(&lines);
    return status;
}

/* Tells the caller of the end of a job, with all that was logged of it. */
static ffd_status call_ended(const batch_run *run, const pool_task *task, ffd_error *error)
{
    byte_buffer lines = {0};
    if (!run->desc->given->ended)
        return FFD_OK;
    append_lines(task, ffd_run_manifest(run), 0, &lines);
    ffd_buffer_append(&lines, "", 1);
    ffd_status status;
    TRY_END(lines.failed ? ffd_fail_memory(error) : FFD_OK);
    ffd_run_call_ended(run, task, lines.data);
end:
    ffd_buffer_free(&lines);
    return status;
}

/* A failed job must not leave positions, neither its own nor those of an earlier run. */
static void clear_row(const batch_run *run, const pool_task *task)
{
    const batch_desc *const desc = run->desc;
    const bool replaces = run->rows.goes_on && (desc->force || desc->jobs.resume);
    if (desc->given->positions && !desc->pool.wishes.dry && (task->end.took_row || replaces) &&
        task->job.row < run->rows.array.rows)
        ffd_row_clear(&run->rows.array, task->job.row);
}

/* Records what the job has made. */
static void put_records(const batch_run *run, const pool_task *task)
{
    ffd_journal_put(run->journal, &task->target, &task->end.record, task->figures.data, task->figures.size);
}

/* Notes the copies that a job has made. */
static void put_copies(const batch_run *run, const pool_task *task)
{
    copy_note note;
    job_record known;
    for (size_t at = 0; at + sizeof note <= task->copies.size; at += sizeof note) {
        memcpy(&note, task->copies.data + at, sizeof note);
        const job_record record = {note.content, note.content};
        if (!ffd_journal_find(run->journal, &note.target, &known, NULL) ||
            !ffd_hash_equal(&known.outputs, &note.content))
            ffd_journal_put(run->journal, &note.target, &record, "", 0);
    }
}

/* Learns from the end of a job, and logs it. */
static ffd_status learn_end(batch_run *run, pool_task *task, ffd_error *error)
{
    uint32_t index;
    TRY(ffd_run_learn(run, task, error));
    TRY(note_state(&run->meshes, task, error));
    TRY(print_log(run, task, error));
    if (task->end.own_box && !ffd_intern(&run->boxed, &task->mesh, sizeof task->mesh, &index))
        return ffd_fail_memory(error);
    return FFD_OK;
}

static void count(ffd_batch_result *counts, const pool_task *task)
{
    uint64_t *const numbers[] = {&counts->done, &counts->skipped, &counts->failed};
    ++*numbers[task->end.outcome];
}

/* A job has failed: by itself, or by its picture. */
static void note_failure(batch_run *run, const pool_task *task)
{
    clear_row(run, task);
    if (run->desc->given->stop)
        run->ending = true;
}

/* Does what must happen as soon as a job ends, with or without its picture, even if earlier jobs still run.
 */
static ffd_status note_made(batch_run *run, pool_task *task, ffd_error *error)
{
    const bool failed = task->end.outcome == OUTCOME_FAILED;
    const ffd_status learned = learn_end(run, task, error);
    count(&run->made, task);
    if (failed)
        note_failure(run, task);
    if (run->journal && task->end.outcome == OUTCOME_DONE && task->end.has_record)
        put_records(run, task);
    if (run->journal)
        put_copies(run, task);
    TRY(learned);
    task->is_made = run->frames.wait && task->end.has_frame;
    task->is_refused = failed;
    if (!task->is_made)
        return FFD_OK;
    const hash128 mesh = ffd_run_read_place(&run->files, task->job.desc.input.path);
    return ffd_frames_add(&run->frames, task, &mesh, error);
}

/* The same when the picture of a job that has waited is drawn, or is not to be drawn. */
static ffd_status note_drawn(batch_run *run, pool_task *task, ffd_error *error)
{
    if (task->end.outcome == OUTCOME_FAILED && !task->is_refused)
        note_failure(run, task);
    return print_log(run, task, error);
}

/* Tells of a job that has ended, with its picture. */
static ffd_status tell_end(batch_run *run, pool_task *task, ffd_error *error)
{
    count(&run->counts, task);
    ffd_run_put_drawn(run, task);
    TRY(call_ended(run, task, error));
    if (run->report && !ffd_report_is_ordered(run->report))
        TRY(report_task(run, run->report, task, error));
    return run->rows.report ? report_task(run, run->rows.report, task, error) : FFD_OK;
}

static ffd_status note_end(batch_run *run, pool_task *task, ffd_error *error)
{
    task->noted = true;
    TRY(run->frames.are_drawn ? note_drawn(run, task, error) : note_made(run, task, error));
    return task->is_made && !run->frames.are_drawn ? FFD_OK : tell_end(run, task, error);
}

ffd_status ffd_run_note_ends(batch_run *run, ffd_error *error)
{
    bool is_first = true; /* no earlier job is still running or waiting */
    for (size_t i = 0; i < run->count; i++) {
        pool_task *const task = run->tasks[i];
        const bool is_valid = !task->job.error.status;
        is_first = is_first && (task->state == TASK_ENDED || task->state == TASK_DROPPED);
        if (task->state != TASK_ENDED || task->noted || (!is_valid && !is_first && !run->ending))
            continue;
        if (run->ending && !is_valid) {
            task->state = TASK_DROPPED;
            run->dropped = true;
        } else {
            TRY(note_end(run, task, error));
        }
    }
    return FFD_OK;
}

/* Does what must happen in the order of the jobs. */
static ffd_status emit_task(batch_run *run, pool_task *task, ffd_error *error)
{
    if (run->desc->given->is_program && run->desc->pool.wishes.dry && task->end.outcome != OUTCOME_FAILED)
        print_plan(task, rows_of(run));
    if (run->depfile && task->rule.size) {
        ffd_depfile_add(run->depfile, &task->rule);
        if (run->box_files.count)
            TRY(ffd_run_list_texts(&task->targets, &run->outputs, error));
    }
    if (run->view)
        TRY(show_task(run, task, error));
    return run->report && ffd_report_is_ordered(run->report) ? report_task(run, run->report, task, error)
                                                             : FFD_OK;
}

/* Whether any output is in the order of the jobs. */
static bool emits_in_order(const batch_run *run)
{
    return run->desc->pool.wishes.dry || run->depfile || run->view ||
           (run->report && ffd_report_is_ordered(run->report));
}

ffd_status ffd_run_take_ended(batch_run *run, ffd_error *error)
{
    const bool in_order = emits_in_order(run);
    size_t kept = 0;
    run->waiting = 0;
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < run->count; i++) {
        pool_task *const task = run->tasks[i];
        const bool is_over = task->state == TASK_DROPPED || (task->state == TASK_ENDED && task->noted);
        if (status || !is_over || (in_order && kept > 0)) {
            run->tasks[kept++] = task;
            run->waiting += ffd_task_is_pending(task);
            continue;
        }
        if (task->state == TASK_ENDED)
            status = run->frames.wait && !run->frames.are_drawn ? ffd_frames_put(&run->frames, task, error)
                                                                : emit_task(run, task, error);
        ffd_task_free(task);
    }
    run->count = kept;
    return status;
}
