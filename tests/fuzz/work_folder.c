/* work_folder.c - a temporary folder for the files of one run. */
#include "work_folder.h"
#include "promise.h"
#include <dirent.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

static size_t clear(const char *path)
{
    size_t count = 0;
    DIR *const open = opendir(path);
    PROMISE(open, "no folder %s", path);
    for (const struct dirent *entry; (entry = readdir(open));) {
        char file[512];
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
            continue;
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        PROMISE(unlink(file) == 0 || rmdir(file) == 0, "%s cannot be removed", file);
        count++;
    }
    closedir(open);
    return count;
}

static void remove_folder(void)
{
    work_clear("out");
    clear(folder);
    rmdir(folder);
}

static void make_folder(void)
{
    char out[WORK_PATH];
    const char *const parent = getenv("TMPDIR");
    const int length =
        snprintf(folder, sizeof folder, "%s/ffd-fuzz-XXXXXX", parent && *parent ? parent : "/tmp");
    PROMISE(length < (int)sizeof folder && mkdtemp(folder), "no folder %s", folder);
    snprintf(out, sizeof out, "%s/out", folder);
    PROMISE(mkdir(out, 0700) == 0, "no folder %s", out);
    atexit(remove_folder);
}

void work_path(const char *name, char path[WORK_PATH])
{
    if (!folder[0])
        make_folder();
    PROMISE(snprintf(path, WORK_PATH, "%s/%s", folder, name) < WORK_PATH, "%s is too long", name);
}

void work_write(const char *name, const void *bytes, size_t size)
{
    char path[WORK_PATH];
    work_path(name, path);
    FILE *const file = fopen(path, "wb");
    PROMISE(file && fwrite(bytes, 1, size, file) == size && fclose(file) == 0, "%s cannot be written", path);
}

size_t work_clear(const char *name)
{
    char path[WORK_PATH];
    work_path(name, path);
    return clear(path);
}
