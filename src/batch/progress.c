#include "batch/progress.h"
#include "base/system/clock.h"
#include "base/system/deadline.h"
#include "base/system/terminal.h"
#include "base/text/words.h"
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

/* Seconds between updates of the bar; between lines. */
#define BAR_SECONDS 0.1
#define LINE_SECONDS 10.0

enum { BAR_WIDTH = 30 };

/* The most characters of a line for the caller. */
#define LONGEST_LINE 4096

void ffd_progress_begin(batch_progress *progress, const ffd_batch_desc *desc)
{
    const double now = ffd_clock_seconds();
    *progress = (batch_progress){
        .desc = desc, .bar = desc->is_program && ffd_terminal_is_error(), .begin = now, .last = now};
}

static void clear_bar(batch_progress *progress)
{
    if (progress->drawn)
        fprintf(stderr, "\r%*s\r", ffd_terminal_width() - 1, "");
    progress->drawn = false;
}

/* Writes a duration, such as "3:07" or "2:15:09". */
static void format_time(double seconds, char *text, size_t capacity)
{
    const uint64_t whole = (uint64_t)(seconds + 0.5), hours = whole / 3600;
    if (hours)
        snprintf(text, capacity, "%" PRIu64 ":%02d:%02d", hours, (int)(whole / 60 % 60), (int)(whole % 60));
    else
        snprintf(text, capacity, "%d:%02d", (int)(whole / 60), (int)(whole % 60));
}

/* Writes the state, such as "1234 jobs, 3 failed, 812/s, 0:07 left". */
static void describe(const batch_progress *progress, const ffd_batch_result *counts, double fraction,
                     char *text, size_t capacity)
{
    const uint64_t jobs = counts->done + counts->skipped + counts->failed;
    const double seconds = ffd_clock_seconds() - progress->begin;
    char left[48] = "";
    if (fraction > 0 && fraction < 1 && jobs > 0) {
        char time[32];
        format_time(seconds * (1 - fraction) / fraction, time, sizeof time);
        snprintf(left, sizeof left, ", %s left", time);
    }
    snprintf(text, capacity, "%" PRIu64 " %s, %" PRIu64 " failed, %.*f/s%s", jobs,
             progress->draws ? ffd_plural(jobs, "picture", "pictures") : ffd_plural(jobs, "job", "jobs"),
             counts->failed, seconds > 0 && (double)jobs / seconds < 10 ? 1 : 0,
             seconds > 0 ? (double)jobs / seconds : 0.0, left);
}

static void draw_bar(batch_progress *progress, const char *text, double fraction)
{
    char line[200], bar[BAR_WIDTH + 1];
    const int filled = fraction > 0 ? (int)(fraction * BAR_WIDTH) : 0, width = ffd_terminal_width();
    for (int i = 0; i < BAR_WIDTH; i++)
        bar[i] = i < filled ? '#' : '.';
    bar[BAR_WIDTH] = 0;
    if (fraction >= 0)
        snprintf(line, sizeof line, "[%s] %s", bar, text);
    else
        snprintf(line, sizeof line, "%s", text);
    clear_bar(progress);
    fprintf(stderr, "%.*s", width - 1, line);
    progress->drawn = true;
}

bool ffd_progress_show(batch_progress *progress, const ffd_batch_result *counts, double fraction)
{
    const ffd_batch_desc *const desc = progress->desc;
    const double now = ffd_clock_seconds();
    char text[160];
    if (!desc->is_program)
        return !(desc->cancel && ffd_flag_is_set(desc->cancel)) &&
               (!desc->progress || desc->progress(desc->progress_user, fraction));
    if (desc->quiet || now - progress->last < (progress->bar ? BAR_SECONDS : LINE_SECONDS))
        return true;
    progress->last = now;
    describe(progress, counts, fraction, text, sizeof text);
    if (progress->bar)
        draw_bar(progress, text, fraction);
    else
        fprintf(stderr, "ffd: %s\n", text);
    return true;
}

void ffd_progress_print(batch_progress *progress, const char *lines)
{
    const ffd_batch_desc *const desc = progress->desc;
    for (const char *end; (end = strchr(lines, '\n')); lines = end + 1) {
        const int length = (int)(end - lines);
        if (desc->is_program) {
            clear_bar(progress);
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
    clear_bar(progress);
    if (!progress->desc->is_program || progress->desc->quiet)
        return;
    const uint64_t jobs = counts->done + counts->skipped + counts->failed;
    const double seconds = ffd_clock_seconds() - progress->begin;
    format_time(seconds, time, sizeof time);
    if (seconds < 60)
        snprintf(time, sizeof time, "%.1f s", seconds);
    fprintf(stderr,
            "ffd: %" PRIu64 " %s in %s: %" PRIu64 " %s, %" PRIu64 " up to date, %" PRIu64 " failed%s\n", jobs,
            ffd_plural(jobs, "job", "jobs"), time, counts->done, done, counts->skipped, counts->failed,
            remark);
}
