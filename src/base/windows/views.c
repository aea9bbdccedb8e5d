#include "base/windows/views.h"
#include "base/windows/names.h"
#include "base/windows/posix.h"
#include <pthread.h>
#include <windows.h>

typedef struct view {
    struct view *next;
    void *at;
    size_t size;
    uint64_t identity[2];
    bool is_copy; /* in memory, by VirtualAlloc */
} view;

static view *views; /* protected by the lock */
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;

static void *map(int fd, size_t size, bool is_written)
{
    const DWORD protection = is_written ? PAGE_READWRITE : PAGE_READONLY,
                access = is_written ? FILE_MAP_READ | FILE_MAP_WRITE : FILE_MAP_READ;
    const HANDLE file = (HANDLE)_get_osfhandle(fd);
    const HANDLE section =
        CreateFileMappingW(file, NULL, protection, (DWORD)((uint64_t)size >> 32), (DWORD)size, NULL);
    void *const at = section ? MapViewOfFile(section, access, 0, 0, size) : NULL;
    if (!at)
        ffd_set_errno();
    if (section)
        CloseHandle(section); /* the view keeps it */
    return at;
}

void *mmap(void *at, size_t size, int protection, int flags, int fd, int64_t offset)
{
    struct stat info;
    (void)at;
    (void)flags;
    if (offset != 0 || fstat(fd, &info) != 0)
        return MAP_FAILED;
    view *const made = malloc(sizeof *made);
    void *const mapped = made ? map(fd, size, protection & PROT_WRITE) : NULL;
    if (!mapped) {
        const int reason = made ? errno : ENOMEM;
        free(made);
        errno = reason;
        return MAP_FAILED;
    }
    pthread_mutex_lock(&lock);
    *made = (view){.next = views, .at = mapped, .size = size, .identity = {info.st_dev, info.st_ino}};
    views = made;
    pthread_mutex_unlock(&lock);
    return mapped;
}

int munmap(void *at, size_t size)
{
    (void)size;
    pthread_mutex_lock(&lock);
    view **place = &views;
    while (*place && (*place)->at != at)
        place = &(*place)->next;
    view *const gone = *place;
    if (gone)
        *place = gone->next;
    pthread_mutex_unlock(&lock);
    if (!gone)
        return -1;
    if (gone->is_copy)
        VirtualFree(at, 0, MEM_RELEASE);
    else
        UnmapViewOfFile(at);
    free(gone);
    return 0;
}

/* Copies a view to memory and then back to its address. What takes that address meanwhile, such as the stack
   of a new thread, would lose the bytes of the view, which are then nowhere: the program ends. */
static void detach(view *of)
{
    DWORD before;
    void *const copy = VirtualAlloc(NULL, of->size, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE);
    if (!copy)
        return;
    memcpy(copy, of->at, of->size);
    UnmapViewOfFile(of->at);
    if (VirtualAlloc(of->at, of->size, MEM_RESERVE | MEM_COMMIT, PAGE_READWRITE) != of->at) {
        fputs("ffd: memory of a mapped file was taken by another part of the process\n", stderr);
        abort();
    }
    memcpy(of->at, copy, of->size);
    VirtualFree(copy, 0, MEM_RELEASE);
    VirtualProtect(of->at, of->size, PAGE_READONLY, &before);
    of->is_copy = true;
}

void ffd_views_detach(const char *path)
{
    struct stat info;
    pthread_mutex_lock(&lock);
    if (views && stat(path, &info) == 0)
        for (view *at = views; at; at = at->next)
            if (!at->is_copy && at->identity[0] == info.st_dev && at->identity[1] == info.st_ino)
                detach(at);
    pthread_mutex_unlock(&lock);
}

/* A page that is taken from the working set is read from the file again. VirtualUnlock does so for pages
   that are not locked, and then fails. */
int madvise(void *at, size_t size, int advice)
{
    if (advice == MADV_DONTNEED)
        VirtualUnlock(at, size);
    return 0;
}

long sysconf(int name)
{
    SYSTEM_INFO info;
    (void)name;
    GetSystemInfo(&info);
    return (long)info.dwPageSize;
}
