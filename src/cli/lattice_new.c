/* lattice_new.c - ffd lattice new: a lattice round meshes. */
#include "cli/command.h"
#include "cli/member.h"
#include "cli/three.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct settings {
    ffd_lattice_desc desc;
    const char *output;
    int shape, spacing;
    ffd_deform_desc job; /* the options that it shares with ffd deform */
    bool help;
    bool has_axis, has_margins; /* has_margins: --margin was given three numbers */
    cli_logging logging;
} settings;

static bool set_knots(void *context, const cli_option *option, const char *value)
{
    settings *s = context;
    return cli_read_knots(s->desc.knots, option, value);
}

static bool set_margin(void *context, const cli_option *option, const char *value)
{
    settings *s = context;
    return cli_read_margin(s->desc.margin, option, value, &s->has_margins);
}

/* The hint at a word that is not an axis: with a sign it means a direction. */
static void hint_axis(const char *value, char hint[CLI_HINT])
{
    static const char *const known[] = {"x", "y", "z"};
    const size_t length = strlen(value);
    const bool is_signed = length == 2 && (value[0] == '-' || value[1] == '-');
    const char letter[] = {length == 2 && value[0] == '-' ? value[1] : value[0], 0};
    const char *const meant = ffd_word_meant(is_signed ? letter : value, known, 3);
    if (meant && is_signed)
        snprintf(hint, CLI_HINT, " (that direction is %s)",
                 *meant == 'x'   ? "-1,0,0"
                 : *meant == 'y' ? "0,-1,0"
                                 : "0,0,-1");
    else
        snprintf(hint, CLI_HINT, "%s%s%s", meant ? " (nearest: " : "", meant ? meant : "", meant ? ")" : "");
}

static bool set_axis(void *context, const cli_option *option, const char *value)
{
    settings *s = context;
    char part[3][CLI_PART];
    s->has_axis = true;
    if (strlen(value) == 1 && *value >= 'x' && *value <= 'z') {
        for (int a = 0; a < 3; a++)
            s->desc.axis[a] = *value == "xyz"[a];
        return true;
    }
    bool right = strchr(value, ',') && cli_split_three(value, part);
    for (int a = 0; right && a < 3; a++)
        right = cli_parse_number(part[a], &s->desc.axis[a]);
    right = right && (s->desc.axis[0] != 0 || s->desc.axis[1] != 0 || s->desc.axis[2] != 0);
    if (!right) {
        char hint[CLI_HINT];
        hint_axis(value, hint);
        cli_complain("--%s: \"%s\" is not x, y, z or a direction like 0,1,1%s", option->name, value, hint);
    }
    return right;
}

static bool set_axes(void *context, const cli_option *option, const char *value)
{
    settings *s = context;
    s->desc.principal = strcmp(value, "principal") == 0;
    if (!s->desc.principal)
        cli_complain("--%s: \"%s\" is not principal", option->name, value);
    return s->desc.principal;
}

static const char *const shape_names[] = {"box", "cylinder", NULL};
static const char *const spacing_names[] = {"greville", "uniform", NULL};

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"output", 'o', "LATTICE", "the file to write", cli_set_text, AT(output), NULL},
    {"size", 0, "N,M,O", "control points along u, v, w, or one number for all; default 4,4,4", cli_set_sizes,
     AT(desc.size), NULL},
    {"degree", 0, "N,M,O", "1 to 14, three or one for all; default 3, or less where there are fewer points",
     cli_set_degrees, AT(desc.degree), NULL},
    {"knots", 0, "K,K,K", "clamped, open, uniform or closed, three or one for all; default clamped",
     set_knots, 0, cli_knots_names},
    {"margin", 0, "F|X,Y,Z",
     "space on both sides, as a fraction of the extent; three: along a box's axes; default 0.05", set_margin,
     0, NULL},
    {"only", 0, "KIND:NAME",
     "round this only, repeatable; glTF: node, mesh, material; OBJ: group, object, material", cli_set_member,
     AT(job), NULL},
    {"spacing", 0, "greville|uniform", "of the control points of a box; default greville", cli_set_choice,
     AT(spacing), spacing_names},
    {"shape", 0, "box|cylinder", "default box", cli_set_choice, AT(shape), shape_names},
    {"axis", 0, "x|y|z|X,Y,Z", "of a cylinder; default z", set_axis, 0, NULL},
    {"axes", 0, "principal", "a box along the mesh's principal axes", set_axes, 0, NULL},
    {"force", 0, NULL, "overwrite an existing file", cli_set_member, AT(job), NULL},
    {"memory", 0, "SIZE", CLI_MEMORY, cli_set_member, AT(job), NULL},
    {"allow-extension", 0, "NAME", CLI_ALLOW_EXTENSION, cli_set_member, AT(job), NULL},
    {"strict", 0, NULL, CLI_STRICT, cli_set_member, AT(job), NULL},
    {"input-format", 0, "FORMAT", FFD_FORMAT_NAMES "; needed for -", cli_set_member, AT(job), NULL},
    {"quiet", 'q', NULL, "only errors", cli_set_flag, AT(logging.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(logging.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static int create(settings *s, const cli_words *words)
{
    ffd_source *const meshes = calloc(words->count, sizeof *meshes);
    ffd_lattice_new_desc desc;
    ffd_error error;
    if (!meshes) {
        cli_complain("out of memory");
        return ffd_status_exit_code(FFD_E_MEMORY);
    }
    for (size_t i = 0; i < words->count; i++) {
        meshes[i] = s->job.input;
        meshes[i].path = words->words[i];
    }
    s->desc.shape = (ffd_lattice_shape)s->shape;
    s->desc.spacing = (ffd_spacing)s->spacing;
    ffd_lattice_new_desc_init(&desc, sizeof desc);
    desc.meshes = meshes;
    desc.mesh_count = words->count;
    desc.only = s->job.only;
    desc.only_count = s->job.only_count;
    desc.lattice = &s->desc;
    desc.output = s->output;
    desc.force = s->job.force;
    desc.log = cli_log;
    desc.log_user = &s->logging;
    const int code = ffd_lattice_new_run(&desc, &error) ? cli_fail(&error) : EXIT_DONE;
    free(meshes);
    return code;
}

/* Returns what is wrong with the options and words, or NULL. */
static const char *mistake(const settings *s, const cli_words *words)
{
    size_t streams = 0;
    for (size_t i = 0; i < words->count; i++)
        streams += strcmp(words->words[i], "-") == 0;
    if (words->count == 0)
        return "needs at least one MESH";
    if (streams > 1)
        return "standard input can be read only once";
    if (!s->output)
        return "no output is given (-o LATTICE)";
    if (ffd_format_from_name(s->output) != FFD_FORMAT_AUTO)
        return "a lattice file is JSON, but the output has the ending of a mesh";
    if (s->has_axis && s->shape != FFD_SHAPE_CYLINDER)
        return "--axis needs --shape cylinder";
    if (s->desc.principal && s->shape != FFD_SHAPE_BOX)
        return "--axes needs --shape box: a cylinder has --axis";
    if (s->has_margins && s->shape != FFD_SHAPE_BOX)
        return "three numbers of --margin need --shape box: a cylinder has one margin, of its radius and "
               "height";
    return NULL;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *s = context;
    const char *why = mistake(s, words);
    if (why)
        return cli_usage(command, why);
    for (size_t i = 0; i < words->count; i++)
        if (!cli_knows_format(words->words[i], s->job.input.format))
            return EXIT_USAGE;
    return create(s, words);
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    ffd_lattice_desc_init(&s.desc, sizeof s.desc);
    const int code = cli_run(command, &s, &s.help, count, arguments, act);
    ffd_deform_desc_clear(&s.job);
    return code;
}

static const cli_example examples[] = {
    {"a box with more control points along y", "ffd lattice new cow.obj -o cow.json --size 4,6,4"},
    {"a cylinder round an upright column",
     "ffd lattice new column.obj -o column.json --shape cylinder --axis y"},
    {"one box round several parts", "ffd lattice new cow.obj vase.obj -o both.json --margin 0.1,0,0.1"},
    {NULL, NULL},
};

const cli_command cli_lattice_new = {
    "lattice new",
    "make a lattice round meshes",
    "usage: ffd lattice new MESH... -o LATTICE [--size 4,4,4] [--degree 3,3,3] "
    "[--shape box|cylinder] [options]\n",
    {.first = options},
    run,
    "MESH",
    examples};
