#include "cli/names.h"
#include <stdlib.h>

bool cli_add_name(void *settings, const cli_option *option, const char *value)
{
    cli_names *const names = (cli_names *)(void *)((char *)settings + option->offset);
    if (!*value) {
        cli_complain("--%s: the name is empty", option->name);
        return false;
    }
    const char **const grown = realloc(names->names, (names->count + 1) * sizeof *grown);
    if (!grown) {
        cli_complain("out of memory");
        return false;
    }
    names->names = grown;
    grown[names->count++] = value;
    return true;
}

void cli_names_free(cli_names *names)
{
    free(names->names);
    *names = (cli_names){0};
}
