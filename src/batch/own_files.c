#include "batch/own_files.h"
#include "base/file/input.h"
#include "base/file/output.h"
#include "base/file/place.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "batch/run_rows.h"
#include "batch/run_view.h"
#include <string.h>

/* A file of the run. */
typedef struct own_file {
    const char *role, *path; /* path NULL: none */
} own_file;

/* Whether both are one file, or will be. */
static bool are_one(const char *a, const char *b)
{
    const hash128 here = ffd_place_of(NULL, a), there = ffd_place_of(NULL, b);
    return memcmp(&here, &there, sizeof here) == 0 || ffd_file_same(a, b);
}

static ffd_status check_pair(const own_file *file, const own_file *other, ffd_error *error)
{
    const bool streams = ffd_output_is_stream(file->path) && ffd_output_is_stream(other->path);
    if (streams)
        return ffd_fail(error, FFD_E_ARGUMENT, "%s and %s cannot both go to standard output", file->role,
                        other->role);
    return are_one(file->path, other->path)
               ? ffd_fail_file(error, FFD_E_ARGUMENT, file->path, "%s and %s have the same name", file->role,
                               other->role)
               : FFD_OK;
}

/* Standard output replaces no file. */
static ffd_status check_read(const own_file *file, const own_file *read, ffd_error *error)
{
    return !ffd_output_is_stream(file->path) && read->path && are_one(file->path, read->path)
               ? ffd_fail_file(error, FFD_E_ARGUMENT, file->path, "%s would replace %s", file->role,
                               read->role)
               : FFD_OK;
}

/* Checks a file that is written beside what the run reads. */
static ffd_status check_reads(const own_file *file, const job_source_desc *jobs, ffd_error *error)
{
    const own_file reads[] = {{"the manifest", jobs->manifest}, {"the table", jobs->table}};
    const ffd_deform_desc *const defaults = jobs->defaults;
    for (size_t i = 0; i < sizeof reads / sizeof *reads; i++)
        TRY(check_read(file, &reads[i], error));
    for (size_t i = 0; defaults && i < defaults->lattice_count; i++)
        TRY(check_read(file, &(own_file){"a lattice", defaults->lattices[i].path}, error));
    const char *const weights =
        defaults && defaults->weight.source ? ffd_weight_file(defaults->weight.source) : NULL;
    TRY(check_read(file, &(own_file){"the weights", weights}, error));
    return defaults && defaults->embedding.path
               ? check_read(file, &(own_file){"the embedding", defaults->embedding.path}, error)
               : FFD_OK;
}

static ffd_status check_all(const own_file *files, size_t count, const batch_desc *desc, ffd_error *error)
{
    for (size_t i = 0; i < count; i++) {
        for (size_t j = 0; j < i && files[i].path; j++)
            TRY(files[j].path ? check_pair(&files[j], &files[i], error) : FFD_OK);
        if (files[i].path)
            TRY(check_reads(&files[i], &desc->jobs, error));
    }
    return FFD_OK;
}

ffd_status ffd_batch_check_own_files(const batch_desc *desc, ffd_error *error)
{
    char *const list = desc->given->positions ? ffd_run_rows_list(desc) : NULL;
    char *const page = desc->given->view
                           ? ffd_run_view_page_of(desc->given->view, desc->jobs.shard, desc->jobs.shards)
                           : NULL;
    const own_file files[] = {{"the report", desc->given->report},
                              {"the depfile", desc->given->depfile},
                              {"the journal", desc->given->journal},
                              {SPELLED("the array of {positions}"), desc->given->positions},
                              {SPELLED("the list of the rows of {positions}"), list},
                              {SPELLED("the index of {view}"), page}};
    const bool complete = (list || !desc->given->positions) && (page || !desc->given->view);
    const ffd_status status =
        complete ? check_all(files, sizeof files / sizeof *files, desc, error) : ffd_fail_memory(error);
    ffd_free(list);
    ffd_free(page);
    return status;
}
