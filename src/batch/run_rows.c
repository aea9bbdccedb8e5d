#include "batch/run_rows.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/place.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/system/interrupt.h"
#include "base/text/buffer.h"
#include "batch/measure.h"
#include "job/report/report_file.h"
#include <inttypes.h>
#include <string.h>

char *ffd_run_rows_list(const batch_desc *desc)
{
    const job_source_desc *const jobs = &desc->jobs;
    const size_t stem = strlen(desc->given->positions) - strlen(".npy");
    byte_buffer name = {0};
    ffd_buffer_append(&name, desc->given->positions, stem);
    if (jobs->shards > 1)
        ffd_buffer_format(&name, "-%" PRIu64 "-of-%" PRIu64, jobs->shard, jobs->shards);
    ffd_buffer_text(&name, ".json");
    return ffd_buffer_finish(&name);
}

/* Finds the size of the array. */
static ffd_status measure(run_rows *rows, const batch_desc *desc, ffd_error *error)
{
    job_source_desc all = desc->jobs;
    rows->array = (row_array){.path = desc->given->positions, .is_double = desc->given->positions_double};
    all.shard = 0;
    all.shards = 1;
    /* It refuses jobs that can be read only once. */
    TRY(ffd_batch_count_vertices(&desc->jobs, &desc->pool, &rows->array.vertices, &rows->is_there, error));
    TRY(ffd_jobs_total(&all, &rows->array.rows, error));
    return ffd_rows_check_size(&rows->array, error);
}

/* An existing array stays if others may be writing to it, or if this run resumes it. */
static ffd_status make_array(run_rows *rows, const batch_desc *desc, ffd_error *error)
{
    const bool is_shared = desc->jobs.shards > 1, joins = is_shared || desc->jobs.resume;
    bool is_there;
    const ffd_status status = ffd_rows_find(&rows->array, &is_there, error);
    rows->replaces = desc->force && !is_shared;
    if (status && !(status == FFD_E_EXISTS && rows->replaces))
        return status;
    rows->goes_on = is_there && joins && !status;
    if (rows->goes_on)
        return FFD_OK;
    const bool force = desc->force || is_shared;
    if (is_there && rows->replaces)
        TRY(ffd_rows_check_replaced(&rows->array, error));
    if (is_there || desc->pool.wishes.dry) /* report all refusals before any work */
        TRY(ffd_output_check(rows->array.path, force, error));
    return desc->pool.wishes.dry ? FFD_OK : ffd_rows_make(&rows->array, rows->replaces, &rows->made, error);
}

ffd_status ffd_run_rows_open(run_rows *rows, const batch_desc *desc, ffd_error *error)
{
    rows->file = ffd_place_of(NULL, desc->given->positions);
    rows->list = ffd_run_rows_list(desc);
    if (!rows->list)
        return ffd_fail_memory(error);
    TRY(measure(rows, desc, error));
    if (rows->is_there)
        TRY(make_array(rows, desc, error));
    return ffd_report_check(rows->list, error);
}

ffd_status ffd_run_rows_place(run_rows *rows, const batch_desc *desc, ffd_error *error)
{
    /* An interrupted run ends without jobs; it must not replace what an earlier run has made. */
    if (desc->pool.wishes.dry || ffd_interrupt_requested())
        return FFD_OK;
    TRY(ffd_report_create(rows->list, desc->pool.wishes.stable, NULL, &rows->report, error));
    return ffd_rows_place(&rows->array, rows->replaces, &rows->made, error);
}

hash128 ffd_run_rows_target(const run_rows *rows, uint64_t row, const hash128 *output)
{
    unsigned char index[8];
    store_u64(index, row);
    const hash_block blocks[] = {{rows->file.bytes, sizeof rows->file.bytes},
                                 {index, sizeof index},
                                 {output, output ? sizeof *output : 0}};
    return ffd_hash_blocks(blocks, 3);
}

void ffd_run_rows_close(run_rows *rows)
{
    ffd_output_destroy(&rows->made);
    ffd_report_destroy(&rows->report);
    ffd_free(rows->list);
    *rows = (run_rows){0};
}
