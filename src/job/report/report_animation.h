/* report_animation.h - the entry of a job of `ffd animate` in a report. */
#ifndef FFD_JOB_REPORT_REPORT_ANIMATION_H
#define FFD_JOB_REPORT_REPORT_ANIMATION_H

#include "base/text/buffer.h"
#include <ffd/animate.h>

/* Appends the entry, without a line break. */
void ffd_report_animation_text(const char *input, const char *output, const ffd_animate_result *result,
                               bool stable, byte_buffer *text);

#endif
