#include "cli/values.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static bool is_set(const cli_values *values, const char *name, size_t length)
{
    for (size_t i = 0; i < values->count; i++)
        if (strlen(values->set[i].name) == length && memcmp(values->set[i].name, name, length) == 0)
            return true;
    return false;
}

/* Parses NAME=VALUE. */
bool cli_add_value(void *settings, const cli_option *option, const char *value)
{
    cli_values *const values = (cli_values *)(void *)((char *)settings + option->offset);
    const char *const equals = strchr(value, '=');
    if (!equals || equals == value) {
        cli_complain("--%s: \"%s\" is not NAME=VALUE", option->name, value);
        return false;
    }
    const size_t length = (size_t)(equals - value);
    if (is_set(values, value, length)) {
        cli_complain("--%s: \"%.*s\" is set twice", option->name, (int)length, value);
        return false;
    }
    char *const name = malloc(length + 1);
    ffd_setting *const grown = realloc(values->set, (values->count + 1) * sizeof *grown);
    values->set = grown ? grown : values->set;
    if (!name || !grown) {
        free(name);
        cli_complain("out of memory");
        return false;
    }
    memcpy(name, value, length);
    name[length] = 0;
    grown[values->count++] = (ffd_setting){name, equals + 1};
    return true;
}

void cli_values_free(cli_values *values)
{
    for (size_t i = 0; i < values->count; i++)
        free((char *)(uintptr_t)values->set[i].name);
    free(values->set);
    *values = (cli_values){0};
}
