/* terminal.h - whether standard error is a terminal, and how wide. */
#ifndef FFD_BASE_SYSTEM_TERMINAL_H
#define FFD_BASE_SYSTEM_TERMINAL_H

#include <stdbool.h>

/* Returns whether standard error is a terminal on which a line can be redrawn. */
bool ffd_terminal_is_error(void);
/* Returns its number of columns; 80 if unknown. */
int ffd_terminal_width(void);

#endif
