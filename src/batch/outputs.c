#include "batch/outputs.h"
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/file/path_list.h"
#include "base/memory/memory.h"
#include "io/formats.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* The format that an option of the job names, or else a path. */
static ffd_format format_of(const batch_job *job, const char *option, const char *path)
{
    const char *const value = ffd_job_option(job, option);
    char name[24];
    snprintf(name, sizeof name, "x.%.20s", value ? value : "");
    return ffd_format_from_name(value ? name : path);
}

/* Forgets what is known of the mesh looked at last, unless this is the same. */
static void turn_to(run_outputs *outputs, const char *input, ffd_format from, ffd_format to)
{
    file_stamp stamp = {0};
    const bool is_file = ffd_file_stamp(input, &stamp);
    if (is_file && outputs->input && strcmp(outputs->input, input) == 0 && outputs->from == from &&
        outputs->to == to && ffd_stamp_equal(&outputs->stamp, &stamp))
        return;
    ffd_free(outputs->input);
    ffd_paths_free(&outputs->resources);
    outputs->input = is_file ? ffd_text_copy(input) : NULL;
    outputs->from = from;
    outputs->to = to;
    outputs->stamp = stamp;
    outputs->has_beside = outputs->has_resources = false;
}

static size_t count_beside(run_outputs *outputs, const mesh_format *format)
{
    if (!outputs->has_beside)
        outputs->beside =
            outputs->input ? format->count_beside(outputs->input, outputs->from, outputs->to) : 0;
    outputs->has_beside = true;
    return outputs->beside;
}

/* Whether what the mesh refers to goes with the output. */
static bool has_copies(const batch_job *job, const mesh_format *from, const mesh_format *to)
{
    const char *const resources = ffd_job_option(job, "resources");
    return job->output && to && from == to && to->find_resources &&
           !(resources && strcmp(resources, "reference") == 0) &&
           ffd_folders_differ(job->words.data, job->target);
}

/* Lists what may be copied, in outputs->resources. *count: how many of these. */
static ffd_status list_resources(run_outputs *outputs, const batch_job *job, size_t *count, ffd_error *error)
{
    ffd_status status = FFD_OK;
    const mesh_format *const to = ffd_format_table(outputs->to);
    *count = 0;
    if (!outputs->input || !has_copies(job, ffd_format_table(outputs->from), to))
        return FFD_OK;
    if (!outputs->has_resources)
        status = to->find_resources(outputs->input, &outputs->resources, error);
    outputs->has_resources = !status;
    *count = status ? 0 : outputs->resources.count;
    return status;
}

/* Lists the files of a job, the output first. One in place keeps its own files beside it. */
static ffd_status list_files(run_outputs *outputs, const batch_job *job, path_list *files, ffd_error *error)
{
    const char *const input = job->words.data; /* its path from here */
    const ffd_format from = format_of(job, "input-format", input);
    const ffd_format to = format_of(job, "output-format", job->target);
    const mesh_format *const format = ffd_format_table(to);
    const ffd_status status = ffd_paths_add(files, job->target, error);
    turn_to(outputs, input, from, to);
    if (status || !job->output || !format || !format->list_beside)
        return status;
    return format->list_beside(job->target, count_beside(outputs, format), files, error);
}

static void refuse(const char *manifest, batch_job *job, const char *file, uint64_t line)
{
    char what[600];
    if (line)
        snprintf(what, sizeof what, "\"%.400s\" is written by the job of line %" PRIu64 " too", file, line);
    else
        snprintf(what, sizeof what, "\"%.400s\" is the report, the depfile or the journal of this run", file);
    if (manifest)
        ffd_fail_line(&job->error, FFD_E_INVALID, manifest, (size_t)job->line, "%s", what);
    else
        ffd_fail_file(&job->error, FFD_E_INVALID, job->input, "%s", what);
}

/* Whether a job before writes a file, by its own name or as a copy, or the run does, and in which line. */
static bool is_taken(const run_outputs *outputs, const hash128 *file, uint64_t *line)
{
    uint64_t number;
    if (ffd_files_find(&outputs->lines, file, line))
        return true;
    if (!ffd_files_find(&outputs->copies, file, &number))
        return false;
    *line = outputs->copied[number].line;
    return true;
}

/* Copies of equal files, as of one texture in many folders, are one file. */
static bool is_same_copy(const char *a, const char *b)
{
    file_input bytes;
    bool same = ffd_file_same(a, b);
    if (same || ffd_file_load(a, &bytes, NULL))
        return same;
    if (ffd_file_compare(b, &bytes, &same, NULL))
        same = false;
    ffd_file_unload(&bytes);
    return same;
}

static ffd_status add_copy(run_outputs *outputs, const hash128 *file, const char *source, uint64_t line,
                           ffd_error *error)
{
    char *const copy = ffd_text_copy(source);
    if (!copy || !ffd_grow((void **)&outputs->copied, &outputs->copied_capacity, outputs->copied_count + 1,
                           sizeof *outputs->copied)) {
        ffd_free(copy);
        return ffd_fail_memory(error);
    }
    outputs->copied[outputs->copied_count] = (copied_file){copy, line};
    return ffd_files_put(&outputs->copies, file, outputs->copied_count++, error);
}

/* Notes a file that the job copies, or refuses the job. */
static ffd_status claim_copy(run_outputs *outputs, const char *manifest, batch_job *job, const char *source,
                             ffd_error *error)
{
    const char *const input = outputs->input;
    ffd_status status = FFD_OK;
    uint64_t line, number;
    if (!ffd_file_exists(source))
        return FFD_OK;
    char *const target = ffd_path_beside(job->target, source + (ffd_path_name(input) - input));
    if (!target)
        return ffd_fail_memory(error);
    const hash128 file = ffd_file_identity(target);
    const bool is_copy = ffd_files_find(&outputs->copies, &file, &number);
    if (is_copy && !is_same_copy(outputs->copied[number].source, source))
        refuse(manifest, job, target, outputs->copied[number].line);
    else if (ffd_files_find(&outputs->lines, &file, &line))
        refuse(manifest, job, target, line);
    else if (!is_copy)
        status = add_copy(outputs, &file, source, job->line, error);
    ffd_free(target);
    return status;
}

ffd_status ffd_outputs_claim(run_outputs *outputs, const char *manifest, batch_job *job, hash128 *target,
                             ffd_error *error)
{
    path_list files = {0};
    uint64_t line;
    size_t copies = 0;
    ffd_status status = list_files(outputs, job, &files, error);
    if (!status)
        status = list_resources(outputs, job, &copies, error);
    hash128 *const identities = status ? NULL : ffd_alloc(files.count, sizeof *identities);
    if (!status && !identities)
        status = ffd_fail_memory(error);
    for (size_t i = 0; i < files.count && !status && !job->error.status; i++) {
        identities[i] = ffd_file_identity(files.paths[i]);
        if (is_taken(outputs, &identities[i], &line))
            refuse(manifest, job, i ? files.paths[i] : ffd_job_output_name(job), line);
    }
    for (size_t i = 0; i < copies && !status && !job->error.status; i++)
        status = claim_copy(outputs, manifest, job, outputs->resources.paths[i], error);
    for (size_t i = 0; i < files.count && !status && !job->error.status; i++)
        status = ffd_files_put(&outputs->lines, &identities[i], job->line, error);
    if (!status)
        *target = identities[0];
    ffd_free(identities);
    ffd_paths_free(&files);
    return status;
}

ffd_status ffd_outputs_reserve(run_outputs *outputs, const char *path, ffd_error *error)
{
    const hash128 file = ffd_file_identity(path);
    return ffd_files_put(&outputs->lines, &file, 0, error);
}

void ffd_outputs_free(run_outputs *outputs)
{
    ffd_files_free(&outputs->lines);
    ffd_files_free(&outputs->copies);
    for (size_t i = 0; i < outputs->copied_count; i++)
        ffd_free(outputs->copied[i].source);
    ffd_free(outputs->copied);
    ffd_paths_free(&outputs->resources);
    ffd_free(outputs->input);
    *outputs = (run_outputs){0};
}
