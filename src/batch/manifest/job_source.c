#include "batch/manifest/job_source.h"
#include "base/file/folder.h"
#include "base/file/glob.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/file/place.h"
#include "base/memory/file_table.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "base/system/interrupt.h"
#include "base/text/content.h"
#include "base/text/words.h"
#include "batch/manifest/job_rows.h"
#include "batch/manifest/lines.h"
#include "batch/manifest/manifest.h"
#include "batch/manifest/table.h"
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct job_source {
    job_source_desc desc;
    batch_frame frame;
    char *folder;       /* for frame.folder */
    uint64_t count;     /* jobs so far, of all shards */
    uint64_t line;      /* first line of the last job */
    const char *text;   /* of the last job of a callback */
    line_reader reader; /* of the manifest or table */
    csv_table table;
    bool numbers_outputs; /* several rows may use one mesh, so outputs get the number of the row */
    file_table
        meshes;      /* number of rows that use each mesh (2: several); unknown for a stream, where all may */
    path_list files; /* matches of the pattern */
};

/* Lines */

/* Whether a line consists of NUL bytes, as after a crash during writing. */
static bool is_zeros(const byte_buffer *line)
{
    for (size_t i = 0; i < line->size; i++)
        if (line->data[i] != 0)
            return false;
    return line->size > 0;
}

static ffd_status read_manifest_line(job_source *source, batch_job *job)
{
    const line_reader *const reader = &source->reader;
    if (!reader->too_long)
        return ffd_job_parse(&source->frame, reader->line.data, reader->line.size, job);
    ffd_fail_line(&job->error, FFD_E_INVALID, source->frame.name, (size_t)reader->count,
                  "the line has more than %zu bytes", LINE_MOST);
    return FFD_OK;
}

/* Tables */

static job_commons list_commons(const job_source *source)
{
    const job_source_desc *const desc = &source->desc;
    return (job_commons){.folder = source->folder,
                         .out_dir = desc->out_dir,
                         .ending = desc->ending,
                         .input = desc->pattern,
                         .defaults = desc->defaults,
                         .skipped = source->table.skipped,
                         .decimal_comma = source->table.separator != ',',
                         .points = source->table.points};
}

/* Returns the path of a row's mesh, freed by the caller; NULL: it has none, or memory runs out. */
static char *mesh_of(const job_source *source)
{
    const job_commons commons = list_commons(source);
    const csv_row *const columns = &source->table.columns, *const row = &source->table.row;
    job_description description = {0};
    csv_flaw flaw = {0};
    ffd_describe_row(&commons, columns, row, 0, &description, &flaw);
    const char *const mesh = ffd_description_find(&description, JOB_INPUT);
    char *const path = mesh ? ffd_text_copy(mesh) : NULL;
    ffd_description_free(&description);
    return path;
}

/* Whether other rows use the same mesh, or may do so. */
static bool is_repeated(const job_source *source)
{
    uint64_t rows;
    if (ffd_file_reads_once(source->desc.table))
        return true;
    char *const mesh = mesh_of(source);
    const hash128 file = mesh ? ffd_place_of(NULL, mesh) : (hash128){{0}};
    ffd_free(mesh);
    return ffd_files_find(&source->meshes, &file, &rows) && rows > 1;
}

static ffd_status read_row(job_source *source, bool valid, batch_job *job)
{
    job_description description = {0};
    csv_flaw flaw = {0};
    if (!ffd_table_check(&source->table, valid, &job->error))
        return FFD_OK;
    const job_commons commons = list_commons(source);
    const uint64_t ordinal = source->numbers_outputs && is_repeated(source) ? source->count : 0;
    ffd_describe_row(&commons, &source->table.columns, &source->table.row, ordinal, &description, &flaw);
    if (flaw.cell[0])
        ffd_flaw_line(&source->table.flaws, source->frame.name, (size_t)job->line, &job->error,
                      "\"%s\" is no number in JSON, and is read as %s", flaw.cell, flaw.number);
    if (flaw.mixed[0] && !job->error.status)
        ffd_flaw_line(
            &source->table.flaws, source->frame.name, (size_t)job->line, &job->error,
            "column \"%s\" has decimal commas, and dots before three digits, which are read as decimal "
            "points too: \"%s\"",
            flaw.column, flaw.mixed);
    const ffd_status status = job->error.status ? FFD_OK : ffd_job_make(&source->frame, &description, job);
    ffd_description_free(&description);
    return status;
}

/* Patterns */

static ffd_status read_file(const job_source *source, const char *path, batch_job *job)
{
    const job_commons commons = list_commons(source);
    job_description description = {0};
    ffd_describe_file(&commons, path, &description);
    const ffd_status status = ffd_job_make(&source->frame, &description, job);
    ffd_description_free(&description);
    return status;
}

/* A file, and the name of its output. */
typedef struct named_file {
    const char *path;
    char *name;
} named_file;

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const named_file *)a)->name, ((const named_file *)b)->name);
}

/* Refuses files whose outputs have equal names: they would overwrite each other. */
static ffd_status refuse_equal_names(const job_source *source, ffd_error *error)
{
    const path_list *const files = &source->files;
    const job_commons commons = list_commons(source);
    named_file *const sorted = ffd_alloc_zero(files->count, sizeof *sorted);
    ffd_status status;
    TRY_END(sorted ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < files->count; i++) {
        sorted[i] = (named_file){files->paths[i], ffd_output_name(&commons, files->paths[i], 0)};
        TRY_END(sorted[i].name ? FFD_OK : ffd_fail_memory(error));
    }
    qsort(sorted, files->count, sizeof *sorted, compare_names);
    for (size_t i = 1; i < files->count; i++)
        if (compare_names(&sorted[i - 1], &sorted[i]) == 0)
            TRY_END(ffd_fail(error, FFD_E_ARGUMENT, "%s and %s would both be written as \"%s\"",
                             sorted[i - 1].path, sorted[i].path, sorted[i].name));
end:
    for (size_t i = 0; sorted && i < files->count; i++)
        ffd_free(sorted[i].name);
    ffd_free(sorted);
    return status;
}

static ffd_status find_files(job_source *source, ffd_error *error)
{
    const char *const pattern = source->desc.pattern;
    if (ffd_folder_is_there(pattern))
        return ffd_fail_file(
            error, FFD_E_IO, pattern, "is a folder: name its meshes by a pattern, such as '%.*s/*.obj'",
            (int)(strlen(pattern) - ffd_is_separator(pattern[strlen(pattern) - 1])), pattern);
    TRY(ffd_glob(pattern, &source->files, error));
    if (ffd_interrupt_requested())
        return FFD_OK;
    if (source->files.count == 0)
        return ffd_fail_file(error, FFD_E_IO, source->desc.pattern, "no file matches this pattern");
    return source->desc.out_dir ? refuse_equal_names(source, error) : FFD_OK;
}

/* All of them */

static void free_source(job_source *source)
{
    ffd_lines_close(&source->reader);
    ffd_table_free(&source->table);
    ffd_files_free(&source->meshes);
    ffd_paths_free(&source->files);
    ffd_free(source->folder);
}

static ffd_status open_text(job_source *source, const char *path, ffd_error *error)
{
    source->frame.name = ffd_file_display_name(path);
    source->folder =
        ffd_file_is_stream(path) || ffd_path_name(path) == path ? ffd_text_copy("") : ffd_path_folder(path);
    if (!source->folder)
        return ffd_fail_memory(error);
    /* Files named on the command line are not relative to the table. */
    source->frame.folder = source->desc.table ? "" : source->folder;
    return ffd_lines_open(path, source->frame.name, &source->reader, error);
}

static ffd_status open_table(job_source *source, ffd_error *error)
{
    if (ffd_format_from_name(source->desc.table) != FFD_FORMAT_AUTO)
        return ffd_fail_file(error, FFD_E_INVALID, source->desc.table,
                             "has the ending of a mesh, not of a table");
    const ffd_status status = open_text(source, source->desc.table, error);
    source->table.reader = &source->reader;
    source->table.name = source->frame.name;
    source->table.ignored = source->desc.ignored;
    return status ? status : ffd_table_begin(&source->table, error);
}

static ffd_status count_row(const job_source *other, file_table *meshes, ffd_error *error)
{
    uint64_t rows = 0;
    char *const mesh = mesh_of(other);
    if (!mesh)
        return FFD_OK;
    const hash128 file = ffd_place_of(NULL, mesh);
    ffd_free(mesh);
    const bool is_known = ffd_files_find(meshes, &file, &rows);
    return is_known && rows > 1 ? FFD_OK : ffd_files_put(meshes, &file, is_known ? 2 : 1, error);
}

/* Reads the whole table once, to find meshes that several rows use. */
static ffd_status count_meshes(job_source *source, ffd_error *error)
{
    job_source other = {.desc = source->desc, .frame = source->frame};
    line_state state = LINE_READ;
    bool valid;
    ffd_status status;
    TRY_END(open_table(&other, error));
    while (state == LINE_READ) {
        TRY_END(ffd_table_next(&other.table, &state, &valid, error));
        if (state == LINE_READ && ffd_table_check(&other.table, valid, NULL))
            TRY_END(count_row(&other, &source->meshes, error));
    }
end:
    free_source(&other);
    return status;
}

ffd_status ffd_jobs_open(const job_source_desc *desc, job_source **source, ffd_error *error)
{
    *source = ffd_alloc_zero(1, sizeof **source);
    if (!*source)
        return ffd_fail_memory(error);
    (*source)->desc = *desc;
    (*source)->table.flaws.strict = desc->strict;
    (*source)->frame = (batch_frame){desc->next ? "jobs" : desc->pattern,
                                     "",
                                     desc->defaults,
                                     desc->ending,
                                     desc->look,
                                     desc->resume,
                                     desc->pictures,
                                     desc->positions};
    ffd_status status;
    TRY_END(desc->next       ? FFD_OK
            : desc->manifest ? open_text(*source, desc->manifest, error)
            : desc->table    ? open_table(*source, error)
                             : find_files(*source, error));
    (*source)->numbers_outputs = desc->table && desc->out_dir && !ffd_table_has(&(*source)->table, "out");
    if ((*source)->numbers_outputs && !ffd_file_reads_once(desc->table))
        TRY_END(count_meshes(*source, error));
end:
    if (status)
        ffd_jobs_close(source);
    return status;
}

/* Asks the caller for the next line. */
static ffd_status ask_caller(job_source *source, line_state *state, ffd_error *error)
{
    source->text = NULL;
    const ffd_status status = source->desc.next(source->desc.next_user, source->count, &source->text);
    *state = status == FFD_OK && source->text ? LINE_READ : LINE_NONE;
    source->line = source->count + 1;
    return status == FFD_OK ? FFD_OK
                            : ffd_fail(error, ffd_status_known(status),
                                       "the caller's function for jobs has failed (%d)", (int)status);
}

/* Finds the next job of any shard. */
static ffd_status find_next(job_source *source, line_state *state, bool *valid, ffd_error *error)
{
    *valid = true;
    if (source->desc.next)
        return ask_caller(source, state, error);
    if (source->desc.manifest) {
        const ffd_status status = ffd_lines_next_filled(&source->reader, state, error);
        source->line = source->reader.count;
        return status;
    }
    if (source->desc.table) {
        const ffd_status status = ffd_table_next(&source->table, state, valid, error);
        source->line = source->table.line;
        return status;
    }
    *state = source->count < source->files.count ? LINE_READ : LINE_NONE;
    source->line = source->count + 1;
    return FFD_OK;
}

/* Whether an object goes on in the next line: a job that is cut off seldom ends so. */
static bool is_open(const char *object)
{
    const char *last = object + strlen(object);
    while (last > object && strchr(" \t\r", last[-1]))
        last--;
    return last > object && strchr("{[,", last[-1]);
}

/* Returns what a manifest is by its first line, if it is no JSON Lines; NULL: it may be. */
static const char *other_manifest(const job_source *source)
{
    const char *const line = source->reader.line.data, *const begin = line + strspn(line, " \t");
    if (*begin == '[')
        return "is a JSON array";
    if (*begin == '{' && strstr(begin, "\"format\"") && strstr(begin, "\"ffd-lattice\""))
        return "is a lattice";
    if (*begin == '{' && is_open(begin))
        return "is JSON over several lines";
    const char *const ending = strrchr(source->frame.name, '.');
    const bool is_table = ending && (strcmp(ending, ".csv") == 0 || strcmp(ending, ".tsv") == 0);
    return is_table && *begin != '{' ? "is no JSON ({csv} reads a table)" : NULL;
}

/* Guesses what a manifest is whose first line is not an object, by that line, and by the whole file if it can
   be read again: comments do not tell. */
static const content_kind *kind_of_manifest(const job_source *source)
{
    const byte_buffer *const line = &source->reader.line;
    const content_kind *kind = ffd_content_kind(line->data, line->size);
    file_input file;
    if (kind || ffd_file_reads_once(source->desc.manifest) ||
        ffd_file_map(source->desc.manifest, &file, NULL))
        return kind;
    kind = ffd_content_kind(file.data, file.size);
    ffd_file_unload(&file);
    return kind;
}

/* Refuses a file of another kind as a whole, by its content or its name. Of an unknown text each line is a
   job that fails. */
static ffd_status check_kind(const job_source *source, ffd_error *error)
{
    const char *const text = source->reader.line.data;
    if (text[strspn(text, " \t")] == '{')
        return FFD_OK;
    const content_kind *kind = kind_of_manifest(source);
    kind = kind && kind->format != FFD_FORMAT_GLTF ? kind : NULL; /* JSON is what a manifest has */
    if (!kind && ffd_format_from_name(source->frame.name) == FFD_FORMAT_AUTO)
        return FFD_OK;
    ffd_fail_line(error, FFD_E_INVALID, source->frame.name, (size_t)source->line,
                  "is no object of JSON: a manifest has one job a line (JSON Lines)");
    if (error)
        ffd_content_mention(kind, error);
    return FFD_E_INVALID;
}

/* Refuses a text that has no jobs at all with one error, not one a line. */
static ffd_status check_first(const job_source *source, ffd_error *error)
{
    const char *const found = source->desc.manifest ? other_manifest(source) : NULL;
    if (is_zeros(&source->reader.line))
        return ffd_fail_line(error, FFD_E_INVALID, source->frame.name, (size_t)source->line,
                             "NUL bytes, and no job before them");
    if (found)
        return ffd_fail_line(error, FFD_E_INVALID, source->frame.name, (size_t)source->line,
                             "%s: a manifest has one job a line (JSON Lines)", SPELLED(found));
    return source->desc.manifest ? check_kind(source, error) : FFD_OK;
}

/* Likewise; checks the first line. */
static ffd_status advance(job_source *source, line_state *state, bool *valid, ffd_error *error)
{
    TRY(find_next(source, state, valid, error));
    return *state != LINE_READ || source->count > 0 ? FFD_OK : check_first(source, error);
}

ffd_status ffd_jobs_next(job_source *source, batch_job *job, line_state *state, ffd_error *error)
{
    bool valid, mine;
    *job = (batch_job){0};
    do {
        const ffd_status status = advance(source, state, &valid, error);
        if (status || *state != LINE_READ)
            return status;
        mine = source->count++ % source->desc.shards == source->desc.shard;
    } while (!mine);
    job->line = source->line;
    job->row = source->count - 1;
    const ffd_status status =
        source->desc.next       ? ffd_job_parse(&source->frame, source->text, strlen(source->text), job)
        : source->desc.manifest ? read_manifest_line(source, job)
        : source->desc.table    ? read_row(source, valid, job)
                                : read_file(source, source->files.paths[source->count - 1], job);
    return status ? ffd_fail_memory(error) : FFD_OK;
}

bool ffd_jobs_come_once(const job_source_desc *desc)
{
    const char *const text = desc->manifest ? desc->manifest : desc->table;
    return (desc->next && !desc->repeats) || (text && ffd_file_reads_once(text));
}

ffd_status ffd_jobs_total(const job_source_desc *desc, uint64_t *total, ffd_error *error)
{
    job_source *source;
    line_state state = LINE_READ;
    bool valid;
    *total = 0;
    TRY(ffd_jobs_open(desc, &source, error));
    ffd_status status = FFD_OK;
    while (state != LINE_NONE && !ffd_interrupt_requested()) {
        if (source->reader.stream)
            ffd_stream_wait(source->reader.stream);
        TRY_END(advance(source, &state, &valid, error));
        source->count += state == LINE_READ;
    }
    *total = source->count;
end:
    ffd_jobs_close(&source);
    return status;
}

uint64_t ffd_jobs_count(const job_source *source)
{
    return source->count;
}

double ffd_jobs_fraction(const job_source *source)
{
    if (source->files.count)
        return (double)source->count / (double)source->files.count;
    const byte_stream *const stream = source->reader.stream;
    if (!stream) /* the pattern was not searched to its end */
        return -1;
    const uint64_t size = ffd_stream_size(stream);
    return size ? (double)ffd_stream_position(stream) / (double)size : -1;
}

int ffd_jobs_descriptor(const job_source *source)
{
    return source->reader.stream ? ffd_stream_descriptor(source->reader.stream) : -1;
}

const mesh_flaws *ffd_jobs_flaws(const job_source *source)
{
    return &source->table.flaws;
}

const char *ffd_jobs_name(const job_source *source)
{
    return source->frame.name;
}

void ffd_jobs_close(job_source **source)
{
    if (!*source)
        return;
    free_source(*source);
    ffd_free(*source);
    *source = NULL;
}
