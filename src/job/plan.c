/* plan.c - ffd_deform_check_many and ffd_output_path: the outputs of several jobs, and whether one reads what
   another one writes: its result would depend on their order. */
#include "base/file/folder.h"
#include "base/file/input.h"
#include "base/file/path.h"
#include "base/file/path_list.h"
#include "base/file/place.h"
#include "base/memory/file_table.h"
#include "base/memory/memory.h"
#include "io/format_names.h"
#include "io/formats.h"
#include "job/input/deform_desc.h"
#include "job/input/source.h"
#include "lattice/file/box_meshes.h"
#include <ffd/program.h>
#include <stdlib.h>
#include <string.h>

/* All zeros: no jobs. */
typedef struct job_plan {
    file_places places;
    file_table outputs;   /* number of the job that writes each */
    path_list inputs;     /* of the jobs, for messages */
    intern_table folders; /* places of the folders of outputs and of those above them */
    bool replaces;        /* an output exists already */
} job_plan;

/* Adds a folder and those above it, as far as they are new. */
static ffd_status add_folders(job_plan *plan, const char *path, ffd_error *error)
{
    char *folder = ffd_path_folder(path);
    char *resolved = folder ? ffd_path_resolve(folder) : NULL;
    char *at = resolved ? resolved : folder; /* a folder that is not there holds no mesh */
    ffd_status status;
    TRY_END(at ? FFD_OK : ffd_fail_memory(error));
    for (bool goes_on = resolved; goes_on;) {
        const hash128 place = ffd_place_of(&plan->places, at);
        const size_t known = plan->folders.count;
        uint32_t index;
        if (!ffd_intern(&plan->folders, &place, sizeof place, &index))
            TRY_END(ffd_fail_memory(error));
        char *const slash = strrchr(at, '/');
        goes_on = index == known && slash && at[1];
        if (goes_on)
            slash[slash == at] = 0;
    }
end:
    ffd_free(folder);
    ffd_free(resolved);
    return status;
}

/* Adds a job. */
static ffd_status add_job(job_plan *plan, const char *input, const char *output, ffd_error *error)
{
    const hash128 place = ffd_place_of(&plan->places, output);
    const size_t index = plan->inputs.count;
    uint64_t writer;
    if (ffd_files_find(&plan->outputs, &place, &writer))
        return ffd_fail_file(error, FFD_E_INVALID, input, "and %s would both write one file",
                             plan->inputs.paths[writer]);
    plan->replaces = plan->replaces || ffd_file_exists(output);
    TRY(ffd_paths_add(&plan->inputs, input, error));
    TRY(ffd_files_put(&plan->outputs, &place, index, error));
    return add_folders(plan, output, error);
}

/* Whether an output of the run lies in the folder of a mesh or below. */
static bool has_outputs_below(job_plan *plan, const char *mesh)
{
    char *const folder = ffd_path_folder(mesh), *const resolved = folder ? ffd_path_resolve(folder) : NULL;
    const hash128 place = resolved ? ffd_place_of(&plan->places, resolved) : (hash128){{0}};
    uint32_t index;
    ffd_free(folder);
    const bool found = !resolved || ffd_intern_find(&plan->folders, &place, sizeof place, &index);
    ffd_free(resolved);
    return found;
}

/* Finds which other job writes a file. */
static bool find_writer(job_plan *plan, size_t job, const char *file, uint64_t *writer)
{
    const hash128 place = ffd_place_of(&plan->places, file);
    return ffd_files_find(&plan->outputs, &place, writer) && *writer != job;
}

/* Checks a file that the mesh names and no job reads. */
static ffd_status check_linked(job_plan *plan, size_t job, const char *file, ffd_error *error)
{
    uint64_t writer;
    if (!find_writer(plan, job, file, &writer))
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_INVALID, plan->inputs.paths[job],
                         "names %s, which this run writes as the output of %s", file,
                         plan->inputs.paths[writer]);
}

/* of: the lattice that leads to the file; NULL: the mesh itself does. */
static ffd_status check_file(job_plan *plan, size_t job, const char *file, const char *of, ffd_error *error)
{
    uint64_t writer;
    if (!find_writer(plan, job, file, &writer))
        return FFD_OK;
    return ffd_fail_file(error, FFD_E_INVALID, plan->inputs.paths[job],
                         "reads %s%s%s%s, which this run writes as the output of %s: their order would count",
                         file, of ? " (for the box of " : "", of ? of : "", of ? ")" : "",
                         plan->inputs.paths[writer]);
}

/* Checks a file that every job reads. */
static ffd_status check_common(job_plan *plan, const char *file, const char *of, ffd_error *error)
{
    uint64_t writer;
    const hash128 place = ffd_place_of(&plan->places, file);
    const bool is_written = ffd_files_find(&plan->outputs, &place, &writer);
    return is_written && plan->inputs.count > 1 ? check_file(plan, writer == 0, file, of, error) : FFD_OK;
}

/* Adds a mesh and the files that it names; the first *read ones are those that a job reads or copies. */
static ffd_status list_mesh(const ffd_source *source, path_list *files, size_t *read, ffd_error *error)
{
    ffd_format format;
    file_input bytes;
    path_list linked = {0};
    ffd_status status = ffd_paths_add(files, source->path, error);
    *read = files->count;
    if (status || ffd_source_format(source, &format, NULL) || !ffd_format_table(format)->sidecars ||
        ffd_file_load(source->path, &bytes, NULL))
        return status;
    const mesh_named named = {.files = files, .linked = &linked};
    status = ffd_format_table(format)->resources->find_named(source->path, &bytes, &named, error);
    *read = files->count - linked.count;
    ffd_paths_free(&linked);
    ffd_file_unload(&bytes);
    return status;
}

/* Checks the files of a mesh that the box of a lattice goes round: every job reads them. */
static ffd_status check_box(job_plan *plan, const char *lattice, const char *mesh, ffd_error *error)
{
    const ffd_source source = {.path = mesh};
    path_list files = {0};
    size_t read;
    ffd_status status;
    TRY_END(list_mesh(&source, &files, &read, error));
    for (size_t i = 0; i < read; i++)
        TRY_END(check_common(plan, files.paths[i], lattice, error));
end:
    ffd_paths_free(&files);
    return status;
}

static ffd_status check_lattice(job_plan *plan, const char *lattice, ffd_error *error)
{
    path_list meshes = {0};
    file_input bytes;
    if (ffd_file_is_stream(lattice) || ffd_file_load(lattice, &bytes, NULL))
        return FFD_OK;
    ffd_status status;
    TRY_END(check_common(plan, lattice, NULL, error));
    TRY_END(ffd_lattice_box_meshes(lattice, &bytes, &meshes, error));
    for (size_t i = 0; i < meshes.count; i++)
        TRY_END(check_box(plan, lattice, meshes.paths[i], error));
end:
    ffd_file_unload(&bytes);
    ffd_paths_free(&meshes);
    return status;
}

/* Checks the mesh of a job. What a mesh names has the ending of no mesh, but that of a buffer may be any. */
static ffd_status check_mesh(job_plan *plan, size_t job, const ffd_source *source, ffd_error *error)
{
    path_list files = {0};
    size_t read = 1;
    ffd_status status;
    TRY_END(has_outputs_below(plan, source->path) ? list_mesh(source, &files, &read, error)
                                                  : ffd_paths_add(&files, source->path, error));
    for (size_t i = 0; i < read; i++)
        TRY_END(check_file(plan, job, files.paths[i], NULL, error));
    for (size_t i = read; i < files.count; i++)
        TRY_END(check_linked(plan, job, files.paths[i], error));
end:
    ffd_paths_free(&files);
    return status;
}

/* The output of a job, and its mesh. */
typedef struct named_output {
    const char *input, *output;
} named_output;

static int compare_outputs(const void *a, const void *b)
{
    return strcmp(((const named_output *)a)->output, ((const named_output *)b)->output);
}

static ffd_status refuse_equal(const named_output *a, const named_output *b, ffd_error *error)
{
    if (strcmp(a->input, b->input) == 0)
        return ffd_fail_file(error, FFD_E_ARGUMENT, a->input, "is named twice");
    return ffd_fail(error, FFD_E_ARGUMENT, "%s and %s would both be written as \"%s\"", a->input, b->input,
                    ffd_path_name(a->output));
}

/* Refuses outputs of one name: they would overwrite each other. */
static ffd_status check_names(const char *const *inputs, const char *const *outputs, size_t count,
                              ffd_error *error)
{
    named_output *const sorted = ffd_alloc(count, sizeof *sorted);
    ffd_status status;
    TRY_END(sorted ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < count; i++)
        sorted[i] = (named_output){inputs[i], outputs[i]};
    qsort(sorted, count, sizeof *sorted, compare_outputs);
    for (size_t i = 1; i < count; i++)
        if (compare_outputs(&sorted[i - 1], &sorted[i]) == 0)
            TRY_END(refuse_equal(&sorted[i - 1], &sorted[i], error));
end:
    ffd_free(sorted);
    return status;
}

static ffd_status check_files_of_all(job_plan *plan, const ffd_deform_desc *job, const char *const *inputs,
                                     const char *const *outputs, size_t count, ffd_error *error)
{
    ffd_source source = job->input;
    for (size_t i = 0; i < count; i++)
        TRY(add_job(plan, inputs[i], outputs[i], error));
    /* A mesh of a box that is not there yet fails all jobs. */
    for (size_t i = 0; i < job->lattice_count && plan->replaces && count > 0; i++)
        TRY(check_lattice(plan, job->lattices[i].path, error));
    for (size_t i = 0; i < count; i++) {
        source.path = inputs[i];
        TRY(check_mesh(plan, i, &source, error));
    }
    return FFD_OK;
}

ffd_status ffd_deform_check_many(const ffd_deform_desc *job, const char *const *inputs,
                                 const char *const *outputs, size_t count, ffd_error *error)
{
    ffd_deform_desc own;
    job_plan plan = {0};
    TRY(ffd_deform_desc_take(job, &own, error));
    const char *const *const written = outputs ? outputs : inputs;
    TRY(check_names(inputs, written, count, error));
    const ffd_status status = check_files_of_all(&plan, &own, inputs, written, count, error);
    ffd_places_free(&plan.places);
    ffd_files_free(&plan.outputs);
    ffd_intern_free(&plan.folders);
    ffd_paths_free(&plan.inputs);
    return status;
}

ffd_status ffd_output_path(const char *folder, const char *input, const char *ending, char **path,
                           ffd_error *error)
{
    const char *const name = ffd_path_name(input);
    char *const named = ending ? ffd_format_rename(name, ending) : ffd_text_copy(name);
    *path = named ? ffd_path_join(folder, named) : NULL;
    ffd_free(named);
    return *path ? FFD_OK : ffd_fail_memory(error);
}
