/* terminal.h - whether standard error is a terminal, and how wide. */
#ifndef FFD_BASE_SYSTEM_TERMINAL_H
#define FFD_BASE_SYSTEM_TERMINAL_H

#include <stdbool.h>

/* Whether standard error is a terminal on which a line can be drawn again. */
bool ffd_terminal_is_error(void);
/* Its columns, 80 where they are not known. */
int ffd_terminal_width(void);

#endif
