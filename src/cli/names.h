/* names.h - options that are given several times, each with a name or a selector of parts. */
#ifndef FFD_CLI_NAMES_H
#define FFD_CLI_NAMES_H

#include "cli/options.h"

/* All zeros: none. */
typedef struct cli_names {
    const char **names; /* count, lent by the command line */
    size_t count;
} cli_names;

/* A setter: adds a name, which is not empty, to the cli_names at the option's offset. */
bool cli_add_name(void *settings, const cli_option *option, const char *value);
/* Likewise: adds a selector of --only. */
bool cli_add_selector(void *settings, const cli_option *option, const char *value);
/* Leaves none. */
void cli_names_free(cli_names *names);

#endif
