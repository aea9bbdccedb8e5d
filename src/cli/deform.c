/* deform.c - ffd deform: one mesh to a file, many to a folder. */
#include "cli/command.h"
#include <errno.h>
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
    ffd_written *written; /* by the jobs so far */
    cli_talk talk;
} settings;

static bool add_lattice(void *context, const cli_option *option, const char *value)
{
    settings *s = context;
    s->lattices[s->lattice_count] = NULL;
    return cli_set_text(&s->lattices[s->lattice_count++], option, value);
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
    desc.written = s->written;
    desc.log = cli_log;
    desc.log_user = &s->talk;
    s->talk.subject = input;
    int code = EXIT_DONE;
    if (ffd_deform_run(&desc, &result, &error))
        code = cli_fail(&error);
    else if (s->talk.verbose && !s->talk.quiet)
        cli_complain("%s: %llu of %llu vertices moved, by %g at most", cli_shown(input),
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

static int compare_paths(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* Two jobs with one output would overwrite each other's. Returns 0 or an exit code, after a complaint. */
static int refuse_equal_outputs(const cli_words *inputs, int (*compare)(const void *, const void *))
{
    const char **sorted = calloc(inputs->count, sizeof *sorted);
    int code = EXIT_DONE;
    if (!sorted) {
        cli_complain("out of memory");
        return ffd_status_exit_code(FFD_E_MEMORY);
    }
    memcpy(sorted, inputs->words, inputs->count * sizeof *sorted);
    qsort(sorted, inputs->count, sizeof *sorted, compare);
    for (size_t i = 1; i < inputs->count && !code; i++)
        if (compare(&sorted[i - 1], &sorted[i]) == 0) {
            if (strcmp(sorted[i - 1], sorted[i]) == 0)
                cli_complain("%s: is named twice", sorted[i]);
            else
                cli_complain("%s and %s would both be written as \"%s\"", sorted[i - 1], sorted[i],
                             name_of(sorted[i]));
            code = EXIT_USAGE;
        }
    free(sorted);
    return code;
}

/* "folder/name", to be freed; NULL after a complaint. */
static char *join(const char *folder, const char *name)
{
    const size_t length = strlen(folder), capacity = length + strlen(name) + 2;
    char *path = malloc(capacity);
    if (path)
        snprintf(path, capacity, "%s%s%s", folder, folder[length - 1] == '/' ? "" : "/", name);
    else
        cli_complain("out of memory");
    return path;
}

/* A missing folder would fail every job; it is said once, before any work. */
static int refuse_missing_folder(const char *folder)
{
    char *inside = join(folder, ".");
    if (!inside)
        return ffd_status_exit_code(FFD_E_MEMORY);
    FILE *file = fopen(inside, "r");
    const bool missing = !file && (errno == ENOENT || errno == ENOTDIR);
    if (file)
        fclose(file);
    free(inside);
    if (!missing)
        return EXIT_DONE;
    cli_complain("%s: there is no such folder", folder);
    return ffd_status_exit_code(FFD_E_IO);
}

static int run_all(settings *s, const cli_words *inputs, ffd_report *report)
{
    int code = EXIT_DONE;
    for (size_t i = 0; i < inputs->count; i++) {
        const char *input = inputs->words[i];
        char *output = s->out_dir ? join(s->out_dir, name_of(input)) : NULL;
        if (s->out_dir && !output)
            return ffd_status_exit_code(FFD_E_MEMORY);
        const int own = run_job(s, input, output, report);
        free(output);
        if (own)
            code = inputs->count == 1 ? own : EXIT_NO;
    }
    return code;
}

/* Whether IN or OUT is meant for all words or for the first of two. */
static bool has_many(const settings *s)
{
    return s->in_place || s->out_dir;
}

static bool is_stream(const char *path)
{
    return strcmp(path, "-") == 0;
}

static const char *wrong_options(const settings *s, const cli_words *words)
{
    if (s->lattice_count == 0)
        return "no lattice is given (-l FILE)";
    if (s->in_place && s->out_dir)
        return "--in-place and --out-dir exclude each other";
    if (s->in_place && s->output_format)
        return "--in-place keeps the format: --output-format has no meaning";
    if (s->out_dir && !*s->out_dir)
        return "the name of the folder for --out-dir is empty";
    if (s->stable && !s->report)
        return "--report-stable needs --report";
    if (has_many(s))
        return words->count < 1 ? "needs at least one IN" : NULL;
    if (words->count < 2)
        return words->count ? "needs an OUT (or --out-dir, --in-place)" : "needs IN and OUT";
    return words->count > 2 ? "more than IN and OUT: several IN need --out-dir or --in-place" : NULL;
}

static const char *wrong_streams(const settings *s, const cli_words *words)
{
    const size_t inputs = has_many(s) ? words->count : 1;
    size_t meshes = 0, lattices = 0;
    for (size_t i = 0; i < inputs; i++)
        meshes += is_stream(words->words[i]);
    for (size_t i = 0; i < s->lattice_count; i++)
        lattices += is_stream(s->lattices[i]);
    if (meshes && s->out_dir)
        return "standard input has no name to be kept in --out-dir";
    if (meshes && s->in_place)
        return "standard input cannot be overwritten";
    if (meshes + lattices > 1 || (lattices && inputs > 1))
        return "standard input can be read only once";
    if (s->report && is_stream(s->report) && !has_many(s) && is_stream(words->words[1]))
        return "the mesh and the report cannot both go to standard output";
    return NULL;
}

/* A report replaces what stands under its name, which must not be a file of the job. */
static const char *wrong_report(const settings *s, const cli_words *words)
{
    if (!s->report || is_stream(s->report))
        return NULL;
    for (size_t i = 0; i < words->count; i++)
        if (strcmp(s->report, words->words[i]) == 0)
            return "the report would replace a mesh";
    for (size_t i = 0; i < s->lattice_count; i++)
        if (strcmp(s->report, s->lattices[i]) == 0)
            return "the report would replace a lattice";
    return NULL;
}

/* All that can be refused before the first job. Returns 0 or an exit code, after a complaint. */
static int refuse(const cli_command *command, const settings *s, const cli_words *words)
{
    const char *why = wrong_options(s, words);
    if (!why)
        why = wrong_streams(s, words);
    if (!why)
        why = wrong_report(s, words);
    if (why)
        return cli_usage(command, why);
    const size_t inputs = has_many(s) ? words->count : 1;
    for (size_t i = 0; i < inputs; i++)
        if (!cli_knows_format(words->words[i], s->input_format))
            return EXIT_USAGE;
    if (!has_many(s) && is_stream(words->words[1]) && !s->output_format) {
        cli_complain("standard output needs --output-format obj, gltf or glb");
        return EXIT_USAGE;
    }
    if (!has_many(s))
        return EXIT_DONE;
    const int code = refuse_equal_outputs(words, s->out_dir ? compare_names : compare_paths);
    return code || !s->out_dir || words->count == 1 ? code : refuse_missing_folder(s->out_dir);
}

static int run_jobs(settings *s, const cli_words *words)
{
    ffd_report *report = NULL;
    ffd_error error;
    int code = EXIT_DONE;
    if (ffd_written_create(&s->written, &error) ||
        (s->report && ffd_report_create(s->report, s->stable, s->written, &report, &error)))
        code = cli_fail(&error);
    else
        code = has_many(s) ? run_all(s, words, report) : run_job(s, words->words[0], words->words[1], report);
    if (report && ffd_report_write(report, &error)) {
        const int own = cli_fail(&error);
        code = code ? code : own;
    }
    ffd_report_destroy(&report);
    ffd_written_destroy(&s->written);
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
        code = refuse(command, &s, &words);
        if (!code)
            code = run_jobs(&s, &words);
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
