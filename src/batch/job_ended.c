/* job_ended.c - tells the caller of a batch that a job has ended. */
#include "base/memory/memory.h"
#include "batch/batch_run.h"
#include "job/figures/figure_values.h"
#include "job/report/output_set.h"
#include "job/report/report_figures.h"
#include "json/json_parse.h"

/* Reads the figures of a skipped job, as far as the journal has them. */
static void read_figures(const pool_task *task, ffd_job_result *result)
{
    const json_input input = {
        .text = task->figures.data, .size = task->figures.size - 1, .name = "the journal"};
    json_tree tree;
    if (task->figures.size == 0 || ffd_json_parse(&input, &tree, NULL))
        return;
    ffd_figures_read(&tree, 0, result);
    ffd_json_tree_free(&tree);
}

/* The pointers in the answer are those of the worker's memory. */
void ffd_run_take_result(const pool_task *task, ffd_job_result *result, ffd_job_result **morphs)
{
    const ffd_deform_desc *const desc = &task->job.desc;
    memcpy(result, task->result.data, sizeof *result);
    const size_t size = task->result.size - sizeof *result;
    *morphs = size ? ffd_alloc(size, 1) : NULL;
    if (*morphs)
        memcpy(*morphs, task->result.data + sizeof *result, size);
    result->morphs =
        (ffd_morph_results){*morphs ? size / sizeof *result : 0, desc->morphs, desc->lattices, *morphs};
    result->outputs = NULL;
    result->picture = result->page = result->own_frame = NULL;
}

ffd_status ffd_run_list_texts(const byte_buffer *texts, path_list *list, ffd_error *error)
{
    for (size_t at = 0; at < texts->size; at += strlen(texts->data + at) + 1)
        TRY(ffd_paths_add(list, texts->data + at, error));
    return FFD_OK;
}

ffd_status ffd_run_list_outputs(const batch_run *run, const pool_task *task, path_list *list,
                                ffd_error *error)
{
    const bool waited = run->frames.wait && task->is_made, failed = task->end.outcome == OUTCOME_FAILED;
    if (!waited || !failed || task->is_refused)
        TRY(ffd_run_list_texts(&task->outputs, list, error));
    if (waited && task->end.has_picture)
        TRY(ffd_paths_add(list, task->picture, error));
    return waited && task->end.has_picture && task->page ? ffd_paths_add(list, task->page, error) : FFD_OK;
}

void ffd_run_name_picture(const pool_task *task, ffd_job_result *result)
{
    const bool is_there = task->end.has_picture;
    result->picture = is_there ? task->picture : NULL;
    result->page = is_there ? task->page : NULL;
    result->own_frame = is_there ? task->own_frame : NULL;
}

void ffd_run_call_ended(const batch_run *run, const pool_task *task, const char *log)
{
    const ffd_batch_desc *const given = run->desc->given;
    ffd_job_result result, *morphs = NULL;
    ffd_output_list outputs = {0};
    if (!given->ended)
        return;
    ffd_result_clear(&result);
    if (task->result.size >= sizeof result)
        ffd_run_take_result(task, &result, &morphs);
    else if (task->end.outcome != OUTCOME_FAILED)
        read_figures(task, &result);
    if (task->failure.status) {
        result.error = task->failure;
        result.status = result.error.status;
    }
    ffd_run_list_outputs(run, task, &outputs.names, NULL);
    result.outputs = &outputs;
    ffd_run_name_picture(task, &result);
    const ffd_batch_job job = {.line = task->job.line,
                               .row = task->job.row,
                               .input = task->job.input,
                               .output = ffd_job_output_name(&task->job),
                               .skipped = task->end.outcome == OUTCOME_SKIPPED,
                               .log = log,
                               .result = &result};
    given->ended(given->ended_user, &job);
    ffd_free(morphs);
    ffd_paths_free(&outputs.names);
}
