#include "batch/worker.h"
#include "base/file/cleanup.h"
#include "base/file/mapping.h"
#include "base/file/output.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/system/interrupt.h"
#include "batch/fingerprint.h"
#include "batch/job_picture.h"
#include "batch/job_scan.h"
#include "batch/journal.h"
#include "batch/manifest/settings.h"
#include "batch/row_array.h"
#include "batch/wire.h"
#include "io/formats.h"
#include "job/chain/chain_load.h"
#include "job/chain/job_cache.h"
#include "job/deform_job.h"
#include "job/figures/figure_values.h"
#include "job/input/setting_lists.h"
#include "job/input/settings.h"
#include "job/input/shown_box.h"
#include "job/input/source.h"
#include "job/report/depfile.h"
#include "job/report/output_set.h"
#include "job/report/report.h"
#include "lattice/file/lattice_time.h"
#include "mesh/resource/copy_notes.h"
#include <ffd/program.h>
#include <ffd/version.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* As in wire_task. */
typedef struct task_texts {
    const char *origin, *input, *output, *picture, *page, *rows, *journal, *animation, *base, *said, *passed;
} task_texts;

typedef struct batch_worker {
    hash_cache hashes;                       /* of the files of all jobs so far */
    ffd_job_cache *cache;                    /* cache between jobs */
    byte_buffer text;                        /* of the task */
    ffd_deform_desc desc;                    /* likewise, in that text */
    task_texts texts;                        /* what else is in it */
    FOR_EACH_ANSWER_TEXT(ANSWER_TEXT_BUFFER) /* of the answer */
    path_list inputs;                        /* files of the task that its outputs depend on */
    ffd_output_list *written;                /* paths of the files that the task writes */
    path_list names;                         /* likewise, as the report has them */
    copy_notes notes;                        /* in the journal */
    job_journal *journal;                    /* opened for the notes of copies; or NULL */
    byte_buffer message;                     /* the whole answer */
    ffd_output_set *output_set; /* of the task: the models that share files with its output; or NULL */
} batch_worker;

/* Returns the next text. */
static const char *next_text(const char *text)
{
    return text + strlen(text) + 1;
}

static bool read_task(batch_worker *worker, wire_task *task)
{
    if (!ffd_process_take(task, sizeof *task) || task->text_size > WIRE_MOST)
        return false;
    worker->text.size = 0;
    char *const text = ffd_buffer_reserve(&worker->text, task->text_size + 1);
    if (!text || !ffd_process_take(text, task->text_size))
        return false;
    text[task->text_size] = 0;
    worker->text.size = task->text_size;
    return true;
}

/* Finds what the journal knows of a copy. */
static bool find_copy(void *context, const char *copy, hash128 *hash)
{
    batch_worker *const worker = context;
    const task_texts *const texts = &worker->texts;
    job_record record;
    if (*texts->journal && !worker->journal)
        ffd_journal_read(texts->journal, &worker->journal, NULL);
    const hash128 key = ffd_journal_copy_key(texts->base, copy);
    const bool found = worker->journal && ffd_journal_find(worker->journal, &key, &record, NULL);
    if (found)
        *hash = record.outputs;
    return found;
}

/* The first process writes the journal. */
static void put_copy(void *context, const char *copy, const hash128 *hash)
{
    batch_worker *const worker = context;
    const copy_note note = {ffd_journal_copy_key(worker->texts.base, copy), *hash};
    if (*worker->texts.journal)
        ffd_buffer_append(&worker->copies, &note, sizeof note);
}

/* Context of a job's log. */
typedef struct job_log {
    byte_buffer *lines;
    const char *subject;
    bool quiet, verbose;
} job_log;

/* Appends one line. File names may contain control characters, which are replaced. */
static void add_line(byte_buffer *lines, const char *subject, const char *line)
{
    const size_t before = lines->size;
    ffd_buffer_format(lines, "%s%s%s", subject, *subject ? ": " : "", line);
    ffd_make_one_line(lines->data + before, lines->size - before);
    ffd_buffer_text(lines, "\n");
}

static void log_line(void *user, ffd_log_level level, const char *line)
{
    const job_log *const log = user;
    if (level == FFD_LOG_WARNING ? !log->quiet : log->verbose)
        add_line(log->lines, log->subject, line);
}

/* Whether a text of `size` bytes contains a line. */
static bool has_line(const char *text, size_t size, const char *line, size_t length)
{
    for (const char *at = text, *end; at < text + size; at = end + 1) {
        end = memchr(at, '\n', (size_t)(text + size - at));
        if ((size_t)(end - at) + 1 == length && memcmp(at, line, length) == 0)
            return true;
    }
    return false;
}

/* Removes the lines from offset `before` on that also occur earlier: the picture repeats warnings of its job,
   and the page those of both. */
static void drop_repeated(byte_buffer *lines, size_t before)
{
    size_t kept = before, length;
    for (size_t at = before; at < lines->size; at += length) {
        const char *const line = lines->data + at;
        length = (size_t)((const char *)memchr(line, '\n', lines->size - at) - line) + 1;
        if (has_line(lines->data, kept, line, length))
            continue;
        memmove(lines->data + kept, line, length);
        kept += length;
    }
    lines->size = kept;
}

static void log_error(batch_worker *worker, const ffd_error *error)
{
    char line[2048];
    ffd_error_format(error, line, sizeof line);
    add_line(&worker->log, "", line);
}

/* The row for a job's positions. */
typedef struct job_row {
    row_array array;
    uint64_t index;
    bool dry;          /* write nothing */
    ffd_error failure; /* why it was not written */
} job_row;

/* An ffd_positions_function. */
static ffd_status take_positions(void *user, const double *positions, size_t count)
{
    job_row *const row = user;
    return row->dry ? ffd_row_check(&row->array, positions, count, &row->failure)
                    : ffd_row_write(&row->array, row->index, positions, count, &row->failure);
}

/* Hashes the results of a job: the output (known: its hash; NULL: read it) and the row. */
static bool hash_results(const ffd_deform_desc *desc, const hash128 *known, const job_row *row, hash128 *hash)
{
    hash128 parts[2];
    size_t count = 0;
    if (known)
        parts[count++] = *known;
    else if (desc->output || desc->in_place) {
        if (ffd_fingerprint_output(desc, &parts[count++], NULL))
            return false;
    }
    if (row && ffd_row_hash(&row->array, row->index, &parts[count++], NULL))
        return false;
    *hash = count == 1 ? parts[0] : ffd_hash(parts, count * sizeof *parts);
    return true;
}

/* Whether the results exist and are what the job would make. */
static bool is_up_to_date(const wire_task *task, const ffd_deform_desc *desc, const job_row *row,
                          wire_answer *answer)
{
    return task->wishes.resume && task->order.has_record &&
           ffd_hash_equal(&answer->end.record.inputs, &task->order.record.inputs) &&
           hash_results(desc, NULL, row, &answer->end.record.outputs) &&
           ffd_hash_equal(&answer->end.record.outputs, &task->order.record.outputs);
}

/* The cache counts against the memory limit: if the limit is reached, tries again without it. */
static ffd_status deform(ffd_deform_desc *desc, ffd_job_result *result)
{
    byte_buffer *const lines = ((const job_log *)desc->log_user)->lines;
    const size_t before = lines->size;
    const ffd_status status = ffd_deform_run(desc, result, NULL);
    if (status != FFD_E_LIMIT || !desc->cache)
        return status;
    lines->size = before;
    desc->cache = NULL;
    return ffd_deform_run(desc, result, NULL);
}

/* Hashes the input files and lists them, as far as wanted. */
static ffd_status hash_files(batch_worker *worker, const wire_task *task, const ffd_deform_desc *desc,
                             wire_answer *answer, ffd_error *error)
{
    if (!task->wishes.records && !task->wishes.dry && !task->wishes.depfile && !task->wishes.frames)
        return FFD_OK;
    /* In a dry run this also shows that they can be read. */
    return ffd_fingerprint_inputs(desc, &task->content, &worker->hashes, &worker->inputs,
                                  &answer->end.record.inputs, error);
}

/* Adds the name of an output in the folder of `target`, or below, as the job names it: output. */
static ffd_status add_name(path_list *names, const char *path, const char *target, const char *output,
                           ffd_error *error)
{
    const size_t folder = (size_t)(ffd_path_name(target) - target);
    if (strncmp(path, target, folder) != 0)
        return ffd_paths_add(names, path, error);
    char *const name = ffd_path_sibling(output, path + folder);
    const ffd_status status = name ? ffd_paths_add(names, name, error) : ffd_fail_memory(error);
    ffd_free(name);
    return status;
}

/* Lists the files beside the output of a job that was not run now. What cannot be known is left out. */
static ffd_status list_files(batch_worker *worker, const ffd_deform_desc *desc, ffd_error *error)
{
    path_list *const paths = &worker->written->names;
    const char *const target = desc->in_place ? desc->input.path : desc->output;
    if (paths->count > 0 || !target || !ffd_deform_list_outputs(desc, NULL))
        return FFD_OK;
    ffd_paths_free(paths);
    return ffd_paths_add(paths, target, error);
}

/* Lists the outputs of a job that has succeeded, or would. */
static ffd_status list_outputs(batch_worker *worker, const wire_task *task, const ffd_deform_desc *desc,
                               ffd_error *error)
{
    const path_list *const paths = &worker->written->names;
    const char *const target = desc->in_place ? desc->input.path : desc->output;
    TRY(list_files(worker, desc, error));
    for (size_t i = 0; i < paths->count; i++)
        TRY(add_name(&worker->names, paths->paths[i], target, worker->texts.output, error));
    return task->has_row ? ffd_paths_add(&worker->names, worker->texts.rows, error) : FFD_OK;
}

/* Adds the picture and the page, if they are wanted. */
static ffd_status add_picture(const task_texts *texts, path_list *list, ffd_error *error)
{
    if (*texts->picture)
        TRY(ffd_paths_add(list, texts->picture, error));
    return *texts->page ? ffd_paths_add(list, texts->page, error) : FFD_OK;
}

/* Lists the outputs of a job that has ended like this, with its picture, and makes the depfile rule. */
static ffd_status describe_outputs(batch_worker *worker, const wire_task *task, const wire_answer *answer,
                                   const ffd_deform_desc *desc, ffd_status done, ffd_error *error)
{
    const bool is_there = answer->end.has_picture || (!done && task->wishes.dry); /* also of a gate */
    if (!done)
        TRY(list_outputs(worker, task, desc, error));
    if (is_there && !task->wishes.frames) /* else the first process adds it, once it is drawn */
        TRY(add_picture(&worker->texts, &worker->names, error));
    if (done)
        return FFD_OK;
    if (is_there || answer->end.has_frame)
        TRY(add_picture(&worker->texts, &worker->written->names, error));
    return task->wishes.depfile && !task->wishes.dry && desc->output
               ? ffd_depfile_rule(&worker->written->names, &worker->inputs, &worker->rule, error)
               : FFD_OK;
}

/* Adds the names and paths of outputs to the answer. done: the status of the job. Returns it, or a failure.
 */
static ffd_status add_outputs(batch_worker *worker, const wire_task *task, const wire_answer *answer,
                              const ffd_deform_desc *desc, ffd_status done, ffd_error *error)
{
    const path_list *const paths = &worker->written->names;
    if (!task->wishes.report && !task->wishes.depfile && !task->wishes.result)
        return done;
    const ffd_status status = describe_outputs(worker, task, answer, desc, done, error);
    for (size_t i = 0; i < worker->names.count; i++)
        ffd_buffer_append(&worker->outputs, worker->names.paths[i], strlen(worker->names.paths[i]) + 1);
    for (size_t i = 0; i < paths->count && task->wishes.depfile; i++)
        ffd_buffer_append(&worker->targets, paths->paths[i], strlen(paths->paths[i]) + 1);
    return done ? done : status;
}

/* Dry run: makes the checks that do not need the mesh. */
static ffd_status plan(const ffd_deform_desc *desc, ffd_error *error)
{
    const chain_files files = {.lattices = desc->lattices,
                               .count = desc->lattice_count,
                               .set = desc->set,
                               .set_count = desc->set_count,
                               .time = desc->has_time ? &desc->time : NULL,
                               .mesh = &desc->input};
    if (desc->output)
        TRY(ffd_output_check_with_folder(desc->output, desc->force || desc->if_changed, error));
    return ffd_chain_check(&files, error);
}

/* Describes the picture of a job. look: kept for it. */
static job_picture describe_picture(const batch_worker *worker, const wire_task *task,
                                    const ffd_deform_desc *desc, ffd_view_desc *look)
{
    const task_texts *const texts = &worker->texts;
    *look = ffd_task_look_desc(&task->look, *texts->animation ? texts->animation : NULL);
    return (job_picture){.path = texts->picture,
                         .page = *texts->page ? texts->page : NULL,
                         .job = desc,
                         .look = look,
                         .frame = task->order.has_frame ? &task->order.frame : NULL,
                         .force = desc->force || desc->if_changed};
}

static void name_picture(const batch_worker *worker, ffd_job_result *result)
{
    result->picture = worker->texts.picture;
    result->page = *worker->texts.page ? worker->texts.page : NULL;
}

/* Draws the picture of a job that was done or refused by a gate, or only measures its frame. result: of the
   job; replaced if only the picture is made (is_all), or if that fails. */
static ffd_status draw(const batch_worker *worker, const wire_task *task, bool is_all,
                       const ffd_deform_desc *desc, wire_answer *answer, ffd_job_result *result)
{
    ffd_view_desc look;
    const job_picture picture = describe_picture(worker, task, desc, &look);
    const bool measures = task->wishes.frames && !task->order.draws;
    ffd_job_result drawn;
    byte_buffer *const lines = ((const job_log *)desc->log_user)->lines;
    const size_t before = lines->size;
    ffd_job_picture_drop_mesh(desc);
    const ffd_status status = measures ? ffd_job_picture_measure(&picture, &answer->end.frame, &drawn)
                                       : ffd_job_picture_write(&picture, &drawn);
    drop_repeated(lines, before);
    const bool is_shown = status == FFD_OK || status == FFD_E_GATE;
    answer->end.has_frame = is_shown && measures;
    answer->end.has_picture = is_shown && !measures;
    if (is_all || !is_shown)
        *result = drawn;
    if (answer->end.has_picture)
        name_picture(worker, result);
    return result->status;
}

/* Hashes the results that were just written. The output is read again unless its bytes were hashed while
   written. A job that went on after a scan copies nothing. */
static bool know_results(batch_worker *worker, const wire_task *task, const ffd_deform_desc *desc,
                         const job_row *row, hash128 *results)
{
    hash128 bytes;
    const bool has_output = desc->output || desc->in_place;
    if (!has_output || !ffd_job_cache_find_output(worker->cache, &bytes) ||
        (!task->order.scans && ffd_fingerprint_has_copies(desc, &worker->hashes)))
        return hash_results(desc, NULL, row, results);
    const hash128 output = ffd_fingerprint_written(&bytes);
    return hash_results(desc, &output, row, results);
}

/* Deforms, and fills in the counts. */
static ffd_status make_output(batch_worker *worker, const wire_task *task, ffd_deform_desc *desc,
                              wire_answer *answer, ffd_job_result *result)
{
    const cache_counts before = ffd_job_cache_counts(worker->cache);
    ffd_job_cache_begin_job(worker->cache, task->wishes.records, &worker->hashes.kept);
    const ffd_status status = deform(desc, result);
    answer->end.counts.reads = ffd_job_cache_counts(worker->cache).reads - before.reads;
    answer->end.counts.searches = ffd_job_cache_counts(worker->cache).searches - before.searches;
    answer->end.has_state = ffd_job_cache_find_state(worker->cache, &answer->end.state);
    return status;
}

/* Refuses to replace a row, before anything else, so that it stays whatever happens to the job. */
static ffd_status take_row(const wire_task *task, const job_row *row, const ffd_deform_desc *desc,
                           wire_answer *answer, ffd_error *error)
{
    if (!row)
        return FFD_OK;
    answer->end.took_row =
        task->wishes.resume || desc->force || desc->if_changed || !ffd_row_is_done(&row->array, row->index);
    return answer->end.took_row
               ? FFD_OK
               : ffd_fail_file(error, FFD_E_EXISTS, row->array.path,
                               "row %" PRIu64 " is there already ({force} replaces it, {resume} goes on)",
                               row->index);
}

/* Refuses to replace a picture or a page, before anything is written. */
static ffd_status check(const batch_worker *worker, const wire_task *task, ffd_deform_desc *desc,
                        ffd_error *error)
{
    const char *const paths[] = {worker->texts.picture, worker->texts.page};
    /* A resumed run may replace what an earlier one left. */
    desc->force = desc->force || task->wishes.resume;
    for (size_t i = 0; i < 2; i++)
        if (*paths[i])
            TRY(ffd_job_picture_check(paths[i], desc->force || desc->if_changed, error));
    return FFD_OK;
}

/* Restores the error of the row, which the callback cannot return. */
static ffd_status judge_row(const job_row *row, ffd_status status, ffd_error *error)
{
    if (!row || !status || !row->failure.status)
        return status;
    *error = row->failure;
    return error->status;
}

/* Whether the picture of a job that is up to date is there: it is known by its bytes, and not older than an
   output. The time of an array does not say when a row was made. */
static bool has_picture(const batch_worker *worker, const wire_task *task, const ffd_deform_desc *desc)
{
    const task_texts *const texts = &worker->texts;
    hash128 bytes;
    return task->order.has_drawn &&
           (!desc->output || ffd_job_picture_is_current(texts->picture, desc->output)) &&
           !ffd_job_picture_hash(texts->picture, *texts->page ? texts->page : NULL, &bytes, NULL) &&
           ffd_hash_equal(&bytes, &task->order.drawn);
}

/* Hashes a picture that was drawn. */
static void know_picture(const batch_worker *worker, wire_answer *answer)
{
    const task_texts *const texts = &worker->texts;
    answer->end.has_drawn =
        answer->end.has_picture &&
        !ffd_job_picture_hash(texts->picture, *texts->page ? texts->page : NULL, &answer->end.drawn, NULL);
}

/* Deforms, unless the results are up to date, and draws the picture (NULL: none is wanted). */
static ffd_status do_job(batch_worker *worker, const wire_task *task, const char *picture, job_row *row,
                         ffd_deform_desc *desc, wire_answer *answer, ffd_job_result *result)
{
    const bool has_output = is_up_to_date(task, desc, row, answer);
    answer->end.has_picture = has_output && picture && has_picture(worker, task, desc);
    if (has_output && (!picture || answer->end.has_picture)) {
        answer->end.outcome = OUTCOME_SKIPPED;
        answer->end.has_frame = answer->end.has_picture && task->wishes.frames;
        answer->end.frame = task->order.frame;
        return FFD_OK;
    }
    ffd_status status = check(worker, task, desc, &result->error);
    if (status || (task->wishes.dry && (has_output || !task->dry_run_job)))
        return status ? status : plan(desc, &result->error);
    desc->dry_run = task->wishes.dry;
    answer->end.dry_run_done = task->wishes.dry;
    if (!has_output)
        status = judge_row(row, make_output(worker, task, desc, answer, result), &result->error);
    if (task->wishes.dry)
        return status;
    if (picture && (status == FFD_OK || status == FFD_E_GATE))
        status = draw(worker, task, has_output, desc, answer, result);
    /* Results exist now: defer a signal that would end the worker, so that they are recorded. */
    ffd_process_defer_stop(true);
    if (!status && task->wishes.records)
        answer->end.has_record =
            has_output || know_results(worker, task, desc, row, &answer->end.record.outputs);
    if (answer->end.has_record)
        know_picture(worker, answer);
    return status;
}

/* Draws the picture of a job that has ended. The picture must show what the job has made. */
static ffd_status draw_ended(batch_worker *worker, const wire_task *task, ffd_deform_desc *desc,
                             wire_answer *answer, ffd_job_result *result)
{
    const unsigned losses = ffd_mapping_losses();
    hash128 inputs;
    TRY(ffd_mapping_judge(losses,
                          ffd_fingerprint_inputs(desc, &task->content, &worker->hashes, &worker->inputs,
                                                 &inputs, &result->error),
                          &result->error));
    if (!ffd_hash_equal(&inputs, &task->order.record.inputs))
        return ffd_fail_file(&result->error, FFD_E_INVALID, worker->texts.picture,
                             "not drawn: the mesh or a lattice has changed since the job has ended");
    desc->force = desc->force || task->wishes.resume;
    const ffd_status status = draw(worker, task, true, desc, answer, result);
    ffd_process_defer_stop(true);
    know_picture(worker, answer);
    return status == FFD_E_GATE ? FFD_OK : status; /* of the gate the job has told */
}

/* A column that is not a placeholder may be a note. */
static void hint_at_columns(const wire_task *task, ffd_error *error)
{
    const size_t length = strlen(error->message);
    if (task->wishes.of_table &&
        strncmp(error->message, CHAIN_NO_PLACEHOLDER, sizeof CHAIN_NO_PLACEHOLDER - 1) == 0)
        snprintf(error->message + length, sizeof error->message - length, "%s",
                 SPELLED("; {csv_ignore} leaves columns of a table out"));
}

/* What is wrong with the settings is wrong with the line of the manifest. Returns the status. */
static ffd_status blame_manifest(const char *origin, const wire_task *task, ffd_error *error)
{
    char what[sizeof error->message];
    if (error->status != FFD_E_ARGUMENT)
        return error->status;
    ffd_error_format(error, what, sizeof what);
    return ffd_fail_line(error, FFD_E_INVALID, origin, (size_t)task->line, "%s", what);
}

/* Measures the mesh of a job, for the shared box. */
static ffd_status measure(batch_worker *worker, const wire_task *task, const ffd_deform_desc *desc,
                          wire_answer *answer, ffd_error *error)
{
    path_list files = {0};
    ffd_status status;
    TRY_END(ffd_shown_box_add(&answer->end.box, &desc->input, desc->only, desc->only_count,
                              task->wishes.depfile ? &files : NULL, NULL, error));
    for (size_t i = 0; i < files.count; i++)
        ffd_buffer_append(&worker->rule, files.paths[i], strlen(files.paths[i]) + 1);
end:
    ffd_paths_free(&files);
    return status;
}

/* Counts the vertices of a job's mesh. */
static ffd_status count_vertices(const wire_task *task, const ffd_deform_desc *desc, wire_answer *answer,
                                 ffd_error *error)
{
    mesh_document *document = NULL;
    ffd_source source = desc->input;
    source.only_positions = true;
    const ffd_status status = ffd_source_open(&source, task->threads, &document, error);
    answer->end.vertices = status ? 0 : ffd_mesh_vertex_count(document);
    ffd_source_close(&document);
    return status;
}

/* Tells the first process that a scan has found nothing, and the job goes on. */
static ffd_status send_nothing_found(ffd_error *error)
{
    wire_answer note;
    memset(&note, 0, sizeof note);
    note.goes_on = true;
    return ffd_process_give(&note, sizeof note)
               ? FFD_OK
               : ffd_fail(error, FFD_E_IO, "the connection to the first process has failed");
}

/* Does everything that the task asks for. */
static ffd_status do_task(batch_worker *worker, const wire_task *task, const char *picture, job_row *row,
                          ffd_deform_desc *desc, wire_answer *answer, ffd_job_result *result)
{
    const ffd_shared_box shared = {.box = task->box};
    const unsigned losses = ffd_mapping_losses();
    ffd_error *const error = &result->error;
    ffd_hash_cache_begin_job(&worker->hashes);
    desc->shared_box = task->has_box ? &shared : NULL;
    if (task->order.draws)
        return draw_ended(worker, task, desc, answer, result);
    TRY(take_row(task, row, desc, answer, error));
    if (task->order.scans)
        TRY(ffd_job_scan(&worker->hashes, task, desc, &worker->rule, answer, error));
    if (answer->scanned)
        return FFD_OK;
    if (task->order.scans && task->wishes.reports_empty_scan)
        TRY(send_nothing_found(error));
    if (task->wishes.count)
        return ffd_mapping_judge(losses, count_vertices(task, desc, answer, error), error);
    /* Files that a killed run has set aside are restored before they are read. */
    if (desc->in_place && !task->wishes.dry) {
        TRY(ffd_restore_output(desc->input.path, error));
        ffd_hash_cache_begin_job(&worker->hashes);
    }
    if (task->wishes.measure)
        return measure(worker, task, desc, answer, error);
    TRY(ffd_mapping_judge(losses, hash_files(worker, task, desc, answer, error), error));
    ffd_status status = do_job(worker, task, *picture ? picture : NULL, row, desc, answer, result);
    status = add_outputs(worker, task, answer, desc, status, error);
    answer->end.own_box = result->own_box;
    return status;
}

/* Prepares the models that share files with the output, as the first process knows them. text: of the passed
   names. */
static ffd_status take_passed(batch_worker *worker, const wire_task *task, const char *text,
                              const ffd_deform_desc *desc, ffd_error *error)
{
    const mesh_format *const format = ffd_format_table(ffd_job_output_format(desc));
    TRY(ffd_output_set_create(&worker->output_set, error));
    worker->output_set->notes = &worker->notes;
    if (!format || !format->sidecars)
        return FFD_OK;
    for (uint32_t i = 0; i < task->passed_count; i++) {
        const char *const users = next_text(text);
        TRY(ffd_users_add(&worker->output_set->users.users, text, users, error));
        text = next_text(users);
    }
    worker->output_set->users.is_complete = !task->order.is_unsurveyed;
    return FFD_OK;
}

/* Finds the settings of the job and the other texts. */
static ffd_status take_texts(batch_worker *worker, ffd_error *error)
{
    const char *at = worker->text.data;
    ffd_deform_desc *const desc = &worker->desc;
    TRY(ffd_settings_take(&at, desc, error));
    desc->input.path = at;
    task_texts *const texts = &worker->texts;
    texts->origin = next_text(at);
    texts->input = next_text(texts->origin);
    texts->output = next_text(texts->input);
    texts->picture = next_text(texts->output);
    texts->page = next_text(texts->picture);
    texts->rows = next_text(texts->page);
    texts->journal = next_text(texts->rows);
    texts->animation = next_text(texts->journal);
    texts->base = next_text(texts->animation);
    texts->said = next_text(texts->base);
    texts->passed = next_text(texts->said);
    ffd_buffer_text(&worker->log, texts->said);
    if (!desc->morphs)
        return FFD_OK;
    desc->morph_results = ffd_alloc_zero(desc->lattice_count, sizeof *desc->morph_results);
    return desc->morph_results ? FFD_OK : ffd_fail_memory(error);
}

/* A column "time" of a table is the option of that name, where it is not a placeholder. set: gets the values
   without it; freed by the caller. */
static ffd_status take_time(const wire_task *task, ffd_deform_desc *desc, ffd_setting **set, ffd_error *error)
{
    bool has_keys = false, has_placeholder = false;
    size_t column = 0;
    while (column < desc->set_count && strcmp(desc->set[column].name, "time") != 0)
        column++;
    if (!task->wishes.of_table || column == desc->set_count)
        return FFD_OK;
    for (size_t i = 0; i < desc->lattice_count; i++) {
        bool keyed, named;
        ffd_lattice_look(&desc->lattices[i], &desc->set[column], &keyed, &named);
        has_keys = has_keys || keyed;
        has_placeholder = has_placeholder || named;
    }
    if (!has_keys)
        return FFD_OK;
    if (has_placeholder)
        return ffd_fail(error, FFD_E_INVALID,
                        "the column \"time\" may be the time of the keys or a placeholder of that name: the "
                        "lattices have both");
    *set = ffd_alloc(desc->set_count, sizeof **set);
    if (!*set)
        return ffd_fail_memory(error);
    memcpy(*set, desc->set, column * sizeof **set);
    memcpy(*set + column, desc->set + column + 1, (desc->set_count - column - 1) * sizeof **set);
    TRY(ffd_member_read(ffd_deform_member_of("time"), desc, desc->set[column].value, error));
    desc->set = *set;
    desc->set_count--;
    return FFD_OK;
}

static ffd_status run_task(batch_worker *worker, const wire_task *task, wire_answer *answer,
                           ffd_job_result *result)
{
    ffd_deform_desc own = worker->desc, *const desc = &own; /* the report has the values of the row */
    ffd_setting *set = NULL;
    job_row row = {.array = task->rows, .index = task->row, .dry = task->wishes.dry};
    job_log log = {&worker->log, desc->input.path, task->wishes.quiet, task->wishes.verbose};
    row.array.path = worker->texts.rows;
    desc->log = log_line;
    desc->log_user = &log;
    desc->quality = task->wishes.quality;
    desc->make_folders = true;
    desc->output_list = worker->written;
    desc->positions = task->has_row ? take_positions : NULL;
    desc->positions_user = &row;
    desc->cache = worker->cache;
    if (take_passed(worker, task, worker->texts.passed, desc, &result->error))
        return result->error.status;
    desc->output_set = worker->output_set;
    if (desc->threads == 0)
        desc->threads = task->threads;
    ffd_status status = take_time(task, desc, &set, &result->error);
    if (!status)
        status =
            do_task(worker, task, worker->texts.picture, task->has_row ? &row : NULL, desc, answer, result);
    ffd_free(set);
    if (status) {
        worker->rule.size = 0;
        hint_at_columns(task, &result->error);
    }
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(&result->error, desc->input.path);
    return status ? blame_manifest(worker->texts.origin, task, &result->error) : FFD_OK;
}

static void make_entry(batch_worker *worker, const wire_task *task, const wire_answer *answer,
                       const ffd_job_result *result)
{
    const task_texts *const texts = &worker->texts;
    byte_buffer set = {0};
    ffd_settings_json(&worker->desc, &set);
    const report_entry entry = {.line = task->line,
                                .input = texts->input,
                                .output = *texts->output ? texts->output : NULL,
                                .outputs = &worker->names,
                                .positions = task->has_row ? texts->rows : NULL,
                                .row = task->row,
                                .set = set.failed ? NULL : set.data,
                                .result = result,
                                .planned = task->wishes.dry && !answer->end.dry_run_done && !result->status,
                                .stable = task->wishes.stable};
    ffd_report_entry_text(&entry, &worker->entry);
    worker->entry.failed = worker->entry.failed || set.failed;
    ffd_buffer_free(&set);
}

/* Adds the result with those of its morph targets. */
static void append_result(batch_worker *worker, const ffd_job_result *result)
{
    const ffd_morph_results *const morphs = &result->morphs;
    ffd_buffer_append(&worker->result, result, sizeof *result);
    if (morphs->results)
        ffd_buffer_append(&worker->result, morphs->results, morphs->count * sizeof *result);
}

static void answer_task(batch_worker *worker, const wire_task *task, wire_answer *answer)
{
    ffd_job_result result;
    ffd_result_clear(&result);
    ffd_deform_desc_init(&worker->desc, sizeof worker->desc);
    const ffd_status taken = take_texts(worker, &result.error);
    result.status = taken ? taken : run_task(worker, task, answer, &result);
    if (result.status) {
        answer->end.outcome = OUTCOME_FAILED;
        if (!task->wishes.measure && !task->wishes.count) /* the job itself reports it later */
            log_error(worker, &result.error);
    }
    /* After running out of memory, a worker may fail with any job. */
    answer->retires = result.status == FFD_E_MEMORY;
    if (answer->end.has_record && !task->wishes.dry) {
        ffd_report_figures(&result, &worker->figures);
        ffd_buffer_append(&worker->figures, "", 1);
    }
    if (task->wishes.report && !taken && !answer->scanned && answer->end.outcome != OUTCOME_SKIPPED)
        make_entry(worker, task, answer, &result);
    const bool is_told = task->order.draws && !result.status; /* when the job has ended */
    if (task->wishes.result && !answer->scanned && answer->end.outcome != OUTCOME_SKIPPED && !is_told)
        append_result(worker, &result);
    ffd_output_set_destroy(&worker->output_set);
    ffd_free(worker->desc.morph_results);
    ffd_setting_lists_free(&worker->desc);
}

/* For a list of the texts of the answer, in their order. */
#define TEXT_OF_WORKER(name) &worker->name,

/* Sends one message: several would wake the first process several times. If memory runs out for it, sends a
   header that says so. */
static bool send_answer(batch_worker *worker, wire_answer *answer)
{
    const byte_buffer *const texts[ANSWER_TEXTS] = {FOR_EACH_ANSWER_TEXT(TEXT_OF_WORKER)};
    byte_buffer *const message = &worker->message;
    for (int i = 0; i < ANSWER_TEXTS; i++)
        answer->sizes[i] = texts[i]->size;
    message->size = 0;
    ffd_buffer_append(message, answer, sizeof *answer);
    for (int i = 0; i < ANSWER_TEXTS; i++) {
        ffd_buffer_append(message, texts[i]->data, texts[i]->size);
        message->failed = message->failed || texts[i]->failed;
    }
    if (!message->failed)
        return ffd_process_give(message->data, message->size);
    memset(answer->sizes, 0, sizeof answer->sizes);
    answer->out_of_memory = answer->retires = true;
    answer->end.outcome = OUTCOME_FAILED;
    return ffd_process_give(answer, sizeof *answer);
}

void ffd_worker_build(char build[WORKER_BUILD])
{
    snprintf(build, WORKER_BUILD, "%s %zu %zu %zu", ffd_version_build(), sizeof(wire_task),
             sizeof(wire_answer), sizeof(ffd_job_result));
}

static void clear_answer(batch_worker *worker)
{
    byte_buffer *const texts[ANSWER_TEXTS] = {FOR_EACH_ANSWER_TEXT(TEXT_OF_WORKER)};
    for (int i = 0; i < ANSWER_TEXTS; i++)
        texts[i]->size = 0;
    ffd_paths_free(&worker->inputs);
    ffd_paths_free(&worker->names);
    ffd_paths_free(&worker->written->names);
}

static void free_worker(batch_worker *worker)
{
    byte_buffer *const texts[ANSWER_TEXTS] = {FOR_EACH_ANSWER_TEXT(TEXT_OF_WORKER)};
    ffd_job_cache_destroy(&worker->cache);
    ffd_hash_cache_free(&worker->hashes);
    ffd_buffer_free(&worker->text);
    for (int i = 0; i < ANSWER_TEXTS; i++)
        ffd_buffer_free(texts[i]);
    ffd_journal_close(&worker->journal);
    ffd_paths_free(&worker->inputs);
    ffd_paths_free(&worker->names);
    ffd_output_list_destroy(&worker->written);
    ffd_buffer_free(&worker->message);
}

/* Does jobs until there are no more. Returns the process's exit code. */
static int run_worker(void)
{
    batch_worker worker = {.notes = {find_copy, put_copy, &worker}};
    wire_task task;
    ffd_cleanup_on_crashes();
    ffd_guard_inputs();
    ffd_interrupt_ignore();
    ffd_process_follow_parent();
    worker.text.failed = ffd_job_cache_create(&worker.cache, NULL) != FFD_OK ||
                         ffd_output_list_create(&worker.written, NULL) != FFD_OK;
    bool going = !worker.text.failed;
    while (going && read_task(&worker, &task)) {
        wire_answer answer;
        memset(&answer, 0, sizeof answer); /* also clears padding, which is sent */
        ffd_shown_box_clear(&answer.end.box);
        clear_answer(&worker);
        answer_task(&worker, &task, &answer);
        ffd_kept_free(&worker.hashes.kept);
        going = send_answer(&worker, &answer) && !answer.retires;
        ffd_process_defer_stop(false);
    }
    const int code = worker.text.failed ? ffd_status_exit_code(FFD_E_MEMORY) : 0;
    free_worker(&worker);
    return code;
}

bool ffd_worker_main(int argc, char **argv, int *exit_code)
{
    char build[WORKER_BUILD];
    if (argc != 2 || strcmp(argv[0], WORKER_NAME) != 0)
        return false;
    ffd_worker_build(build);
    *exit_code = strcmp(argv[1], build) == 0 ? run_worker() : ffd_status_exit_code(FFD_E_UNSUPPORTED);
    return true;
}
