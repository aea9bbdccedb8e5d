/* view.c - ffd view: a page or a picture of a mesh before and after. */
#include "cli/job.h"
#include "cli/look.h"
#include <ctype.h>
#include <string.h>

typedef struct settings {
    cli_job job;
    const char *output, *deformed; /* deformed: path of the second mesh, or NULL */
    cli_look look;
    bool full, force;
    cli_kept kept;
} settings;

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"output", 'o', "FILE.html|FILE.png", "a page, which a browser opens without a network; or a picture",
     cli_set_text, AT(output), NULL},
    {"morph", 0, "NAME=LATTICE",
     "in place of -l: the morph target that this lattice makes; a page has a slider; repeatable",
     cli_set_member, AT(job.desc), NULL},
    CLI_PICTURE_OPTIONS(AT(look)),
    CLI_SIDE_OPTIONS(AT(look)),
    {"full", 0, NULL, "a page shows all vertices; else a mesh of more than 200,000 is simplified",
     cli_set_flag, AT(full), NULL},
    {"force", 0, NULL, "overwrite an existing output", cli_set_flag, AT(force), NULL},
    CLI_KEPT_OPTIONS(AT(kept)),
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static int show(cli_job *job, const char *input, ffd_report *report)
{
    settings *const s = (settings *)job;
    ffd_deform_desc desc;
    ffd_view_desc view;
    ffd_source deformed;
    ffd_job_result result = {.struct_size = sizeof result};
    cli_job_describe(job, input, &desc);
    ffd_view_desc_init(&view, sizeof view);
    view.job = &desc;
    view.output = s->output;
    view.force = s->force;
    view.full = s->full;
    cli_look_describe(&s->look, &view);
    if (s->deformed) {
        deformed = desc.input;
        deformed.path = s->deformed;
        view.deformed = &deformed;
    }
    ffd_view_run(&view, &result, NULL);
    return cli_job_ended(job, &result, input, NULL, report);
}

/* Without a deformation files are shown as they are. Returns the option that does not apply to that, or
   NULL. */
static const char *mistake_of_files(settings *s, const cli_words *words)
{
    if (s->job.desc.morphs)
        return "--morph makes targets of IN: it takes no OUT-MESH";
    if (s->job.desc.fail_on)
        return "--fail-on judges a deformation: it needs -l, and no OUT-MESH";
    if (s->job.report)
        return "--report describes a deformation: it needs -l, and no OUT-MESH";
    if (s->job.desc.embedding.path)
        return "--embedding is for a deformation: it needs -l, and no OUT-MESH";
    return cli_job_option_mistake(&s->job, words, words->count);
}

/* In upper or lower case. */
static bool has_ending(const char *path, const char *ending)
{
    const size_t length = strlen(path), size = strlen(ending);
    size_t same = 0;
    while (size <= length && same < size &&
           tolower((unsigned char)path[length - size + same]) == (unsigned char)ending[same])
        same++;
    return same == size;
}

/* Returns an option that applies only to the other kind of output, or NULL. */
static const char *mistake_of_kind(const settings *s)
{
    const bool is_picture = has_ending(s->output, ".png"),
               is_page = has_ending(s->output, ".html") || has_ending(s->output, ".htm");
    if (is_picture && s->full)
        return "--full is for pages, but the output is a picture";
    if (is_page && s->look.size[0])
        return "--size is for pictures, but the output is a page";
    if (is_page && s->look.frames)
        return "--frames is for pictures, but the output is a page";
    return NULL;
}

static const char *mistake(settings *s, const cli_words *words)
{
    if (words->count == 0)
        return "needs IN";
    if (words->count > 2)
        return "takes IN and one OUT-MESH at most";
    if (!s->output)
        return "no output is given (-o FILE.html or FILE.png)";
    const char *const why = mistake_of_kind(s);
    if (why)
        return why;
    if (words->count == 2 || s->job.desc.lattice_count == 0)
        return mistake_of_files(s, words);
    if (s->job.report && ffd_paths_meet(s->job.report, s->output))
        return "the report would replace the picture or page";
    return cli_job_mistake(&s->job, words, 1);
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    const char *const why = mistake(s, words);
    if (why)
        return cli_usage(command, why);
    if (!cli_job_knows_formats(&s->job, words, words->count))
        return EXIT_USAGE;
    s->deformed = words->count == 2 ? words->words[1] : NULL;
    return cli_job_run_all(&s->job, words, 1, show);
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    return cli_job_run(command, &s.job, count, arguments, act);
}

static const cli_example examples[] = {
    {"a page of what a deformation does, for a browser", "ffd view cow.obj -l bend.json -o bend.html"},
    {"a page of two files, the mesh before and after", "ffd view old.obj new.obj -o change.html"},
    {"a picture, before and after side by side", "ffd view cow.obj -l bend.json -o bend.png --camera front"},
    {"a row of five pictures, from rest to deformed",
     "ffd view cow.obj -l bend.json -o row.png --frames 5 --size 300x400"},
    {"five poses of an animation, and below them deformed",
     "ffd view robot.glb -l tall.json -o walk.png --animation walk --size 300x400"},
    {"a page with sliders for new morph targets, and for those of the model",
     "ffd view robot.glb --morph tall=tall.json --morph turn=twist.json -o targets.html"},
    {NULL, NULL},
};

const cli_command cli_view = {
    "view",
    "a page or picture: before and after, cage, colours, what went wrong",
    "usage: ffd view IN -l LATTICE [-l LATTICE ...] -o FILE.html|FILE.png [options]    deforms in memory\n"
    "       ffd view IN --morph NAME=LATTICE [--morph ...] -o FILE.html|FILE.png [options]    new targets, "
    "in "
    "full\n"
    "       ffd view IN [OUT-MESH] [-l LATTICE ...] -o FILE.html|FILE.png [options]    shows files, and the "
    "cage of "
    "-l\n"
    "       exit 1: a gate of --fail-on is violated; the output is written all the same\n",
    {.first = options, .more = cli_job_options},
    run,
    "MESH",
    examples};
