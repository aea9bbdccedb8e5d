#include "batch/measure.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/system/interrupt.h"
#include "job/input/settings.h"
#include <string.h>

/* Jobs in memory at a time. */
#define WINDOW ((size_t)256)

/* The longest wait, in seconds. */
#define POLL 0.1

typedef struct measuring {
    job_source *source;
    worker_pool *pool;
    pool_task *tasks[WINDOW]; /* count entries */
    size_t count;
    hash128 last; /* hash of the last job's mesh and the options for reading it */
    bool has_last;
    bool ended, starved; /* the source has no more jobs; its next job is not complete yet */
    size_t window;       /* jobs in memory at a time */
    bool counts;         /* only count the vertices of the first readable mesh: */
    bool found;
    uint64_t vertices;
    shown_box *box; /* else: the box round all meshes */
    path_list *files;
} measuring;

/* Hashes a job's mesh, as far as it is measured. */
static hash128 hash_input(const batch_job *job)
{
    const ffd_deform_desc read = {
        .input = job->desc.input, .only = job->desc.only, .only_count = job->desc.only_count};
    byte_buffer bytes = {0};
    ffd_settings_write(&read, SETTINGS_ALL, &bytes);
    ffd_buffer_append(&bytes, job->input, strlen(job->input));
    const hash128 hash = ffd_hash(bytes.data, bytes.size);
    ffd_buffer_free(&bytes);
    return hash;
}

/* Whether a job has a mesh that was not measured just before. */
static bool is_new(measuring *m, const batch_job *job)
{
    if (job->error.status)
        return false;
    const hash128 input = hash_input(job);
    const bool is_known = m->has_last && ffd_hash_equal(&m->last, &input);
    m->last = input;
    m->has_last = true;
    return !is_known;
}

static ffd_status read_jobs(measuring *m, ffd_error *error)
{
    m->starved = false;
    while (!m->ended && !m->starved && !m->found && m->count < m->window) {
        line_state state;
        pool_task *const task = ffd_alloc_zero(1, sizeof *task);
        if (!task)
            return ffd_fail_memory(error);
        const ffd_status status = ffd_jobs_next(m->source, &task->job, &state, error);
        m->ended = !status && state == LINE_NONE;
        m->starved = !status && state == LINE_LATER;
        if (status || state != LINE_READ || !is_new(m, &task->job)) {
            ffd_task_free(task);
            if (status)
                return status;
            continue;
        }
        task->mesh = ffd_hash(task->job.input, strlen(task->job.input));
        m->tasks[m->count++] = task;
    }
    return FFD_OK;
}

static ffd_status take_task(measuring *m, const pool_task *task, ffd_error *error)
{
    if (task->end.outcome == OUTCOME_FAILED)
        return FFD_OK;
    if (m->counts) {
        m->found = true;
        m->vertices = task->end.vertices;
        return FFD_OK;
    }
    ffd_shown_box_join(m->box, &task->end.box);
    for (size_t at = 0; at < task->rule.size; at += strlen(task->rule.data + at) + 1)
        TRY(ffd_paths_add(m->files, task->rule.data + at, error));
    return FFD_OK;
}

static ffd_status take_ended(measuring *m, ffd_error *error)
{
    ffd_status status = FFD_OK;
    size_t kept = 0;
    for (size_t i = 0; i < m->count; i++) {
        if (m->tasks[i]->state != TASK_ENDED) {
            m->tasks[kept++] = m->tasks[i];
            continue;
        }
        if (!status)
            status = take_task(m, m->tasks[i], error);
        ffd_task_free(m->tasks[i]);
    }
    m->count = kept;
    return status;
}

static ffd_status measure_all(measuring *m, ffd_error *error)
{
    while (!ffd_interrupt_requested()) {
        TRY(read_jobs(m, error));
        TRY(ffd_pool_assign(m->pool, m->tasks, m->count, error));
        if (ffd_pool_running(m->pool) > 0 || m->starved)
            ffd_pool_wait(m->pool, -1, POLL);
        TRY(take_ended(m, error));
        if (m->count == 0 && (m->ended || m->found))
            break;
    }
    return FFD_OK;
}

/* Sends the jobs of all shards to workers. member: the reason, for messages. */
static ffd_status measure(measuring *m, const job_source_desc *jobs, pool_desc *pool, const char *member,
                          ffd_error *error)
{
    job_source_desc all = *jobs;
    if (ffd_jobs_come_once(jobs))
        return ffd_fail(error, FFD_E_ARGUMENT, "%s reads the jobs twice, but %s", SPELLED(member),
                        jobs->next ? "its caller gives them only once"
                                   : "standard input and pipes can be read only once");
    all.shard = 0;
    all.shards = 1;
    ffd_status status;
    TRY_END(ffd_jobs_open(&all, &m->source, error));
    pool->origin = ffd_jobs_name(m->source);
    TRY_END(ffd_pool_create(pool, &m->pool, error));
    TRY_END(measure_all(m, error));
end:
    if (m->pool)
        ffd_pool_stop(m->pool);
    for (size_t i = 0; i < m->count; i++)
        ffd_task_free(m->tasks[i]);
    ffd_pool_destroy(&m->pool);
    ffd_jobs_close(&m->source);
    return status;
}

ffd_status ffd_batch_measure(const job_source_desc *jobs, const pool_desc *pool, bool wants_files,
                             shown_box *box, path_list *files, ffd_error *error)
{
    measuring m = {.window = WINDOW, .box = box, .files = files};
    pool_desc measurers = *pool;
    measurers.wishes.measure = true;
    measurers.wishes.depfile = wants_files;
    ffd_shown_box_clear(box);
    return measure(&m, jobs, &measurers, "{shared_box}", error);
}

ffd_status ffd_batch_count_vertices(const job_source_desc *jobs, const pool_desc *pool, uint64_t *vertices,
                                    bool *found, ffd_error *error)
{
    measuring m = {.window = 1, .counts = true}; /* one at a time, as the first readable mesh counts */
    pool_desc counters = *pool;
    counters.workers = 1;
    counters.wishes.count = true;
    const ffd_status status = measure(&m, jobs, &counters, "{positions}", error);
    *vertices = m.vertices;
    *found = m.found;
    return status;
}
