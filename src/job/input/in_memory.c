#include "job/input/in_memory.h"
#include "base/memory/memory.h"
#include <ffd/settings.h>
#include <stdio.h>
#include <string.h>

/* The longest line of the log, in bytes. */
#define LINE_CAPACITY 2048

struct memory_callback {
    memory_callback *next;
    ffd_resolve_function resolve;
    void *user;
};

static ffd_status resolve(void *user, const char *name, const void **data, size_t *size)
{
    const memory_callback *const callback = user;
    ffd_bytes bytes = {0};
    const ffd_status status = callback->resolve(callback->user, name, &bytes);
    *data = bytes.data;
    *size = bytes.size;
    return !status && !bytes.data && bytes.size > 0 ? FFD_E_ARGUMENT : status;
}

static ffd_status begin(job_memory *memory, ffd_error *error)
{
    return memory->files ? FFD_OK : ffd_memory_create(&memory->files, error);
}

static ffd_status check_bytes(const char *what, ffd_bytes bytes, ffd_error *error)
{
    if (bytes.data || bytes.size == 0)
        return FFD_OK;
    return ffd_fail(error, FFD_E_ARGUMENT, "the %zu bytes of %s are NULL", bytes.size, what);
}

ffd_status ffd_in_memory_source(job_memory *memory, ffd_source *source, ffd_error *error)
{
    const ffd_bytes bytes = source->bytes;
    const char *const name = source->path ? source->path : "mesh";
    ffd_status status = check_bytes(name, bytes, error);
    if (!status && source->resolve && !bytes.data)
        status =
            ffd_fail(error, FFD_E_ARGUMENT, "a resolve function is only for a mesh whose bytes are given");
    if (status || !bytes.data)
        return status;
    status = begin(memory, error);
    memory_callback *callback = NULL;
    if (!status && source->resolve) {
        callback = ffd_alloc_zero(1, sizeof *callback);
        if (!callback)
            return ffd_fail_memory(error);
        *callback = (memory_callback){memory->callbacks, source->resolve, source->resolve_user};
        memory->callbacks = callback;
    }
    if (!status)
        status = ffd_memory_lend(memory->files, name, bytes.data, bytes.size, callback ? resolve : NULL,
                                 callback, &source->path, error);
    source->bytes = (ffd_bytes){0}; /* the copy serves as options for the meshes that lattices name */
    source->resolve = NULL;
    return status;
}

ffd_status ffd_in_memory_bytes(job_memory *memory, ffd_bytes bytes, const char *name, const char **path,
                               ffd_error *error)
{
    ffd_status status = check_bytes(*path ? *path : name, bytes, error);
    if (status || !bytes.data)
        return status;
    status = begin(memory, error);
    return status ? status
                  : ffd_memory_lend(memory->files, *path ? *path : name, bytes.data, bytes.size, NULL, NULL,
                                    path, error);
}

ffd_status ffd_in_memory_output(job_memory *memory, ffd_sink_function sink, void *user, const char **output,
                                ffd_error *error)
{
    if (!sink || !*output)
        return FFD_OK;
    const ffd_status status = begin(memory, error);
    return status ? status : ffd_memory_take(memory->files, *output, sink, user, output, error);
}

static void send_line(void *user, ffd_log_level level, const char *line)
{
    const job_memory *const memory = user;
    char shown[LINE_CAPACITY];
    snprintf(shown, sizeof shown, "%s", line);
    ffd_memory_show(memory->files, shown, sizeof shown);
    memory->log(memory->log_user, level, shown);
}

void ffd_in_memory_log(job_memory *memory, ffd_log_function *log, void **user)
{
    if (!memory->files || !*log)
        return;
    memory->log = *log;
    memory->log_user = *user;
    *log = send_line;
    *user = memory;
}

/* Registers lattices that are objects or texts under names of their own, so that no file is meant. */
static ffd_status name_lattices(job_memory *memory, ffd_deform_desc *desc, ffd_error *error)
{
    static const char nothing[1] = "";
    if ((!desc->lattice_objects && !desc->lattice_texts) || desc->lattice_count == 0)
        return FFD_OK;
    memory->lattices = ffd_alloc_zero(desc->lattice_count, sizeof *memory->lattices);
    ffd_status status = memory->lattices ? FFD_OK : ffd_fail_memory(error);
    for (size_t i = 0; i < desc->lattice_count && !status; i++) {
        const bool is_object = desc->lattice_objects && desc->lattice_objects[i];
        ffd_bytes bytes = desc->lattice_texts ? desc->lattice_texts[i] : (ffd_bytes){0};
        char name[40];
        snprintf(name, sizeof name, "lattice %zu", i + 1);
        memory->lattices[i] = desc->lattices ? desc->lattices[i] : NULL;
        if (is_object && bytes.data)
            status = ffd_fail(error, FFD_E_ARGUMENT, "%s is given as an object and as a text", name);
        if (is_object)
            bytes = (ffd_bytes){nothing, 0};
        if (!status)
            status = ffd_in_memory_bytes(memory, bytes, name, &memory->lattices[i], error);
        if (!status && !memory->lattices[i])
            status = ffd_fail(error, FFD_E_ARGUMENT, "%s is neither a file nor an object nor a text", name);
    }
    desc->lattices = memory->lattices;
    desc->lattice_texts = NULL;
    return status;
}

ffd_status ffd_in_memory_desc(job_memory *memory, ffd_deform_desc *desc, ffd_error *error)
{
    ffd_status status = ffd_deform_desc_check(desc, error);
    if (!status)
        status = ffd_in_memory_source(memory, &desc->input, error);
    if (!status)
        status = name_lattices(memory, desc, error);
    if (!status)
        status = ffd_in_memory_bytes(memory, desc->embedding_bytes, "embedding", &desc->embedding, error);
    desc->embedding_bytes = (ffd_bytes){0};
    if (!status)
        status = ffd_in_memory_output(memory, desc->sink, desc->sink_user, &desc->output, error);
    if (desc->sink)
        desc->written = NULL;
    ffd_in_memory_log(memory, &desc->log, &desc->log_user);
    return status;
}

ffd_status ffd_in_memory_judge(const job_memory *memory, ffd_status status, ffd_error *error)
{
    status = ffd_memory_judge(memory->files, status, error);
    if (status && error) {
        ffd_memory_show(memory->files, error->file, sizeof error->file);
        ffd_memory_show(memory->files, error->message, sizeof error->message);
    }
    return status;
}

void ffd_in_memory_end(job_memory *memory)
{
    while (memory->callbacks) {
        memory_callback *const next = memory->callbacks->next;
        ffd_free(memory->callbacks);
        memory->callbacks = next;
    }
    ffd_memory_destroy(&memory->files);
    ffd_free(memory->lattices);
    *memory = (job_memory){0};
}
