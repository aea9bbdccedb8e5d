#define _DEFAULT_SOURCE /* getentropy */
#include "base/file/memory_files.h"
#include "base/file/path.h"
#include "base/memory/intern.h"
#include "base/memory/memory.h"
#include <pthread.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Paths are "ffd-memory:FILES/FOLDER/NAME"; FILES and FOLDER are the numbers of a memory_files and of one of
   its folders. Names from the caller may be absolute or contain "..": a path has only their last
   component. */
static const char scheme[] = "ffd-memory:";
#define SCHEME_SIZE (sizeof scheme - 1)
/* Capacity for a path up to its folder, with the final slash. */
#define HEAD_CAPACITY 64

/* A file that was added under a name, and further files in its folder. */
typedef struct memory_folder {
    char *name;  /* as the caller gave it */
    char *path;  /* of that file */
    char *shown; /* folder of the name for messages, with a final slash */
    size_t head; /* length of the path before the file name */
    memory_resolve *resolve;
    void *user;
} memory_folder;

typedef struct memory_bytes {
    const void *bytes; /* NULL: no file at this path */
    size_t size;
} memory_bytes;

struct memory_files {
    memory_files *next;
    uint64_t number;
    pthread_mutex_t lock; /* protects the members below */
    memory_folder **folders;
    size_t folder_count, folder_capacity;
    intern_table paths; /* normalized paths of files that were requested */
    memory_bytes *found;
    size_t found_capacity;
    ffd_error failure; /* the first failure of a resolve function, or FFD_E_MEMORY */
};

/* All existing objects, in any thread. Numbers start at a random one, so that a path in a file does not lead
   to another job's memory. */
static pthread_mutex_t all_lock = PTHREAD_MUTEX_INITIALIZER;
static memory_files *all;
static uint64_t last_number;

ffd_status ffd_memory_create(memory_files **files, ffd_error *error)
{
    memory_files *const made = ffd_alloc_zero(1, sizeof *made);
    *files = made;
    if (!made)
        return ffd_fail_memory(error);
    pthread_mutex_init(&made->lock, NULL);
    pthread_mutex_lock(&all_lock);
    if (!last_number && getentropy(&last_number, sizeof last_number) != 0)
        last_number = (uint64_t)(uintptr_t)made;
    made->number = ++last_number;
    made->next = all;
    all = made;
    pthread_mutex_unlock(&all_lock);
    return FFD_OK;
}

static void free_folder(memory_folder *folder)
{
    ffd_free(folder->name);
    ffd_free(folder->path);
    ffd_free(folder->shown);
    ffd_free(folder);
}

void ffd_memory_destroy(memory_files **files)
{
    if (!files || !*files)
        return;
    pthread_mutex_lock(&all_lock);
    memory_files **at = &all;
    while (*at != *files)
        at = &(*at)->next;
    *at = (*files)->next;
    pthread_mutex_unlock(&all_lock);
    for (size_t i = 0; i < (*files)->folder_count; i++)
        free_folder((*files)->folders[i]);
    ffd_free((*files)->folders);
    ffd_free((*files)->found);
    ffd_intern_free(&(*files)->paths);
    pthread_mutex_destroy(&(*files)->lock);
    ffd_free(*files);
    *files = NULL;
}

/* Returns the object that a path belongs to; NULL if it is not a path in memory. */
static memory_files *files_of(const char *path)
{
    if (strncmp(path, scheme, SCHEME_SIZE) != 0)
        return NULL;
    char *end;
    const uint64_t number = strtoull(path + SCHEME_SIZE, &end, 10);
    if (*end != '/')
        return NULL;
    pthread_mutex_lock(&all_lock);
    memory_files *files = all;
    while (files && files->number != number)
        files = files->next;
    pthread_mutex_unlock(&all_lock);
    return files;
}

bool ffd_memory_has(const char *path)
{
    return files_of(path) != NULL;
}

/* Returns the folder of a normalized path. */
static const memory_folder *folder_of(const memory_files *files, const char *path)
{
    for (size_t i = 0; i < files->folder_count; i++)
        if (strncmp(path, files->folders[i]->path, files->folders[i]->head) == 0)
            return files->folders[i];
    return NULL;
}

const char *ffd_memory_name(const char *path)
{
    const memory_files *const files = files_of(path);
    const memory_folder *const folder = files ? folder_of(files, path) : NULL;
    return folder && strcmp(folder->path, path) == 0 ? folder->name : NULL;
}

/* Records the result of a request, found or not. */
static ffd_status note(memory_files *files, const char *path, memory_bytes bytes, ffd_error *error)
{
    uint32_t number;
    if (!ffd_grow((void **)&files->found, &files->found_capacity, files->paths.count + 1,
                  sizeof *files->found) ||
        !ffd_intern(&files->paths, path, strlen(path), &number))
        return ffd_fail_memory(error);
    files->found[number] = bytes;
    return FFD_OK;
}

static memory_folder *make_folder(const memory_files *files, const char *name)
{
    memory_folder *const folder = ffd_alloc_zero(1, sizeof *folder);
    const char *const last = ffd_path_name(name);
    char head[HEAD_CAPACITY];
    if (!folder)
        return NULL;
    folder->head = (size_t)snprintf(head, sizeof head, "%s%llu/%zu/", scheme,
                                    (unsigned long long)files->number, files->folder_count);
    folder->name = ffd_text_copy(name);
    folder->path = ffd_path_join(head, last);
    folder->shown = ffd_text_copy(name);
    if (folder->name && folder->path && folder->shown) {
        folder->shown[last - name] = 0;
        return folder;
    }
    free_folder(folder);
    return NULL;
}

static ffd_status add_folder(memory_files *files, const char *name, memory_folder **folder, ffd_error *error)
{
    *folder = ffd_grow((void **)&files->folders, &files->folder_capacity, files->folder_count + 1,
                       sizeof(memory_folder *))
                  ? make_folder(files, name)
                  : NULL;
    if (!*folder)
        return ffd_fail_memory(error);
    files->folders[files->folder_count++] = *folder;
    return FFD_OK;
}

ffd_status ffd_memory_lend(memory_files *files, const char *name, const void *bytes, size_t size,
                           memory_resolve *resolve, void *user, const char **path, ffd_error *error)
{
    memory_folder *folder;
    const ffd_status status = add_folder(files, name, &folder, error);
    if (status)
        return status;
    folder->resolve = resolve;
    folder->user = user;
    *path = folder->path;
    return note(files, folder->path, (memory_bytes){bytes, size}, error);
}

void ffd_memory_show(const memory_files *files, char *text, size_t capacity)
{
    for (char *at = text; files && (at = strstr(at, scheme));) {
        const memory_folder *const folder = folder_of(files, at);
        if (!folder) {
            at += SCHEME_SIZE;
            continue;
        }
        const size_t length = strlen(at + folder->head), room = capacity - (size_t)(at - text) - 1;
        const size_t shown = strlen(folder->shown) < room ? strlen(folder->shown) : room;
        const size_t kept = length < room - shown ? length : room - shown;
        memmove(at + shown, at + folder->head, kept);
        memcpy(at, folder->shown, shown);
        at[shown + kept] = 0;
        at += shown;
    }
}

ffd_status ffd_memory_judge(const memory_files *files, ffd_status status, ffd_error *error)
{
    if (!files || !files->failure.status)
        return status;
    if (error)
        *error = files->failure;
    return files->failure.status;
}

ffd_status ffd_memory_judge_path(const char *path, ffd_status status, ffd_error *error)
{
    return ffd_memory_judge(files_of(path), status, error);
}

/* Calls the resolve function for a file that is not known yet. */
static ffd_status resolve(memory_files *files, const char *path, memory_bytes *bytes, ffd_error *error)
{
    const memory_folder *const folder = folder_of(files, path);
    *bytes = (memory_bytes){0};
    if (!folder || !folder->resolve || !path[folder->head])
        return FFD_OK;
    if (files->failure.status) /* the job will fail: no further calls */
        return ffd_memory_judge(files, FFD_OK, error);
    const char *const name = path + folder->head;
    const ffd_status status =
        ffd_status_known(folder->resolve(folder->user, name, &bytes->bytes, &bytes->size));
    if (!status)
        return note(files, path, *bytes, error);
    if (!files->failure.status)
        ffd_fail_file(&files->failure, status, folder->name, "the file \"%s\" was not given by the caller",
                      name);
    *bytes = (memory_bytes){0};
    return ffd_memory_judge(files, status, error);
}

ffd_status ffd_memory_find(const char *path, const void **bytes, size_t *size, ffd_error *error)
{
    memory_files *const files = files_of(path);
    char *const plain = ffd_path_normalize(path);
    memory_bytes found = {0};
    uint32_t number;
    ffd_status status = plain ? FFD_OK : ffd_fail_memory(error);
    if (files) {
        pthread_mutex_lock(&files->lock);
        if (plain && ffd_intern_find(&files->paths, plain, strlen(plain), &number))
            found = files->found[number];
        else if (plain)
            status = resolve(files, plain, &found, error);
        if (status == FFD_E_MEMORY &&
            !files->failure.status) /* record it, so that a caller who only tests for existence fails too */
            ffd_fail_memory(&files->failure);
        pthread_mutex_unlock(&files->lock);
    }
    ffd_free(plain);
    *bytes = found.bytes;
    *size = found.bytes ? found.size : 0;
    return status;
}
