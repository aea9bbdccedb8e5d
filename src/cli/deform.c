/* deform.c - ffd deform: one mesh to a file, many to a folder. */
#include "cli/command.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct settings {
    const char **lattices;
    size_t lattice_count;
    const char *out_dir, *report;
    int outside, normals, space, resources;
    int threads;
    ffd_format input_format, output_format;
    bool force, in_place, stable, help;
    cli_talk talk;
} settings;

static bool add_lattice(void *context, const cli_option *option, const char *value)
{
    settings *s = context;
    (void)option;
    s->lattices[s->lattice_count++] = value;
    return true;
}

static const char *const outside_names[] = {"keep", "error", NULL};
static const char *const normals_names[] = {"transform", "keep", NULL};
static const char *const space_names[] = {"scene", "mesh", NULL};
static const char *const resources_names[] = {"copy", "reference", NULL};

#define AT(field) offsetof(settings, field)
static const cli_option options[] = {
    {"lattice", 'l', "FILE", "lattice file; several are applied in this order", add_lattice, 0, NULL},
    {"out-dir", 0, "DIR", "write every IN under its own name into this folder", cli_set_text, AT(out_dir),
     NULL},
    {"outside", 0, "keep|error", "vertices outside the lattice: stay, or fail (exit 5); default keep",
     cli_set_choice, AT(outside), outside_names},
    {"normals", 0, "transform|keep",
     "normals and tangents: follow the deformation, or stay; default transform", cli_set_choice, AT(normals),
     normals_names},
    {"space", 0, "scene|mesh",
     "glTF: the lattice stands in the scene, or in each mesh's own space; default scene", cli_set_choice,
     AT(space), space_names},
    {"resources", 0, "copy|reference",
     "images of a .gltf written elsewhere: copied, or referred to; default copy", cli_set_choice,
     AT(resources), resources_names},
    {"report", 0, "FILE|-", "JSON report", cli_set_text, AT(report), NULL},
    {"report-stable", 0, NULL, "leave the seconds out of the report", cli_set_flag, AT(stable), NULL},
    {"threads", 'j', "N", "threads; never changes a byte; default all processors", cli_set_count, AT(threads),
     NULL},
    {"in-place", 0, NULL, "overwrite IN", cli_set_flag, AT(in_place), NULL},
    {"force", 0, NULL, "overwrite an existing output", cli_set_flag, AT(force), NULL},
    {"input-format", 0, "FORMAT", "obj, gltf or glb; needed for -", cli_set_format, AT(input_format), NULL},
    {"output-format", 0, "FORMAT", "obj, gltf or glb; needed for -", cli_set_format, AT(output_format), NULL},
    {"quiet", 'q', NULL, "only errors", cli_set_flag, AT(talk.quiet), NULL},
    {"verbose", 'v', NULL, "say more", cli_set_flag, AT(talk.verbose), NULL},
    {"help", 'h', NULL, "this help", cli_set_flag, AT(help), NULL},
    {NULL, 0, NULL, NULL, NULL, 0, NULL},
};

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

/* One job, with its line in the report. Returns its exit code. */
static int run_job(settings *s, const char *input, const char *output, ffd_report *report)
{
    ffd_deform_desc desc;
    ffd_job_result result;
    ffd_error error;
    ffd_deform_desc_init(&desc);
    desc.input = (ffd_source){input, s->input_format, (ffd_space)s->space};
    desc.output = s->in_place ? NULL : output;
    desc.output_format = s->output_format;
    desc.lattices = s->lattices;
    desc.lattice_count = s->lattice_count;
    desc.outside = (ffd_outside)s->outside;
    desc.normals = (ffd_normals)s->normals;
    desc.resources = (ffd_resources)s->resources;
    desc.threads = s->threads;
    desc.force = s->force;
    desc.in_place = s->in_place;
    desc.log = cli_log;
    desc.log_user = &s->talk;
    s->talk.subject = input;
    int code = EXIT_DONE;
    if (ffd_deform_run(&desc, &result, &error))
        code = cli_fail(&error);
    else if (s->talk.verbose && !s->talk.quiet)
        cli_complain("%s: %llu of %llu vertices moved, by %g at most", input,
                     (unsigned long long)result.moved, (unsigned long long)result.vertices,
                     result.displacement_max);
    if (report && ffd_report_add(report, input, s->in_place ? input : output, &result, &error))
        code = cli_fail(&error);
    return code;
}

static int compare_names(const void *a, const void *b)
{
    return strcmp(name_of(*(const char *const *)a), name_of(*(const char *const *)b));
}

/* Outputs of one name in --out-dir would overwrite each other. */
static bool names_differ(const cli_words *inputs)
{
    const char **sorted = malloc(inputs->count * sizeof *sorted);
    bool differ = sorted != NULL;
    if (!sorted) {
        cli_complain("out of memory");
        return false;
    }
    memcpy(sorted, inputs->words, inputs->count * sizeof *sorted);
    qsort(sorted, inputs->count, sizeof *sorted, compare_names);
    for (size_t i = 1; i < inputs->count && differ; i++)
        if (strcmp(name_of(sorted[i - 1]), name_of(sorted[i])) == 0) {
            cli_complain("%s and %s would both be written as \"%s\"", sorted[i - 1], sorted[i],
                         name_of(sorted[i]));
            differ = false;
        }
    free(sorted);
    return differ;
}

static int run_to_folder(settings *s, const cli_words *inputs, ffd_report *report)
{
    int code = EXIT_DONE;
    for (size_t i = 0; i < inputs->count; i++) {
        const char *input = inputs->words[i];
        char *output = NULL;
        if (s->out_dir) {
            const size_t capacity = strlen(s->out_dir) + strlen(name_of(input)) + 2;
            output = malloc(capacity);
            if (!output) {
                cli_complain("out of memory");
                return ffd_status_exit_code(FFD_E_MEMORY);
            }
            snprintf(output, capacity, "%s/%s", s->out_dir, name_of(input));
        }
        const int own = run_job(s, input, output, report);
        free(output);
        if (own)
            code = inputs->count == 1 ? own : EXIT_NO;
    }
    return code;
}

static bool words_are_right(const cli_command *command, const settings *s, const cli_words *words)
{
    const char *why = NULL;
    if (s->lattice_count == 0)
        why = "no lattice is given (-l FILE)";
    else if (s->in_place && s->out_dir)
        why = "--in-place and --out-dir exclude each other";
    else if (s->in_place && words->count < 1)
        why = "needs at least one IN";
    else if (s->out_dir && words->count < 1)
        why = "needs at least one IN";
    else if (!s->in_place && !s->out_dir && words->count != 2)
        why = words->count < 2 ? "needs IN and OUT"
                               : "more than IN and OUT: several IN need --out-dir or --in-place";
    for (size_t i = 0; !why && s->out_dir && i < words->count; i++)
        if (strcmp(words->words[i], "-") == 0)
            why = "standard input has no name to be kept in --out-dir";
    if (!why && s->report && strcmp(s->report, "-") == 0 && !s->in_place && !s->out_dir &&
        strcmp(words->words[1], "-") == 0)
        why = "the mesh and the report cannot both go to standard output";
    if (why)
        cli_usage(command, why);
    return !why && (!s->out_dir || names_differ(words));
}

static int run_jobs(settings *s, const cli_words *words)
{
    ffd_report *report = NULL;
    ffd_error error;
    if (s->report && ffd_report_create(s->stable, &report, &error))
        return cli_fail(&error);
    int code = s->out_dir || s->in_place ? run_to_folder(s, words, report)
                                         : run_job(s, words->words[0], words->words[1], report);
    if (report && ffd_report_write(report, s->report, &error)) {
        const int own = cli_fail(&error);
        code = code ? code : own;
    }
    ffd_report_destroy(&report);
    return code;
}

static int run(const cli_command *command, int count, char **arguments)
{
    settings s = {0};
    cli_words words;
    int code = EXIT_USAGE;
    s.lattices = calloc((size_t)count + 1, sizeof *s.lattices);
    if (!s.lattices) {
        cli_complain("out of memory");
        return ffd_status_exit_code(FFD_E_MEMORY);
    }
    if (cli_begin(command, &s, &s.help, count, arguments, &words, &code)) {
        if (words_are_right(command, &s, &words))
            code = run_jobs(&s, &words);
        else
            code = EXIT_USAGE;
        free(words.words);
    }
    free(s.lattices);
    return code;
}

const cli_command cli_deform = {"deform", "move meshes with a lattice",
                                "usage: ffd deform IN OUT -l LATTICE [-l LATTICE ...] [options]\n"
                                "       ffd deform IN... --out-dir DIR -l LATTICE [options]\n"
                                "       ffd deform IN... --in-place -l LATTICE [options]\n",
                                options, run};
