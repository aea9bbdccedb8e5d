/* mesh_trial.c - opens the bytes of a mesh, and deforms and saves it. */
#include "mesh_trial.h"
#include "io/formats.h"
#include "job/chain/chain_load.h"
#include "job/deform_job.h"
#include "promise.h"
#include <string.h>

bool trial_is_gltf(ffd_format format)
{
    return format == FFD_FORMAT_GLTF || format == FFD_FORMAT_GLB;
}

void trial_refusal(ffd_status status, const ffd_error *error)
{
    PROMISE(status == FFD_E_INVALID || status == FFD_E_LIMIT || status == FFD_E_UNSUPPORTED ||
                status == FFD_E_IO || status == FFD_E_MEMORY,
            "status %d: %s", status, error->message);
    PROMISE(error->status == status && error->message[0] && !strpbrk(error->message, "\r\n"),
            "status %d says '%s'", status, error->message);
}

mesh_document *trial_open(const trial *of, const char *name, const uint8_t *data, size_t size,
                          unsigned char **block, ffd_error *error)
{
    char path[WORK_PATH];
    work_path(name, path);
    unsigned char *const copy = malloc(size > 0 ? size : 1);
    PROMISE(copy, "no memory");
    memcpy(copy, data, size);
    file_input input = {.data = copy, .size = size, .block = copy};
    const ffd_source source = {.path = path, .format = of->format, .space = of->space};
    mesh_document *document = NULL;
    const ffd_status status =
        ffd_format_open(ffd_format_table(of->format), &input, &source, &document, error);
    if (status) {
        trial_refusal(status, error);
        PROMISE(!document, "a document in spite of status %d", status);
        ffd_file_unload(&input);
    } else if (block) {
        *block = copy;
    }
    return document;
}

mesh_document *trial_open_again(const trial *of, const char *name, const uint8_t *data, size_t size)
{
    ffd_error error = {0};
    mesh_document *const document = trial_open(of, name, data, size, NULL, &error);
    PROMISE(document, "%s is refused: %s: %s", name, error.pointer, error.message);
    return document;
}

static ffd_status save(const trial *of, const deform_job *job, ffd_error *error)
{
    char path[WORK_PATH];
    work_path(of->output, path);
    const mesh_save_options options = {.path = path, .format = of->format, .force = true};
    file_output *output;
    ffd_status status = ffd_output_create(&output, error);
    if (!status)
        status = job->document->format->save(job->document, &options, output, &job->log, error);
    if (!status)
        status = ffd_output_commit(output, error);
    ffd_output_destroy(&output);
    return status;
}

bool trial_deform(const trial *of, mesh_document *document, uint64_t *moved)
{
    const ffd_lattice_source lattices[] = {{.path = of->lattice}};
    ffd_deform_desc desc;
    ffd_job_result result = {.struct_size = sizeof result};
    deform_job job;
    ffd_deform_desc_init(&desc, sizeof desc);
    desc.input.path = of->input;
    desc.input.space = of->space;
    desc.lattices = lattices;
    desc.lattice_count = 1;
    desc.normals = of->normals;
    desc.rig = of->rig;
    desc.threads = 1;
    ffd_status status = ffd_deform_job_begin(&job, &desc, false, &result);
    job.document = document;
    if (!status)
        status = ffd_chain_load(&(chain_files){.lattices = lattices, .count = 1}, &(chain_outside){0},
                                FFD_ISA_AUTO, NULL, &job.chain, &result.error);
    PROMISE(!status, "%s", result.error.message);
    status = ffd_deform_job_run(&job, &result, &result.error);
    if (!status)
        status = save(of, &job, &result.error);
    if (status)
        trial_refusal(status, &result.error);
    *moved = result.moved;
    return ffd_deform_job_end(&job, status, &result, NULL) == FFD_OK;
}
