#include "base/system/cgroup.h"
#include <stdio.h>
#include <string.h>

/* Longer paths, and longer lines of mountinfo, are passed over. */
#define PATH_ROOM 4096
#define LINE_ROOM 8192

/* Reads a limit in the folder of one cgroup. */
typedef uint64_t (*limit_reader)(const char *folder);

/* Opens a file of a folder; NULL if that fails. */
static FILE *open_in(const char *folder, const char *name)
{
    char path[PATH_ROOM + 64];
    const int length = snprintf(path, sizeof path, "%s/%s", folder, name);
    return length > 0 && (size_t)length < sizeof path ? fopen(path, "re") : NULL;
}

/* Reads the next line, without its end. A line that is too long is passed over. */
static bool next_line(FILE *file, char *line, size_t room)
{
    while (fgets(line, (int)room, file)) {
        const size_t length = strcspn(line, "\n");
        if (line[length] == '\n' || feof(file)) {
            line[length] = 0;
            return true;
        }
        for (int byte = 0; byte != '\n' && byte != EOF;)
            byte = getc(file);
    }
    return false;
}

/* Reads a file of one line. */
static bool read_value(const char *folder, const char *name, char *text, size_t room)
{
    FILE *const file = open_in(folder, name);
    const bool read = file && next_line(file, text, room);
    if (file)
        fclose(file);
    return read;
}

static uint64_t quota_of_version_2(const char *folder)
{
    char text[64];
    return read_value(folder, "cpu.max", text, sizeof text) ? ffd_cgroup_processors(text) : CGROUP_UNLIMITED;
}

static uint64_t quota_of_version_1(const char *folder)
{
    char quota[32], period[32], text[sizeof quota + sizeof period];
    if (!read_value(folder, "cpu.cfs_quota_us", quota, sizeof quota) ||
        !read_value(folder, "cpu.cfs_period_us", period, sizeof period))
        return CGROUP_UNLIMITED;
    snprintf(text, sizeof text, "%s %s", quota, period);
    return ffd_cgroup_processors(text);
}

static uint64_t memory_of_version_2(const char *folder)
{
    char text[64];
    return read_value(folder, "memory.max", text, sizeof text) ? ffd_cgroup_bytes(text) : CGROUP_UNLIMITED;
}

static uint64_t memory_of_version_1(const char *folder)
{
    char text[64];
    return read_value(folder, "memory.limit_in_bytes", text, sizeof text) ? ffd_cgroup_bytes(text)
                                                                          : CGROUP_UNLIMITED;
}

/* A hierarchy, and the process's cgroup in it. */
typedef struct hierarchy {
    const char *controller; /* "": version 2 */
    limit_reader read;
    char path[PATH_ROOM];       /* in the hierarchy; "": unknown */
    char folder[2 * PATH_ROOM]; /* "": unknown */
    size_t top;                 /* length of the mount point's path, with which the folder begins */
    size_t root;                /* length of the mount's root */
} hierarchy;

enum { VERSIONS = 2 };

static void find_paths(const char *process, hierarchy of[VERSIONS])
{
    char line[LINE_ROOM];
    cgroup_place place;
    FILE *const file = open_in(process, "cgroup");
    while (file && next_line(file, line, sizeof line)) {
        if (!ffd_cgroup_place(line, &place) || strlen(place.path) >= PATH_ROOM)
            continue;
        for (int i = 0; i < VERSIONS; i++)
            if (ffd_cgroup_controls(place.controllers, of[i].controller))
                strcpy(of[i].path, place.path);
    }
    if (file)
        fclose(file);
}

/* Takes the mount if it shows the process's cgroup. Of several, the one that shows the most of what is above
   it counts; of equal ones the last, because it may hide the others. */
static void take_mount(const cgroup_mount *mount, hierarchy *in)
{
    const char *const below = *in->path ? ffd_cgroup_below(mount->root, in->path) : NULL;
    const size_t root = strlen(mount->root), top = strlen(mount->point);
    if (!below || (*in->folder && root > in->root) || top + strlen(below) >= sizeof in->folder)
        return;
    snprintf(in->folder, sizeof in->folder, "%s%s", mount->point, below);
    in->top = top;
    in->root = root;
}

static void find_folders(const char *process, hierarchy of[VERSIONS])
{
    char line[LINE_ROOM];
    cgroup_mount mount;
    FILE *const file = open_in(process, "mountinfo");
    while (file && next_line(file, line, sizeof line)) {
        if (!ffd_cgroup_mount(line, &mount))
            continue;
        for (int i = 0; i < VERSIONS; i++)
            if (ffd_cgroup_controls(mount.controllers, of[i].controller))
                take_mount(&mount, &of[i]);
    }
    if (file)
        fclose(file);
}

/* Returns the least limit in a hierarchy, of the process's cgroup and of those above it. One that cannot be
   read is none: files that are not there are usual, as at the root and where a controller is off. */
static uint64_t least_in(hierarchy *in)
{
    uint64_t least = CGROUP_UNLIMITED;
    while (*in->folder) {
        const uint64_t limit = in->read(in->folder);
        least = limit < least ? limit : least;
        char *const slash = strrchr(in->folder, '/');
        if (!slash || (size_t)(slash - in->folder) < in->top)
            return least;
        *slash = 0;
    }
    return least;
}

/* Returns the least limit in the hierarchy of version 2 and in that of a controller of version 1. Where both
   are mounted, a controller is in one of them; the other has no files of it. */
static uint64_t least_limit(const char *process, limit_reader second, const char *controller,
                            limit_reader first)
{
    hierarchy of[VERSIONS] = {{.controller = "", .read = second}, {.controller = controller, .read = first}};
    find_paths(process, of);
    find_folders(process, of);
    const uint64_t a = least_in(&of[0]), b = least_in(&of[1]);
    return a < b ? a : b;
}

uint64_t ffd_cgroup_processor_limit(const char *process)
{
    return least_limit(process, quota_of_version_2, "cpu", quota_of_version_1);
}

uint64_t ffd_cgroup_memory_limit(const char *process)
{
    return least_limit(process, memory_of_version_2, "memory", memory_of_version_1);
}
