#include "batch/outputs.h"
#include "base/file/folder.h"
#include "base/file/path.h"
#include "base/file/path_list.h"
#include "base/file/place.h"
#include "base/memory/memory.h"
#include "io/formats.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Returns the format that an option of the job gives, or else that of a path. */
static ffd_format format_of(const batch_job *job, const char *option, const char *path)
{
    const char *const value = ffd_job_option(job, option);
    char name[24];
    if (!value)
        return ffd_format_from_name(path);
    snprintf(name, sizeof name, "x.%.20s", value);
    return ffd_format_from_name(name);
}

/* The formats, which determine what a job writes beside its output and copies with it. */
typedef struct output_kind {
    const char *input; /* path of the input */
    ffd_format from, to;
    const mesh_format *format; /* of the output; NULL: unknown */
    bool is_kept;              /* input and output have the same one */
} output_kind;

static output_kind kind_of(const batch_job *job)
{
    const char *const input = job->words.data;
    const ffd_format from = format_of(job, "input-format", input);
    const ffd_format to = job->target ? format_of(job, "output-format", job->target) : FFD_FORMAT_AUTO;
    const mesh_format *const format = ffd_format_table(to);
    return (output_kind){input, from, to, format, format == ffd_format_table(from)};
}

/* Whether resources of the mesh are copied with the output. */
static bool has_copies(const batch_job *job, const output_kind *kind)
{
    const char *const resources = ffd_job_option(job, "resources");
    return job->output && kind->format && kind->is_kept && kind->format->find_resources &&
           !(resources && strcmp(resources, "reference") == 0) &&
           ffd_folders_differ(kind->input, job->target);
}

output_others ffd_outputs_others(const batch_job *job)
{
    const output_kind kind = kind_of(job);
    const bool has_beside = job->output && kind.format && kind.format->name_beside;
    if (has_beside && !kind.is_kept)
        return OTHERS_KNOWN;
    return has_beside || has_copies(job, &kind) ? OTHERS_BY_MESH : OTHERS_NONE;
}

static bool knows(const run_outputs *outputs, const output_kind *kind)
{
    file_stamp stamp;
    return outputs->input && strcmp(outputs->input, kind->input) == 0 && outputs->from == kind->from &&
           outputs->to == kind->to && ffd_file_stamp(kind->input, &stamp) &&
           ffd_stamp_equal(&outputs->stamp, &stamp);
}

bool ffd_outputs_know_mesh(const run_outputs *outputs, const batch_job *job)
{
    const output_kind kind = kind_of(job);
    return knows(outputs, &kind);
}

ffd_status ffd_outputs_learn(run_outputs *outputs, const batch_job *job, size_t beside,
                             const byte_buffer *resources, ffd_error *error)
{
    const output_kind kind = kind_of(job);
    file_stamp stamp = {0};
    const bool is_file = ffd_file_stamp(kind.input, &stamp);
    ffd_status status = FFD_OK;
    ffd_free(outputs->input);
    ffd_paths_free(&outputs->resources);
    outputs->input = is_file ? ffd_text_copy(kind.input) : NULL;
    outputs->from = kind.from;
    outputs->to = kind.to;
    outputs->stamp = stamp;
    outputs->beside = beside;
    for (size_t at = 0; at < resources->size && !status; at += strlen(resources->data + at) + 1)
        status = ffd_paths_add(&outputs->resources, resources->data + at, error);
    return status;
}

/* Lists the files beside the output. In place, the mesh keeps its own. */
static ffd_status list_beside(const run_outputs *outputs, const batch_job *job, const output_kind *kind,
                              path_list *files, ffd_error *error)
{
    const mesh_format *const format = kind->format;
    size_t beside = 0;
    if (!job->output || !format || !format->name_beside)
        return FFD_OK;
    if (!kind->is_kept)
        beside = format->count_beside(NULL, kind->from, kind->to);
    else if (knows(outputs, kind))
        beside = outputs->beside;
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < beside && !status; i++) {
        char *const path = format->name_beside(job->target, i);
        status = path ? ffd_paths_add(files, path, error) : ffd_fail_memory(error);
        ffd_free(path);
    }
    return status;
}

/* role: what the file is for the job, with a blank; or "". */
static void refuse(const char *manifest, batch_job *job, const char *role, const char *file, uint64_t line)
{
    char what[600];
    if (line)
        snprintf(what, sizeof what, "%s\"%.400s\" is written by the job of line %" PRIu64 " too", role, file,
                 line);
    else
        snprintf(what, sizeof what,
                 "%s\"%.400s\" is the report, the depfile, the journal, the index or the array of this run",
                 role, file);
    if (manifest)
        ffd_fail_line(&job->error, FFD_E_INVALID, manifest, (size_t)job->line, "%s", what);
    else
        ffd_fail_file(&job->error, FFD_E_INVALID, job->input, "%s", what);
}

/* Whether an earlier job writes a file, as an output or as a copy, or the run does. *line: of that job; 0:
   the run. */
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

/* Copies of identical files may share a target, as one texture in many folders. */
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

/* Claims the target of a file that the job copies, or refuses the job. */
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
    const hash128 file = ffd_place_of(NULL, target);
    const bool is_copy = ffd_files_find(&outputs->copies, &file, &number);
    if (is_copy && !is_same_copy(outputs->copied[number].source, source))
        refuse(manifest, job, "", target, outputs->copied[number].line);
    else if (ffd_files_find(&outputs->lines, &file, &line))
        refuse(manifest, job, "", target, line);
    else if (!is_copy)
        status = add_copy(outputs, &file, source, job->line, error);
    ffd_free(target);
    return status;
}

/* Claims the files that the job writes, or refuses the job. */
static ffd_status claim_files(run_outputs *outputs, const char *manifest, batch_job *job,
                              const path_list *files, ffd_error *error)
{
    hash128 *const identities = ffd_alloc(files->count, sizeof *identities);
    ffd_status status = identities ? FFD_OK : ffd_fail_memory(error);
    uint64_t line;
    for (size_t i = 0; i < files->count && !status && !job->error.status; i++) {
        identities[i] = ffd_place_of(NULL, files->paths[i]);
        if (is_taken(outputs, &identities[i], &line))
            refuse(manifest, job, "", files->paths[i], line);
    }
    for (size_t i = 0; i < files->count && !status && !job->error.status; i++)
        status = ffd_files_put(&outputs->lines, &identities[i], job->line, error);
    ffd_free(identities);
    return status;
}

ffd_status ffd_outputs_claim(run_outputs *outputs, const char *manifest, batch_job *job, hash128 *target,
                             ffd_error *error)
{
    uint64_t line;
    *target = ffd_place_of(NULL, job->target);
    if (!is_taken(outputs, target, &line))
        return ffd_files_put(&outputs->lines, target, job->line, error);
    refuse(manifest, job, "", ffd_job_output_name(job), line);
    return FFD_OK;
}

ffd_status ffd_outputs_claim_picture(run_outputs *outputs, const char *manifest, batch_job *job,
                                     const hash128 *file, const char *path, ffd_error *error)
{
    uint64_t line;
    if (!is_taken(outputs, file, &line))
        return ffd_files_put(&outputs->lines, file, job->line, error);
    refuse(manifest, job, "", path, line);
    return FFD_OK;
}

ffd_status ffd_outputs_claim_others(run_outputs *outputs, const char *manifest, batch_job *job,
                                    ffd_error *error)
{
    const output_kind kind = kind_of(job);
    const size_t copies = has_copies(job, &kind) && knows(outputs, &kind) ? outputs->resources.count : 0;
    path_list files = {0};
    ffd_status status = list_beside(outputs, job, &kind, &files, error);
    if (!status && files.count > 0)
        status = claim_files(outputs, manifest, job, &files, error);
    for (size_t i = 0; i < copies && !status && !job->error.status; i++)
        status = claim_copy(outputs, manifest, job, outputs->resources.paths[i], error);
    ffd_paths_free(&files);
    return status;
}

void ffd_outputs_check_embedding(const run_outputs *outputs, const char *manifest, batch_job *job)
{
    const char *const embedding = ffd_job_option(job, "embedding");
    uint64_t line;
    if (!embedding || job->error.status)
        return;
    const hash128 file = ffd_place_of(NULL, embedding);
    if (is_taken(outputs, &file, &line))
        refuse(manifest, job, "the embedding ", embedding, line);
}

ffd_status ffd_outputs_reserve(run_outputs *outputs, const char *path, ffd_error *error)
{
    const hash128 file = ffd_place_of(NULL, path);
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
