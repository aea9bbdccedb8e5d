#include "batch/progress.h"
#include "base/system/clock.h"
#include "base/system/deadline.h"
#include "base/system/terminal.h"
#include "base/text/words.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* The most characters of a line for the caller. */
#define LONGEST_LINE 4096

void ffd_progress_begin(batch_progress *progress, const ffd_batch_desc *desc)
{
    *progress = (batch_progress){.desc = desc};
    ffd_progress_bar_begin(&progress->bar, desc->is_program && ffd_terminal_is_error());
}

/* Writes the state, such as "1234 jobs, 3 failed, 812/s, 0:07 left". */
static void describe(const batch_progress *progress, const ffd_batch_result *counts, double fraction,
                     char *text, size_t capacity)
{
    const uint64_t jobs = counts->done + counts->skipped + counts->failed;
    const double seconds = ffd_clock_seconds() - progress->bar.begin;
    char left[48];
    ffd_progress_left(&progress->bar, jobs > 0 ? fraction : 0, left, sizeof left);
    snprintf(text, capacity, "%" PRIu64 " %s, %" PRIu64 " failed, %.*f/s%s", jobs,
             progress->draws ? ffd_plural(jobs, "picture", "pictures") : ffd_plural(jobs, "job", "jobs"),
             counts->failed, seconds > 0 && (double)jobs / seconds < 10 ? 1 : 0,
             seconds > 0 ? (double)jobs / seconds : 0.0, left);
}

bool ffd_progress_show(batch_progress *progress, const ffd_batch_result *counts, double fraction)
{
    const ffd_batch_desc *const desc = progress->desc;
    char text[160];
    if (!desc->is_program)
        return !(desc->cancel && ffd_flag_is_set(desc->cancel)) &&
               (!desc->progress || desc->progress(desc->progress_user, fraction));
    if (desc->quiet || !ffd_progress_bar_is_due(&progress->bar))
        return true;
    describe(progress, counts, fraction, text, sizeof text);
    ffd_progress_bar_show(&progress->bar, text, fraction);
    return true;
}

void ffd_progress_print(batch_progress *progress, const char *lines)
{
    const ffd_batch_desc *const desc = progress->desc;
    for (const char *end; (end = strchr(lines, '\n')); lines = end + 1) {
        const int length = (int)(end - lines);
        if (desc->is_program) {
            ffd_progress_bar_clear(&progress->bar);
            fprintf(stderr, "ffd: %.*s\n", length, lines);
        } else if (desc->log) {
            char line[LONGEST_LINE];
            snprintf(line, sizeof line, "%.*s", length, lines);
            desc->log(desc->log_user, FFD_LOG_WARNING, line);
        }
    }
}

void ffd_progress_end(batch_progress *progress, const ffd_batch_result *counts, const char *done,
                      const char *remark)
{
    char time[32];
    ffd_progress_bar_clear(&progress->bar);
    if (!progress->desc->is_program || progress->desc->quiet)
        return;
    const uint64_t jobs = counts->done + counts->skipped + counts->failed;
    const double seconds = ffd_clock_seconds() - progress->bar.begin;
    ffd_progress_time(seconds, time, sizeof time);
    if (seconds < 60)
        snprintf(time, sizeof time, "%.1f s", seconds);
    fprintf(stderr,
            "ffd: %" PRIu64 " %s in %s: %" PRIu64 " %s, %" PRIu64 " up to date, %" PRIu64 " failed%s\n", jobs,
            ffd_plural(jobs, "job", "jobs"), time, counts->done, done, counts->skipped, counts->failed,
            remark);
}
