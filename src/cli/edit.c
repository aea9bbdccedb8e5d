/* edit.c - ffd edit: a page in which a lattice is shaped by hand. */
#include "cli/command.h"
#include "cli/look.h"
#include "cli/member.h"
#include "cli/three.h"
#include <string.h>

typedef struct settings {
    ffd_deform_desc job; /* the options that it shares with ffd deform */
    ffd_lattice_desc lattice;
    bool is_new[4]; /* --size, --degree, --knots, --margin are given */
    const char *output;
    cli_look look;
    bool full, help;
    cli_logging logging;
} settings;

static bool set_size(void *context, const cli_option *option, const char *value)
{
    ((settings *)context)->is_new[0] = true;
    return cli_set_sizes(context, option, value);
}

static bool set_degree(void *context, const cli_option *option, const char *value)
{
    ((settings *)context)->is_new[1] = true;
    return cli_set_degrees(context, option, value);
}

static bool set_knots(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    s->is_new[2] = true;
    return cli_read_knots(s->lattice.knots, option, value);
}

static bool set_margin(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    bool are_three;
    s->is_new[3] = true;
    return cli_read_margin(s->lattice.margin, option, value, &are_three);
}

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"lattice", 'l', "LATTICE", "lattice file; of several, which act in this order, the last is edited",
     cli_set_member, AT(job), NULL},
    {"size", 0, "N,M,O", "without -l: control points along u, v, w of a new box; default 4,4,4", set_size,
     AT(lattice.size), NULL},
    {"degree", 0, "N,M,O", "of the new box, 1 to 14; default 3, or less where there are fewer points",
     set_degree, AT(lattice.degree), NULL},
    {"knots", 0, "K,K,K", "of the new box: clamped, open, uniform or closed; default clamped", set_knots, 0,
     cli_knots_names},
    {"margin", 0, "F|X,Y,Z", "space round the mesh in the new box, as a fraction of its extent; default 0.05",
     set_margin, 0, NULL},
    {"output", 'o', "PAGE.html", "a page, which a browser opens without a network", cli_set_text, AT(output),
     NULL},
    {"only", 0, "KIND:NAME", "move only this, repeatable; a new box goes round it", cli_set_member, AT(job),
     NULL},
    {"outside", 0, "keep|extend|error",
     "vertices outside the lattice: stay, follow its border, or fail (exit 5); default keep", cli_set_member,
     AT(job), NULL},
    {"falloff", 0, "R", "with --outside extend: the displacement fades to zero over this distance",
     cli_set_member, AT(job), NULL},
    {"snap", 0, "D|Dr", CLI_SNAP, cli_set_member, AT(job), NULL},
    {"space", 0, "scene|mesh",
     "glTF: the lattice is in the space of the scene, or of each mesh; default scene", cli_set_member,
     AT(job), NULL},
    {"set", 0, "NAME=VALUE",
     "value of the placeholder {\"$\": \"NAME\"} in the moves of a lattice; repeatable", cli_set_member,
     AT(job), NULL},
    {"time", 0, "T", CLI_TIME, cli_set_member, AT(job), NULL},
    {"up", 0, "y|z|x", "the axis that points upwards on the page; default y", cli_set_up, AT(look),
     cli_up_names},
    {"full", 0, NULL, "show all vertices; else a mesh of more than 200,000 is simplified", cli_set_flag,
     AT(full), NULL},
    {"force", 0, NULL, "overwrite an existing page", cli_set_member, AT(job), NULL},
    {"threads", 'j', "N", CLI_THREADS, cli_set_member, AT(job), NULL},
    {"memory", 0, "SIZE", CLI_MEMORY, cli_set_member, AT(job), NULL},
    {"allow-extension", 0, "NAME", CLI_ALLOW_EXTENSION, cli_set_member, AT(job), NULL},
    {"strict", 0, NULL, CLI_STRICT, cli_set_member, AT(job), NULL},
    {"input-format", 0, "FORMAT", FFD_FORMAT_NAMES "; needed for -", cli_set_member, AT(job), NULL},
    {"quiet", 'q', NULL, "only errors", cli_set_flag, AT(logging.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(logging.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static bool makes_lattice(const settings *s)
{
    return s->is_new[0] || s->is_new[1] || s->is_new[2] || s->is_new[3];
}

static int edit(settings *s, const char *input)
{
    ffd_edit_desc desc;
    ffd_view_desc look;
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    ffd_edit_desc_init(&desc, sizeof desc);
    ffd_view_desc_init(&look, sizeof look);
    cli_look_describe(&s->look, &look);
    s->job.input.path = input;
    s->job.log = cli_log;
    s->job.log_user = &s->logging;
    s->logging.subject = input;
    desc.job = &s->job;
    desc.lattice = s->job.lattice_count == 0 ? &s->lattice : NULL;
    desc.output = s->output;
    desc.force = s->job.force;
    desc.full = s->full;
    desc.up = look.up;
    return ffd_edit_run(&desc, &result, &error) ? cli_fail(&error) : EXIT_DONE;
}

/* Returns what is wrong with the options and words, or NULL. */
static const char *mistake(const settings *s, const cli_words *words)
{
    if (words->count != 1)
        return "needs one MESH";
    if (!s->output)
        return "no output is given (-o PAGE.html)";
    if (s->job.lattice_count > 0 && makes_lattice(s))
        return "--size, --degree, --knots and --margin are of a new lattice: not with -l";
    return NULL;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    const char *const why = mistake(s, words);
    if (why)
        return cli_usage(command, why);
    return cli_knows_format(words->words[0], s->job.input.format) ? edit(s, words->words[0]) : EXIT_USAGE;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    ffd_deform_desc_init(&s.job, sizeof s.job);
    ffd_lattice_desc_init(&s.lattice, sizeof s.lattice);
    const int code = cli_run(command, &s, &s.help, count, arguments, act);
    ffd_deform_desc_clear(&s.job);
    return code;
}

static const cli_example examples[] = {
    {"a page with a new lattice of 4 x 4 x 4 control points", "ffd edit cow.obj -o cow.html"},
    {"shape a lattice further", "ffd edit cow.obj -l bend.json -o bend.html"},
    {NULL, NULL},
};

const cli_command cli_edit = {"edit",
                              "a page to shape a lattice by hand",
                              "usage: ffd edit MESH [-l LATTICE ... | --size N,M,O] -o PAGE.html [options]\n",
                              {.first = options},
                              run,
                              "MESH",
                              examples};
