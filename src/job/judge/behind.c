/* behind.c - says what stays behind when the mesh moves. */
#include "base/text/words.h"
#include "job/judge/warnings.h"
#include <inttypes.h>
#include <stdio.h>

/* Writes ": hand, foot, tail and 2 more". all: the number of things; 0: names are of parts that hold
   several. */
static void write_names(const ffd_behind *behind, uint64_t all, char *text, size_t capacity)
{
    size_t length = 0, named = 0;
    *text = 0;
    for (; named < FFD_BEHIND_NAMES && behind->names[named][0]; named++)
        length += (size_t)snprintf(text + length, capacity - length, "%s%s", named ? ", " : ": ",
                                   behind->names[named]);
    if (all > named)
        snprintf(text + length, capacity - length, " and %" PRIu64 " more", all - named);
}

/* Joints, pivots and sockets have a warning of their own (ffd_rig_warn). */
static bool is_warned_elsewhere(int kind, ffd_rig rig)
{
    return rig == FFD_RIG_KEEP &&
           (kind == FFD_BEHIND_JOINT || kind == FFD_BEHIND_PIVOT || kind == FFD_BEHIND_SOCKET);
}

void ffd_behind_warn(const ffd_job_result *result, ffd_rig rig, const mesh_log *log)
{
    static const char *const one[FFD_BEHIND_KIND_COUNT] = {
        [FFD_BEHIND_SOCKET] = "socket",        [FFD_BEHIND_CAMERA] = "camera",
        [FFD_BEHIND_LIGHT] = "light",          [FFD_BEHIND_JOINT] = "joint",
        [FFD_BEHIND_PIVOT] = "animated pivot", [FFD_BEHIND_PHYSICS_SHAPE] = "physics shape"};
    char names[FFD_BEHIND_NAMES * (sizeof result->behind[0].names[0] + 2) + 40];
    for (int kind = 0; kind < FFD_BEHIND_SPLAT; kind++) {
        const ffd_behind *behind = &result->behind[kind];
        if (behind->count == 0 || is_warned_elsewhere(kind, rig))
            continue;
        write_names(behind, behind->count, names, sizeof names);
        ffd_log_line(log, FFD_LOG_WARNING, "%" PRIu64 " %s%s, though the lattice moves the mesh there%s",
                     behind->count, one[kind],
                     ffd_plural(behind->count, " stays where it is", "s stay where they are"), names);
    }
    const ffd_behind *splats = &result->behind[FFD_BEHIND_SPLAT];
    if (splats->count == 0)
        return;
    write_names(splats, 0, names, sizeof names);
    ffd_log_line(log, FFD_LOG_WARNING, "%" PRIu64 " Gaussian splat%s%s", splats->count,
                 ffd_plural(splats->count, " moves, but its rotation and scale stay",
                            "s move, but their rotations and scales stay"),
                 names);
}
