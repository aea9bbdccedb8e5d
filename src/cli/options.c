#include "cli/options.h"
#include <ffd/ffd.h>
#include <ffd/program.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void cli_complain(const char *format, ...)
{
    char line[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    /* Control characters from the command line are replaced, so that it stays one line. */
    ffd_make_one_line(line, strlen(line));
    fprintf(stderr, "ffd: %s\n", line);
}

bool cli_set_flag(void *settings, const cli_option *option, const char *value)
{
    (void)value;
    *(bool *)((char *)settings + option->offset) = true;
    return true;
}

bool cli_read(const ffd_member *member, void *base, const cli_option *option, const char *value)
{
    char name[64];
    ffd_member own = *member;
    ffd_error error;
    snprintf(name, sizeof name, "--%s", option->name);
    own.name = name;
    if (!ffd_member_read(&own, base, value, &error))
        return true;
    char line[2048];
    ffd_error_format(&error, line, sizeof line);
    cli_complain("%s", line);
    return false;
}

/* Sets a field of the command's own. */
static bool read_own(ffd_member_kind kind, void *settings, const cli_option *option, const char *value)
{
    const ffd_member member = {.kind = kind,
                               .offset = option->offset,
                               .second = option->offset + offsetof(cli_distance, is_relative),
                               .words = option->choices};
    return cli_read(&member, settings, option, value);
}

bool cli_set_text(void *settings, const cli_option *option, const char *value)
{
    return read_own(FFD_MEMBER_TEXT, settings, option, value);
}

bool cli_set_positive(void *settings, const cli_option *option, const char *value)
{
    return read_own(FFD_MEMBER_LENGTH, settings, option, value);
}

bool cli_set_distance(void *settings, const cli_option *option, const char *value)
{
    return read_own(FFD_MEMBER_DISTANCE, settings, option, value);
}

bool cli_set_count(void *settings, const cli_option *option, const char *value)
{
    return read_own(FFD_MEMBER_COUNT, settings, option, value);
}

bool cli_set_choice(void *settings, const cli_option *option, const char *value)
{
    return read_own(FFD_MEMBER_CHOICE, settings, option, value);
}

void cli_hint_choice(const cli_option *option, const char *value, char hint[CLI_HINT])
{
    size_t count = 0;
    while (option->choices[count])
        count++;
    const char *const meant = ffd_word_meant(value, option->choices, count);
    snprintf(hint, CLI_HINT, "%s%s%s", meant ? " (nearest: " : "", meant ? meant : "", meant ? ")" : "");
}

bool cli_parse_number(const char *text, double *value)
{
    /* Excludes what strtod also accepts: spaces, hexadecimal numbers, infinities, a locale's comma. */
    if (!*text || strspn(text, "+-.0123456789eE") != strlen(text))
        return false;
    char *end;
    *value = strtod(text, &end);
    return *end == 0 && isfinite(*value);
}

cli_option_walk cli_begin_walk(const cli_table *options)
{
    return (cli_option_walk){options, options->first, 0};
}

static const cli_option *by_name(const cli_table *options, const char *name, size_t length)
{
    const cli_option *const parts[] = {options->first, options->more, options->base};
    for (int i = 0; i < 3; i++)
        for (const cli_option *option = parts[i]; option && option->name; option++)
            if (strlen(option->name) == length && memcmp(option->name, name, length) == 0)
                return option;
    return NULL;
}

const cli_option *cli_next_option(cli_option_walk *walk)
{
    const cli_option *const parts[] = {walk->options->more, walk->options->base};
    for (;;) {
        if (walk->at && walk->at->name) {
            const cli_option *const option = walk->at++;
            if (by_name(walk->options, option->name, strlen(option->name)) == option)
                return option;
        } else if (walk->part < 2) {
            walk->at = parts[walk->part++];
        } else {
            return NULL;
        }
    }
}

/* The most options of a command that are compared with an unknown one. */
#define MOST_OPTIONS 128

/* Words of who looks for an option that is called otherwise: parts of the mesh, and moves. */
static const char *hint_of(const char *word, const char *const *known, size_t count)
{
    static const struct hint {
        const char *word, *option, *text;
    } hints[] = {{"node", "only", "--only node:NAME"},
                 {"mesh", "only", "--only mesh:NAME"},
                 {"material", "only", "--only material:NAME"},
                 {"group", "only", "--only group:NAME"},
                 {"object", "only", "--only object:NAME"},
                 {"select", "only", "--only KIND:NAME"},
                 {"translate", "lattice", "moves are in the lattice file: \"by\""},
                 {"scale", "lattice", "moves are in the lattice file: \"scale\""},
                 {"rotate", "lattice", "moves are in the lattice file: \"rotate\""},
                 {"twist", "lattice", "moves are in the lattice file: \"twist\""},
                 {"bend", "lattice", "moves are in the lattice file: \"bend\""},
                 {"taper", "lattice", "moves are in the lattice file: \"taper\""},
                 {"mirror", "lattice", "moves are in the lattice file: \"mirror\""}};
    for (size_t i = 0; i < sizeof hints / sizeof *hints; i++)
        if (strcmp(word, hints[i].word) == 0)
            for (size_t k = 0; k < count; k++)
                if (strcmp(known[k], hints[i].option) == 0)
                    return hints[i].text;
    return NULL;
}

static bool unknown_option(const cli_table *options, const char *name, size_t length)
{
    const char *known[MOST_OPTIONS];
    char word[64];
    size_t count = 0;
    cli_option_walk walk = cli_begin_walk(options);
    for (const cli_option *option; count < MOST_OPTIONS && (option = cli_next_option(&walk));)
        known[count++] = option->name;
    snprintf(word, sizeof word, "%.*s", (int)(length < sizeof word ? length : sizeof word - 1), name);
    const char *const hint = hint_of(word, known, count);
    if (hint) {
        cli_complain("unknown option --%s (%s)", word, hint);
        return false;
    }
    const char *const meant = ffd_word_meant(word, known, count);
    cli_complain("unknown option --%.*s (%s%s)", (int)(length < 60 ? length : 60), name,
                 meant ? "nearest: --" : "--help lists the known ones", meant ? meant : "");
    return false;
}

/* Complains; suggests the only option whose name begins with the letter. */
static bool unknown_letter(const cli_table *options, char letter)
{
    cli_option_walk walk = cli_begin_walk(options);
    const char *found = NULL;
    size_t count = 0;
    if (letter == 'o' && options->output) {
        cli_complain("unknown option -o: %s", options->output);
        return false;
    }
    for (const cli_option *option; (option = cli_next_option(&walk));)
        if (option->name[0] == letter) {
            found = option->name;
            count++;
        }
    cli_complain("unknown option -%c (%s%s)", letter,
                 count == 1 ? "nearest: --" : "--help lists the known ones", count == 1 ? found : "");
    return false;
}

static const cli_option *by_letter(const cli_table *options, char letter)
{
    cli_option_walk walk = cli_begin_walk(options);
    for (const cli_option *option; (option = cli_next_option(&walk));)
        if (option->letter == letter)
            return option;
    return NULL;
}

/* Parses --name, --name=value or --name value. *next: the following argument. */
static bool parse_long(const cli_table *options, void *settings, const char *text, char ***next, char **end)
{
    const char *equals = strchr(text, '=');
    const size_t length = equals ? (size_t)(equals - text) : strlen(text);
    const cli_option *option = by_name(options, text, length);
    if (!option)
        return unknown_option(options, text, length);
    const char *value = equals ? equals + 1 : NULL;
    if (!option->value && value) {
        cli_complain("--%s takes no value", option->name);
        return false;
    }
    if (option->value && !value) {
        if (*next == end) {
            cli_complain("--%s needs a value (%s)", option->name, option->value);
            return false;
        }
        value = *(*next)++;
    }
    return option->set(settings, option, value);
}

/* Parses -q, -lFILE or -l FILE. Letters without values may be combined. */
static bool parse_letters(const cli_table *options, void *settings, const char *text, char ***next,
                          char **end)
{
    for (; *text; text++) {
        const cli_option *option = by_letter(options, *text);
        if (!option)
            return unknown_letter(options, *text);
        if (!option->value) {
            if (!option->set(settings, option, NULL))
                return false;
            continue;
        }
        const char *value = text[1] ? text + 1 : NULL;
        if (!value) {
            if (*next == end) {
                cli_complain("-%c needs a value (%s)", *text, option->value);
                return false;
            }
            value = *(*next)++;
        }
        return option->set(settings, option, value);
    }
    return true;
}

bool cli_parse(const cli_table *options, void *settings, const bool *help, int count, char **arguments,
               cli_words *words)
{
    char **next = arguments, **end = arguments + count;
    bool only_words = false;
    words->count = 0;
    while (next < end && !*help) {
        const char *argument = *next++;
        if (only_words || argument[0] != '-' || !argument[1])
            words->words[words->count++] = argument;
        else if (strcmp(argument, "--") == 0)
            only_words = true;
        else if (argument[1] == '-' ? !parse_long(options, settings, argument + 2, &next, end)
                                    : !parse_letters(options, settings, argument + 1, &next, end))
            return false;
    }
    return true;
}

void cli_print_options(const cli_table *options)
{
    cli_option_walk walk = cli_begin_walk(options);
    for (const cli_option *option; (option = cli_next_option(&walk));) {
        char left[64], letter[8] = "    ";
        if (option->letter && by_letter(options, option->letter) == option)
            snprintf(letter, sizeof letter, "-%c, ", option->letter);
        snprintf(left, sizeof left, "%s--%s%s%s", letter, option->name, option->value ? " " : "",
                 option->value ? option->value : "");
        printf("  %-32s  %s\n", left, option->help);
    }
}
