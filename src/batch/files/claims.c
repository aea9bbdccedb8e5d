#include "batch/files/claims.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "batch/files/run_reads.h"
#include <inttypes.h>
#include <string.h>

/* Whether an output would replace the mesh that it is made of, which a worker refuses: other jobs may read
   the mesh. */
static bool is_mesh(const batch_job *job)
{
    return job->output && strcmp(job->desc.input.path, job->target) == 0;
}

/* Returns the places of the output: those of the first look, before any job began, where there was one. */
static const output_place *place_output(run_files *files, batch_job *job)
{
    if (!job->place.is_known)
        job->place.place = ffd_place_both(&files->places, files->base, job->target, &job->place.seen);
    job->place.is_known = true;
    return &job->place;
}

ffd_status ffd_claims_expect(run_files *files, batch_job *job, ffd_error *error)
{
    uint64_t line;
    if (!job->target || is_mesh(job))
        return FFD_OK;
    const hash128 place = place_output(files, job)->place;
    if (!files->has_odd_outputs) {
        const job_kind kind = ffd_job_kind(job);
        files->has_odd_outputs =
            ffd_format_from_name(job->target) == FFD_FORMAT_AUTO || ffd_job_has_copies(job, &kind);
    }
    TRY(ffd_files_find(&files->writes, &place, &line)
            ? FFD_OK
            : ffd_files_put(&files->writes, &place, job->line, error));
    return ffd_run_add_folder(files, job->target, error);
}

/* Whether an earlier job reads a file. *line: of that job. */
static bool is_read(const run_files *files, const batch_job *job, const hash128 *file, uint64_t *line)
{
    return ffd_files_find(&files->reads, file, line) && *line != job->line;
}

/* Whether a job that comes first, this one, or the run writes a file already. */
static bool is_taken(const run_files *files, const batch_job *job, const hash128 *file, uint64_t *line)
{
    return ffd_run_writer(files, file, line) && *line <= job->line;
}

ffd_status ffd_claims_output(run_files *files, batch_job *job, hash128 *target, ffd_error *error)
{
    uint64_t line;
    const hash128 *const place = &place_output(files, job)->place;
    *target = job->place.seen;
    if (is_mesh(job))
        return FFD_OK;
    const bool taken = is_taken(files, job, place, &line), is_own = taken && line == job->line;
    if (taken && !is_own) /* else it was expected */
        ffd_run_refuse(files, job, "", ffd_job_output_name(job), line);
    else if (files->comes_once && is_read(files, job, place, &line))
        ffd_run_refuse_written(files, job, ffd_job_output_name(job), line);
    else if (!is_own)
        return ffd_files_put(&files->writes, place, job->line, error);
    return FFD_OK;
}

ffd_status ffd_claims_picture(run_files *files, batch_job *job, const hash128 *file, const char *path,
                              ffd_error *error)
{
    uint64_t line;
    if (is_taken(files, job, file, &line))
        ffd_run_refuse(files, job, "", path, line);
    else if (is_read(files, job, file, &line))
        ffd_run_refuse_written(files, job, path, line);
    else
        return ffd_files_put(&files->writes, file, job->line, error);
    return FFD_OK;
}

claim_needs ffd_claims_need(run_files *files, const batch_job *job, const job_kind *kind)
{
    const bool by_mesh = (kind->has_sidecars && kind->is_kept) || ffd_reads_need_named(files, kind) ||
                         ffd_job_has_copies(job, kind);
    return (claim_needs){.mesh = by_mesh,
                         .lattices = !ffd_reads_know_lattices(files, job),
                         .others = by_mesh || ffd_job_count_sidecars(kind) > 0};
}

bool ffd_claims_are_ready(const run_files *files, const batch_job *job, const job_kind *kind,
                          const claim_needs *needs)
{
    return (!needs->mesh || ffd_reads_know_mesh(files, kind)) &&
           (!needs->lattices || ffd_reads_know_lattices(files, job));
}

/* Returns the number of files beside an output, as far as they are known. */
static size_t count_sidecars(const run_files *files, const job_kind *kind)
{
    if (!kind->has_sidecars || !kind->is_kept)
        return ffd_job_count_sidecars(kind);
    return kind->is_scanned ? files->scan.sidecars : 0;
}

bool ffd_claims_need_survey(run_files *files, const batch_job *job, const job_kind *kind)
{
    return count_sidecars(files, kind) > 0 && ffd_run_survey(files, job->target) == SURVEY_NONE;
}

bool ffd_claims_lack_survey(run_files *files, const batch_job *job, const job_kind *kind)
{
    return count_sidecars(files, kind) > 0 && ffd_run_survey(files, job->target) == SURVEY_FAILED;
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

static ffd_status add_copy(run_files *files, const hash128 *file, const char *source, uint64_t line,
                           ffd_error *error)
{
    char *const copy = ffd_text_copy(source);
    if (!copy || !ffd_grow((void **)&files->copied, &files->copied_capacity, files->copied_count + 1,
                           sizeof *files->copied)) {
        ffd_free(copy);
        return ffd_fail_memory(error);
    }
    files->copied[files->copied_count] = (copied_file){copy, line};
    return ffd_files_put(&files->copies, file, files->copied_count++, error);
}

/* Claims the target of a file that the job copies, or refuses the job. What is there already stays, so that
   jobs may read it. */
static ffd_status claim_copy(run_files *files, batch_job *job, const char *source, ffd_error *error)
{
    const char *const input = files->scan.input;
    ffd_status status = FFD_OK;
    uint64_t line, index;
    if (!ffd_file_exists(source))
        return FFD_OK;
    char *const target = ffd_path_sibling(job->target, source + (ffd_path_name(input) - input));
    if (!target)
        return ffd_fail_memory(error);
    const hash128 file = ffd_run_place(files, target);
    const bool is_copy = ffd_files_find(&files->copies, &file, &index);
    if (is_copy && !is_same_copy(files->copied[index].source, source))
        ffd_run_refuse(files, job, "", target, files->copied[index].line);
    else if (ffd_files_find(&files->writes, &file, &line))
        ffd_run_refuse(files, job, "", target, line);
    else if (!is_copy && is_read(files, job, &file, &line) && !ffd_file_exists(target))
        ffd_run_refuse_written(files, job, target, line);
    else if (!is_copy)
        status = add_copy(files, &file, source, job->line, error);
    ffd_free(target);
    return status;
}

/* A name for a file beside an output. */
typedef struct sidecar_name {
    char *path;
    hash128 place;
    bool exists, is_own; /* is_own: the model that the output replaces names it */
    size_t others;       /* models that name it too, */
    byte_buffer users;   /* and the names of the first ones */
} sidecar_name;

/* Finds the models that name a file; what another job reads in another way counts too. */
static ffd_status find_others(run_files *files, const batch_job *job, sidecar_name *name, ffd_error *error)
{
    path_list names = {0};
    uint64_t line;
    ffd_status status;
    TRY_END(
        ffd_users_find(&files->users, name->path, job->target, &name->others, &name->is_own, &names, error));
    for (size_t i = 0; i < names.count; i++)
        ffd_buffer_format(&name->users, "%s%s", i ? ", " : "", names.paths[i]);
    if (name->others > names.count)
        ffd_buffer_format(&name->users, " and %zu more", name->others - names.count);
    if (!name->others && is_read(files, job, &name->place, &line)) {
        name->others = 1;
        ffd_buffer_format(&name->users, "the job of line %" PRIu64, line);
    }
end:
    ffd_paths_free(&names);
    return status;
}

/* The claim of the files beside an output. */
typedef struct sidecar_claim {
    run_files *files;
    batch_job *job;
    const job_kind *kind;
    hash128 *places; /* count entries: those claimed */
    size_t count, capacity;
    size_t fresh;        /* those that do not exist yet, or are not of this model */
    byte_buffer *passed; /* as of ffd_claims_others */
} sidecar_claim;

static void notify_worker(sidecar_claim *claim, const char *path, const char *users, size_t size)
{
    ffd_buffer_append(claim->passed, path, strlen(path) + 1);
    ffd_buffer_append(claim->passed, users, size);
    ffd_buffer_append(claim->passed, "", 1);
}

/* Judges a name in the same way as the worker will (mesh/resource/sidecar.c), and claims it or passes
   it over. */
static ffd_status judge_name(sidecar_claim *claim, sidecar_name *name, ffd_error *error)
{
    batch_job *const job = claim->job;
    const bool in_place = !job->output, has_passed = claim->passed->size > 0;
    const bool is_free = !name->others && (!name->exists || name->is_own || (!in_place && !has_passed));
    uint64_t line;
    if (name->others)
        notify_worker(claim, name->path, name->users.data, name->users.size);
    else if (is_free && has_passed && name->exists)
        notify_worker(claim, name->path, job->target, strlen(job->target));
    if (!is_free)
        return FFD_OK;
    if (is_taken(claim->files, job, &name->place, &line)) {
        ffd_run_refuse(claim->files, job, "", name->path, line);
        return FFD_OK;
    }
    if (!ffd_grow((void **)&claim->places, &claim->capacity, claim->count + 1, sizeof *claim->places))
        return ffd_fail_memory(error);
    claim->places[claim->count++] = name->place;
    claim->fresh += !in_place || !name->exists; /* in place some buffers stay: names are left for all */
    return FFD_OK;
}

static ffd_status claim_name(sidecar_claim *claim, size_t index, ffd_error *error)
{
    sidecar_name name = {.path = claim->kind->format->sidecars->name(claim->job->target, index)};
    if (!name.path)
        return ffd_fail_memory(error);
    name.place = ffd_run_place(claim->files, name.path);
    name.exists = ffd_file_exists(name.path);
    ffd_status status;
    TRY_END(find_others(claim->files, claim->job, &name, error));
    TRY_END(judge_name(claim, &name, error));
    if (name.users.failed || claim->passed->failed)
        TRY_END(ffd_fail_memory(error));
end:
    ffd_buffer_free(&name.users);
    ffd_free(name.path);
    return status;
}

/* Claims as many files beside the output, or none and refuses the job. */
static ffd_status claim_sidecar(run_files *files, batch_job *job, const job_kind *kind, size_t count,
                                byte_buffer *passed, ffd_error *error)
{
    sidecar_claim claim = {.files = files, .job = job, .kind = kind, .passed = passed};
    ffd_status status = FFD_OK;
    for (size_t index = 0; claim.fresh < count && !job->error.status; index++)
        TRY_END(claim_name(&claim, index, error));
    for (size_t i = 0; i < claim.count && !job->error.status; i++)
        TRY_END(ffd_files_put(&files->writes, &claim.places[i], job->line, error));
end:
    ffd_free(claim.places);
    return status;
}

ffd_status ffd_claims_others(run_files *files, batch_job *job, const job_kind *kind, byte_buffer *passed,
                             ffd_error *error)
{
    const size_t sidecars = count_sidecars(files, kind);
    const size_t copies = kind->is_scanned && ffd_job_has_copies(job, kind) ? files->scan.copies.count : 0;
    ffd_reads_check_boxes(files, job);
    if (kind->is_scanned && !job->error.status)
        ffd_reads_check_named(files, job);
    if (sidecars > 0 && !job->error.status)
        TRY(claim_sidecar(files, job, kind, sidecars, passed, error));
    for (size_t i = 0; i < copies && !job->error.status; i++)
        TRY(claim_copy(files, job, files->scan.copies.paths[i], error));
    return FFD_OK;
}
