/* values.h - values of placeholders on the command line: --set NAME=VALUE, repeatable. */
#ifndef FFD_CLI_VALUES_H
#define FFD_CLI_VALUES_H

#include "base/memory/intern.h"
#include "cli/options.h"
#include <ffd/lattice.h>

/* All zeros: none. */
typedef struct cli_values {
    ffd_setting *set; /* count entries; their names are owned */
    size_t count;
    intern_table known; /* their names */
} cli_values;

/* A setter: adds to the cli_values at the option's offset. */
bool cli_add_value(void *settings, const cli_option *option, const char *value);
/* Frees the settings; leaves all zeros. */
void cli_values_free(cli_values *values);

#endif
