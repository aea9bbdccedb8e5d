/* report.h - the JSON report (data/schema/formats.md 2), entry by entry (public: ffd/job.h). */
#ifndef FFD_JOB_REPORT_REPORT_H
#define FFD_JOB_REPORT_REPORT_H

#include "json/json_text.h"
#include <ffd/job.h>

/* What a report says of a job. */
typedef struct report_entry {
    uint64_t line; /* of the job in its manifest; 0: it has none, and the entry does not say it */
    const char *input, *output; /* may be NULL */
    const ffd_job_result *result;
    bool skipped; /* the output was up to date; of the result only zeros are there */
    bool stable;  /* without times */
} report_entry;

/* Appends the entry's text as it is in a report. */
void ffd_report_entry_text(const report_entry *entry, byte_buffer *text);
/* Adds an entry by its text. Errors: as ffd_report_add. */
ffd_status ffd_report_add_text(ffd_report *report, const char *text, size_t size, ffd_error *error);

#endif
