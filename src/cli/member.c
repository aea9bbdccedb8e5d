#include "cli/member.h"
#include <ffd/settings.h>
#include <stdio.h>
#include <string.h>

/* What is spelled otherwise than an option of its name. */
static const char *const others[][2] = {
    {"by", "--wrt"},          {"deformed", "OUT-MESH"}, {"workers", "-j"},
    {"lattice", "-l"},        {"lattices", "-l"},       {"output", "OUT"},
    {"manifest", "MANIFEST"}, {"quality", "--report"},  {"principal", "--axes principal"},
    {"meshes", "--mesh"},     {"before", "BEFORE"},     {"after", "AFTER"},
};

/* The name of a member without that of its struct. */
static const char *last_name(const char *member)
{
    const char *const dot = strrchr(member, '.');
    return dot ? dot + 1 : member;
}

/* Makes "--in-place" of "in_place", which may be a member of any description. */
static void make_option(const char *name, char *option, size_t capacity)
{
    const ffd_member *member;
    size_t index = 0;
    while ((member = ffd_deform_member(index)) != NULL &&
           !(member->option && strcmp(last_name(member->name), name) == 0))
        index++;
    snprintf(option, capacity, "--%s", member ? member->option : name);
    for (char *c = option; *c; c++)
        *c = *c == '_' ? '-' : *c;
}

void cli_spell(const char *member, const char *value, char *text, size_t capacity)
{
    const char *const name = last_name(member), *option = NULL;
    char made[64];
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        if (strcmp(others[i][0], name) == 0)
            option = others[i][1];
    if (!option)
        make_option(name, made, sizeof made);
    snprintf(text, capacity, "%s%s%s", option ? option : made, value ? " " : "", value ? value : "");
}

bool cli_set_member(void *settings, const cli_option *option, const char *value)
{
    return cli_read(ffd_deform_member_of(option->name), (char *)settings + option->offset, option, value);
}
