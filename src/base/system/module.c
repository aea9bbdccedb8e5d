#define _GNU_SOURCE /* RTLD_DEEPBIND, RTLD_DEFAULT, MAP_ANONYMOUS */
#include "base/system/module.h"
#include "base/spelling.h"
#include "base/system/deadline.h"
#include "base/system/own_file.h"
#include "base/system/thread_local.h"
#include <dlfcn.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#define MODULE_BYTES ((size_t)16 << 20)
#define THREAD_BYTES ((size_t)64 << 10)

/* The folders of modules: absolute, or relative to the folder of the program or library that this is linked
   into. */
static const char *const folders[] = {FFD_MODULE_FOLDERS};

/* The modules whose libraries are the system's, and not compiled into them. */
static const char *const deep[] = {FFD_DEEP_MODULES};

/* Returns whether this much memory is available, without touching it as an allocation could. */
static bool has_memory(size_t bytes)
{
    void *const mapped = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    return mapped != MAP_FAILED && munmap(mapped, bytes) == 0;
}

static bool is_wanted(const module_identity *found, const module_identity *wanted)
{
    return strcmp(found->file, wanted->file) == 0 && strcmp(found->version, wanted->version) == 0 &&
           found->interface == wanted->interface;
}

/* found: the identity that the module claims; NULL: none. */
static ffd_status refuse_module(const char *path, const module_identity *found, const module *of,
                                ffd_error *error)
{
    char is[120] = "no module of ffd";
    if (found)
        snprintf(is, sizeof is, "%.40s %.40s (%lu)", found->file, found->version,
                 (unsigned long)found->interface);
    return ffd_fail(error, FFD_E_UNSUPPORTED, "%s is %s, and not %s %s (%lu), which is needed for %s", path,
                    is, of->wanted.file, of->wanted.version, (unsigned long)of->wanted.interface, of->what);
}

/* How names are found that a module does not define itself. The loader looks in the program and in what it
   was started with first: there, functions of other versions can have the names of those that the libraries
   of a module have, and call each other by. With RTLD_DEEPBIND the module's own libraries come first. Only
   the functions that allocate memory are still those of the process (base/memory/process_allocator.h). The
   runtime of a sanitizer must come first, and ends the program at this flag. */
static int binding_of(const char *file)
{
#ifdef RTLD_DEEPBIND
    for (size_t i = 0; i < sizeof deep / sizeof *deep; i++)
        if (strcmp(deep[i], file) == 0 && !dlsym(RTLD_DEFAULT, "__sanitizer_set_report_path"))
            return RTLD_DEEPBIND;
#endif
    (void)deep;
    (void)file;
    return 0;
}

/* Checks that memory suffices for the module and its libraries before it loads them: libraries that run out
   of memory while they are loaded abort the program, and the loader gives reasons only as text without fixed
   wording. A module that is refused is not closed: another part of the process may have loaded the same
   file. */
static ffd_status open_module(const module *of, const module_head **head, ffd_error *error)
{
    char path[LONGEST_PATH];
    bool is_known;
    if (!has_memory(MODULE_BYTES))
        return ffd_fail_memory(error);
    if (!ffd_find_near(folders, sizeof folders / sizeof *folders, of->wanted.file, path, &is_known))
        return ffd_fail(error, FFD_E_UNSUPPORTED,
                        "the module for %s cannot be loaded: %s: is no file, or one of another user, or one "
                        "that everybody may change",
                        of->what, path);
    void *const handle = dlopen(path, RTLD_NOW | RTLD_LOCAL | binding_of(of->wanted.file));
    if (!handle) {
        const char *const reason = dlerror();
        return ffd_fail(error, FFD_E_UNSUPPORTED, "the module for %s cannot be loaded: %s%s", of->what,
                        reason ? reason : "no reason is given",
                        is_known ? "" : "; the folder of ffd is not known, or its path is too long");
    }
    *head = dlsym(handle, MODULE_SYMBOL);
    if (*head && is_wanted(&(*head)->identity, &of->wanted)) {
        (*head)->spell_members(ffd_spelling());
        (*head)->ask(ffd_deadline_check);
        return FFD_OK;
    }
    const ffd_status status = refuse_module(path, *head ? &(*head)->identity : NULL, of, error);
    *head = NULL;
    return status;
}

/* Prepares the calling thread once, since there is at most one C++ runtime. Returns false if memory is
   short. */
static bool prepare_thread(const module_head *head)
{
    static _Thread_local bool is_prepared FFD_ALLOCATED_WITH_THREAD;
    if (is_prepared || !head->prepare)
        return true;
    if (!has_memory(THREAD_BYTES))
        return false;
    head->prepare();
    is_prepared = true;
    return true;
}

static ffd_status load_once(module *of, const module_head **head, ffd_error *error)
{
    static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
    pthread_mutex_lock(&lock);
    *head = atomic_load(&of->head);
    ffd_status status = FFD_OK;
    if (!*head)
        TRY_END(open_module(of, head, error));
    atomic_store(&of->head, *head);
end:
    pthread_mutex_unlock(&lock);
    return status;
}

ffd_status ffd_module_load(module *of, const module_head **head, ffd_error *error)
{
    *head = atomic_load(&of->head);
    TRY(*head ? FFD_OK : load_once(of, head, error));
    if (!prepare_thread(*head))
        return ffd_fail_memory(error);
    return FFD_OK;
}
