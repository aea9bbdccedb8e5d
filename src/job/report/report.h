/* report.h - the entries of the JSON report (data/schema/formats.md 2). */
#ifndef FFD_JOB_REPORT_REPORT_H
#define FFD_JOB_REPORT_REPORT_H

#include "base/text/buffer.h"
#include <ffd/job.h>

/* What a report says of a job. */
typedef struct report_entry {
    uint64_t line; /* of the job in its manifest; 0: it has none, and the entry does not say it */
    const char *input, *output; /* may be NULL */
    const char *positions;      /* the array with the job's positions, in this row; NULL: there is none */
    uint64_t row;
    const char *set; /* values of placeholders as a JSON object; NULL: not said */
    const ffd_job_result *result;
    const char *figures; /* of the run that made the output (ffd_report_figures), in place of the result's; or
                            NULL */
    bool skipped;        /* the output was up to date */
    bool planned;        /* the job was not done, so that its figures are not known */
    bool stable;         /* without times */
} report_entry;

/* Appends the entry's text as it is in a report. */
void ffd_report_entry_text(const report_entry *entry, byte_buffer *text);
/* Appends the figures of a result, with its times, as a JSON object on one line. */
void ffd_report_figures(const ffd_job_result *result, byte_buffer *text);

#endif
