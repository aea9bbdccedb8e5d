#include "cli/names.h"
#include "cli/command.h"
#include <stdlib.h>

static bool add(void *settings, const cli_option *option, const char *value)
{
    cli_names *const names = (cli_names *)(void *)((char *)settings + option->offset);
    const char **const grown = realloc(names->names, (names->count + 1) * sizeof *grown);
    if (!grown) {
        cli_complain("out of memory");
        return false;
    }
    names->names = grown;
    grown[names->count++] = value;
    return true;
}

bool cli_add_name(void *settings, const cli_option *option, const char *value)
{
    if (!*value) {
        cli_complain("--%s: the name is empty", option->name);
        return false;
    }
    return add(settings, option, value);
}

bool cli_add_selector(void *settings, const cli_option *option, const char *value)
{
    ffd_error error;
    if (ffd_selector_check(value, &error)) {
        cli_fail(&error);
        return false;
    }
    return add(settings, option, value);
}

void cli_names_free(cli_names *names)
{
    free(names->names);
    *names = (cli_names){0};
}
