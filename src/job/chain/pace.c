#include "job/chain/pace.h"
#include "base/spelling.h"
#include "base/system/clock.h"
#include "base/system/deadline.h"
#include "base/text/words.h"
#include "base/vector/vec.h"
#include "embed/frame/frame.h"
#include "embed/locator.h"
#include "mesh/mesh.h"
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

/* So many points are searched before the time is looked at, */
#define FIRST_POINTS ((size_t)100)
/* and so many at once; with a deadline one point, and then as many as fit into a moment. */
#define MOST_POINTS ((size_t)1024)
#define MOMENT 0.05
/* A point that takes so many seconds is worth a word. */
#define SLOW 0.01

static void warn(chain_pace *pace, const chain_link *link)
{
    const double each = pace->seconds / (double)pace->done, parts = ceil_of(pace->points / MESH_RANGE_STEP);
    const double all = larger_of(each * pace->points / lesser_of(pace->threads, parts), pace->seconds);
    const ffd_lattice_source *const lattice = pace->lattices ? &pace->lattices[link - pace->links] : NULL;
    char text[40], name[201] = "";
    if (pace->is_logged || pace->done < FIRST_POINTS || each < SLOW)
        return;
    pace->is_logged = true;
    if (lattice)
        ffd_name_shown(lattice->path, name, sizeof name);
    if (all < 120)
        snprintf(text, sizeof text, "%.0f seconds", all);
    else if (all < 7200)
        snprintf(text, sizeof text, "%.0f minutes", all / 60);
    else
        snprintf(text, sizeof text, "%.1f hours", all / 3600);
    ffd_log_line(&pace->log, FFD_LOG_WARNING,
                 "the search for %" PRIu64
                 " vertices in the lattice%s%s took %.3g seconds, because it folds at "
                 "rest or has steep weights; all vertices may take about %s%s",
                 pace->done, *name ? " " : "", name, pace->seconds, text, SPELLED(pace->more));
}

/* How many points to search next, after these many took these seconds. */
static size_t next_slice(size_t points, double seconds)
{
    if (seconds > MOMENT)
        return points > 8 ? points / 8 : 1;
    return 4 * points < MOST_POINTS ? 4 * points : MOST_POINTS;
}

ffd_status ffd_pace_find(const chain_link *link, const double *x, size_t count, chain_pace *pace,
                         ffd_location *locations, ffd_error *error)
{
    const bool ends = ffd_deadline_get(), slices = link->locator->method == METHOD_GENERAL && (pace || ends);
    size_t size = !slices ? count : ends ? 1 : pace->done < FIRST_POINTS ? FIRST_POINTS : MOST_POINTS;
    TRY(ffd_deadline_check(error));
    for (size_t first = 0; first < count;) {
        const size_t left = count - first, now = left < size ? left : size;
        const double start = slices ? ffd_clock_seconds() : 0;
        TRY(ffd_locator_find(link->locator, x + 3 * first, now, locations + first, error));
        first += now;
        if (!slices)
            continue;
        const double seconds = ffd_clock_seconds() - start;
        if (pace) {
            pace->done += now;
            pace->seconds += seconds;
            warn(pace, link);
        }
        size = ends ? next_slice(now, seconds) : MOST_POINTS;
        TRY(ffd_deadline_check(error));
    }
    return FFD_OK;
}
