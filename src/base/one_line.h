/* one_line.h - texts that become one line of a message, whatever names are in them. */
#ifndef FFD_BASE_ONE_LINE_H
#define FFD_BASE_ONE_LINE_H

#include <stddef.h>

/* Replaces what breaks a line, controls a terminal or turns the direction of a text, each byte by '?':
   control characters (ASCII and U+0080 to U+009F), U+2028 to U+202E and U+2066 to U+2069. All other bytes
   stay. */
void ffd_make_one_line(char *text, size_t size);

#endif
