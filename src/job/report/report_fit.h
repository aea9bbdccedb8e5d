/* report_fit.h - the entry of a job of `ffd fit` in a report. */
#ifndef FFD_JOB_REPORT_REPORT_FIT_H
#define FFD_JOB_REPORT_REPORT_FIT_H

#include "base/text/buffer.h"
#include "json/json_text.h"
#include <ffd/fit.h>

/* Appends the text of the entry. stable: leave out the seconds. */
void ffd_report_fit_text(const char *input, const char *output, const ffd_fit_job_result *result, bool stable,
                         byte_buffer *text);
/* Writes the member `fit` of such a job, under a key (NULL: the whole text). */
void ffd_report_write_fit(json_text *json, const char *key, const ffd_fit_job_result *result);

#endif
