#include "batch/job_rows.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "json/json_parse.h"
#include "json/json_setting.h"
#include <string.h>

/* Sets a placeholder to a cell. */
static void set_cell(job_description *job, const char *column, const char *cell)
{
    json_setting value;
    if (ffd_json_setting_parse(cell, JSON_NO_NUL | JSON_DOUBLES | JSON_INTEGERS, &value))
        job->texts.failed = true;
    else
        ffd_description_set(job, column, &value.tree, 0);
    ffd_json_setting_free(&value);
}

/* Adds a path, which is relative to folder ("": to the current one). */
static void add_path(job_description *job, job_part part, const char *folder, const char *path)
{
    if (!*folder || ffd_path_is_absolute(path)) {
        ffd_description_add(job, part, NULL, path);
        return;
    }
    char *const joined = ffd_path_join(folder, path);
    if (joined)
        ffd_description_add(job, part, NULL, joined);
    else
        job->texts.failed = true;
    ffd_free(joined);
}

static void add_lattices(job_description *job, const job_commons *commons)
{
    for (size_t i = 0; i < commons->lattice_count; i++)
        ffd_description_add(job, JOB_LATTICE, NULL, commons->lattices[i]);
}

/* In the folder of outputs, the output has the name of the input. */
static void add_output(job_description *job, const char *folder, const char *input)
{
    char *const name = ffd_text_copy(ffd_path_name(input));
    if (name)
        add_path(job, JOB_OUTPUT, folder, name);
    else
        job->texts.failed = true;
    ffd_free(name);
}

/* "in", "out", "lattice" are files, other columns values of placeholders. Relative paths start at the table's
   folder, those of outputs at the batch's. */
static void describe_cell(const job_commons *commons, const char *column, const char *cell,
                          job_description *job)
{
    const char *const out_dir = commons->out_dir;
    if (strcmp(column, "in") != 0 && strcmp(column, "out") != 0 && strcmp(column, "lattice") != 0)
        set_cell(job, column, cell);
    else if (*cell && *column == 'o')
        add_path(job, JOB_OUTPUT, out_dir ? out_dir : commons->folder, cell);
    else if (*cell)
        add_path(job, *column == 'i' ? JOB_INPUT : JOB_LATTICE, commons->folder, cell);
}

void ffd_describe_row(const job_commons *commons, const csv_row *columns, const csv_row *row,
                      job_description *job)
{
    const char *column = NULL, *cell = NULL;
    for (size_t i = 0; i < row->count; i++) {
        column = ffd_csv_next(columns, column);
        cell = ffd_csv_next(row, cell);
        describe_cell(commons, column, cell, job);
    }
    if (commons->input && !ffd_description_find(job, JOB_INPUT))
        ffd_description_add(job, JOB_INPUT, NULL, commons->input);
    const char *const input = ffd_description_find(job, JOB_INPUT);
    if (commons->out_dir && input && !ffd_description_find(job, JOB_OUTPUT))
        add_output(job, commons->out_dir, input);
    if (!ffd_description_find(job, JOB_LATTICE))
        add_lattices(job, commons);
}

void ffd_describe_file(const job_commons *commons, const char *path, job_description *job)
{
    ffd_description_add(job, JOB_INPUT, NULL, path);
    if (commons->out_dir)
        add_output(job, commons->out_dir, path);
    add_lattices(job, commons);
}
