/* jacobian.c - ffd jacobian: the derivative of positions by control points or by placeholders. */
#include "cli/job.h"
#include <ffd/jacobian.h>
#include <inttypes.h>
#include <stdio.h>

typedef struct settings {
    cli_job job;
    const char *output, *times, *transposed;
    int by;
    int of;
    bool has_of, components, check, force;
} settings;

static const char *const by_names[] = {"points", "parameters", NULL};

/* A whole number from 0. */
static bool set_of(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    double number;
    s->has_of = cli_parse_number(value, &number) && number >= 0 && number < 1024 && number == (int)number;
    if (s->has_of)
        s->of = (int)number;
    else
        cli_complain("--%s: \"%.60s\" is not the number of a lattice, from 0", option->name, value);
    return s->has_of;
}

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"lattice", 'l', "LATTICE", "lattice file; several act in this order", cli_set_member, AT(job.desc),
     NULL},
    {"output", 'o', "FILE.npz|.mtx|.npy", "the matrix, sparse; .npy: dense, by parameters; a product",
     cli_set_text, AT(output), NULL},
    {"wrt", 0, "points|parameters", "by the deformed control points, or by the placeholders; default points",
     cli_set_choice, AT(by), by_names},
    {"components", 0, NULL, "3 x 3 numbers for each vertex and control point, in the space of the file",
     cli_set_flag, AT(components), NULL},
    {"of", 0, "I", "by the control points of lattice I, from 0; default the last", set_of, 0, NULL},
    {"times", 0, "V.npy", "write the product with these displacements of control points, or values",
     cli_set_text, AT(times), NULL},
    {"transposed", 0, "V.npy", "write the product of the transposed matrix with these N x 3 numbers",
     cli_set_text, AT(transposed), NULL},
    {"check", 0, NULL, "compare 16 vertices with central differences; exit 1 above 1e-6", cli_set_flag,
     AT(check), NULL},
    {"set", 0, "NAME=VALUE",
     "value of the placeholder {\"$\": \"NAME\"} in the moves of a lattice; repeatable", cli_set_member,
     AT(job.desc), NULL},
    {"time", 0, "T", CLI_TIME, cli_set_member, AT(job.desc), NULL},
    {"outside", 0, "keep|extend|error",
     "vertices outside the lattice: stay, follow its border, or fail (exit 5)", cli_set_member, AT(job.desc),
     NULL},
    {"falloff", 0, "R", "with --outside extend: the displacement fades to zero over this distance",
     cli_set_member, AT(job.desc), NULL},
    {"seam", 0, CLI_SEAM_VALUE, CLI_SEAM, cli_set_member, AT(job.desc), NULL},
    {"snap", 0, "D|Dr", CLI_SNAP, cli_set_member, AT(job.desc), NULL},
    {"space", 0, "scene|mesh",
     "glTF: the lattice is in the space of the scene, or of each mesh; default scene", cli_set_member,
     AT(job.desc), NULL},
    {"weight", 0, "SOURCE", "rows times the weights of vertices, as for ffd deform", cli_set_member,
     AT(job.desc), NULL},
    {"only", 0, "KIND:NAME", "only this, repeatable, as for ffd deform", cli_set_member, AT(job.desc), NULL},
    {"threads", 'j', "N", CLI_THREADS, cli_set_member, AT(job.desc), NULL},
    {"isa", 0, "auto|scalar|sse2|avx2|avx512|neon", CLI_ISA, cli_set_member, AT(job.desc), NULL},
    {"memory", 0, "SIZE", CLI_MEMORY, cli_set_member, AT(job.desc), NULL},
    {"timeout", 0, "SECONDS", CLI_TIMEOUT, cli_set_member, AT(job.desc), NULL},
    {"allow-extension", 0, "NAME", CLI_ALLOW_EXTENSION, cli_set_member, AT(job.desc), NULL},
    {"strict", 0, NULL, CLI_STRICT, cli_set_member, AT(job.desc), NULL},
    {"input-format", 0, "FORMAT", FFD_FORMAT_NAMES "; needed for -", cli_set_member, AT(job.desc), NULL},
    {"force", 0, NULL, "overwrite an existing output", cli_set_flag, AT(force), NULL},
    {"quiet", 'q', NULL, "only errors", cli_set_flag, AT(job.logging.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(job.logging.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(job.help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static void print_result(const settings *s, const ffd_jacobian_result *result)
{
    printf("%s\n  matrix         %" PRIu64 " x %" PRIu64 ", %" PRIu64 " numbers\n", s->output, result->rows,
           result->columns, result->entries);
    printf("  vertices       %" PRIu64 ": %" PRIu64 " follow, %" PRIu64 " %s empty rows\n", result->vertices,
           result->moving, result->vertices - result->moving,
           result->vertices - result->moving == 1 ? "has" : "have");
    if (s->check)
        printf("  differences    agree within %.2g\n", result->worst);
}

static int jacobian(settings *s, const char *input)
{
    ffd_deform_desc job;
    ffd_jacobian_desc desc;
    ffd_jacobian_result result = {.struct_size = sizeof result};
    ffd_error error;
    cli_job_describe(&s->job, input, &job);
    job.force = s->force;
    ffd_jacobian_desc_init(&desc, sizeof desc);
    desc.job = &job;
    desc.output = s->output;
    desc.by = (ffd_jacobian_by)s->by;
    desc.components = s->components;
    desc.of = s->has_of ? (size_t)s->of : FFD_LATTICE_LAST;
    desc.times = s->times;
    desc.transposed = s->transposed;
    desc.check = s->check;
    if (ffd_jacobian_run(&desc, &result, &error))
        return cli_fail(&error);
    if (!s->job.logging.quiet)
        print_result(s, &result);
    return EXIT_DONE;
}

/* Returns what is wrong with the options, or NULL. */
static const char *mistake(settings *s, const cli_words *words)
{
    if (words->count != 1)
        return "needs one IN";
    if (!s->output)
        return "no output is given (-o FILE.npz)";
    if (s->times && s->transposed)
        return "--times and --transposed are two products: one at a time";
    if (s->has_of && s->by == FFD_BY_PARAMETERS)
        return "--of is for --wrt points: parameters are those of all lattices";
    return cli_job_mistake(&s->job, words, 1);
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    const char *const why = mistake(s, words);
    if (why)
        return cli_usage(command, why);
    return cli_job_knows_formats(&s->job, words, 1) ? jacobian(s, words->words[0]) : EXIT_USAGE;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {.by = FFD_BY_POINTS};
    return cli_job_run(command, &s.job, count, arguments, act);
}

static const cli_example examples[] = {
    {"how each vertex follows the control points", "ffd jacobian vase.obj -l bend.json -o J.npz"},
    {"how they follow the parameters of a design, checked against differences",
     "ffd jacobian vase.obj -l swept.json --set SWEEP=30 --wrt parameters --check -o J.npy"},
    {"the gradient of an objective by control points",
     "ffd jacobian vase.obj -l bend.json --transposed dFdX.npy -o dFdQ.npy"},
    {NULL, NULL},
};

const cli_command cli_jacobian = {
    "jacobian",
    "the derivative of positions by control points or parameters",
    "usage: ffd jacobian IN -l LATTICE [-l LATTICE ...] -o J.npz|J.mtx|J.npy [options]\n"
    "       exit 1: with --check, central differences disagree\n",
    {.first = options},
    run,
    "MESH",
    examples};
