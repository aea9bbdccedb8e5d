/* report.h - writes entries of the JSON report (data/schema/formats.md 2). */
#ifndef FFD_JOB_REPORT_REPORT_H
#define FFD_JOB_REPORT_REPORT_H

#include "base/file/path_list.h"
#include "base/text/buffer.h"
#include "json/json_text.h"
#include <ffd/job.h>

/* The status of an entry. */
typedef enum report_outcome { REPORT_OK, REPORT_FAILED, REPORT_SKIPPED } report_outcome;
#define REPORT_OUTCOMES 3
/* Returns "ok", "failed" or "skipped". */
const char *ffd_report_outcome_name(report_outcome outcome);

/* One job in a report. */
typedef struct report_entry {
    uint64_t line;              /* of the job in its manifest; 0: none, and not written */
    const char *input, *output; /* names; may be NULL */
    const char *positions;      /* array file that holds the job's positions, in row `row`; NULL: none */
    uint64_t row;
    const path_list
        *outputs;    /* names of the files that the job has written; NULL: `output`, unless it failed */
    const char *set; /* values of placeholders as a JSON object; NULL: not written */
    const ffd_job_result *result;
    const char *figures; /* in place of the result's, those of an earlier run that made the output
                            (ffd_report_figures); or NULL */
    bool skipped;        /* the output was up to date */
    bool planned;        /* the job was not run, so its figures are unknown */
    bool stable;         /* leave out times */
} report_entry;

/* Writes an entry, an object, into the array of a report. */
typedef void report_entry_writer(json_text *json, const void *entry);
/* Appends the text that a writer makes of an entry, indented as in a report. */
void ffd_report_indent_entry(report_entry_writer *write, const void *entry, byte_buffer *text);
/* Writes the members status, exit and error of an entry. */
void ffd_report_write_outcome(json_text *json, ffd_status status, const ffd_error *error, bool skipped);

/* Begins the entry of a job with one output: input, output, the outputs that were written, and how it ended.
 */
void ffd_report_begin_single(json_text *json, const char *input, const char *output, ffd_status status,
                             const ffd_error *error);

/* Appends the text of an entry. */
void ffd_report_entry_text(const report_entry *entry, byte_buffer *text);
/* Appends the figures of a result, including times, as a JSON object on one line. */
void ffd_report_figures(const ffd_job_result *result, byte_buffer *text);

#endif
