/* three.h - options of three values, one for each direction. */
#ifndef FFD_CLI_THREE_H
#define FFD_CLI_THREE_H

#include "cli/options.h"
#include <ffd/lattice.h>

/* Capacity of a part. */
#define CLI_PART 32

/* Splits "4,4,4" into three texts; "4" stands for three. Returns false if there are not three. */
bool cli_split_three(const char *value, char part[3][CLI_PART]);
/* Parses the whole text as a whole number without sign. */
bool cli_parse_count(const char *text, long least, long greatest, long *count);

/* The words for knots. */
extern const char *const cli_knots_names[];
/* Reads three of them. Returns false after a complaint. */
bool cli_read_knots(ffd_knots knots[3], const cli_option *option, const char *value);
/* Reads margins from 0 on. *are_three: not one for all. Returns false after a complaint. */
bool cli_read_margin(double margin[3], const cli_option *option, const char *value, bool *are_three);

/* Setters: */

/* size_t[3]: numbers of control points. */
bool cli_set_sizes(void *settings, const cli_option *option, const char *value);
/* int[3]: degrees. */
bool cli_set_degrees(void *settings, const cli_option *option, const char *value);

#endif
