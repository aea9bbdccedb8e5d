/* deform.c - ffd deform: one mesh to a file, or many to a folder. */
#include "cli/deform.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef cli_deform_settings settings;

static bool set_output_format(void *context, const cli_option *option, const char *value)
{
    settings *const s = context;
    s->output_ending = value;
    return cli_set_member(context, option, value);
}

#define AT(field) offsetof(settings, field)
const cli_option cli_deform_options[] = {
    {"morph", 0, "NAME=LATTICE",
     "glTF out, in place of -l: as --as-morph, for this lattice; repeatable, in one pass", cli_set_member,
     AT(job.desc), NULL},
    {"clip", 0, "CLIP",
     "with --morph: animate weights, \"NAME: TIME TARGET=W ..., TIME ...\"; seconds; repeatable",
     cli_set_member, AT(job.desc), NULL},
    {"out-dir", 0, "DIR", "write every IN under its own name into this folder, which is made", cli_set_text,
     AT(out_dir), NULL},
    {"in-place", 0, NULL, "overwrite IN", cli_set_member, AT(job.desc), NULL},
    {"force", 0, NULL, "overwrite an existing output", cli_set_member, AT(job.desc), NULL},
    {"if-changed", 0, NULL, "as --force, but leave an output that would stay the same untouched",
     cli_set_member, AT(job.desc), NULL},
    {"depfile", 0, "FILE", "write what OUT was made from, for make and ninja", cli_set_text, AT(depfile_path),
     NULL},
    {"resources", 0, "copy|reference|refresh",
     "images, materials beside OUT: copied, referred to, copied anew; default copy", cli_set_member,
     AT(job.desc), NULL},
    {"output-format", 0, "FORMAT", FFD_FORMAT_NAMES "; -, --out-dir, batch", set_output_format, AT(job.desc),
     NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

/* Returns the path of an input's output in --out-dir; free it with ffd_free. NULL after a complaint. */
static char *output_of(const settings *s, const char *input)
{
    char *output;
    if (ffd_output_path(s->out_dir, input, s->output_ending, &output, NULL))
        cli_complain("out of memory");
    return output;
}

/* Refuses jobs that write one file, or of which one reads what another one writes. outputs: room for as many
   paths as there are inputs. Returns 0, or an exit code after a complaint. */
static int check_outputs(const settings *s, const cli_words *inputs, char **outputs)
{
    ffd_error error;
    for (size_t i = 0; i < inputs->count && s->out_dir; i++) {
        outputs[i] = output_of(s, inputs->words[i]);
        if (!outputs[i])
            return ffd_status_exit_code(FFD_E_MEMORY);
    }
    return ffd_deform_check_many(&s->job.desc, inputs->words, s->out_dir ? (const char **)outputs : NULL,
                                 inputs->count, &error)
               ? cli_fail(&error)
               : EXIT_DONE;
}

static int refuse_conflicts(const settings *s, const cli_words *inputs)
{
    char **const outputs = calloc(inputs->count, sizeof *outputs);
    if (!outputs) {
        cli_complain("out of memory");
        return ffd_status_exit_code(FFD_E_MEMORY);
    }
    const int code = check_outputs(s, inputs, outputs);
    for (size_t i = 0; i < inputs->count; i++)
        ffd_free(outputs[i]);
    free(outputs);
    return code;
}

/* A file in the place of the folder would fail every job: complain once, before any work. */
static int refuse_no_folder(const char *folder)
{
    ffd_error error;
    return ffd_check_output_folder(folder, &error) ? cli_fail(&error) : EXIT_DONE;
}

static bool describe(settings *s, const char *input, const char *output, ffd_deform_desc *desc)
{
    cli_job_describe(&s->job, input, desc);
    desc->output = s->job.desc.in_place ? NULL : output;
    desc->make_folders = s->out_dir != NULL;
    desc->depfile = s->depfile;
    if (!desc->morphs)
        return true;
    if (!s->job.morph_results)
        s->job.morph_results = calloc(desc->lattice_count, sizeof *s->job.morph_results);
    desc->morph_results = s->job.morph_results;
    if (!desc->morph_results)
        cli_complain("out of memory");
    return desc->morph_results;
}

static int deform(settings *s, const char *input, const char *output, ffd_report *report)
{
    ffd_job_result result = {.struct_size = sizeof result};
    ffd_deform_desc desc;
    if (!describe(s, input, output, &desc))
        return ffd_status_exit_code(FFD_E_MEMORY);
    if (!ffd_deform_run(&desc, &result, NULL) && s->job.logging.verbose && !s->job.logging.quiet)
        cli_complain(result.moved ? "%s: %llu of %llu %s moved, by %g at most" : "%s: %llu of %llu %s moved",
                     cli_display_name(input), (unsigned long long)result.moved,
                     (unsigned long long)result.vertices, result.vertices == 1 ? "vertex" : "vertices",
                     result.displacement.max);
    return cli_job_ended(&s->job, &result, input, s->job.desc.in_place ? input : output, report);
}

static int run_job(cli_job *job, const char *input, ffd_report *report)
{
    settings *s = (settings *)job;
    if (!s->out_dir)
        return deform(s, input, s->output, report);
    char *const output = output_of(s, input);
    const int code = output ? deform(s, input, output, report) : ffd_status_exit_code(FFD_E_MEMORY);
    ffd_free(output);
    return code;
}

/* Whether all words are IN; else they are IN and OUT. */
static bool has_many(const settings *s)
{
    return s->job.desc.in_place || s->out_dir;
}

static const char *wrong_words(const settings *s, const cli_words *words)
{
    if (has_many(s))
        return words->count < 1 ? "needs at least one IN" : NULL;
    if (words->count < 2)
        return words->count ? "needs an OUT (or --out-dir, --in-place)" : "needs IN and OUT";
    return words->count > 2 ? "more than IN and OUT: several IN need --out-dir or --in-place" : NULL;
}

/* A depfile needs outputs with names, and must not be a file of a job. */
static const char *wrong_depfile(const settings *s, const cli_words *words)
{
    const bool stream = cli_is_stream(s->depfile_path);
    if (s->job.desc.in_place)
        return "--depfile cannot be used with --in-place: a file cannot depend on itself";
    if (s->output && cli_is_stream(s->output))
        return "--depfile needs a file name as OUT";
    if (s->job.report && ffd_paths_meet(s->job.report, s->depfile_path))
        return stream ? "the depfile and the report cannot both go to standard output"
                      : "the depfile and the report have the same name";
    for (size_t i = 0; i < words->count && !stream; i++)
        if (ffd_paths_meet(words->words[i], s->depfile_path))
            return "the depfile would replace a mesh";
    return NULL;
}

static const char *wrong_outputs(const settings *s, const cli_words *words, size_t inputs)
{
    bool stream = false;
    for (size_t i = 0; i < inputs; i++)
        stream = stream || cli_is_stream(words->words[i]);
    if (s->job.desc.in_place && s->out_dir)
        return "--in-place and --out-dir cannot be used together";
    if (stream && s->out_dir)
        return "standard input has no file name to keep in --out-dir";
    if (stream && s->job.desc.in_place)
        return "standard input cannot be overwritten";
    if (s->job.report && cli_is_stream(s->job.report) && s->output && cli_is_stream(s->output))
        return "the mesh and the report cannot both go to standard output";
    return s->depfile_path ? wrong_depfile(s, words) : NULL;
}

/* Makes all checks before the first job. Returns 0, or an exit code after a complaint. */
static int refuse(const cli_command *command, settings *s, const cli_words *words, size_t inputs)
{
    const char *why = s->job.desc.lattice_count ? wrong_words(s, words) : NULL;
    if (!why && !has_many(s) && words->count > 1)
        s->output = words->words[1];
    if (!why)
        why = wrong_outputs(s, words, inputs);
    if (!why)
        why = cli_job_mistake(&s->job, words, inputs);
    if (why)
        return cli_usage(command, why);
    if (!cli_job_knows_formats(&s->job, words, inputs))
        return EXIT_USAGE;
    if (s->output && cli_is_stream(s->output) && !s->job.desc.output_format) {
        cli_complain("standard output needs --output-format " FFD_FORMAT_NAMES);
        return EXIT_USAGE;
    }
    if (!has_many(s))
        return EXIT_DONE;
    const int code = inputs > 1 ? refuse_conflicts(s, words) : EXIT_DONE;
    return code || !s->out_dir || words->count == 1 ? code : refuse_no_folder(s->out_dir);
}

/* Runs the jobs and, if all succeed, writes the depfile. */
static int run_all(settings *s, const cli_words *words, size_t inputs)
{
    ffd_error error;
    if (s->depfile_path && ffd_depfile_create(s->depfile_path, &s->depfile, &error))
        return cli_fail(&error);
    /* The shared box needs files that a killed run has set aside. A file that cannot be restored is reported
       by its own job. */
    for (size_t i = 0; i < inputs && s->job.desc.in_place && s->job.shares_box; i++)
        ffd_restore_output(words->words[i], NULL);
    int code = cli_job_run_all(&s->job, words, inputs, run_job);
    if (!code && s->depfile && ffd_depfile_write(s->depfile, &error))
        code = cli_fail(&error);
    ffd_depfile_destroy(&s->depfile);
    return code;
}

static int act(const cli_command *command, void *context, const cli_words *words)
{
    settings *const s = context;
    const size_t inputs = has_many(s) || !words->count ? words->count : 1;
    const int code = refuse(command, s, words, inputs);
    return code ? code : run_all(s, words, inputs);
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    return cli_job_run(command, &s.job, count, arguments, act);
}

static const cli_example examples[] = {
    {"bend a mesh", "ffd deform robot.glb bent.glb -l bend.json"},
    {"many meshes into a folder, with a report",
     "ffd deform cow.obj vase.obj --out-dir bent -l twist.json --report report.json"},
    {"one part of a mesh (ffd info --parts has the names)",
     "ffd deform knight.glb cape.glb -l bend.json --only node:Knight_Cape"},
    {"an arm, each vertex as far as it hangs on the lower bone",
     "ffd deform knight.glb arm.glb -l bend.json --only node:Knight_ArmLeft --weight joint:lowerarm.l"},
    {"a part that joins the rest smoothly, where the mesh leaves the lattice",
     "ffd deform column.obj leaning.obj -l upper.json --seam C1"},
    {"a taller character, whose skeleton and animations follow",
     "ffd deform knight.glb taller.glb -l tall.json --rig follow"},
    {"two shapes to animate, and an animation of them",
     "ffd deform robot.glb moves.glb --morph bow=bend.json --morph turn=twist.json --clip 'hi: 0, 0.5 bow=1, "
     "1 turn=1'"},
    {"from a stream to a stream",
     "ffd deform - - --input-format obj --output-format ply -l bend.json <cow.obj >cow.ply"},
    {NULL, NULL},
};

const cli_command cli_deform = {
    "deform",
    "move meshes with a lattice",
    "usage: ffd deform IN OUT -l LATTICE [-l LATTICE ...] [options]\n"
    "       ffd deform IN... --out-dir DIR -l LATTICE [options]\n"
    "       ffd deform IN... --in-place -l LATTICE [options]\n"
    "       ffd deform IN OUT --morph NAME=LATTICE [--morph ...] [--clip CLIP] [options]\n",
    {.first = cli_job_options,
     .more = cli_deform_options,
     .output = "OUT is the second argument (ffd deform IN OUT -l LATTICE)"},
    run,
    "MESH",
    examples};
