#include "job/input/in_memory.h"
#include "base/fail.h"
#include "base/file/output.h"
#include "base/memory/memory.h"
#include <ffd/settings.h>
#include <stdio.h>

static ffd_status check_bytes(const char *what, ffd_bytes bytes, ffd_error *error)
{
    if (bytes.data || bytes.size == 0)
        return FFD_OK;
    return ffd_fail(error, FFD_E_ARGUMENT, "the %zu bytes of %s are NULL", bytes.size, what);
}

ffd_status ffd_in_memory_bytes(ffd_bytes bytes, const char *name, const char **path, ffd_error *error)
{
    const char *const own = *path ? *path : name;
    TRY(check_bytes(own, bytes, error));
    if (!bytes.data)
        return FFD_OK;
    *path = own;
    return ffd_file_check_name(own, error);
}

ffd_status ffd_in_memory_source(job_memory *memory, ffd_source *source, ffd_error *error)
{
    TRY(ffd_in_memory_bytes(source->bytes, "mesh", &source->path, error));
    if (source->resolve && !source->bytes.data)
        return ffd_fail(error, FFD_E_ARGUMENT, "a resolve function is only for a mesh whose bytes are given");
    if (!source->bytes.data)
        return FFD_OK;
    const ffd_status added = ffd_memory_add(&memory->files, source, error);
    source->resolve = ffd_memory_find;
    source->resolve_user = memory->files;
    return added;
}

ffd_status ffd_in_memory_output(ffd_sink_function sink, const char *output, ffd_error *error)
{
    return sink && output ? ffd_file_check_name(output, error) : FFD_OK;
}

ffd_status ffd_in_memory_lattice(ffd_lattice_source *lattice, const char *what, const char *name,
                                 ffd_error *error)
{
    const ffd_bytes text = lattice->text;
    if (lattice->object && text.data)
        return ffd_fail(error, FFD_E_ARGUMENT, "%s is given as an object and as a text", what);
    TRY(check_bytes(lattice->path ? lattice->path : name, text, error));
    if ((!lattice->object && !text.data))
        return FFD_OK;
    lattice->path = lattice->path ? lattice->path : name;
    return ffd_file_check_name(lattice->path, error);
}

/* Names the lattices that have no path. */
static ffd_status name_lattices(job_memory *memory, ffd_deform_desc *desc, ffd_error *error)
{
    if (!desc->lattices || desc->lattice_count == 0)
        return FFD_OK;
    memory->lattices = ffd_alloc(desc->lattice_count, sizeof *memory->lattices);
    memory->names = ffd_alloc(desc->lattice_count, sizeof *memory->names);
    ffd_status status;
    TRY_END(memory->lattices && memory->names ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < desc->lattice_count; i++) {
        char *const name = memory->names[i];
        memory->lattices[i] = desc->lattices[i];
        snprintf(name, sizeof memory->names[i], "lattice %zu", i + 1);
        TRY_END(ffd_in_memory_lattice(&memory->lattices[i], name, name, error));
        if (!memory->lattices[i].path)
            TRY_END(ffd_fail(error, FFD_E_ARGUMENT, "%s is neither a file nor an object nor a text", name));
    }
end:
    desc->lattices = memory->lattices;
    return status;
}

ffd_status ffd_in_memory_desc(job_memory *memory, ffd_deform_desc *desc, ffd_error *error)
{
    ffd_status status;
    TRY_END(ffd_deform_desc_check(desc, error));
    TRY_END(ffd_in_memory_source(memory, &desc->input, error));
    TRY_END(name_lattices(memory, desc, error));
    TRY_END(ffd_in_memory_bytes(desc->embedding.bytes, "embedding", &desc->embedding.path, error));
    TRY_END(ffd_in_memory_bytes(desc->weight.bytes, "weight.npy", &desc->weight.source, error));
    TRY_END(ffd_in_memory_output(desc->sink, desc->output, error));
end:
    if (desc->sink)
        desc->output_set = NULL;
    return status;
}

ffd_status ffd_in_memory_judge(const ffd_source *source, ffd_status status, ffd_error *error)
{
    return source->resolve == ffd_memory_find ? ffd_memory_judge(source->resolve_user, status, error)
                                              : status;
}

ffd_status ffd_in_memory_end(job_memory *memory, ffd_status status, ffd_error *error)
{
    status = ffd_memory_judge(memory->files, status, error);
    ffd_memory_free(&memory->files);
    ffd_free(memory->lattices);
    ffd_free(memory->names);
    *memory = (job_memory){0};
    return status;
}
