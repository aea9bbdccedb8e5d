/* report_file.h - the file of a report (public: ffd/job.h): a JSON object with an array of entries, or JSON
   Lines. It grows entry by entry, and is valid JSON at any time. */
#ifndef FFD_JOB_REPORT_REPORT_FILE_H
#define FFD_JOB_REPORT_REPORT_FILE_H

#include "base/text/buffer.h"
#include <ffd/job.h>

/* Whether the name has the ending of JSON Lines. */
bool ffd_report_has_lines(const char *path);
/* Makes the checks of ffd_report_create without writing, for a dry run. */
ffd_status ffd_report_check(const char *path, ffd_error *error);
/* Whether entries must be added in the order of the jobs: a stream cannot be reordered. */
bool ffd_report_is_ordered(const ffd_report *report);
/* Adds the entry of a job as text. Jobs are numbered from 0 in their order; the finished report is in that
   order, except JSON Lines with times, which keep the order of the calls. Errors: as of ffd_report_add. */
ffd_status ffd_report_add_text(ffd_report *report, uint64_t index, const char *text, size_t size,
                               ffd_error *error);

/* Appends the text before the first entry. */
void ffd_report_begin_text(bool lines, byte_buffer *text);
/* Appends an entry, with the separator before it. */
void ffd_report_put_entry(bool lines, bool is_first, const char *entry, size_t size, byte_buffer *text);
/* Appends the text after the last entry. */
void ffd_report_end_text(bool lines, bool is_empty, byte_buffer *text);

#endif
