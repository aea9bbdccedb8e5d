/* compare.c - ffd compare: are two files the same mesh? */
#include "cli/command.h"
#include "cli/member.h"
#include <stdio.h>
#include <string.h>

typedef struct settings {
    cli_distance tolerance;
    double normal_tolerance;
    bool has_normal_tolerance;
    ffd_deform_desc job; /* the options that it shares with ffd deform */
    bool json, recursive, help;
    cli_logging logging;
} settings;

static bool set_normal_tolerance(void *context, const cli_option *option, const char *value)
{
    settings *s = context;
    s->has_normal_tolerance = true;
    if (cli_parse_number(value, &s->normal_tolerance) && s->normal_tolerance >= 0)
        return true;
    cli_complain("--%s: \"%s\" is not a number of at least 0", option->name, value);
    return false;
}

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"tolerance", 0, "T",
     "positions may differ by T in a coordinate, or by T of A's diagonal (1e-6r); default 0",
     cli_set_distance, AT(tolerance), NULL},
    {"normal-tolerance", 0, "T",
     "normals and tangents may differ by T in a component; default 0, or the number of a T with r",
     set_normal_tolerance, 0, NULL},
    {"recursive", 0, NULL, "A and B are folders: compare the meshes of equal names in them and below",
     cli_set_flag, AT(recursive), NULL},
    {"json", 0, NULL, "the result as JSON", cli_set_flag, AT(json), NULL},
    {"memory", 0, "SIZE", CLI_MEMORY, cli_set_member, AT(job), NULL},
    {"strict", 0, NULL, CLI_STRICT, cli_set_member, AT(job), NULL},
    {"input-format", 0, "FORMAT", FFD_FORMAT_NAMES "; of -, else of both", cli_set_member, AT(job), NULL},
    {"quiet", 'q', NULL, "only errors and the exit code (and --json)", cli_set_flag, AT(logging.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(logging.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

/* Describes a file. other: the one that it is compared with, for its format. */
static ffd_source source(const settings *s, const char *file, const char *other)
{
    const bool other_only = strcmp(other, "-") == 0 && strcmp(file, "-") != 0;
    ffd_source source = s->job.input;
    source.path = file;
    source.format = other_only ? FFD_FORMAT_AUTO : source.format;
    return source;
}

/* Prints the counts, such as "3 differences: 2 positions, 1 other". */
static void print_counts(const ffd_comparison *comparison)
{
    static const char *const names[FFD_DIFFERENCE_KIND_COUNT] = {
        " position", " normal", " tangent", " texture coordinate", " in the topology", " other"};
    printf("%s%llu difference%s", comparison->complete ? "" : "at least ",
           (unsigned long long)comparison->differences, comparison->differences == 1 ? "" : "s");
    for (int kind = 0, shown = 0; kind < FFD_DIFFERENCE_KIND_COUNT; kind++) {
        const uint64_t count = comparison->counts[kind];
        const bool plural = count > 1 && kind < FFD_DIFFERENCE_TOPOLOGY;
        if (count)
            printf("%s%llu%s%s", shown++ ? ", " : ": ", (unsigned long long)count, names[kind],
                   plural ? "s" : "");
    }
    printf("\n");
}

static int print_json(const ffd_comparison *comparison, const char *a, const char *b)
{
    ffd_error error;
    char *text;
    if (ffd_comparison_json(comparison, a, b, &text, &error))
        return cli_fail(&error);
    fputs(text, stdout);
    ffd_free(text);
    return comparison->equal ? EXIT_DONE : EXIT_NO;
}

static int print_verdict(const settings *s, const ffd_comparison *comparison, const char *a, const char *b)
{
    if (s->logging.verbose && !s->logging.quiet)
        cli_complain("%llu position%s compared, largest difference of a coordinate %g",
                     (unsigned long long)comparison->positions_compared,
                     comparison->positions_compared == 1 ? "" : "s", comparison->position_difference_max);
    if (s->json)
        return print_json(comparison, a, b);
    if (s->logging.quiet || comparison->equal)
        return comparison->equal ? EXIT_DONE : EXIT_NO;
    printf("%s and %s differ: %s\n", cli_display_name(a), cli_display_name(b), comparison->first.text);
    if (comparison->differences > 1 && comparison->worst.text[0])
        printf("worst: %s\n", comparison->worst.text);
    if (comparison->differences > 1 || !comparison->complete)
        print_counts(comparison);
    return EXIT_NO;
}

static ffd_compare_desc describe(settings *s, const char *a, const char *b)
{
    ffd_compare_desc desc;
    ffd_compare_desc_init(&desc, sizeof desc);
    desc.a = source(s, a, b);
    desc.b = source(s, b, a);
    desc.tolerance = s->tolerance.value;
    desc.relative = s->tolerance.is_relative;
    desc.direction_tolerance = s->has_normal_tolerance    ? s->normal_tolerance
                               : s->tolerance.is_relative ? s->tolerance.value
                                                          : 0;
    desc.log = cli_log;
    desc.log_user = &s->logging;
    return desc;
}

static int compare(settings *s, const char *a, const char *b)
{
    const ffd_compare_desc desc = describe(s, a, b);
    if (!cli_knows_format(a, desc.a.format) || !cli_knows_format(b, desc.b.format))
        return EXIT_USAGE;
    ffd_comparison comparison = {.struct_size = sizeof comparison};
    ffd_error error;
    if (ffd_compare_run(&desc, &comparison, &error))
        return cli_fail(&error);
    return print_verdict(s, &comparison, a, b);
}

/* What a line about a mesh needs. */
typedef struct folders {
    const settings *settings;
    const char *a, *b;
} folders;

/* An ffd_compared_function: prints a line about each mesh that is not the same. */
static ffd_status print_file(void *user, const ffd_compared_file *file)
{
    const folders *const of = user;
    const bool is_quiet = of->settings->logging.quiet;
    if (file->error)
        cli_fail(file->error);
    else if (is_quiet || (file->comparison && file->comparison->equal))
        return FFD_OK;
    else if (!file->comparison)
        printf("only in %s: %s\n", cli_display_name(file->in_a ? of->a : of->b), file->name);
    else
        printf("%s: differs: %s\n", file->name, file->comparison->first.text);
    return FFD_OK;
}

static void print_summary(const ffd_folder_comparison *result)
{
    printf("%llu the same, %llu different, %llu only in A, %llu only in B, %llu not readable\n",
           (unsigned long long)result->same, (unsigned long long)result->different,
           (unsigned long long)result->only_a, (unsigned long long)result->only_b,
           (unsigned long long)result->failed);
}

static int compare_folders(settings *s, const char *a, const char *b)
{
    const ffd_compare_desc desc = describe(s, a, b);
    folders of = {s, a, b};
    ffd_folder_comparison result = {.struct_size = sizeof result};
    ffd_error error;
    char *text = NULL;
    if (s->json ? ffd_compare_folders_json(&desc, &result, &text, &error)
                : ffd_compare_folders(&desc, print_file, &of, &result, &error))
        return cli_fail(&error);
    if (s->json)
        fputs(text, stdout);
    else if (!s->logging.quiet && !result.equal)
        print_summary(&result);
    if (!s->logging.quiet && result.equal && result.same == 0)
        cli_complain("%s and %s: neither has a mesh: nothing was compared", cli_display_name(a),
                     cli_display_name(b));
    ffd_free(text);
    return result.equal ? EXIT_DONE : EXIT_NO;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    if (words->count != 2)
        return cli_usage(command, s->recursive ? "needs the folders A and B" : "needs A and B");
    if (s->recursive && (strcmp(words->words[0], "-") == 0 || strcmp(words->words[1], "-") == 0))
        return cli_usage(command, "--recursive compares folders, not standard input");
    if (s->recursive && s->job.input.format != FFD_FORMAT_AUTO)
        return cli_usage(command, "--input-format cannot be used with --recursive: endings say the formats");
    if (s->recursive)
        return compare_folders(s, words->words[0], words->words[1]);
    if (strcmp(words->words[0], "-") == 0 && strcmp(words->words[1], "-") == 0)
        return cli_usage(command, "standard input can be read only once");
    return compare(context, words->words[0], words->words[1]);
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    return cli_run(command, &s, &s.help, count, arguments, act);
}

static const cli_example examples[] = {
    {"the same, to the bit?", "ffd compare old.obj new.obj"},
    {"the same to a millionth of its size?", "ffd compare old.obj new.obj --tolerance 1e-6r"},
    {"two folders, mesh by mesh",
     "mkdir -p a b; cp cow.obj vase.obj a; cp a/* b; ffd compare a b --recursive"},
    {NULL, NULL},
};

const cli_command cli_compare = {
    "compare",
    "are two files the same mesh?",
    "usage: ffd compare A B [--tolerance T] [options]\n"
    "       ffd compare A B --recursive [--tolerance T] [options]\n"
    "       exit 0: the same; 1: not, with the first and the worst difference and their number\n",
    {.first = options},
    run,
    "MESH",
    examples};
