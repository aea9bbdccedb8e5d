/* report_file.h - the file of a report (public: ffd/job.h): a JSON object with an array of entries, or JSON
   Lines. It grows entry by entry, and is whole JSON at any moment. */
#ifndef FFD_JOB_REPORT_REPORT_FILE_H
#define FFD_JOB_REPORT_REPORT_FILE_H

#include "base/text/buffer.h"
#include <ffd/job.h>

/* Whether the name is that of JSON Lines. */
bool ffd_report_has_lines(const char *path);
/* The refusals of ffd_report_create, for a run that writes nothing. */
ffd_status ffd_report_check(const char *path, ffd_error *error);
/* Whether entries have to be added in the order of the jobs: what goes to a stream stays there. */
bool ffd_report_is_ordered(const ffd_report *report);
/* Adds the entry of a job by its text. Jobs are numbered from 0, in their order, in which the report has them
   in the end; only one of JSON Lines with times keeps the order of the calls. Errors: as ffd_report_add. */
ffd_status ffd_report_add_text(ffd_report *report, uint64_t number, const char *text, size_t size,
                               ffd_error *error);

/* Appends what stands before the first entry of a report. */
void ffd_report_begin_text(bool lines, byte_buffer *text);
/* Appends an entry, with what stands between it and the one before. */
void ffd_report_put_entry(bool lines, bool is_first, const char *entry, size_t size, byte_buffer *text);
/* Appends what stands after the last entry. */
void ffd_report_end_text(bool lines, bool is_empty, byte_buffer *text);

#endif
