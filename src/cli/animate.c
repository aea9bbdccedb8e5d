/* animate.c - ffd animate: a lattice with keys as an animation of morph targets. */
#include "cli/job.h"
#include "cli/reported.h"
#include <ffd/animate.h>
#include <inttypes.h>
#include <string.h>

typedef struct settings {
    cli_job job;
    const char *name, *depfile_path;
    cli_distance tolerance; /* value 0: not given */
    ffd_animate_targets targets;
    size_t count;
    double frames_per_second; /* 0: not given */
} settings;

static bool set_tolerance(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    if (!cli_set_distance(s, option, value))
        return false;
    if (s->tolerance.value > 0)
        return true;
    cli_complain("--%s: \"%.80s\" is not a number above 0, alone or followed by r", option->name, value);
    return false;
}

static bool set_targets(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    double number;
    s->targets = strcmp(value, "auto") == 0   ? FFD_TARGETS_AUTO
                 : strcmp(value, "keys") == 0 ? FFD_TARGETS_KEYS
                                              : FFD_TARGETS_COUNT;
    if (s->targets != FFD_TARGETS_COUNT)
        return true;
    if (cli_parse_number(value, &number) && number >= 1 && number <= 1024 && number == (int)number) {
        s->count = (size_t)number;
        return true;
    }
    cli_complain("--%s: \"%.80s\" is not auto, keys or a number from 1 to 1024", option->name, value);
    return false;
}

static bool set_frames(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    if (cli_parse_number(value, &s->frames_per_second) && s->frames_per_second >= 1 &&
        s->frames_per_second <= 1000)
        return true;
    cli_complain("--%s: \"%.80s\" is not a number from 1 to 1000", option->name, value);
    return false;
}

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"lattice", 'l', "LATTICE", "lattice file with keys", cli_set_member, AT(job.desc), NULL},
    {"name", 0, "NAME", "of the animation; its morph targets are NAME-1, ..; default as the lattice's file",
     cli_set_text, AT(name), NULL},
    {"tolerance", 0, "TOL|TOLr",
     "how far a vertex may be from its place (r: parts of the lattice's diagonal); default 1e-3r",
     set_tolerance, AT(tolerance), NULL},
    {"targets", 0, "auto|keys|N",
     "morph targets: as few as the tolerance allows, one for each key, or N; default auto", set_targets, 0,
     NULL},
    {"fps", 0, "N", "samples a second at least, where keys set values, 1 to 1000; default 60", set_frames, 0,
     NULL},
    {"set", 0, "NAME=VALUE",
     "value of the placeholder {\"$\": \"NAME\"} in the moves of the lattice; repeatable", cli_set_member,
     AT(job.desc), NULL},
    {"outside", 0, "keep|extend|error",
     "vertices outside the lattice: stay, follow its border, or fail (exit 5); default keep", cli_set_member,
     AT(job.desc), NULL},
    {"falloff", 0, "R", "with --outside extend: the displacement fades to zero over this distance",
     cli_set_member, AT(job.desc), NULL},
    {"seam", 0, CLI_SEAM_VALUE, CLI_SEAM, cli_set_member, AT(job.desc), NULL},
    {"snap", 0, "D|Dr", CLI_SNAP, cli_set_member, AT(job.desc), NULL},
    {"normals", 0, "transform|keep",
     "normals, tangents of morph targets: those of each shape, or none; default transform", cli_set_member,
     AT(job.desc), NULL},
    {"space", 0, "scene|mesh",
     "glTF: the lattice is in the space of the scene, or of each mesh; default scene", cli_set_member,
     AT(job.desc), NULL},
    {"only", 0, "KIND:NAME", "only this, repeatable, as for ffd deform", cli_set_member, AT(job.desc), NULL},
    {"weight", 0, "SOURCE", "how much of the displacement each vertex takes, as for ffd deform",
     cli_set_member, AT(job.desc), NULL},
    {"report", 0, "FILE|-", "JSON report; JSON Lines if the name ends in .jsonl", cli_set_text,
     AT(job.report), NULL},
    {"report-stable", 0, NULL, "leave the seconds out of the report", cli_set_flag, AT(job.stable), NULL},
    {"resources", 0, "copy|reference|refresh",
     "images, materials beside OUT: copied, referred to, copied anew; default copy", cli_set_member,
     AT(job.desc), NULL},
    {"depfile", 0, "FILE", "write what OUT was made from, for make and ninja", cli_set_text, AT(depfile_path),
     NULL},
    {"force", 0, NULL, "overwrite an existing output", cli_set_member, AT(job.desc), NULL},
    {"if-changed", 0, NULL, "as --force, but leave an output that would stay the same untouched",
     cli_set_member, AT(job.desc), NULL},
    {"threads", 'j', "N", CLI_THREADS, cli_set_member, AT(job.desc), NULL},
    {"isa", 0, "auto|scalar|sse2|avx2|avx512|neon", CLI_ISA, cli_set_member, AT(job.desc), NULL},
    {"memory", 0, "SIZE", CLI_MEMORY, cli_set_member, AT(job.desc), NULL},
    {"timeout", 0, "SECONDS", CLI_TIMEOUT, cli_set_member, AT(job.desc), NULL},
    {"allow-extension", 0, "NAME", CLI_ALLOW_EXTENSION, cli_set_member, AT(job.desc), NULL},
    {"strict", 0, NULL, CLI_STRICT, cli_set_member, AT(job.desc), NULL},
    {"quiet", 'q', NULL, "only errors", cli_set_flag, AT(job.logging.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(job.logging.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(job.help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static void describe(settings *s, const char *input, const char *output, ffd_depfile *depfile,
                     ffd_deform_desc *job, ffd_animate_desc *desc)
{
    cli_job_describe(&s->job, input, job);
    job->quality = false; /* the report has no figures of it */
    job->output = output;
    job->depfile = depfile;
    ffd_animate_desc_init(desc, sizeof *desc);
    desc->job = job;
    desc->name = s->name;
    if (s->tolerance.value > 0) {
        desc->tolerance = s->tolerance.value;
        desc->relative = s->tolerance.is_relative;
    }
    desc->targets = s->targets;
    desc->count = s->count;
    if (s->frames_per_second > 0)
        desc->frames_per_second = s->frames_per_second;
}

/* Context of animate. */
typedef struct animate_call {
    settings *settings;
    const char *input, *output;
    ffd_depfile *depfile;
} animate_call;

static int animate(void *context, ffd_output_set *files, ffd_report *report)
{
    const animate_call *const call = context;
    ffd_deform_desc job;
    ffd_animate_desc desc;
    ffd_animate_result result = {.struct_size = sizeof result};
    ffd_error error;
    call->settings->job.output_set = files;
    describe(call->settings, call->input, call->output, call->depfile, &job, &desc);
    int code = ffd_animate_run(&desc, &result, &error) ? cli_fail(&error) : EXIT_DONE;
    if (report && ffd_report_add_animation(report, call->input, call->output, &result, &error))
        code = cli_fail(&error);
    return code;
}

/* Runs the job, and writes the report and, if it succeeds, the depfile. */
static int run_job(settings *s, const char *input, const char *output)
{
    const cli_report report = {s->job.report, s->job.stable};
    animate_call call = {s, input, output, NULL};
    ffd_error error;
    int code;
    if ((s->depfile_path && ffd_depfile_create(s->depfile_path, &call.depfile, &error)) ||
        (report.path && ffd_output_list_create(&s->job.outputs, &error)))
        code = cli_fail(&error);
    else
        code = cli_run_reported(&report, animate, &call);
    if (!code && call.depfile && ffd_depfile_write(call.depfile, &error))
        code = cli_fail(&error);
    ffd_depfile_destroy(&call.depfile);
    ffd_output_list_destroy(&s->job.outputs);
    return code;
}

/* A depfile must not be a file of the job. */
static const char *wrong_depfile(const settings *s, const cli_words *words)
{
    if (s->job.report && ffd_paths_meet(s->job.report, s->depfile_path))
        return "the depfile and the report have the same name";
    for (size_t i = 0; i < words->count; i++)
        if (ffd_paths_meet(words->words[i], s->depfile_path))
            return "the depfile would replace a mesh";
    return ffd_paths_meet(s->job.desc.lattices[0].path, s->depfile_path)
               ? "the depfile would replace a lattice"
               : NULL;
}

/* Returns what is wrong with the options and words, or NULL. */
static const char *mistake(settings *s, const cli_words *words)
{
    if (s->job.desc.lattice_count == 0)
        return "no lattice is given (-l FILE)";
    if (s->job.desc.lattice_count > 1)
        return "an animation has one lattice, not several";
    if (words->count != 2)
        return "needs IN and OUT";
    if (s->job.desc.normals == FFD_NORMALS_RECOMPUTE)
        return "--normals recompute cannot be used with an animation: transform or keep";
    for (size_t i = 0; i < 2; i++)
        if (cli_is_stream(words->words[i]))
            return "IN and OUT are files, not streams";
    const char *const why = cli_job_mistake(&s->job, words, 1);
    return why || !s->depfile_path ? why : wrong_depfile(s, words);
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    const char *const why = mistake(s, words);
    if (why)
        return cli_usage(command, why);
    const ffd_format format = ffd_format_from_name(words->words[1]);
    if (format != FFD_FORMAT_GLTF && format != FFD_FORMAT_GLB) {
        cli_complain("%s: cannot hold an animation: only .glb, .gltf and .vrm can", words->words[1]);
        return EXIT_USAGE;
    }
    return cli_job_knows_formats(&s->job, words, 1) ? run_job(s, words->words[0], words->words[1])
                                                    : EXIT_USAGE;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {.targets = FFD_TARGETS_AUTO};
    return cli_job_run(command, &s.job, count, arguments, act);
}

static const cli_example examples[] = {
    {"a lattice with keys as an animation", "ffd animate robot.glb turning.glb -l turning.json"},
    {"the same with a morph target for each key, and what that costs",
     "ffd animate robot.glb keyed.glb -l turning.json --targets keys --report report.json"},
    {NULL, NULL},
};

const cli_command cli_animate = {
    "animate",
    "a lattice with keys as an animation of morph targets",
    "usage: ffd animate IN OUT.glb|.gltf|.vrm -l LATTICE [--name NAME] [--tolerance TOL|TOLr]\n"
    "       [--targets auto|keys|N] [--fps N] [options]\n",
    {.first = options, .output = "OUT is the second argument (ffd animate IN OUT -l LATTICE)"},
    run,
    "MESH",
    examples};
