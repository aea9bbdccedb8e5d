#include "cli/values.h"
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

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
    uint32_t index;
    const bool is_known = ffd_intern(&values->known, value, length, &index);
    if (is_known && index < values->count) {
        cli_complain("--%s: \"%.*s\" is set twice", option->name, (int)length, value);
        return false;
    }
    char *const name = is_known ? malloc(length + 1) : NULL;
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
    ffd_intern_free(&values->known);
    *values = (cli_values){0};
}
