/* cgroup_text.h - the texts in which Linux tells of control groups (cgroups): lines of /proc/self/cgroup and
   of /proc/self/mountinfo (man 7 cgroups, man 5 proc), and limits. */
#ifndef FFD_BASE_SYSTEM_CGROUP_TEXT_H
#define FFD_BASE_SYSTEM_CGROUP_TEXT_H

#include <stdbool.h>
#include <stdint.h>

/* No limit, or none that can be read. */
#define CGROUP_UNLIMITED UINT64_MAX

/* The cgroup of a process in one hierarchy of cgroups. Nothing is owned. */
typedef struct cgroup_place {
    const char *controllers; /* as "cpu,cpuacct"; of the one hierarchy of version 2: "" */
    const char *path;        /* in the hierarchy */
} cgroup_place;

/* Where a hierarchy is mounted. Nothing is owned. */
typedef struct cgroup_mount {
    const char *controllers; /* likewise, among other options */
    const char *root;        /* the cgroup that stands at the mount point, as a path in the hierarchy */
    const char *point;       /* the mount point */
} cgroup_mount;

/* Splits a line of /proc/self/cgroup, which is changed. Returns false if it is none. */
bool ffd_cgroup_place(char *line, cgroup_place *place);
/* Splits a line of /proc/self/mountinfo, which is changed. Returns false if it is not of a mount of cgroups.
 */
bool ffd_cgroup_mount(char *line, cgroup_mount *mount);
/* Whether a hierarchy with these controllers has this one. "": whether it is that of version 2. */
bool ffd_cgroup_controls(const char *controllers, const char *controller);
/* Returns where below the mount point a cgroup stands: "/a/b"; "" for the mount point itself. That is also
   the answer if the mount shows more than the process's namespace of cgroups: the names on the way are
   unknown then, but the mount point stands above the cgroup. NULL: the mount does not show it. */
const char *ffd_cgroup_below(const char *root, const char *path);

/* Returns how many processors "QUOTA PERIOD" allows, rounded up. These are times in microseconds as in
   cpu.max, or as in cpu.cfs_quota_us and cpu.cfs_period_us; a quota of "max" or -1 is none. */
uint64_t ffd_cgroup_processors(const char *text);
/* Returns the number of bytes of memory.max or memory.limit_in_bytes. */
uint64_t ffd_cgroup_bytes(const char *text);

#endif
