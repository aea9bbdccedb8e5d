#include "batch/files/run_reads.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "batch/files/scan.h"
#include <string.h>

/* Notes that a job reads a file; of several the first one counts. */
static ffd_status note(run_files *files, const hash128 *file, uint64_t line, ffd_error *error)
{
    uint64_t known;
    return ffd_files_find(&files->reads, file, &known) ? FFD_OK
                                                       : ffd_files_put(&files->reads, file, line, error);
}

/* Notes that a job reads all files of a list. *conflicts: the first of them that other jobs, or the run,
   write. */
static ffd_status note_all(run_files *files, const path_list *list, uint64_t line, read_conflicts *conflicts,
                           ffd_error *error)
{
    *conflicts = (read_conflicts){0};
    for (size_t i = 0; i < list->count; i++) {
        const hash128 place = ffd_run_place(files, list->paths[i]);
        uint64_t writer;
        TRY(note(files, &place, line, error));
        if (conflicts->count == 2 || !ffd_run_writer(files, &place, &writer) ||
            (conflicts->count && writer == conflicts->lines[0]))
            continue;
        conflicts->files[conflicts->count] = i;
        conflicts->lines[conflicts->count++] = writer;
    }
    return FFD_OK;
}

/* One of the files that a job names. */
typedef struct named_read {
    const char *role, *path;
    bool may_be_own; /* the job may write it */
    bool is_lattice;
} named_read;

/* Returns one of these, by its index: the mesh, the lattices, the weights, the embedding. path NULL: behind
   the last. */
static named_read read_of(const batch_job *job, size_t index)
{
    const ffd_deform_desc *const desc = &job->desc;
    if (index == 0)
        return (named_read){"the mesh ", desc->input.path, true, false};
    if (index <= desc->lattice_count)
        return (named_read){"the lattice ", desc->lattices[index - 1].path, true, true};
    const char *const weights = desc->weight.source ? ffd_weight_file(desc->weight.source) : NULL;
    if (weights && index == desc->lattice_count + 1)
        return (named_read){"the weights ", weights, false, false};
    const bool is_last = index == desc->lattice_count + (weights ? 2 : 1);
    return (named_read){"the embedding ", is_last ? desc->embedding.path : NULL, false, false};
}

ffd_status ffd_reads_check(run_files *files, batch_job *job, ffd_error *error)
{
    uint64_t line;
    size_t index = 0;
    for (named_read read = read_of(job, index); read.path && !job->error.status;
         read = read_of(job, ++index)) {
        const hash128 place = ffd_run_read_place(files, read.path);
        if (ffd_run_writer(files, &place, &line) && !(read.may_be_own && line == job->line))
            ffd_run_refuse(files, job, read.role, read.path, line);
        else
            TRY(note(files, &place, job->line, error));
    }
    return FFD_OK;
}

void ffd_reads_check_own(run_files *files, batch_job *job)
{
    uint64_t line;
    size_t index = 0;
    for (named_read read = read_of(job, index); read.path && !job->error.status;
         read = read_of(job, ++index)) {
        const hash128 place = ffd_run_read_place(files, read.path);
        if (ffd_files_find(&files->writes, &place, &line) && line == 0)
            ffd_run_refuse(files, job, read.role, read.path, 0);
    }
}

/* Lattices */

static const known_lattice *find_lattice(const run_files *files, const char *path)
{
    uint32_t index;
    return ffd_intern_find(&files->lattices.paths, path, strlen(path), &index) ? &files->lattices.list[index]
                                                                               : NULL;
}

/* Adds a lattice; one that is known stays as it is. *added: NULL then. */
static ffd_status add_lattice(run_files *files, const char *path, known_lattice **added, ffd_error *error)
{
    known_lattices *const lattices = &files->lattices;
    const size_t count = lattices->paths.count;
    uint32_t index;
    *added = NULL;
    if (!ffd_grow((void **)&lattices->list, &lattices->capacity, count + 1, sizeof *lattices->list) ||
        !ffd_intern(&lattices->paths, path, strlen(path), &index))
        return ffd_fail_memory(error);
    if (index < count)
        return FFD_OK;
    *added = &lattices->list[index];
    **added = (known_lattice){0};
    return FFD_OK;
}

bool ffd_reads_know_lattices(const run_files *files, const batch_job *job)
{
    size_t index = 0;
    for (named_read read = read_of(job, index); read.path; read = read_of(job, ++index))
        if (read.is_lattice && !find_lattice(files, read.path))
            return false;
    return true;
}

void ffd_reads_check_boxes(const run_files *files, batch_job *job)
{
    size_t index = 0;
    for (named_read read = read_of(job, index); read.path; read = read_of(job, ++index)) {
        const known_lattice *const lattice = read.is_lattice ? find_lattice(files, read.path) : NULL;
        if (lattice)
            ffd_run_refuse_conflict(files, job, "the mesh of a box, or its buffer, ", &lattice->files,
                                    &lattice->conflicts);
    }
}

/* Finds which jobs write the files of a lattice's box, once all are listed. */
static ffd_status end_lattice(run_files *files, known_lattice *lattice, uint64_t line, ffd_error *error)
{
    if (!lattice)
        return FFD_OK;
    return note_all(files, &lattice->files, line, &lattice->conflicts, error);
}

/* The mesh */

bool ffd_reads_know_mesh(const run_files *files, const job_kind *kind)
{
    const mesh_scan *const scan = &files->scan;
    file_stamp stamp;
    return scan->input && strcmp(scan->input, kind->input) == 0 && scan->from == kind->from &&
           scan->to == kind->to && ffd_file_stamp(kind->input, &stamp) &&
           ffd_stamp_equal(&scan->stamp, &stamp);
}

bool ffd_reads_need_named(run_files *files, const job_kind *kind)
{
    const mesh_format *const source = kind->source;
    return source && source->resources && (source->sidecars || files->has_odd_outputs) &&
           ffd_run_writes_near(files, kind->input);
}

void ffd_reads_check_named(const run_files *files, batch_job *job)
{
    ffd_run_refuse_conflict(files, job, "the buffer, image, library or other file ", &files->scan.named,
                            &files->scan.conflicts);
}

static void begin_scan(run_files *files, const job_kind *kind, size_t sidecars)
{
    mesh_scan *const scan = &files->scan;
    ffd_free(scan->input);
    ffd_paths_free(&scan->named);
    ffd_paths_free(&scan->copies);
    *scan = (mesh_scan){.from = kind->from, .to = kind->to, .sidecars = sidecars};
    if (ffd_file_stamp(kind->input, &scan->stamp))
        scan->input = ffd_text_copy(kind->input);
}

static ffd_status end_scan(run_files *files, const job_kind *kind, uint64_t line, ffd_error *error)
{
    mesh_scan *const scan = &files->scan;
    TRY(note_all(files, &scan->named, line, &scan->conflicts, error));
    for (size_t i = 0; i < scan->named.count; i++)
        TRY(ffd_users_add(&files->users, scan->named.paths[i], kind->input, error));
    return FFD_OK;
}

/* State of reading what a worker has found. */
typedef struct finding {
    run_files *files;
    const batch_job *job;
    known_lattice *lattice; /* the last one; NULL: none, or known before */
    const char *model;      /* the last one */
} finding;

static ffd_status take(finding *f, scan_kind kind, const char *path, ffd_error *error)
{
    mesh_scan *const scan = &f->files->scan;
    ffd_status status = FFD_OK;
    if (kind == SCAN_NAMED)
        return ffd_paths_add(&scan->named, path, error);
    if (kind == SCAN_COPY)
        return ffd_paths_add(&scan->copies, path, error);
    if (kind == SCAN_LATTICE) {
        TRY(end_lattice(f->files, f->lattice, f->job->line, error));
        return add_lattice(f->files, path, &f->lattice, error);
    }
    if (kind == SCAN_BOX)
        return f->lattice ? ffd_paths_add(&f->lattice->files, path, error) : FFD_OK;
    if (kind == SCAN_MODEL)
        f->model = path;
    if (kind == SCAN_BUFFER && f->model)
        status = ffd_users_add(&f->files->users, path, f->model, error);
    return kind == SCAN_FOLDER ? ffd_run_set_survey(f->files, f->job->target, SURVEY_DONE, error) : status;
}

ffd_status ffd_reads_learn(run_files *files, const batch_job *job, const job_kind *kind, bool of_mesh,
                           size_t sidecars, const byte_buffer *found, ffd_error *error)
{
    finding f = {.files = files, .job = job};
    size_t at = 0;
    scan_kind entry;
    if (of_mesh)
        begin_scan(files, kind, sidecars);
    for (const char *path = ffd_scan_next(found, &at, &entry); path; path = ffd_scan_next(found, &at, &entry))
        TRY(take(&f, entry, path, error));
    TRY(end_lattice(files, f.lattice, job->line, error));
    return of_mesh ? end_scan(files, kind, job->line, error) : FFD_OK;
}

ffd_status ffd_reads_learn_nothing(run_files *files, const batch_job *job, bool of_mesh, ffd_error *error)
{
    const job_kind kind = ffd_job_kind(job);
    known_lattice *added;
    if (of_mesh)
        begin_scan(files, &kind, 0);
    size_t index = 0;
    for (named_read read = read_of(job, index); read.path; read = read_of(job, ++index))
        if (read.is_lattice)
            TRY(add_lattice(files, read.path, &added, error));
    return FFD_OK;
}
