/* compare.c - ffd compare: are two files the same mesh? */
#include "cli/command.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct settings {
    double tolerance;
    ffd_format input_format;
    uint64_t memory;
    bool help;
    cli_talk talk;
} settings;

static bool set_tolerance(void *context, const cli_option *option, const char *value)
{
    settings *s = context;
    if (cli_parse_number(value, &s->tolerance) && s->tolerance >= 0)
        return true;
    cli_complain("--%s: \"%s\" is not a number from 0 on", option->name, value);
    return false;
}

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"tolerance", 0, "T", "positions may differ by this much in a coordinate; default 0", set_tolerance, 0,
     NULL},
    {"memory", 0, "SIZE", CLI_MEMORY, cli_set_bytes, AT(memory), NULL},
    {"input-format", 0, "FORMAT", CLI_FORMATS "; of - where one of them is, else of both", cli_set_format,
     AT(input_format), NULL},
    {"quiet", 'q', NULL, "only errors and the exit code", cli_set_flag, AT(talk.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(talk.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

/* file's format, where other is what it is compared with. */
static ffd_source source(const settings *s, const char *file, const char *other)
{
    const bool other_only = strcmp(other, "-") == 0 && strcmp(file, "-") != 0;
    const ffd_format format = other_only ? FFD_FORMAT_AUTO : s->input_format;
    return (ffd_source){.path = file, .format = format, .memory = s->memory};
}

static int compare(const settings *s, const char *a, const char *b)
{
    const ffd_source first = source(s, a, b), second = source(s, b, a);
    if (!cli_knows_format(a, first.format) || !cli_knows_format(b, second.format))
        return EXIT_USAGE;
    ffd_comparison comparison;
    ffd_error error;
    if (ffd_compare_run(&first, &second, s->tolerance, &comparison, &error))
        return cli_fail(&error);
    if (s->talk.verbose && !s->talk.quiet)
        cli_complain("%llu positions compared, largest difference of a coordinate %g",
                     (unsigned long long)comparison.positions_compared, comparison.position_difference_max);
    if (!s->talk.quiet && !comparison.equal)
        printf("%s and %s differ: %s\n", cli_shown(a), cli_shown(b), comparison.difference);
    return comparison.equal ? EXIT_DONE : EXIT_NO;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    cli_words words;
    int code = EXIT_USAGE;
    if (!cli_begin(command, &s, &s.help, count, arguments, &words, &code))
        return code;
    if (words.count != 2)
        code = cli_usage(command, "needs A and B");
    else if (strcmp(words.words[0], "-") == 0 && strcmp(words.words[1], "-") == 0)
        code = cli_usage(command, "standard input can be read only once");
    else
        code = compare(&s, words.words[0], words.words[1]);
    free(words.words);
    return code;
}

static const cli_example examples[] = {
    {"the same, to the bit?", "ffd compare old.obj new.obj"},
    {"the same to a millionth of a unit?", "ffd compare old.obj new.obj --tolerance 1e-6"},
    {NULL, NULL},
};

const cli_command cli_compare = {"compare",
                                 "are two files the same mesh?",
                                 "usage: ffd compare A B [--tolerance T] [options]\n"
                                 "       exit 0: the same, 1: not\n",
                                 {.first = options},
                                 run,
                                 "MESH",
                                 examples};
