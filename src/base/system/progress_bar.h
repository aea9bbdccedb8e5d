/* progress_bar.h - how far a program has come, on standard error: a bar that is redrawn on a terminal, else a
   line from time to time. */
#ifndef FFD_BASE_SYSTEM_PROGRESS_BAR_H
#define FFD_BASE_SYSTEM_PROGRESS_BAR_H

#include <stdbool.h>
#include <stddef.h>

typedef struct progress_bar {
    bool is_terminal, is_drawn;
    double begin, last; /* seconds: of the start, and of the last update */
} progress_bar;

/* Starts the clock. */
void ffd_progress_bar_begin(progress_bar *bar, bool is_terminal);
/* Returns whether an update is due, and counts it as done. */
bool ffd_progress_bar_is_due(progress_bar *bar);
/* Shows a text. fraction: that is done; negative: unknown. */
void ffd_progress_bar_show(progress_bar *bar, const char *text, double fraction);
/* Removes the bar from the terminal: before anything else is written there. */
void ffd_progress_bar_clear(progress_bar *bar);

/* Writes a duration, such as "3:07" or "2:15:09". */
void ffd_progress_time(double seconds, char *text, size_t capacity);
/* Writes how long the rest will take, such as ", 0:07 left"; nothing if that is not known. */
void ffd_progress_left(const progress_bar *bar, double fraction, char *text, size_t capacity);

#endif
