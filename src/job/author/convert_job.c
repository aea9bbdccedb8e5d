/* convert_job.c - the job of `ffd lattice convert`. */
#include "author/part.h"
#include "base/file/mapping.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/text/words.h"
#include "job/author/author_job.h"
#include "job/chain/lattice_memory.h"
#include "lattice/build.h"
#include "lattice/file/lattice_source.h"
#include "lattice/table/table.h"
#include <stdio.h>
#include <string.h>

typedef enum lattice_format { FORMAT_UNKNOWN, FORMAT_JSON, FORMAT_CSV, FORMAT_NPY } lattice_format;

void ffd_lattice_convert_desc_init(ffd_lattice_convert_desc *desc, size_t size)
{
    const ffd_lattice_convert_desc defaults = {.struct_size = sizeof defaults};
    ffd_struct_give(&defaults, sizeof defaults, desc, size);
}

static lattice_format format_of(const char *name)
{
    return ffd_path_has_ending(name, ".csv")                              ? FORMAT_CSV
           : ffd_path_has_ending(name, ".npy")                            ? FORMAT_NPY
           : strcmp(name, "-") == 0 || ffd_path_has_ending(name, ".json") ? FORMAT_JSON
                                                                          : FORMAT_UNKNOWN;
}

/* An object, and a text that has no name of its own, is JSON. */
static lattice_format source_format(const ffd_lattice_source *source)
{
    const bool is_in_memory = source->object || source->text.data;
    const lattice_format format = format_of(source->path);
    return source->object || (is_in_memory && format == FORMAT_UNKNOWN) ? FORMAT_JSON : format;
}

static ffd_status refuse_ending(const char *name, const char *what, ffd_error *error)
{
    return ffd_fail_file(error, FFD_E_ARGUMENT, name,
                         "has no ending of a lattice that is %s: .json, .csv or .npy", what);
}

/* What only JSON has. */
static ffd_status check_table(const author_job *job, ffd_error *error)
{
    if (job->set_count > 0)
        return ffd_fail_file(error, FFD_E_ARGUMENT, job->lattices[0].path,
                             "has no placeholders: {set} is not for it");
    if (job->mesh_count > 0)
        return ffd_fail_file(error, FFD_E_ARGUMENT, job->lattices[0].path,
                             "does not go round a mesh: {meshes} is not for it");
    return ffd_author_check(job, error);
}

static ffd_status read_spec(const author_job *job, lattice_format format,
                            const ffd_lattice_convert_desc *desc, memory_budget *budget, lattice_spec **spec,
                            ffd_error *error)
{
    const ffd_lattice_source *const source = &job->lattices[0];
    table_wish wish;
    file_input file;
    memcpy(wish.size, desc->size, sizeof wish.size);
    memcpy(wish.degree, desc->degree, sizeof wish.degree);
    TRY(ffd_file_take(source->path, source->text, &file, error));
    ffd_status status = format == FORMAT_CSV ? ffd_lattice_read_csv(&file, source->path, &wish, spec, error)
                                             : ffd_lattice_read_npy(&file, source->path, &wish, spec, error);
    if (!status)
        status = ffd_lattice_memory_take(budget, *spec, file.size, error);
    ffd_file_unload(&file);
    return status;
}

static ffd_status read_table(const author_job *job, lattice_format format,
                             const ffd_lattice_convert_desc *desc, author_input *input, ffd_error *error)
{
    const unsigned losses = ffd_mapping_losses();
    lattice_spec *spec = NULL;
    ffd_status status;
    *input = (author_input){.memory = ffd_budget_make(job->reading->memory)};
    TRY_END(check_table(job, error));
    TRY_END(ffd_mapping_judge(losses, read_spec(job, format, desc, &input->memory, &spec, error), error));
    input->lattices = ffd_alloc_zero(1, sizeof *input->lattices);
    TRY_END(input->lattices ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_spec_build(spec, NULL, &input->lattices[0], error));
    input->count = 1;
    spec = NULL;
end:
    ffd_spec_free(spec);
    return status;
}

static ffd_status read_json(const author_job *job, const ffd_lattice_convert_desc *desc, author_input *input,
                            ffd_error *error)
{
    for (int a = 0; a < 3; a++) {
        if (desc->size[a])
            return ffd_fail_file(error, FFD_E_ARGUMENT, job->lattices[0].path,
                                 "tells its size itself: {size} is not for it");
        if (desc->degree[a])
            return ffd_fail_file(error, FFD_E_ARGUMENT, job->lattices[0].path,
                                 "tells its degree itself: {degree} is not for it");
    }
    return ffd_author_begin(job, input, error);
}

/* An array holds one state. */
static ffd_status choose_part(lattice_format format, const ffd_lattice *lattice, const char *output,
                              ffd_lattice_part *part, ffd_error *error)
{
    if (format != FORMAT_NPY) {
        *part = *part == FFD_PART_DEFAULT ? FFD_PART_BOTH : *part;
        return FFD_OK;
    }
    if (*part == FFD_PART_BOTH || (*part == FFD_PART_DEFAULT && !ffd_lattice_is_still(lattice)))
        return ffd_fail_file(
            error, FFD_E_ARGUMENT, output,
            "holds one state of a lattice, and this one is deformed: choose rest or deformed "
            "({part})");
    *part = *part == FFD_PART_DEFAULT ? FFD_PART_REST : *part;
    return FFD_OK;
}

/* Names what an array does not hold, and what it is read as. */
static void warn_of_losses(const author_job *job, const ffd_lattice *made)
{
    char name[100], lost[80] = "";
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &made->knots[a];
        const char *const what = ffd_knots_closed(knots) ? "closed knots" : "knots";
        const bool is_default =
            knots->kind == KNOTS_CLAMPED && knots->degree == ffd_lattice_table_degree(made->size[a]);
        const size_t used = strlen(lost);
        if (!is_default)
            snprintf(lost + used, sizeof lost - used, "%s%s of %c", used ? ", " : "", what, "uvw"[a]);
    }
    const size_t used = strlen(lost);
    if (made->rest_weights)
        snprintf(lost + used, sizeof lost - used, "%sweights", used ? ", " : "");
    if (!lost[0])
        return;
    ffd_name_shown(job->output, name, sizeof name);
    ffd_log_line(
        &job->log, FFD_LOG_WARNING,
        "%s: an array holds positions alone, not the %s: it is read as clamped uniform, without weights, "
        "of degree min(3, n - 1)",
        name, lost);
}

static ffd_status write_table(const author_job *job, lattice_format format, const ffd_lattice *made,
                              ffd_error *error)
{
    file_output *output;
    ffd_status status;
    if (!made->rest)
        return ffd_fail(error, FFD_E_INVALID,
                        "the box of the lattice is that of a mesh, and a table needs positions ({meshes})");
    TRY(ffd_author_output(job, &output, error));
    TRY_END(ffd_output_begin(output, job->output, job->force, error));
    TRY_END(format == FORMAT_CSV ? ffd_lattice_write_csv(made, output, error)
                                 : ffd_lattice_write_npy(made, FFD_VOLUME_REST, output, error));
    TRY_END(ffd_output_commit(output, error));
    if (format == FORMAT_NPY)
        warn_of_losses(job, made);
end:
    ffd_output_destroy(&output);
    return status;
}

static ffd_status convert(const author_job *job, const ffd_lattice_convert_desc *desc, ffd_error *error)
{
    const lattice_format from = source_format(&job->lattices[0]), to = format_of(job->output);
    ffd_lattice_part part = desc->part;
    author_input input = {0};
    ffd_lattice *made = NULL;
    ffd_status status;
    TRY_END(from == FORMAT_UNKNOWN ? refuse_ending(job->lattices[0].path, "read", error) : FFD_OK);
    TRY_END(to == FORMAT_UNKNOWN ? refuse_ending(job->output, "written", error) : FFD_OK);
    TRY_END(from == FORMAT_JSON ? read_json(job, desc, &input, error)
                                : read_table(job, from, desc, &input, error));
    const ffd_lattice *const lattice = input.lattices[0];
    TRY_END(choose_part(to, lattice, job->output, &part, error));
    TRY_END(lattice->spec ? ffd_lattice_memory_take(&input.memory, lattice->spec, 0, error) : FFD_OK);
    TRY_END(ffd_lattice_take_part(lattice, part, &made, error));
    TRY_END(to == FORMAT_JSON ? ffd_author_write(job, made, error) : write_table(job, to, made, error));
end:
    if (status && status != FFD_E_ARGUMENT)
        ffd_fail_name_file(error, job->lattices[0].path);
    ffd_lattice_destroy(&made);
    ffd_author_end(&input);
    return status;
}

static ffd_status run(const ffd_lattice_convert_desc *desc, job_memory *memory, ffd_error *error)
{
    ffd_source *meshes = NULL;
    ffd_lattice_source lattice = desc->lattice;
    ffd_status status;
    TRY_END(desc->part >= FFD_PART_DEFAULT && desc->part <= FFD_PART_DEFORMED
                ? FFD_OK
                : ffd_fail(error, FFD_E_ARGUMENT, "there is no part %d of a lattice", (int)desc->part));
    TRY_END(ffd_in_memory_lattice(&lattice, "the lattice", "lattice", error));
    TRY_END(ffd_author_take_meshes(memory, desc->meshes, desc->mesh_count, &meshes, error));
    TRY_END(ffd_in_memory_output(desc->sink, desc->output, error));
    TRY_END(lattice.path && desc->output
                ? FFD_OK
                : ffd_fail(error, FFD_E_ARGUMENT, "the job's description is not complete"));
    const author_job job = {.lattices = &lattice,
                            .lattice_count = 1,
                            .set = desc->set,
                            .set_count = desc->set_count,
                            .meshes = meshes,
                            .mesh_count = desc->mesh_count,
                            .only = desc->only,
                            .only_count = desc->only_count,
                            .reading = &desc->reading,
                            .output = desc->output,
                            .force = desc->force,
                            .output_set = desc->output_set,
                            .log = {desc->log, desc->log_user},
                            .sink = desc->sink,
                            .sink_user = desc->sink_user};
    TRY_END(convert(&job, desc, error));
end:
    ffd_free(meshes);
    return status;
}

ffd_status ffd_lattice_convert_run(const ffd_lattice_convert_desc *callers, ffd_error *error)
{
    ffd_lattice_convert_desc desc;
    ffd_lattice_convert_desc_init(&desc, sizeof desc);
    TRY(ffd_struct_take(&desc, sizeof desc, callers, "ffd_lattice_convert_desc", error));
    job_memory memory = {0};
    const ffd_status status = run(&desc, &memory, error);
    return ffd_in_memory_end(&memory, status, error);
}
