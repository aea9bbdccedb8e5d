#include "base/file/mapping.h"
#include "base/file/path.h"
#include "base/memory/memory.h"
#include "base/posix.h"
#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>

/* The signal handler reads the atomic members in any thread at any time; the lock protects the others. */
struct file_mapping {
    _Atomic uintptr_t begin; /* 0: this entry is free */
    _Atomic size_t size;
    atomic_bool is_cut; /* the file was read beyond its new end */
    bool is_counted;
    bool has_identity;
    uint64_t identity[2];
    char *path;
};

enum { BLOCK = 64 };

/* Blocks are never freed, because the handler may be reading them. */
typedef struct mapping_block {
    file_mapping mappings[BLOCK];
    struct mapping_block *_Atomic next;
} mapping_block;

static mapping_block first;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static unsigned losses;
static char lost[1024]; /* path of the file that was truncated last */

/* Returns a free entry; NULL if memory runs out. */
static file_mapping *find_place(void)
{
    mapping_block *block = &first;
    for (;; block = atomic_load(&block->next)) {
        for (int i = 0; i < BLOCK; i++)
            if (atomic_load(&block->mappings[i].begin) == 0)
                return &block->mappings[i];
        if (!atomic_load(&block->next)) {
            mapping_block *const more = ffd_alloc_zero(1, sizeof *more);
            atomic_store(&block->next, more);
            return more ? more->mappings : NULL;
        }
    }
}

file_mapping *ffd_mapping_note(const void *begin, size_t size, const char *path, const uint64_t identity[2])
{
    char *const copy = ffd_text_copy(path);
    if (!copy)
        return NULL;
    pthread_mutex_lock(&lock);
    file_mapping *const mapping = find_place();
    if (mapping) {
        atomic_store(&mapping->is_cut, false);
        mapping->is_counted = false;
        mapping->has_identity = identity != NULL;
        for (int i = 0; i < 2 && identity; i++)
            mapping->identity[i] = identity[i];
        mapping->path = copy;
        atomic_store(&mapping->size, size);
        atomic_store(&mapping->begin, (uintptr_t)begin);
    }
    pthread_mutex_unlock(&lock);
    if (!mapping)
        ffd_free(copy);
    return mapping;
}

/* Returns whether the file still exists at its path and is shorter than when it was mapped. */
static bool is_shorter(const file_mapping *mapping)
{
    struct stat info;
    return mapping->has_identity && stat(mapping->path, &info) == 0 &&
           (uint64_t)info.st_dev == mapping->identity[0] && (uint64_t)info.st_ino == mapping->identity[1] &&
           (uintmax_t)info.st_size < atomic_load(&mapping->size);
}

static void count(file_mapping *mapping)
{
    if (mapping->is_counted || !(atomic_load(&mapping->is_cut) || is_shorter(mapping)))
        return;
    mapping->is_counted = true;
    losses++;
    snprintf(lost, sizeof lost, "%s", mapping->path);
}

void ffd_mapping_forget(file_mapping *mapping)
{
    pthread_mutex_lock(&lock);
    count(mapping);
    atomic_store(&mapping->begin, 0);
    ffd_free(mapping->path);
    mapping->path = NULL;
    pthread_mutex_unlock(&lock);
}

static void count_all(void)
{
    for (mapping_block *block = &first; block; block = atomic_load(&block->next))
        for (int i = 0; i < BLOCK; i++)
            if (atomic_load(&block->mappings[i].begin) != 0)
                count(&block->mappings[i]);
}

unsigned ffd_mapping_losses(void)
{
    pthread_mutex_lock(&lock);
    count_all();
    const unsigned found = losses;
    pthread_mutex_unlock(&lock);
    return found;
}

ffd_status ffd_mapping_judge(unsigned before, ffd_status status, ffd_error *error)
{
    pthread_mutex_lock(&lock);
    count_all();
    if (losses != before)
        status = ffd_fail_file(error, FFD_E_IO, lost, "became shorter while it was read");
    pthread_mutex_unlock(&lock);
    return status;
}

size_t ffd_mapping_cut(uintptr_t address)
{
    for (mapping_block *block = &first; block; block = atomic_load(&block->next))
        for (int i = 0; i < BLOCK; i++) {
            file_mapping *const mapping = &block->mappings[i];
            const uintptr_t begin = atomic_load(&mapping->begin);
            const size_t size = atomic_load(&mapping->size);
            if (begin == 0 || address < begin || address - begin >= size)
                continue;
            atomic_store(&mapping->is_cut, true);
            return size - (address - begin);
        }
    return 0;
}
