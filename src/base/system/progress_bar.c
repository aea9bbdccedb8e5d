#include "base/system/progress_bar.h"
#include "base/memory/memory.h"
#include "base/system/clock.h"
#include "base/system/terminal.h"
#include <ffd/program.h>
#include <inttypes.h>
#include <stdio.h>

/* Seconds between updates of the bar; between lines. */
#define BAR_SECONDS 0.1
#define LINE_SECONDS 10.0

enum { BAR_WIDTH = 30 };

void ffd_progress_bar_begin(progress_bar *bar, bool is_terminal)
{
    const double now = ffd_clock_seconds();
    *bar = (progress_bar){.is_terminal = is_terminal, .begin = now, .last = now};
}

bool ffd_progress_bar_is_due(progress_bar *bar)
{
    const double now = ffd_clock_seconds();
    if (now - bar->last < (bar->is_terminal ? BAR_SECONDS : LINE_SECONDS))
        return false;
    bar->last = now;
    return true;
}

static void draw(progress_bar *bar, const char *text, double fraction)
{
    char line[200], drawn[BAR_WIDTH + 1];
    const int filled = fraction > 0 ? (int)(fraction * BAR_WIDTH) : 0, width = ffd_terminal_width();
    for (int i = 0; i < BAR_WIDTH; i++)
        drawn[i] = i < filled ? '#' : '.';
    drawn[BAR_WIDTH] = 0;
    if (fraction >= 0)
        snprintf(line, sizeof line, "[%s] %s", drawn, text);
    else
        snprintf(line, sizeof line, "%s", text);
    ffd_progress_bar_clear(bar);
    fprintf(stderr, "%.*s", width - 1, line);
    bar->is_drawn = true;
}

void ffd_progress_bar_show(progress_bar *bar, const char *text, double fraction)
{
    if (bar->is_terminal)
        draw(bar, text, fraction);
    else
        fprintf(stderr, "ffd: %s\n", text);
}

void ffd_progress_bar_clear(progress_bar *bar)
{
    if (bar->is_drawn)
        fprintf(stderr, "\r%*s\r", ffd_terminal_width() - 1, "");
    bar->is_drawn = false;
}

void ffd_progress_time(double seconds, char *text, size_t capacity)
{
    const uint64_t whole = (uint64_t)(seconds + 0.5), hours = whole / 3600;
    if (hours)
        snprintf(text, capacity, "%" PRIu64 ":%02d:%02d", hours, (int)(whole / 60 % 60), (int)(whole % 60));
    else
        snprintf(text, capacity, "%d:%02d", (int)(whole / 60), (int)(whole % 60));
}

void ffd_progress_left(const progress_bar *bar, double fraction, char *text, size_t capacity)
{
    char time[32];
    *text = 0;
    if (!(fraction > 0 && fraction < 1))
        return;
    ffd_progress_time((ffd_clock_seconds() - bar->begin) * (1 - fraction) / fraction, time, sizeof time);
    snprintf(text, capacity, ", %s left", time);
}

struct ffd_bar {
    const char *what;
    progress_bar bar;
};

ffd_bar *ffd_bar_create(const char *what)
{
    ffd_bar *const made = ffd_alloc(1, sizeof *made);
    if (!made)
        return NULL;
    made->what = what;
    ffd_progress_bar_begin(&made->bar, ffd_terminal_is_error());
    return made;
}

bool ffd_bar_show(void *bar, double done)
{
    ffd_bar *const shown = bar;
    char text[160], left[48];
    if (!shown || !ffd_progress_bar_is_due(&shown->bar))
        return true;
    ffd_progress_left(&shown->bar, done, left, sizeof left);
    snprintf(text, sizeof text, "%.100s: %d %%%s", shown->what, (int)(100 * done), left);
    ffd_progress_bar_show(&shown->bar, text, done);
    return true;
}

void ffd_bar_clear(ffd_bar *bar)
{
    if (bar)
        ffd_progress_bar_clear(&bar->bar);
}

void ffd_bar_destroy(ffd_bar **bar)
{
    if (!bar)
        return;
    ffd_bar_clear(*bar);
    ffd_free(*bar);
    *bar = NULL;
}
