/* compare.c - ffd compare: are two files the same mesh? */
#include "cli/command.h"
#include <stdio.h>
#include <stdlib.h>

typedef struct settings {
    double tolerance;
    ffd_format input_format;
    bool quiet, help;
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
    {"input-format", 0, "FORMAT", "obj, gltf or glb; needed for -", cli_set_format, AT(input_format), NULL},
    {"quiet", 'q', NULL, "only the exit code", cli_set_flag, AT(quiet), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static int compare(const settings *s, const char *a, const char *b)
{
    const ffd_source first = {a, s->input_format, FFD_SPACE_SCENE},
                     second = {b, s->input_format, FFD_SPACE_SCENE};
    ffd_comparison comparison;
    ffd_error error;
    if (ffd_compare_run(&first, &second, s->tolerance, &comparison, &error))
        return cli_fail(&error);
    if (!s->quiet && !comparison.equal)
        printf("%s and %s differ: %s\n", a, b, comparison.difference);
    return comparison.equal ? EXIT_DONE : EXIT_NO;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    cli_words words;
    int code = EXIT_USAGE;
    if (!cli_begin(command, &s, &s.help, count, arguments, &words, &code))
        return code;
    code =
        words.count == 2 ? compare(&s, words.words[0], words.words[1]) : cli_usage(command, "needs A and B");
    free(words.words);
    return code;
}

const cli_command cli_compare = {"compare", "are two files the same mesh?",
                                 "usage: ffd compare A B [--tolerance T]\n"
                                 "       exit 0: the same, 1: not\n",
                                 options, run};
