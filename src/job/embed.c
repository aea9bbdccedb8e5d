/* embed.c - the job of `ffd embed`. */
#include "base/file/folder.h"
#include "base/file/mapping.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/system/clock.h"
#include "base/system/thread.h"
#include "io/npy/npy.h"
#include "job/chain/chain_load.h"
#include "job/chain/lattice_memory.h"
#include "job/chain/pace.h"
#include "job/figures/figure_values.h"
#include "job/input/deform_desc.h"
#include "job/input/embedding_file.h"
#include "job/input/in_memory.h"
#include "job/input/source.h"
#include "job/judge/warnings.h"
#include "job/pass/chain_fit.h"
#include "job/pass/pass.h"
#include "job/reads.h"
#include "lattice/file/lattice_source.h"
#include <math.h>
#include <string.h>

void ffd_embed_desc_init(ffd_embed_desc *desc, size_t size)
{
    const ffd_embed_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

/* An embedding's arrays, and what they belong to. */
typedef struct embedding {
    mesh_document *document;
    lattice_chain chain;
    double *uvw;
    uint8_t *statuses;
    size_t count;
    hash128 positions, lattice;
    unsigned losses; /* of mapped inputs, before the job (base/file/mapping.h) */
} embedding;

static ffd_status write_arrays(const ffd_embed_desc *desc, const embedding *made, file_output *output,
                               ffd_error *error)
{
    if (desc->status_output) {
        TRY(ffd_output_begin(output, desc->status_output, desc->force, error));
        TRY(ffd_npy_begin(output, "|u1", made->count, 0, error));
        TRY(ffd_output_write(output, made->statuses, made->count, error));
    }
    TRY(ffd_output_begin(output, desc->output, desc->force, error));
    return ffd_embedding_write(output, made->uvw, made->statuses, made->count, &made->positions,
                               &made->lattice, error);
}

static ffd_status write_files(const ffd_embed_desc *desc, const embedding *made, ffd_error *error)
{
    file_output *output;
    TRY(ffd_output_create(&output, error));
    ffd_output_redirect(output, desc->sink, desc->sink_user);
    ffd_status status;
    TRY_END(ffd_mapping_judge(made->losses, write_arrays(desc, made, output, error), error));
    TRY_END(ffd_output_commit(output, error));
end:
    ffd_output_destroy(&output);
    return status;
}

static ffd_status check_output(const ffd_embed_desc *desc, const char *path, ffd_error *error)
{
    if (ffd_job_reads_mesh(&desc->input, path) || ffd_job_reads_lattice(&desc->lattice, 1, path))
        return ffd_fail_file(error, FFD_E_EXISTS, path, "is an input of this command");
    TRY(ffd_output_check(path, desc->force, error));
    return ffd_output_is_stream(path) || ffd_path_has_ending(path, ".npy")
               ? FFD_OK
               : ffd_fail_file(error, FFD_E_ARGUMENT, path, "must end in .npy: it is an array");
}

/* Returns the absolute path of a file that need not exist. NULL: its folder does not exist, or memory runs
   out. */
static char *path_of(const char *path)
{
    char *folder = ffd_path_folder(path);
    char *resolved = folder ? ffd_path_resolve(folder) : NULL;
    char *target = resolved ? ffd_path_join(resolved, ffd_path_name(path)) : NULL;
    ffd_free(folder);
    ffd_free(resolved);
    return target;
}

static bool is_one_file(const char *a, const char *b)
{
    if (strcmp(a, b) == 0)
        return true;
    if (ffd_output_is_stream(a) || ffd_output_is_stream(b))
        return false;
    if (ffd_file_same(a, b))
        return true;
    char *x = path_of(a), *y = path_of(b);
    const bool one = x && y && strcmp(x, y) == 0;
    ffd_free(x);
    ffd_free(y);
    return one;
}

static ffd_status fail_one_file(const char *output, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_ARGUMENT, output, "is named for both u,v,w and the statuses");
}

static ffd_status check_outputs(const ffd_embed_desc *desc, ffd_error *error)
{
    if (!desc->input.path || !desc->lattice.path || !desc->output ||
        !ffd_desc_has_settings(desc->set, desc->set_count))
        return ffd_fail(error, FFD_E_ARGUMENT, "the job's description is not complete");
    if (!(desc->snap >= 0 && isfinite(desc->snap)))
        return ffd_fail(error, FFD_E_ARGUMENT, "the snap %g is not a length", desc->snap);
    if (desc->sink)
        return desc->status_output && strcmp(desc->output, desc->status_output) == 0
                   ? fail_one_file(desc->output, error)
                   : FFD_OK;
    /* Restore files that a killed run had set aside. */
    TRY(ffd_output_is_stream(desc->output) ? FFD_OK : ffd_restore_output(desc->output, error));
    TRY(check_output(desc, desc->output, error));
    if (desc->status_output)
        TRY(check_output(desc, desc->status_output, error));
    if (desc->status_output && is_one_file(desc->output, desc->status_output))
        TRY(fail_one_file(desc->output, error));
    return FFD_OK;
}

/* Refuses to replace what is read through the mesh and the lattice. */
static ffd_status check_reads(const ffd_embed_desc *desc, const embedding *made, ffd_error *error)
{
    const char *const outputs[] = {desc->output, desc->status_output};
    for (size_t i = 0; i < 2 && outputs[i] && !desc->sink; i++) {
        TRY(ffd_job_check_mesh_files(outputs[i], &desc->input, NULL, error));
        TRY(ffd_job_check_box_files(outputs[i], &made->chain, &desc->lattice, error));
    }
    return FFD_OK;
}

/* Opens the mesh and fits the loaded lattice to it. */
static ffd_status open_mesh(const ffd_embed_desc *desc, embedding *made, int threads, ffd_error *error)
{
    const mesh_log log = {desc->log, desc->log_user};
    TRY(ffd_source_open(&desc->input, threads, &made->document, error));
    TRY(ffd_mesh_check(made->document, error));
    TRY(ffd_mesh_warn(made->document, &log, error));
    return ffd_chain_fit(&made->chain, made->document, threads, NULL, error);
}

/* Allocates and fills the arrays. */
static ffd_status make(const ffd_embed_desc *desc, embedding *made, int threads, const mesh_log *log,
                       pass_totals *totals, ffd_error *error)
{
    made->count = (size_t)ffd_mesh_vertex_count(made->document);
    memory_budget budget = made->document->budget;
    TRY(ffd_lattice_memory_share(&made->chain, &budget, error));
    TRY(ffd_budget_take(&budget, made->count, 3 * sizeof *made->uvw + sizeof *made->statuses, error));
    made->uvw = ffd_alloc(made->count, 3 * sizeof *made->uvw);
    made->statuses = ffd_alloc(made->count, sizeof *made->statuses);
    if (!made->uvw || !made->statuses)
        return ffd_fail_memory(error);
    threads = ffd_pass_threads(&budget, 0, threads);
    chain_pace pace = {.points = (double)made->count,
                       .threads = threads,
                       .links = made->chain.links,
                       .lattices = &desc->lattice,
                       .more = "",
                       .log = *log};
    const mesh_pass pass = {.document = made->document,
                            .chain = &made->chain,
                            .links = 1,
                            .threads = threads,
                            .uvw = made->uvw,
                            .statuses = made->statuses,
                            .pace = &pace};
    return ffd_pass_over_mesh(&pass, totals, error);
}

/* Writes the arrays with the hashes of mesh and rest lattice. */
static ffd_status write(const ffd_embed_desc *desc, embedding *made, int threads, ffd_error *error)
{
    const chain_link *const link = &made->chain.links[0];
    made->lattice = ffd_embedding_hash_rest(link->lattice, link->snap);
    TRY(ffd_embedding_hash_positions(made->document, threads, &made->positions, error));
    return write_files(desc, made, error);
}

/* Runs the job once the lattice is loaded. */
static ffd_status embed(const ffd_embed_desc *desc, embedding *made, double start, ffd_job_result *result,
                        ffd_error *error)
{
    const mesh_log log = {desc->log, desc->log_user};
    pass_totals totals;
    TRY(ffd_threads_check(desc->threads, error));
    const int threads = ffd_threads_for(desc->threads, UINT64_MAX);
    TRY(open_mesh(desc, made, threads, error));
    const double opened = ffd_clock_seconds();
    result->seconds.read = opened - start;
    TRY(ffd_mapping_judge(made->losses, make(desc, made, threads, &log, &totals, error), error));
    const double embedded = ffd_clock_seconds();
    ffd_result_fill(result, &totals, embedded - opened);
    ffd_result_note_flaws(result, &made->document->flaws);
    ffd_flaws_warn(&made->document->flaws, NULL, &log);
    ffd_result_warn(&totals, &made->chain, false, &log);
    if (totals.vertices == 0)
        ffd_log_line(&log, FFD_LOG_WARNING, "there are no vertices");
    const ffd_status status = write(desc, made, threads, error);
    result->seconds.write = ffd_clock_seconds() - embedded;
    return status;
}

static ffd_status load_and_embed(const ffd_embed_desc *desc, ffd_job_result *result, ffd_error *error)
{
    const double start = ffd_clock_seconds();
    const mesh_log log = {desc->log, desc->log_user};
    const chain_files files = {.lattices = &desc->lattice,
                               .count = 1,
                               .set = desc->set,
                               .set_count = desc->set_count,
                               .rest_only = true,
                               .mesh = &desc->input,
                               .log = &log};
    const chain_outside outside = {.snap = desc->snap, .snap_is_relative = desc->snap_relative};
    embedding made = {.losses = ffd_mapping_losses()};
    TRY(check_outputs(desc, error));
    TRY(ffd_chain_load(&files, &outside, FFD_ISA_AUTO, NULL, &made.chain, error));
    ffd_status status;
    TRY_END(check_reads(desc, &made, error));
    TRY_END(embed(desc, &made, start, result, error));
end:
    if (status)
        status = ffd_mapping_judge(made.losses, status, error);
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(error, ffd_source_name(&desc->input));
    ffd_free(made.uvw);
    ffd_free(made.statuses);
    ffd_source_close(&made.document);
    ffd_chain_free(&made.chain);
    return status;
}

/* Names and checks data in memory. */
static ffd_status take_memory(job_memory *memory, ffd_embed_desc *desc, ffd_error *error)
{
    TRY(ffd_in_memory_lattice(&desc->lattice, "the lattice", "lattice", error));
    if (desc->sink && desc->output && desc->status_output && strcmp(desc->output, desc->status_output) == 0)
        TRY(fail_one_file(desc->output, error));
    TRY(ffd_in_memory_source(memory, &desc->input, error));
    TRY(ffd_in_memory_output(desc->sink, desc->output, error));
    return ffd_in_memory_output(desc->sink, desc->status_output, error);
}

ffd_status ffd_embed_run(const ffd_embed_desc *callers, ffd_job_result *callers_result, ffd_error *error)
{
    ffd_embed_desc desc;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_embed_desc_init(&desc, sizeof desc);
    TRY(ffd_struct_take(&desc, sizeof desc, callers, "ffd_embed_desc", error));
    if (callers_result)
        TRY(ffd_struct_check(sizeof result, callers_result, "ffd_job_result", error));
    job_memory memory = {0};
    ffd_status status;
    TRY_END(take_memory(&memory, &desc, &result.error));
    TRY_END(load_and_embed(&desc, &result, &result.error));
end:
    result.status = ffd_in_memory_end(&memory, status, &result.error);
    if (result.status && error)
        *error = result.error;
    if (callers_result)
        ffd_struct_give(&result, sizeof result, callers_result, callers_result->struct_size);
    return result.status;
}
