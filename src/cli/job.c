#include "cli/job.h"
#include "cli/reported.h"
#include <stdlib.h>
#include <string.h>

#define AT(field) offsetof(cli_job, field)
const cli_option cli_job_options[] = {
    {"lattice", 'l', "LATTICE", "lattice file; several act in this order, or with --blocks side by side",
     cli_set_member, AT(desc), NULL},
    {"set", 0, "NAME=VALUE",
     "value of the placeholder {\"$\": \"NAME\"} in the moves of a lattice; repeatable", cli_set_member,
     AT(desc), NULL},
    {"time", 0, "T", CLI_TIME, cli_set_member, AT(desc), NULL},
    {"shared-box", 0, NULL,
     "a lattice's \"box\": \"mesh\" goes round all IN (in batch: all jobs), not round each", cli_set_flag,
     AT(shares_box), NULL},
    {"outside", 0, "keep|extend|error",
     "vertices outside the lattice: stay, follow its border, or fail (exit 5); default keep", cli_set_member,
     AT(desc), NULL},
    {"falloff", 0, "R", "with --outside extend: the displacement fades to zero over this distance",
     cli_set_member, AT(desc), NULL},
    {"seam", 0, CLI_SEAM_VALUE, CLI_SEAM, cli_set_member, AT(desc), NULL},
    {"snap", 0, "D|Dr", CLI_SNAP, cli_set_member, AT(desc), NULL},
    {"blocks", 0, NULL,
     "all -l act on the mesh at rest, each vertex in the first that holds it; default in turn",
     cli_set_member, AT(desc), NULL},
    {"normals", 0, "transform|recompute|keep",
     "normals, tangents: carried along, from the deformed faces, or kept; default transform", cli_set_member,
     AT(desc), NULL},
    {"space", 0, "scene|mesh",
     "glTF: the lattice is in the space of the scene, or of each mesh; default scene", cli_set_member,
     AT(desc), NULL},
    {"rig", 0, "keep|follow",
     "glTF: joints, pivots, sockets, cameras, lights, animations stay, or follow; default keep",
     cli_set_member, AT(desc), NULL},
    {"only", 0, "KIND:NAME",
     "only this, repeatable; glTF: node (and below), mesh, material; OBJ: group, object, material",
     cli_set_member, AT(desc), NULL},
    {"rigid", 0, "KIND:NAME",
     "this part moves as one piece, repeatable: kinds as of --only, joint:NAME; or component", cli_set_member,
     AT(desc), NULL},
    {"uniform", 0, "KIND:NAME", "as --rigid, and the part may become larger or smaller as a whole",
     cli_set_member, AT(desc), NULL},
    {"as-morph", 0, "NAME",
     "glTF out: leave the shape; add, or replace, the morph target of this name by the deformation",
     cli_set_member, AT(desc), NULL},
    {"embedding", 0, "FILE.npy", "u,v,w that ffd embed has written for this mesh and rest lattice",
     cli_set_member, AT(desc), NULL},
    {"weight", 0, "SOURCE",
     "vertices move as far: FILE.npy, attribute:, joint:, property:NAME, color:r; 1-SOURCE", cli_set_member,
     AT(desc), NULL},
    {"fail-on", 0, "GATES",
     "exit 1: folds,outside,multiple,singular,invalid,tear|flipped|inverted[=X],edges=X,quality=X",
     cli_set_member, AT(desc), NULL},
    {"report", 0, "FILE|-", "JSON report; JSON Lines if the name ends in .jsonl", cli_set_text, AT(report),
     NULL},
    {"report-stable", 0, NULL, "leave the seconds out of the report", cli_set_flag, AT(stable), NULL},
    {"threads", 'j', "N", CLI_THREADS, cli_set_member, AT(desc), NULL},
    {"isa", 0, "auto|scalar|sse2|avx2|avx512|neon",
     "instruction set of the kernels; never changes the output; default auto", cli_set_member, AT(desc),
     NULL},
    {"memory", 0, "SIZE", CLI_MEMORY, cli_set_member, AT(desc), NULL},
    {"timeout", 0, "SECONDS", CLI_TIMEOUT, cli_set_member, AT(desc), NULL},
    {"allow-extension", 0, "NAME", CLI_ALLOW_EXTENSION, cli_set_member, AT(desc), NULL},
    {"strict", 0, NULL, CLI_STRICT, cli_set_member, AT(desc), NULL},
    {"input-format", 0, "FORMAT", FFD_FORMAT_NAMES "; needed for -", cli_set_member, AT(desc), NULL},
    {"quiet", 'q', NULL, "only errors", cli_set_flag, AT(logging.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(logging.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

bool cli_job_begin(const cli_command *command, cli_job *job, int count, char **arguments, cli_words *words,
                   int *exit_code)
{
    ffd_deform_desc_init(&job->desc, sizeof job->desc);
    if (cli_begin(command, job, &job->help, count, arguments, words, exit_code))
        return true;
    ffd_deform_desc_clear(&job->desc);
    return false;
}

void cli_job_end(cli_job *job, cli_words *words)
{
    free(words->words);
    free(job->morph_results);
    ffd_deform_desc_clear(&job->desc);
}

int cli_job_run(const cli_command *command, cli_job *job, int count, char **arguments, cli_action *action)
{
    cli_words words;
    int code = EXIT_USAGE;
    if (!cli_job_begin(command, job, count, arguments, &words, &code))
        return code;
    code = action(command, job, &words);
    cli_job_end(job, &words);
    return code;
}

static const char *wrong_streams(const cli_job *job, const cli_words *words, size_t inputs)
{
    size_t meshes = 0, others = job->desc.embedding.path && cli_is_stream(job->desc.embedding.path);
    for (size_t i = 0; i < inputs; i++)
        meshes += cli_is_stream(words->words[i]);
    for (size_t i = 0; i < job->desc.lattice_count; i++)
        others += cli_is_stream(job->desc.lattices[i].path);
    if (meshes && job->shares_box)
        return "--shared-box reads each IN twice, but standard input can be read only once";
    return meshes + others > 1 || (others && inputs > 1) ? "standard input can be read only once" : NULL;
}

static const char *weight_file(const cli_job *job)
{
    return job->desc.weight.source ? ffd_weight_file(job->desc.weight.source) : NULL;
}

/* A report replaces an existing report, but must not be a file of the job. */
static const char *wrong_report(const cli_job *job, const cli_words *words)
{
    if (!job->report || cli_is_stream(job->report))
        return NULL;
    for (size_t i = 0; i < words->count; i++)
        if (ffd_paths_meet(job->report, words->words[i]))
            return "the report would replace a mesh";
    for (size_t i = 0; i < job->desc.lattice_count; i++)
        if (ffd_paths_meet(job->report, job->desc.lattices[i].path))
            return "the report would replace a lattice";
    if (job->desc.embedding.path && ffd_paths_meet(job->report, job->desc.embedding.path))
        return "the report would replace the embedding";
    const char *const weights = weight_file(job);
    return weights && ffd_paths_meet(job->report, weights) ? "the report would replace the weights" : NULL;
}

bool cli_job_mixes_morphs(const cli_job *job)
{
    const ffd_deform_desc *const desc = &job->desc;
    size_t named = 0;
    while (desc->morphs && named < desc->lattice_count && desc->morphs[named])
        named++;
    return desc->morphs && named < desc->lattice_count;
}

const char *cli_job_option_mistake(cli_job *job, const cli_words *words, size_t inputs)
{
    ffd_deform_desc desc;
    cli_job_describe(job, NULL, &desc);
    if (cli_job_mixes_morphs(job))
        return "-l cannot be used with --morph: each --morph names its own lattice";
    if (ffd_deform_desc_check(&desc, &job->refusal))
        return job->refusal.message;
    if (desc.embedding.path && inputs > 1)
        return "--embedding works with one mesh, but several IN are given";
    if (weight_file(job) && inputs > 1)
        return "--weight with a FILE.npy works with one mesh, but several IN are given";
    if (job->stable && !job->report)
        return "--report-stable needs --report";
    const char *why = wrong_streams(job, words, inputs);
    return why ? why : wrong_report(job, words);
}

const char *cli_job_mistake(cli_job *job, const cli_words *words, size_t inputs)
{
    return job->desc.lattice_count ? cli_job_option_mistake(job, words, inputs)
                                   : "no lattice is given (-l FILE)";
}

bool cli_job_knows_formats(const cli_job *job, const cli_words *words, size_t inputs)
{
    for (size_t i = 0; i < inputs; i++)
        if (!cli_knows_format(words->words[i], job->desc.input.format))
            return false;
    return true;
}

void cli_job_describe(cli_job *job, const char *input, ffd_deform_desc *desc)
{
    *desc = job->desc;
    desc->input.path = input;
    desc->quality = job->report != NULL;
    desc->output_set = job->output_set;
    desc->output_list = job->outputs;
    desc->cache = job->cache;
    desc->shared_box = job->shared_box;
    desc->log = cli_log;
    desc->log_user = &job->logging;
    job->logging.subject = input;
}

int cli_job_ended(cli_job *job, const ffd_job_result *result, const char *input, const char *output,
                  ffd_report *report)
{
    ffd_error error;
    int code = result->status ? cli_fail(&result->error) : EXIT_DONE;
    job->own_boxes += result->own_box;
    if (report && ffd_report_add(report, input, output, result, &error))
        code = cli_fail(&error);
    return code;
}

static int run_each(cli_job *job, const cli_words *words, size_t inputs, cli_job_function one,
                    ffd_report *report)
{
    int code = EXIT_DONE;
    for (size_t i = 0; i < inputs; i++) {
        const int own = one(job, words->words[i], report);
        if (own)
            code = inputs == 1 ? own : EXIT_NO;
    }
    if (job->own_boxes > 1 && !job->logging.quiet)
        cli_complain(
            "the lattice's box was laid round each of the %zu meshes by itself: parts that meet need "
            "one box round all of them (--shared-box)",
            job->own_boxes);
    return code;
}

/* Measures the shared box of all inputs. An unreadable one is skipped, as its own job reports it. */
static int share_box(cli_job *job, const cli_words *words, size_t inputs)
{
    ffd_error error;
    if (!job->shares_box)
        return EXIT_DONE;
    if (ffd_shared_box_create(&job->shared_box, &error))
        return cli_fail(&error);
    for (size_t i = 0; i < inputs; i++) {
        ffd_deform_desc desc;
        cli_job_describe(job, words->words[i], &desc);
        if (ffd_shared_box_add(job->shared_box, &desc, &error) == FFD_E_MEMORY)
            return cli_fail(&error);
    }
    return EXIT_DONE;
}

/* Context of run_inputs. */
typedef struct inputs_call {
    cli_job *job;
    const cli_words *words;
    size_t inputs;
    cli_job_function one;
} inputs_call;

static int run_inputs(void *context, ffd_output_set *files, ffd_report *report)
{
    const inputs_call *const call = context;
    call->job->output_set = files;
    const int code = share_box(call->job, call->words, call->inputs);
    return code ? code : run_each(call->job, call->words, call->inputs, call->one, report);
}

int cli_job_run_all(cli_job *job, const cli_words *words, size_t inputs, cli_job_function one)
{
    const cli_report report = {job->report, job->stable};
    ffd_error error;
    int code;
    if ((inputs > 1 && ffd_job_cache_create_for_lattices(&job->cache, &error)) ||
        (job->report && ffd_output_list_create(&job->outputs, &error)))
        code = cli_fail(&error);
    else
        code = cli_run_reported(&report, run_inputs, &(inputs_call){job, words, inputs, one});
    ffd_output_list_destroy(&job->outputs);
    ffd_job_cache_destroy(&job->cache);
    ffd_shared_box_destroy(&job->shared_box);
    return code;
}
