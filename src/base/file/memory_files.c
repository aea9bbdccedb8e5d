#include "base/file/memory_files.h"
#include "base/fail.h"
#include "base/file/path.h"
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include <pthread.h>
#include <string.h>

struct memory_files {
    memory_files *next;
    ffd_source mesh;      /* as the caller gave it, with a name */
    pthread_mutex_t lock; /* protects the members below */
    intern_table names;   /* of files that were asked for, normalized */
    ffd_bytes *found;     /* data NULL: there is no such file */
    size_t capacity;
    ffd_error failure; /* the first failure of the callback, or FFD_E_MEMORY */
};

/* Asks the caller for a file, and notes the answer. */
static ffd_status ask(memory_files *files, const char *name, ffd_bytes *bytes)
{
    uint32_t index;
    ffd_status status = FFD_OK;
    if (strcmp(name, ffd_path_name(files->mesh.path)) == 0)
        *bytes = files->mesh.bytes;
    else if (files->mesh.resolve)
        status = ffd_status_known(files->mesh.resolve(files->mesh.resolve_user, name, bytes));
    if (!status && !bytes->data && bytes->size > 0)
        status = FFD_E_ARGUMENT;
    if (status)
        return ffd_fail_file(&files->failure, status, files->mesh.path,
                             "the file \"%s\" was not given by the caller", name);
    if (!ffd_grow((void **)&files->found, &files->capacity, files->names.count + 1, sizeof *files->found) ||
        !ffd_intern(&files->names, name, strlen(name), &index))
        return ffd_fail_memory(&files->failure);
    files->found[index] = *bytes;
    return FFD_OK;
}

/* A job whose callback has failed will fail: there are no further calls. */
ffd_status ffd_memory_find(void *user, const char *relative, ffd_bytes *bytes)
{
    memory_files *const files = user;
    char *const name = ffd_path_normalize(relative);
    const bool is_inside = name && *name && !ffd_path_is_absolute(name) && !ffd_path_leads_out(name);
    uint32_t index;
    *bytes = (ffd_bytes){0};
    pthread_mutex_lock(&files->lock);
    if (!name && !files->failure.status)
        ffd_fail_memory(&files->failure);
    ffd_status status = files->failure.status;
    if (!status && is_inside && ffd_intern_find(&files->names, name, strlen(name), &index))
        *bytes = files->found[index];
    else if (!status && is_inside)
        status = ask(files, name, bytes);
    if (status)
        *bytes = (ffd_bytes){0};
    pthread_mutex_unlock(&files->lock);
    ffd_free(name);
    return status;
}

ffd_status ffd_memory_add(memory_files **list, const ffd_source *mesh, ffd_error *error)
{
    memory_files *const files = ffd_alloc_zero(1, sizeof *files);
    if (!files)
        return ffd_fail_memory(error);
    files->mesh = *mesh;
    files->next = *list;
    *list = files;
    pthread_mutex_init(&files->lock, NULL);
    return FFD_OK;
}

ffd_status ffd_memory_judge(const memory_files *list, ffd_status status, ffd_error *error)
{
    for (; list; list = list->next)
        if (list->failure.status) {
            status = list->failure.status;
            if (error)
                *error = list->failure;
        }
    return status;
}

void ffd_memory_free(memory_files **list)
{
    while (*list) {
        memory_files *const files = *list;
        *list = files->next;
        ffd_intern_free(&files->names);
        ffd_free(files->found);
        pthread_mutex_destroy(&files->lock);
        ffd_free(files);
    }
}
