#include "batch/pool.h"
#include "base/file/temporary.h"
#include "base/memory/memory.h"
#include "base/system/cgroup.h"
#include "base/system/clock.h"
#include "base/system/processors.h"
#include "base/text/words.h"
#include "batch/worker.h"
#include "job/input/settings.h"
#include <ffd/job.h>
#include <ffd/version.h>
#include <stdio.h>
#include <string.h>

/* Seconds for running jobs to finish when all are stopped, and again for a worker to remove unfinished files.
   Together they stay below a second. */
#define GRACE 0.4

typedef struct pool_worker {
    worker_process *process; /* NULL: not started, or ended */
    pool_task *task;         /* NULL: idle */
    byte_buffer answer;      /* bytes received so far */
    hash128 mesh;            /* of the current or last task */
    uint64_t memory;         /* bytes that this task may take: the worker keeps its mesh */
    bool has_mesh, timed_out, stopped, retires;
    bool was_logged; /* the task was sent */
    bool is_unheard; /* its message is invalid, or memory ran out for it */
    bool is_ending;  /* its time is up */
    double deadline; /* 0: none */
} pool_worker;

struct worker_pool {
    pool_desc desc;             /* with desc.workers > 0 */
    int processors;             /* shared by the workers */
    pool_worker *workers;       /* desc.workers entries */
    worker_process **processes; /* the same processes, as an array to wait for */
    ffd_error refusal;          /* the workers are of another build */
    bool dry_run_done;          /* dry run: a job was tried, all but writing */
    uint64_t memory;            /* bytes that all workers together may take; UINT64_MAX: no limit */
    pool_shortage shortage;     /* if needed > 0 */
    pool_counts counts;
};

ffd_status ffd_pool_create(const pool_desc *desc, worker_pool **pool, ffd_error *error)
{
    *pool = ffd_alloc_zero(1, sizeof **pool);
    if (!*pool)
        return ffd_fail_memory(error);
    (*pool)->desc = *desc;
    (*pool)->processors = ffd_processor_count();
    (*pool)->memory = desc->workers == 0 ? ffd_cgroup_memory_limit(CGROUP_SELF) : UINT64_MAX;
    if (desc->workers == 0)
        (*pool)->desc.workers = (*pool)->processors;
    const size_t workers = (size_t)(*pool)->desc.workers;
    (*pool)->workers = ffd_alloc_zero(workers, sizeof *(*pool)->workers);
    (*pool)->processes = ffd_alloc_zero(workers, sizeof *(*pool)->processes);
    if ((*pool)->workers && (*pool)->processes)
        return FFD_OK;
    ffd_pool_destroy(pool);
    return ffd_fail_memory(error);
}

/* Sending */

static void append_word(byte_buffer *text, const char *word)
{
    if (word)
        ffd_buffer_append(text, word, strlen(word) + 1);
}

static uint32_t count_words(const byte_buffer *words)
{
    uint32_t count = 0;
    for (size_t i = 0; i < words->size; i++)
        count += words->data[i] == 0;
    return count;
}

static bool send_task(const worker_pool *pool, pool_worker *worker, const pool_task *task, int threads)
{
    const pool_desc *const desc = &pool->desc;
    const batch_job *const job = &task->job;
    byte_buffer text = {0}; /* sent together with its header: two messages would wake the worker twice */
    wire_task head;
    memset(&head, 0, sizeof head); /* also clears padding, which is sent */
    ffd_buffer_append(&text, &head, sizeof head);
    ffd_settings_write(&job->desc, SETTINGS_ALL, &text);
    append_word(&text, job->desc.input.path);
    append_word(&text, pool->desc.origin);
    append_word(&text, job->input);
    append_word(&text, ffd_job_output_name(job) ? ffd_job_output_name(job) : "");
    append_word(&text, task->picture ? task->picture : "");
    append_word(&text, task->page ? task->page : "");
    append_word(&text, desc->rows ? desc->rows->path : "");
    append_word(&text, desc->journal ? desc->journal : "");
    append_word(&text, job->look.animation ? job->look.animation : "");
    append_word(&text, desc->base ? desc->base : "");
    ffd_buffer_append(&text, task->log.data, task->log.size);
    ffd_buffer_append(&text, "", 1);
    ffd_buffer_append(&text, task->passed.data, task->passed.size);
    head.text_size = text.size - sizeof head;
    head.line = job->line;
    head.row = job->row;
    head.content = job->content;
    head.wishes = desc->wishes;
    head.order = task->order;
    head.look = ffd_task_look(&job->look);
    head.passed_count = count_words(&task->passed) / 2;
    head.threads = threads;
    head.dry_run_job = desc->wishes.dry && !pool->dry_run_done;
    head.has_row = desc->rows != NULL;
    if (desc->rows)
        head.rows = *desc->rows;
    head.has_box = desc->box != NULL;
    if (desc->box)
        head.box = *desc->box;
    if (!text.failed)
        memcpy(text.data, &head, sizeof head);
    const bool sent = !text.failed && ffd_process_send(worker->process, text.data, text.size);
    ffd_buffer_free(&text);
    return sent;
}

/* Which worker does what */

static bool is_of(const pool_worker *worker, const pool_task *task)
{
    return worker->has_mesh && ffd_hash_equal(&worker->mesh, &task->mesh);
}

/* Whether another worker has loaded the task's mesh. */
static bool is_taken(const worker_pool *pool, const pool_worker *worker, const pool_task *task)
{
    for (int i = 0; i < pool->desc.workers; i++)
        if (&pool->workers[i] != worker && is_of(&pool->workers[i], task))
            return true;
    return false;
}

/* Chooses the next task of a worker: the first one whose mesh the worker has, or no other worker has. Else
   the first one with a mesh that is not large: reading it again is cheaper than an idle processor. A large
   mesh in N workers would take N times the memory, while one worker can use as many threads. */
static pool_task *choose(const worker_pool *pool, const pool_worker *worker, pool_task *const *tasks,
                         size_t count)
{
    pool_task *first = NULL;
    for (size_t i = 0; i < count; i++) {
        if (!tasks[i] || (tasks[i]->state != TASK_WAITS && tasks[i]->state != TASK_NEW))
            continue;
        if (is_of(worker, tasks[i]) || !is_taken(pool, worker, tasks[i]))
            return tasks[i];
        if (!first && !tasks[i]->is_large)
            first = tasks[i];
    }
    return first;
}

/* Memory */

/* Returns the memory that is left beside the workers that run and, unless worker is NULL, all other idle
   ones. */
static uint64_t memory_of_others(const worker_pool *pool, const pool_worker *worker)
{
    uint64_t left = pool->memory;
    for (int i = 0; i < pool->desc.workers; i++) {
        const pool_worker *const other = &pool->workers[i];
        if (other->task || (worker && other != worker && other->process))
            left -= other->memory < left ? other->memory : left;
    }
    return left;
}

/* Whether a task fits into this much memory. */
static bool fits(const worker_pool *pool, pool_task *task, uint64_t left)
{
    if (task->memory == 0 && left < UINT64_MAX)
        task->memory = ffd_job_memory(&task->job, pool->desc.draws);
    return task->memory <= left;
}

/* Ends a worker. end: how it ended; or NULL. */
static void finish_worker(pool_worker *worker, process_end *end)
{
    ffd_process_finish(&worker->process, end);
    ffd_buffer_free(&worker->answer);
    worker->has_mesh = worker->retires = false;
}

static void note_shortage(worker_pool *pool, const pool_task *task)
{
    pool_shortage *const shortage = &pool->shortage;
    if (shortage->needed > 0)
        return;
    *shortage = (pool_shortage){.limit = pool->memory,
                                .needed = task->memory,
                                .running = (int)ffd_pool_running(pool),
                                .processors = pool->processors};
    ffd_name_shown(task->job.input, shortage->name, sizeof shortage->name);
}

/* Whether memory suffices for an idle worker's next task, if need be without the other idle workers, which
   are ended. Else the task waits for those that run; but one always may. */
static bool make_room(worker_pool *pool, const pool_worker *worker, pool_task *task)
{
    for (int i = 0; i < pool->desc.workers && !fits(pool, task, memory_of_others(pool, worker)); i++) {
        pool_worker *const other = &pool->workers[i];
        if (other != worker && !other->task)
            finish_worker(other, NULL);
    }
    if (fits(pool, task, memory_of_others(pool, worker)) || ffd_pool_running(pool) == 0)
        return true;
    note_shortage(pool, task);
    return false;
}

const pool_shortage *ffd_pool_shortage(const worker_pool *pool)
{
    return pool->shortage.needed > 0 ? &pool->shortage : NULL;
}

/* Counts the tasks that can run at the same time, including running ones: at most one a worker, one for each
   large mesh, and as many as memory allows. */
static int count_runnable(const worker_pool *pool, pool_task *const *tasks, size_t count)
{
    int found = (int)ffd_pool_running(pool);
    const hash128 *large = NULL;
    uint64_t left = memory_of_others(pool, NULL);
    for (size_t i = 0; i < count && found < pool->desc.workers; i++) {
        pool_task *const task = tasks[i];
        if (!task || !ffd_task_is_pending(task))
            continue;
        if (task->is_large && ((large && ffd_hash_equal(large, &task->mesh)) || is_taken(pool, NULL, task)))
            continue;
        if (!fits(pool, task, left))
            break;
        left -= left < UINT64_MAX ? task->memory : 0;
        found++;
        large = task->is_large ? &task->mesh : large;
    }
    return found;
}

static void begin_task(const worker_pool *pool, pool_worker *worker, pool_task *task)
{
    worker->task = task;
    worker->mesh = task->mesh;
    worker->memory = task->memory;
    worker->has_mesh = true;
    worker->timed_out = worker->stopped = worker->is_ending = worker->is_unheard = false;
    worker->deadline = pool->desc.timeout > 0 ? ffd_clock_seconds() + pool->desc.timeout : 0;
    task->order.scans = task->state == TASK_NEW;
    task->end.took_row = task->end.took_row || pool->desc.rows != NULL;
    task->state = TASK_RUNS;
}

static ffd_status start_worker(const worker_pool *pool, pool_worker *worker, ffd_error *error)
{
    char build[WORKER_BUILD];
    ffd_worker_build(build);
    return ffd_process_start(pool->desc.program, WORKER_NAME, build, &worker->process, error);
}

ffd_status ffd_pool_assign(worker_pool *pool, pool_task *const *tasks, size_t count, ffd_error *error)
{
    const pool_desc *const desc = &pool->desc;
    if (pool->refusal.status) {
        if (error)
            *error = pool->refusal;
        return pool->refusal.status;
    }
    for (int i = 0; i < desc->workers; i++) {
        pool_worker *const worker = &pool->workers[i];
        pool_task *const task = worker->task ? NULL : choose(pool, worker, tasks, count);
        if (!task)
            continue;
        if (!make_room(pool, worker, task))
            return FFD_OK; /* none of the others goes first: the task could wait for ever */
        const ffd_status status = worker->process ? FFD_OK : start_worker(pool, worker, error);
        if (status && ffd_pool_running(pool) > 0)
            return FFD_OK; /* go on with the workers that exist */
        if (status)
            return status;
        pool->counts.workers += !worker->has_mesh;
        begin_task(pool, worker, task);
        const int share = pool->processors / count_runnable(pool, tasks, count);
        /* If sending fails, the worker has ended; that shows when its answer is read. */
        worker->was_logged = send_task(pool, worker, task, share < 1 ? 1 : share);
    }
    return FFD_OK;
}

/* Ends */

static void end_task(pool_worker *worker, task_outcome outcome)
{
    worker->task->state = TASK_ENDED;
    worker->task->end.outcome = outcome;
    worker->task = NULL;
    worker->deadline = 0;
}

/* For a list of the texts of a task, in the order of an answer. */
#define TEXT_OF_TASK(name) &task->name,

/* Returns the size of an answer with its texts; 0: it is invalid. */
static uint64_t answer_size(const wire_answer *head)
{
    uint64_t size = sizeof *head;
    for (int i = 0; i < ANSWER_TEXTS; i++) {
        if (head->sizes[i] > WIRE_MOST)
            return 0;
        size += head->sizes[i];
    }
    return size;
}

/* Takes the result of a scan, the first text; the task goes back to the window. */
static void take_scan(pool_worker *worker, const wire_answer *head, const char *found)
{
    pool_task *const task = worker->task;
    ffd_buffer_append(&task->found, found, head->sizes[0]);
    task->end.sidecars = (size_t)head->end.sidecars;
    task->has_scanned = true;
    task->was_returned = false;
    worker->retires = head->retires;
    if (head->out_of_memory || task->found.failed) {
        ffd_fail_file(&task->failure, FFD_E_MEMORY, task->job.input, "out of memory");
        end_task(worker, OUTCOME_FAILED);
        return;
    }
    task->state = TASK_SCANNED;
    worker->task = NULL;
    worker->deadline = 0;
}

/* Takes the texts of an answer. Returns false if memory runs out. */
static bool take_texts(pool_task *task, const wire_answer *head, const char *at)
{
    byte_buffer *const texts[ANSWER_TEXTS] = {FOR_EACH_ANSWER_TEXT(TEXT_OF_TASK)};
    bool is_whole = true;
    task->log.size = 0; /* that of the answer begins with it */
    if (!task->order.draws && head->end.outcome != OUTCOME_SKIPPED)
        task->figures.size = 0;
    if (task->order.draws && head->end.outcome == OUTCOME_FAILED)
        task->result.size = 0;
    for (int i = 0; i < ANSWER_TEXTS; i++) {
        ffd_buffer_append(texts[i], at, head->sizes[i]);
        at += head->sizes[i];
        is_whole = is_whole && !texts[i]->failed;
    }
    return is_whole;
}

/* Adds how the drawing has ended to how the job has. */
static void take_drawing(pool_task *task, const task_end *end)
{
    task->end.has_picture = end->has_picture;
    task->end.has_drawn = end->has_drawn;
    task->end.drawn = end->drawn;
    if (end->outcome == OUTCOME_FAILED || task->end.outcome == OUTCOME_SKIPPED)
        task->end.outcome = end->outcome;
}

/* Takes a worker's answer if it is complete. Returns false if it is invalid. */
static bool take_answer(worker_pool *pool, pool_worker *worker)
{
    byte_buffer *const bytes = &worker->answer;
    wire_answer head;
    if (bytes->size < sizeof head)
        return true;
    memcpy(&head, bytes->data, sizeof head);
    const uint64_t size = answer_size(&head);
    if (!worker->task || ((head.scanned || head.goes_on) && !worker->task->order.scans) || size == 0)
        return false;
    if (bytes->size < size)
        return true;
    pool_task *const task = worker->task;
    if (head.goes_on) { /* the rest of the answer may be here already */
        task->order.scans = false;
        task->scanned_in_vain = true;
        bytes->size -= sizeof head;
        memmove(bytes->data, bytes->data + sizeof head, bytes->size);
        return take_answer(pool, worker);
    }
    if (head.scanned) {
        take_scan(worker, &head, bytes->data + sizeof head);
        bytes->size = 0;
        return true;
    }
    task->scanned_in_vain = task->scanned_in_vain || task->order.scans;
    const bool lost = !take_texts(task, &head, bytes->data + sizeof head);
    if (head.out_of_memory || lost)
        ffd_fail_file(&task->failure, FFD_E_MEMORY, task->job.input, "out of memory");
    if (task->order.draws)
        take_drawing(task, &head.end);
    else
        task->end = head.end;
    pool->counts.jobs.reads += head.end.counts.reads;
    pool->counts.jobs.searches += head.end.counts.searches;
    worker->retires = head.retires;
    pool->dry_run_done = pool->dry_run_done || head.end.dry_run_done;
    bytes->size = 0;
    end_task(worker, lost ? OUTCOME_FAILED : task->end.outcome);
    return true;
}

/* Describes a failure that the worker could not report. */
static void describe_failure(const worker_pool *pool, const pool_worker *worker, const process_end *end,
                             ffd_error *error)
{
    const char *const name = worker->task->job.input;
    if (pool->refusal.status)
        *error = pool->refusal;
    else if (worker->timed_out)
        ffd_fail_file(error, FFD_E_LIMIT, name, "took longer than %g %s ({timeout})", pool->desc.timeout,
                      pool->desc.timeout == 1 ? "second" : "seconds");
    else if (worker->stopped)
        ffd_fail_file(error, FFD_E_LIMIT, name, "was stopped before it ended");
    else if (!end->signal && end->code == ffd_status_exit_code(FFD_E_MEMORY))
        ffd_fail_file(error, FFD_E_MEMORY, name, "out of memory");
    else if (worker->is_unheard || (!end->signal && end->code == 0))
        ffd_fail_file(
            error, FFD_E_IO, name,
            "the connection to the worker that did this job has failed: what it has made is not known");
    else if (end->killed)
        ffd_fail_file(error, FFD_E_MEMORY, name,
                      "was ended by the system (%s), probably because memory ran out", end->text);
    else
        ffd_fail_file(error, FFD_E_LIMIT, name, "crashed: %s", end->text);
}

static void end_worker(worker_pool *pool, pool_worker *worker)
{
    process_end end;
    finish_worker(worker, &end);
    /* Builds that know of no such workers take them for a command. */
    if (!end.signal && (end.code == ffd_status_exit_code(FFD_E_UNSUPPORTED) ||
                        end.code == ffd_status_exit_code(FFD_E_ARGUMENT)))
        ffd_fail_file(&pool->refusal, FFD_E_UNSUPPORTED, pool->desc.program ? pool->desc.program : "ffd",
                      "is of another build than the library, which is %s: it cannot do the jobs of a batch",
                      ffd_version());
    if (!worker->task)
        return;
    pool_task *const task = worker->task;
    if (!worker->was_logged &&
        !task->was_returned) { /* the worker had ended before: give the task to another one, once */
        task->state = task->order.scans ? TASK_NEW : TASK_WAITS;
        task->was_returned = true;
        worker->task = NULL;
        return;
    }
    describe_failure(pool, worker, &end, &task->failure);
    if (task->job.target) {
        ffd_restore_output(task->job.target, NULL); /* it may have been killed while renaming files */
        ffd_temporary_discard(task->job.target);
    }
    if (task->picture)
        ffd_temporary_discard(task->picture);
    if (task->page)
        ffd_temporary_discard(task->page);
    end_task(worker, OUTCOME_FAILED);
}

static void receive(worker_pool *pool, pool_worker *worker)
{
    const bool alive = ffd_process_receive(worker->process, &worker->answer);
    const bool understood = take_answer(pool, worker) && !worker->answer.failed;
    if (understood && alive && !worker->retires)
        return;
    worker->is_unheard = !understood;
    if (!understood && alive)
        ffd_process_kill(worker->process);
    end_worker(pool, worker);
}

static void check_time(pool_worker *worker, double now)
{
    if (!worker->task || worker->deadline <= 0 || now < worker->deadline)
        return;
    if (worker->is_ending) {
        worker->deadline = 0;
        ffd_process_kill(worker->process);
        return;
    }
    worker->is_ending = true;
    worker->timed_out = !worker->stopped;
    worker->deadline = now + GRACE;
    ffd_process_stop(worker->process);
}

/* Returns the seconds until the next deadline, at most `seconds`. */
static double time_left(const worker_pool *pool, double seconds)
{
    const double now = ffd_clock_seconds();
    for (int i = 0; i < pool->desc.workers; i++) {
        const double deadline = pool->workers[i].task ? pool->workers[i].deadline : 0;
        if (deadline > 0 && deadline - now < seconds)
            seconds = deadline > now ? deadline - now : 0;
    }
    return seconds;
}

void ffd_pool_wait(worker_pool *pool, int input, double seconds)
{
    for (int i = 0; i < pool->desc.workers; i++)
        pool->processes[i] = pool->workers[i].process;
    ffd_process_wait(pool->processes, (size_t)pool->desc.workers, input, time_left(pool, seconds));
    const double now = ffd_clock_seconds();
    for (int i = 0; i < pool->desc.workers; i++) {
        if (!pool->workers[i].process)
            continue;
        receive(pool, &pool->workers[i]);
        check_time(&pool->workers[i], now);
    }
}

size_t ffd_pool_running(const worker_pool *pool)
{
    size_t count = 0;
    for (int i = 0; i < pool->desc.workers; i++)
        count += pool->workers[i].task != NULL;
    return count;
}

pool_counts ffd_pool_counts(const worker_pool *pool)
{
    return pool->counts;
}

void ffd_pool_stop(worker_pool *pool)
{
    const double end = ffd_clock_seconds() + GRACE;
    for (int i = 0; i < pool->desc.workers; i++) {
        pool_worker *const worker = &pool->workers[i];
        if (!worker->task)
            continue;
        worker->stopped = !worker->is_ending;
        worker->deadline = end;
    }
    while (ffd_pool_running(pool) > 0)
        ffd_pool_wait(pool, -1, GRACE);
}

void ffd_pool_destroy(worker_pool **pool)
{
    if (!pool || !*pool)
        return;
    for (int i = 0; (*pool)->workers && i < (*pool)->desc.workers; i++) {
        ffd_process_finish(&(*pool)->workers[i].process, NULL);
        ffd_buffer_free(&(*pool)->workers[i].answer);
    }
    ffd_free((*pool)->workers);
    ffd_free((*pool)->processes);
    ffd_free(*pool);
    *pool = NULL;
}

bool ffd_task_is_pending(const pool_task *task)
{
    return task->state < TASK_RUNS;
}

bool ffd_task_is_settled(const pool_task *task)
{
    return task->state == TASK_WAITS || (task->state == TASK_RUNS && !task->order.scans) ||
           task->state == TASK_ENDED || task->state == TASK_DROPPED;
}

void ffd_task_free(pool_task *task)
{
    if (!task)
        return;
    ffd_job_free(&task->job);
    ffd_free(task->picture);
    ffd_free(task->page);
    byte_buffer *const texts[ANSWER_TEXTS] = {FOR_EACH_ANSWER_TEXT(TEXT_OF_TASK)};
    for (int i = 0; i < ANSWER_TEXTS; i++)
        ffd_buffer_free(texts[i]);
    ffd_buffer_free(&task->found);
    ffd_buffer_free(&task->passed);
    ffd_free(task);
}
