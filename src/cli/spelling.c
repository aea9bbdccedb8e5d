#include "cli/spelling.h"
#include <stdio.h>
#include <string.h>

/* Members whose options have other names. */
static const char *const others[][2] = {
    {"allow_extensions", "--allow-extension"},
    {"by", "--wrt"},
    {"clips", "--clip"},
    {"deformed", "OUT-MESH"},
    {"format", "--input-format"},
    {"jobs", "-j"},
    {"lattice", "-l"},
    {"lattices", "-l"},
    {"morphs", "--morph"},
    {"output", "OUT"},
    {"quality", "--report"},
};

/* Makes "--in-place" of "in_place". */
static const char *make_option(const char *name, char *option, size_t capacity)
{
    snprintf(option, capacity, "--%s", name);
    for (char *c = option; *c; c++)
        *c = *c == '_' ? '-' : *c;
    return option;
}

void cli_spell(const char *member, const char *value, char *text, size_t capacity)
{
    const char *const dot = strrchr(member, '.'), *const name = dot ? dot + 1 : member, *option = NULL;
    char made[64];
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (strcmp(others[i][0], name) == 0)
            option = others[i][1];
    snprintf(text, capacity, "%s%s%s", option ? option : make_option(name, made, sizeof made),
             value ? " " : "", value ? value : "");
}
