#include "cli/options.h"
#include "base/one_line.h"
#include "base/text/size.h"
#include "base/text/words.h"
#include "io/format_names.h"
#include <errno.h>
#include <ffd/ffd.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Buffer for complaints instead of standard error; or NULL. */
static char *captured;
static size_t captured_capacity;

void cli_capture(char *text, size_t capacity)
{
    captured = text;
    captured_capacity = capacity;
}

void cli_complain(const char *format, ...)
{
    char line[2048];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    /* Control characters from the command line are replaced, so that it stays one line. */
    ffd_make_one_line(line, strlen(line));
    if (captured)
        snprintf(captured, captured_capacity, "%s", line);
    else
        fprintf(stderr, "ffd: %s\n", line);
}

static void *field(void *settings, const cli_option *option)
{
    return (char *)settings + option->offset;
}

bool cli_set_flag(void *settings, const cli_option *option, const char *value)
{
    (void)value;
    *(bool *)field(settings, option) = true;
    return true;
}

bool cli_set_text(void *settings, const cli_option *option, const char *value)
{
    const char **text = field(settings, option);
    if (!*value) {
        cli_complain("--%s: the value is empty", option->name);
        return false;
    }
    if (*text) {
        cli_complain("--%s is given twice: \"%s\" and \"%s\"", option->name, *text, value);
        return false;
    }
    *text = value;
    return true;
}

bool cli_set_positive(void *settings, const cli_option *option, const char *value)
{
    double number;
    if (!cli_parse_number(value, &number) || !(number > 0)) {
        cli_complain("--%s: \"%s\" is not a number above 0", option->name, value);
        return false;
    }
    *(double *)field(settings, option) = number;
    return true;
}

bool cli_set_distance(void *settings, const cli_option *option, const char *value)
{
    cli_distance *const distance = field(settings, option);
    char number[512];
    const size_t length = strlen(value);
    const bool is_relative = length > 0 && value[length - 1] == 'r';
    if (length - is_relative < sizeof number) {
        memcpy(number, value, length - is_relative);
        number[length - is_relative] = 0;
        distance->is_relative = is_relative;
        if (cli_parse_number(number, &distance->value) && distance->value >= 0)
            return true;
    }
    cli_complain("--%s: \"%s\" is not a number of at least 0, alone or followed by r", option->name, value);
    return false;
}

bool cli_set_count(void *settings, const cli_option *option, const char *value)
{
    char *end;
    errno = 0;
    const long count = strtol(value, &end, 10);
    if (*value < '0' || *value > '9' || *end || errno || count < 1 || count > 1024) {
        cli_complain("--%s: \"%s\" is not a whole number from 1 to 1024", option->name, value);
        return false;
    }
    *(int *)field(settings, option) = (int)count;
    return true;
}

bool cli_set_bytes(void *settings, const cli_option *option, const char *value)
{
    if (ffd_size_parse(value, field(settings, option)))
        return true;
    cli_complain("--%s: \"%s\" is not a size in bytes, as 700M or 4G", option->name, value);
    return false;
}

void cli_hint_choice(const cli_option *option, const char *value, char hint[CLI_HINT])
{
    size_t count = 0;
    while (option->choices[count])
        count++;
    const char *const meant = ffd_word_meant(value, option->choices, count);
    snprintf(hint, CLI_HINT, "%s%s%s", meant ? " (nearest: " : "", meant ? meant : "", meant ? ")" : "");
}

bool cli_set_choice(void *settings, const cli_option *option, const char *value)
{
    char known[200] = "";
    for (int i = 0; option->choices[i]; i++) {
        if (strcmp(option->choices[i], value) == 0) {
            *(int *)field(settings, option) = i;
            return true;
        }
        const size_t length = strlen(known);
        snprintf(known + length, sizeof known - length, "%s%s", i ? ", " : "", option->choices[i]);
    }
    char hint[CLI_HINT];
    cli_hint_choice(option, value, hint);
    cli_complain("--%s: \"%s\" is not one of %s%s", option->name, value, known, hint);
    return false;
}

bool cli_set_format(void *settings, const cli_option *option, const char *value)
{
    char name[32];
    snprintf(name, sizeof name, "x.%s", value[0] == '.' ? value + 1 : value);
    const ffd_format format = strlen(value) < 16 ? ffd_format_from_name(name) : FFD_FORMAT_AUTO;
    if (format == FFD_FORMAT_AUTO) {
        cli_complain("--%s: \"%s\" is not one of " FORMAT_NAMES, option->name, value);
        return false;
    }
    *(ffd_format *)field(settings, option) = format;
    return true;
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

static bool unknown_option(const cli_table *options, const char *name, size_t length)
{
    nearest_word nearest = {.word = name, .length = length};
    cli_option_walk walk = cli_begin_walk(options);
    for (const cli_option *option; (option = cli_next_option(&walk));)
        ffd_nearest_offer(&nearest, option->name);
    const char *const meant = ffd_nearest_meant(&nearest);
    cli_complain("unknown option --%.*s (%s%s)", (int)(length < 60 ? length : 60), name,
                 meant ? "nearest: --" : "--help lists the known ones", meant ? meant : "");
    return false;
}

/* Complains; suggests the option whose name begins with the letter. */
static bool unknown_letter(const cli_table *options, char letter)
{
    cli_option_walk walk = cli_begin_walk(options);
    for (const cli_option *option; (option = cli_next_option(&walk));)
        if (option->name[0] == letter) {
            cli_complain("unknown option -%c (nearest: --%s)", letter, option->name);
            return false;
        }
    cli_complain("unknown option -%c (--help lists the known ones)", letter);
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

static bool set(const cli_table *options, void *settings, const cli_option *option, const char *value)
{
    return option->set(settings, option, value) && (!options->note || options->note(settings, option, value));
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
        cli_complain(captured ? "--%s takes no value: true or false is wanted" : "--%s takes no value",
                     option->name);
        return false;
    }
    if (option->value && !value) {
        if (*next == end) {
            cli_complain("--%s needs a value (%s)", option->name, option->value);
            return false;
        }
        value = *(*next)++;
    }
    return set(options, settings, option, value);
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
            if (!set(options, settings, option, NULL))
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
        return set(options, settings, option, value);
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
