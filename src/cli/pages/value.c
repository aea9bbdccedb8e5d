#include "cli/pages/value.h"
#include "cli/member.h"
#include <ctype.h>
#include <ffd/job.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Names for kinds of files, with their endings, as "a, b or c", and the name of those without one. */
static const struct {
    const char *name, *endings, *whole;
} kinds[] = {
    {"MESH", FFD_FORMAT_NAMES, "points"}, {"LATTICE", "json", NULL}, {"REPORT", "json", NULL},
    {"MANIFEST", "jsonl", NULL},          {"TABLE", "csv", NULL},
};
/* The format of files without an ending. */
static const char whole_format[] = "foam";
enum { KINDS = sizeof kinds / sizeof *kinds };

static void append(char text[200], const char *separator, const char *more, size_t length)
{
    const size_t before = strlen(text);
    const int needed =
        snprintf(text + before, 200 - before, "%s%.*s", before ? separator : "", (int)length, more);
    if (before + (size_t)needed >= 200) {
        fprintf(stderr, "ffd-pages: no space for \"%s\"\n", more);
        exit(1);
    }
}

static bool is(const char *part, size_t length, const char *name)
{
    return strlen(name) == length && memcmp(part, name, length) == 0;
}

/* Appends each word of "a, b or c" but this one. */
static void append_list(char text[200], const char *separator, const char *list, const char *without)
{
    while (*list) {
        const size_t length = strcspn(list, ", ");
        if (length > 0 && !is(list, length, "or") && !is(list, length, without))
            append(text, separator, list, length);
        list += length > 0 ? length : 1;
    }
}

static bool is_word(const char *part, size_t length)
{
    for (size_t i = 0; i < length; i++)
        if (!islower((unsigned char)part[i]) && !isdigit((unsigned char)part[i]))
            return false;
    return length > 0;
}

/* Takes one of the parts that | separates. */
static void take(pages_value *value, const char *part, size_t length)
{
    static const char file[] = "FILE";
    if (is(part, length, "FORMAT"))
        append_list(value->words, " ", FFD_FORMAT_NAMES, "");
    else if (is_word(part, length))
        append(value->words, " ", part, length);
    else if (is(part, length, "DIR"))
        value->folders = true;
    else if (length >= 4 && memcmp(part, file, 4) == 0 && (length == 4 || part[4] == '.')) {
        value->files = true;
        if (length > 5)
            append(value->endings, "|", part + 5, length - 5);
    }
    for (int i = 0; i < KINDS; i++)
        if (is(part, length, kinds[i].name)) {
            value->files = true;
            append_list(value->endings, "|", kinds[i].endings, whole_format);
            value->whole = kinds[i].whole ? kinds[i].whole : value->whole;
        }
}

static pages_value parse(const char *text)
{
    pages_value value = {.words = ""};
    while (text && *text) {
        const size_t length = strcspn(text, "|");
        take(&value, text, length);
        text += length + (text[length] == '|');
    }
    return value;
}

pages_value pages_option_value(const cli_option *option)
{
    pages_value value = parse(option->value);
    const ffd_member *const member =
        option->set == cli_set_member ? ffd_deform_member_of(option->name) : NULL;
    const char *const *const words =
        member && member->kind == FFD_MEMBER_GATES ? member->words : option->choices;
    if (!words || option->set == cli_set_choice)
        return value;
    value.list = true;
    for (int i = 0; words[i]; i++)
        append(value.words, " ", words[i], strlen(words[i]));
    return value;
}

pages_value pages_command_arguments(const cli_command *command)
{
    return parse(command->arguments);
}
