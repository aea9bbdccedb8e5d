#include "base/clock.h"
#include "base/memory.h"
#include "base/thread.h"
#include "io/npy/npy.h"
#include "job/placement.h"
#include "job/source.h"
#include <string.h>

void ffd_embed_desc_init(ffd_embed_desc *desc)
{
    memset(desc, 0, sizeof *desc);
    desc->struct_size = sizeof *desc;
}

/* Arrays are written as this machine holds them. */
static bool is_little_endian(void)
{
    const uint16_t one = 1;
    unsigned char first;
    memcpy(&first, &one, 1);
    return first == 1;
}

static ffd_status write_arrays(const ffd_embed_desc *desc, const double *uvw, const uint8_t *statuses,
                               size_t count, ffd_error *error)
{
    file_output *output;
    ffd_status status = ffd_output_create(&output, error);
    if (status)
        return status;
    status = ffd_output_begin(output, desc->output, desc->force, error);
    if (!status)
        status = ffd_npy_begin(output, is_little_endian() ? "<f8" : ">f8", count, 3, error);
    if (!status)
        status = ffd_output_write(output, uvw, 3 * count * sizeof *uvw, error);
    if (!status && desc->status_output) {
        status = ffd_output_begin(output, desc->status_output, desc->force, error);
        if (!status)
            status = ffd_npy_begin(output, "|u1", count, 0, error);
        if (!status)
            status = ffd_output_write(output, statuses, count, error);
    }
    if (!status)
        status = ffd_output_commit(output, error);
    ffd_output_destroy(&output);
    return status;
}

static ffd_status check_output(const ffd_embed_desc *desc, const char *path, ffd_error *error)
{
    if (ffd_file_same(path, desc->input.path) || ffd_file_same(path, desc->lattice))
        return ffd_fail_file(error, FFD_E_EXISTS, path, "is an input of this command");
    return ffd_output_check(path, desc->force, error);
}

static ffd_status check_outputs(const ffd_embed_desc *desc, ffd_error *error)
{
    if (desc->struct_size != sizeof *desc || !desc->input.path || !desc->lattice || !desc->output)
        return ffd_fail(error, FFD_E_ARGUMENT, "the job's description is not complete");
    ffd_status status = check_output(desc, desc->output, error);
    if (!status && desc->status_output)
        status = check_output(desc, desc->status_output, error);
    if (!status && desc->status_output &&
        (strcmp(desc->output, desc->status_output) == 0 || ffd_file_same(desc->output, desc->status_output)))
        status =
            ffd_fail_file(error, FFD_E_ARGUMENT, desc->output, "is named for both u,v,w and the statuses");
    return status;
}

static ffd_status run(const ffd_embed_desc *desc, ffd_job_result *result, ffd_error *error)
{
    const mesh_log log = {desc->log, desc->log_user};
    const int threads = desc->threads > 0 ? desc->threads : ffd_processor_count();
    const double start = ffd_clock_seconds();
    mesh_document *document = NULL;
    lattice_chain chain;
    pass_totals totals;
    double *uvw = NULL;
    uint8_t *statuses = NULL;

    ffd_status status = check_outputs(desc, error);
    if (!status)
        status = ffd_chain_load(&desc->lattice, 1, &chain, error);
    if (status)
        return status;
    status = ffd_source_open(&desc->input, &document, error);
    if (!status)
        status = document->format->check(document, error);
    if (!status)
        status = ffd_chain_place(&chain, document, threads, error);
    if (status)
        goto out;
    const double opened = ffd_clock_seconds();
    result->seconds_read = opened - start;

    const size_t count = (size_t)ffd_pass_vertex_count(document);
    uvw = ffd_alloc(count, 3 * sizeof *uvw);
    statuses = ffd_alloc(count, sizeof *statuses);
    if (!uvw || !statuses) {
        status = ffd_fail_memory(error);
        goto out;
    }
    const mesh_pass pass = {.document = document,
                            .chain = &chain,
                            .links = 1,
                            .threads = threads,
                            .uvw = uvw,
                            .statuses = statuses};
    status = ffd_pass_run(&pass, &totals, error);
    if (status)
        goto out;
    const double embedded = ffd_clock_seconds();
    ffd_result_fill(result, &totals, embedded - opened);
    ffd_result_warn(&totals, &log);
    status = write_arrays(desc, uvw, statuses, count, error);
    result->seconds_write = ffd_clock_seconds() - embedded;
out:
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(error, ffd_source_name(&desc->input));
    ffd_free(uvw);
    ffd_free(statuses);
    ffd_source_close(&document);
    ffd_chain_free(&chain);
    return status;
}

ffd_status ffd_embed_run(const ffd_embed_desc *desc, ffd_job_result *result, ffd_error *error)
{
    ffd_job_result own;
    ffd_job_result *figures = result ? result : &own;
    memset(figures, 0, sizeof *figures);
    figures->status = run(desc, figures, &figures->error);
    if (figures->status && error)
        *error = figures->error;
    return figures->status;
}
