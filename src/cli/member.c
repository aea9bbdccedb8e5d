#include "cli/member.h"
#include <ffd/settings.h>
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

static const ffd_member *find_member(const char *option)
{
    const ffd_member *member;
    char name[64];
    size_t index = 0;
    while ((member = ffd_deform_member(index++)) != NULL) {
        cli_spell(member->name, NULL, name, sizeof name);
        if (strncmp(name, "--", 2) == 0 && strcmp(name + 2, option) == 0)
            break;
    }
    return member;
}

bool cli_set_member(void *settings, const cli_option *option, const char *value)
{
    static const cli_setter setters[] = {
        [FFD_MEMBER_FLAG] = cli_set_flag,       [FFD_MEMBER_CHOICE] = cli_set_choice,
        [FFD_MEMBER_FORMAT] = cli_set_format,   [FFD_MEMBER_COUNT] = cli_set_count,
        [FFD_MEMBER_LENGTH] = cli_set_positive, [FFD_MEMBER_TIME] = cli_set_positive,
        [FFD_MEMBER_BYTES] = cli_set_bytes,     [FFD_MEMBER_TEXT] = cli_set_text,
    };
    const ffd_member *const member = find_member(option->name);
    const cli_option own = {.name = option->name, .offset = member->offset, .choices = member->words};
    return setters[member->kind]((char *)settings + option->offset, &own, value);
}
