#include "batch/manifest/job_rows.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/spelling.h"
#include "io/format_names.h"
#include "json/json_parse.h"
#include "json/json_setting.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#define CELL_RULES (JSON_NO_NUL | JSON_DOUBLES | JSON_INTEGERS)

static bool is_json(const char *text)
{
    json_setting value;
    const bool parsed = ffd_json_setting_parse(text, CELL_RULES, &value) == FFD_OK && !value.quoted;
    ffd_json_setting_free(&value);
    return parsed;
}

/* Converts a cell to a JSON number; freed by the caller. NULL: the cell is not a number. flaw: gets the first
   cell that is not written as JSON. */
static char *number_of(const job_commons *commons, const char *cell, csv_flaw *flaw)
{
    byte_buffer text = {0};
    char *number = NULL;
    if (!is_json(cell) && ffd_csv_number(cell, commons->decimal_comma, &text))
        number = ffd_buffer_finish(&text);
    ffd_buffer_free(&text);
    if (number && !is_json(number)) { /* out of range */
        ffd_free(number);
        number = NULL;
    }
    /* In a table with decimal commas, a comma is not a flaw. */
    const bool is_flaw = number && !flaw->cell[0] && !(commons->decimal_comma && strchr(cell, ','));
    if (is_flaw) {
        snprintf(flaw->cell, sizeof flaw->cell, "%s", cell);
        snprintf(flaw->number, sizeof flaw->number, "%s", number);
    }
    return number;
}

/* Notes how a number writes its decimals, and whether its column has two ways that contradict each other. */
static void note_point(const job_commons *commons, size_t index, const char *column, const char *cell,
                       csv_flaw *flaw)
{
    const csv_point point = ffd_csv_point(cell);
    uint8_t *const points = &commons->points[index];
    *points |= (uint8_t)point;
    if (!point || *points != (CSV_DECIMAL_COMMA | CSV_DOT_OF_THREE) || flaw->mixed[0])
        return;
    snprintf(flaw->column, sizeof flaw->column, "%s", column);
    snprintf(flaw->mixed, sizeof flaw->mixed, "%s", cell);
}

/* Sets a placeholder to the value of a cell of column i. */
static void set_cell(const job_commons *commons, size_t i, const char *column, const char *cell,
                     job_description *job, csv_flaw *flaw)
{
    char *const number = number_of(commons, cell, flaw);
    json_setting value;
    if (commons->decimal_comma && (number || (is_json(cell) && !strpbrk(cell, "[{\""))))
        note_point(commons, i, column, cell, flaw);
    if (ffd_json_setting_parse(number ? number : cell, CELL_RULES, &value))
        job->texts.failed = true;
    else
        ffd_description_set(job, column, &value.tree, 0);
    ffd_json_setting_free(&value);
    ffd_free(number);
}

/* Adds a path, relative to folder ("": the current one). */
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
    const ffd_deform_desc *const defaults = commons->defaults;
    for (size_t i = 0; defaults && i < defaults->lattice_count; i++)
        if (defaults->morphs)
            ffd_description_add(job, JOB_MORPH, defaults->morphs[i], defaults->lattices[i].path);
        else
            ffd_description_add(job, JOB_LATTICE, NULL, defaults->lattices[i].path);
}

char *ffd_output_name(const job_commons *commons, const char *input, uint64_t ordinal)
{
    char *const named = commons->ending ? ffd_format_rename(input, commons->ending) : ffd_text_copy(input);
    char *const stem = named ? ffd_path_stem(named) : NULL;
    byte_buffer text = {.failed = !stem};
    /* The name of a mesh of OpenFOAM stays: a folder has the number. */
    if (stem && ordinal && ffd_format_from_name(named) == FFD_FORMAT_FOAM)
        ffd_buffer_format(&text, "%s-%" PRIu64 "/%s", stem, ordinal, ffd_path_name(named));
    else if (stem && ordinal)
        ffd_buffer_format(&text, "%s-%" PRIu64 "%s", stem, ordinal, ffd_path_ending(named));
    else if (stem)
        ffd_buffer_text(&text, ffd_path_name(named));
    ffd_free(stem);
    ffd_free(named);
    return ffd_buffer_finish(&text);
}

/* Adds the output, in the folder of outputs. ordinal: as in ffd_output_name. */
static void add_output(const job_commons *commons, const char *input, uint64_t ordinal, job_description *job)
{
    char *const name = ffd_output_name(commons, input, ordinal);
    if (name)
        add_path(job, JOB_OUTPUT, commons->out_dir, name);
    else
        job->texts.failed = true;
    ffd_free(name);
}

/* Whether a path, relative to some folder, leads to a file outside of it; true too if memory runs out. */
static bool leads_out(const char *path, job_description *job)
{
    char *const normal = ffd_path_normalize(path);
    const bool out = !normal || ffd_path_is_absolute(path) || ffd_path_leads_out(normal);
    job->texts.failed = job->texts.failed || !normal;
    ffd_free(normal);
    return out;
}

/* Adds an output that a cell names. A table that somebody else has made must not reach what is outside of
   --out-dir. */
static void add_named_output(const job_commons *commons, const char *cell, job_description *job)
{
    byte_buffer text = {0};
    if (!commons->out_dir || !leads_out(cell, job)) {
        add_path(job, JOB_OUTPUT, commons->out_dir ? commons->out_dir : commons->folder, cell);
        return;
    }
    ffd_buffer_format(&text, SPELLED("\"out\" leads out of {out_dir}: \"%s\""), cell);
    char *const wrong = ffd_buffer_finish(&text);
    if (wrong)
        ffd_description_add(job, JOB_WRONG, "out", wrong);
    else
        job->texts.failed = true;
    ffd_free(wrong);
}

/* The columns "in", "out" and "lattice" are files; others are values of placeholders. Paths are relative to
   the table's folder, those of outputs to --out-dir. An empty cell says nothing; but one in quotes is a
   text. */
static void describe_cell(const job_commons *commons, size_t i, const char *column, const char *cell,
                          char way, job_description *job, csv_flaw *flaw)
{
    if (!*cell && !(way & CSV_IN_QUOTES))
        return;
    if (strcmp(column, "in") != 0 && strcmp(column, "out") != 0 && strcmp(column, "lattice") != 0)
        set_cell(commons, i, column, cell, job, flaw);
    else if (*cell && *column == 'o')
        add_named_output(commons, cell, job);
    else if (*cell)
        add_path(job, *column == 'i' ? JOB_INPUT : JOB_LATTICE, commons->folder, cell);
}

void ffd_describe_row(const job_commons *commons, const csv_row *columns, const csv_row *row,
                      uint64_t ordinal, job_description *job, csv_flaw *flaw)
{
    const char *column = NULL, *cell = NULL;
    for (size_t i = 0; i < row->count; i++) {
        column = ffd_csv_next(columns, column);
        cell = ffd_csv_next(row, cell);
        if (!commons->skipped[i])
            describe_cell(commons, i, column, cell, row->ways.data[i], job, flaw);
    }
    if (commons->input && !ffd_description_find(job, JOB_INPUT))
        ffd_description_add(job, JOB_INPUT, NULL, commons->input);
    const char *const input = ffd_description_find(job, JOB_INPUT);
    if (commons->out_dir && input && !ffd_description_find(job, JOB_OUTPUT) &&
        !ffd_description_wrong(job, "out"))
        add_output(commons, input, ordinal, job);
    if (!ffd_description_find(job, JOB_LATTICE))
        add_lattices(job, commons);
}

void ffd_describe_file(const job_commons *commons, const char *path, job_description *job)
{
    ffd_description_add(job, JOB_INPUT, NULL, path);
    if (commons->out_dir)
        add_output(commons, path, 0, job);
    add_lattices(job, commons);
}
