/* report_refine.h - the entry of a job of `ffd lattice refine` in a report. */
#ifndef FFD_JOB_REPORT_REPORT_REFINE_H
#define FFD_JOB_REPORT_REPORT_REFINE_H

#include "base/text/buffer.h"
#include <ffd/job.h>

/* Appends the text of the entry. stable: leave out the seconds. */
void ffd_report_refine_text(const char *input, const char *output, const ffd_refine_result *result,
                            bool stable, byte_buffer *text);

#endif
