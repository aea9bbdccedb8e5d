/* Preloaded into a program (LD_PRELOAD): it sees another machine. FFD_TRAP_PROCESSORS: how many processors
   its affinity allows. FFD_TRAP_SELF: the folder with the files cgroup and mountinfo of /proc/self.
   FFD_TRAP_LOG: a file to which each new thread adds a byte. */
#define _GNU_SOURCE
#undef _FILE_OFFSET_BITS /* fopen and fopen64 must be two functions here */
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int sched_getaffinity(pid_t process, size_t size, cpu_set_t *set)
{
    (void)process;
    CPU_ZERO_S(size, set);
    for (int i = 0; i < atoi(getenv("FFD_TRAP_PROCESSORS")); i++)
        CPU_SET_S(i, size, set);
    return 0;
}

/* Finds the library's function of this name, which the one here replaces. */
static void find(const char *name, void *function)
{
    void *const found = dlsym(RTLD_NEXT, name);
    memcpy(function, &found, sizeof found);
}

static FILE *open_as(const char *function, const char *path, const char *mode)
{
    static const char self[] = "/proc/self/";
    char other[4096];
    FILE *(*real)(const char *, const char *);
    find(function, &real);
    const char *const name = strncmp(path, self, sizeof self - 1) == 0 ? path + sizeof self - 1 : "";
    if (strcmp(name, "cgroup") != 0 && strcmp(name, "mountinfo") != 0)
        return real(path, mode);
    snprintf(other, sizeof other, "%s/%s", getenv("FFD_TRAP_SELF"), name);
    return real(other, mode);
}

FILE *fopen(const char *path, const char *mode)
{
    return open_as("fopen", path, mode);
}

FILE *fopen64(const char *path, const char *mode)
{
    return open_as("fopen64", path, mode);
}

int pthread_create(pthread_t *thread, const pthread_attr_t *attributes, void *(*start)(void *),
                   void *argument)
{
    int (*real)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);
    find("pthread_create", &real);
    const int log = open(getenv("FFD_TRAP_LOG"), O_WRONLY | O_APPEND | O_CREAT, 0600);
    if (log < 0 || write(log, "t", 1) != 1 || close(log) != 0)
        abort();
    return real(thread, attributes, start, argument);
}
