/* names.h - repeatable options whose values are names or selectors. */
#ifndef FFD_CLI_NAMES_H
#define FFD_CLI_NAMES_H

#include "cli/options.h"

/* All zeros: none. */
typedef struct cli_names {
    const char **names; /* count entries, borrowed from the command line */
    size_t count;
} cli_names;

/* A setter: adds a name, which must not be empty, to the cli_names at the option's offset. */
bool cli_add_name(void *settings, const cli_option *option, const char *value);
/* Likewise adds a selector for --only. */
bool cli_add_selector(void *settings, const cli_option *option, const char *value);
/* Frees the list; leaves all zeros. */
void cli_names_free(cli_names *names);

#endif
