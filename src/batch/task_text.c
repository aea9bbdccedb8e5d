#include "batch/task_text.h"
#include "base/one_line.h"
#include "batch/manifest/settings.h"
#include "job/figures/figure_values.h"
#include "job/report/report.h"
#include <string.h>

/* Appends an error and a line break. */
static void append_error(const ffd_error *error, byte_buffer *text)
{
    char line[2048];
    ffd_error_format(error, line, sizeof line);
    ffd_buffer_text(text, line);
    ffd_buffer_text(text, "\n");
}

/* Appends "FILE:LINE: ". */
static void append_place(const batch_job *job, const char *manifest, byte_buffer *text)
{
    ffd_error place;
    char line[2048];
    ffd_fail_line(&place, FFD_E_INVALID, manifest, (size_t)job->line, "%s", "");
    ffd_error_format(&place, line, sizeof line);
    ffd_buffer_text(text, line);
}

/* Appends "NAME=VALUE, NAME=VALUE: ", with control characters replaced. */
static void append_settings(const batch_job *job, byte_buffer *text)
{
    const size_t before = text->size;
    ffd_settings_show(job->words.data, job->word_count, text);
    if (text->size == before)
        return;
    ffd_make_one_line(text->data + before, text->size - before);
    ffd_buffer_text(text, ": ");
}

void ffd_task_lines(const pool_task *task, const char *manifest, byte_buffer *text)
{
    byte_buffer lines = {0}, lead = {0};
    if (task->log.size)
        ffd_buffer_append(&lines, task->log.data, task->log.size);
    if (task->failure.status)
        append_error(&task->failure, &lines);
    if (lines.size == 0) {
        text->failed = text->failed || lines.failed;
        ffd_buffer_free(&lines);
        return;
    }
    if (manifest)
        append_place(&task->job, manifest, &lead);
    const size_t place = lead.size;
    append_settings(&task->job, &lead);
    for (const char *line = lines.data, *const end = line + lines.size, *next; line < end; line = next) {
        next = memchr(line, '\n', (size_t)(end - line));
        next = next ? next + 1 : end;
        /* An error of the manifest line has its place already. */
        if (!place || (size_t)(next - line) < place || memcmp(line, lead.data, place) != 0)
            ffd_buffer_append(text, lead.data, lead.size);
        ffd_buffer_append(text, line, (size_t)(next - line));
    }
    text->failed = text->failed || lines.failed || lead.failed;
    ffd_buffer_free(&lines);
    ffd_buffer_free(&lead);
}

void ffd_task_entry(const pool_task *task, const row_array *rows, bool stable, byte_buffer *text)
{
    const batch_job *const job = &task->job;
    ffd_job_result result;
    byte_buffer set = {0};
    ffd_result_clear(&result);
    result.status = task->failure.status;
    result.error = task->failure;
    ffd_settings_json(job->words.data, job->word_count, &set);
    const bool skipped = task->outcome == OUTCOME_SKIPPED;
    result.picture = task->has_picture ? task->picture : NULL;
    const report_entry entry = {.line = job->line,
                                .input = job->input,
                                .output = ffd_job_output_name(job),
                                .positions = rows ? rows->path : NULL,
                                .row = job->row,
                                .set = set.failed ? NULL : set.data,
                                .result = &result,
                                .figures = skipped && task->figures.size ? task->figures.data : NULL,
                                .skipped = skipped,
                                .stable = stable};
    ffd_report_entry_text(&entry, text);
    text->failed = text->failed || set.failed;
    ffd_buffer_free(&set);
}
