/* run_claims.c - claims the files of a batch's jobs, in their order. */
#include "base/file/place.h"
#include "batch/batch_run.h"
#include "batch/files/run_reads.h"

void ffd_run_fail_task(pool_task *task)
{
    task->failure = task->job.error;
    task->state = TASK_ENDED;
    task->end.outcome = OUTCOME_FAILED;
}

static void find_record(batch_run *run, pool_task *task)
{
    byte_buffer *const figures = run->report || run->view || run->rows.report ? &task->figures : NULL;
    task->order.has_record = ffd_journal_find(run->journal, &task->target, &task->order.record, figures);
    if (task->order.has_record && task->picture)
        ffd_run_find_drawn(run, task);
}

/* Names the picture of a job and its page, and claims their files, at the same time as the output. */
static ffd_status claim_picture(batch_run *run, pool_task *task, ffd_error *error)
{
    hash128 files[2];
    TRY(ffd_run_view_name(run->view, task, files, error));
    const hash128 seen = ffd_place_relative(&run->files.places, run->base, task->picture);
    const hash_block blocks[] = {{seen.bytes, sizeof seen.bytes}, {task->target.bytes, sizeof seen.bytes}};
    task->picture_target = ffd_hash_blocks(blocks, 2);
    TRY(ffd_claims_picture(&run->files, &task->job, &files[0], task->picture, error));
    return task->page && !task->job.error.status
               ? ffd_claims_picture(&run->files, &task->job, &files[1], task->page, error)
               : FFD_OK;
}

/* Claims the output of a job and checks what it reads, as far as its description says it. */
static ffd_status claim_output(batch_run *run, pool_task *task, ffd_error *error)
{
    batch_job *const job = &task->job;
    const job_kind kind = ffd_job_kind(job);
    if (job->target && ffd_claims_output(&run->files, job, &task->target, error))
        return FFD_E_MEMORY;
    if (run->desc->given->positions)
        task->target = ffd_run_rows_target(&run->rows, job->row, job->target ? &task->target : NULL);
    task->order.needs = ffd_claims_need(&run->files, job, &kind);
    task->state = task->order.needs.mesh || task->order.needs.lattices ? TASK_NEW
                  : task->order.needs.others                           ? TASK_SCANNED
                                                                       : TASK_WAITS;
    task->order.only_scans = ffd_job_count_sidecars(&kind) > 0;
    if (run->view && !job->error.status && claim_picture(run, task, error))
        return FFD_E_MEMORY;
    if (!job->error.status && ffd_reads_check(&run->files, job, error))
        return FFD_E_MEMORY;
    ffd_reads_check_boxes(&run->files, job);
    if (job->error.status)
        ffd_run_fail_task(task);
    else if (run->journal)
        find_record(run, task);
    return FFD_OK;
}

/* Sends a task to a worker, which scans the models of the folder of its output. */
static ffd_status ask_for_survey(batch_run *run, pool_task *task, ffd_error *error)
{
    task->order.surveys = task->order.needs.mesh = true;
    task->state = TASK_NEW;
    return ffd_run_set_survey(&run->files, task->job.target, SURVEY_ASKED, error);
}

/* Claims the files beside the output and copied with it, once they are known. */
static ffd_status claim_others(batch_run *run, pool_task *task, ffd_error *error)
{
    batch_job *const job = &task->job;
    job_kind kind = ffd_job_kind(job);
    if (task->has_scanned)
        TRY(ffd_reads_learn(&run->files, job, &kind, task->order.needs.mesh, task->end.sidecars, &task->found,
                            error));
    ffd_buffer_free(&task->found);
    task->has_scanned = false;
    kind.is_scanned = ffd_reads_know_mesh(&run->files, &kind);
    if (ffd_claims_need_survey(&run->files, job, &kind))
        return ask_for_survey(run, task, error);
    TRY(ffd_claims_others(&run->files, job, &kind, &task->passed, error));
    task->order.is_unsurveyed = ffd_claims_lack_survey(&run->files, job, &kind);
    task->state = TASK_WAITS;
    if (job->error.status)
        ffd_run_fail_task(task);
    return FFD_OK;
}

/* Whether a task that waits for a worker to scan needs that no more, since others were scanned. */
static bool is_known(const batch_run *run, const pool_task *task)
{
    if (task->state != TASK_NEW || task->order.surveys)
        return false;
    const job_kind kind = ffd_job_kind(&task->job);
    return ffd_claims_are_ready(&run->files, &task->job, &kind, &task->order.needs);
}

ffd_status ffd_run_learn(batch_run *run, pool_task *task, ffd_error *error)
{
    const bool is_new = task->scanned_in_vain && !task->is_learned;
    task->is_learned = task->is_learned || task->scanned_in_vain;
    if (task->state == TASK_ENDED && task->order.surveys &&
        ffd_run_survey(&run->files, task->job.target) == SURVEY_ASKED)
        return ffd_run_set_survey(&run->files, task->job.target, SURVEY_FAILED, error);
    return is_new ? ffd_reads_learn_nothing(&run->files, &task->job, task->order.needs.mesh, error) : FFD_OK;
}

/* No file beside an output, or copied with it, has the ending of a mesh format. So an output with one is
   claimed at once, if those of all jobs are known; any other is claimed when the files of all earlier jobs
   are. */
ffd_status ffd_run_claim_tasks(batch_run *run, ffd_error *error)
{
    bool settled = true;
    for (size_t i = 0; i < run->count; i++) {
        pool_task *const task = run->tasks[i];
        if (task->scanned_in_vain && !task->is_learned)
            TRY(ffd_run_learn(run, task, error));
        if (task->state == TASK_ORDERED && (settled || (task->has_mesh_name && !run->files.comes_once)))
            TRY(claim_output(run, task, error));
        if (settled && (task->state == TASK_SCANNED || is_known(run, task)))
            TRY(claim_others(run, task, error));
        settled = settled && ffd_task_is_settled(task);
    }
    return FFD_OK;
}
