/* three.h - options of three values, one for each direction. */
#ifndef FFD_CLI_THREE_H
#define FFD_CLI_THREE_H

#include <stdbool.h>

/* Capacity of a part. */
#define CLI_PART 32

/* Splits "4,4,4" into three texts; "4" stands for three. Returns false if there are not three. */
bool cli_split_three(const char *value, char part[3][CLI_PART]);
/* Parses the whole text as a whole number without sign. */
bool cli_parse_count(const char *text, long least, long greatest, long *count);

#endif
