/* cells.c - says which cells of a volume mesh a deformation inverts. */
#include "base/spelling.h"
#include "base/text/words.h"
#include "job/judge/warnings.h"
#include <inttypes.h>
#include <stdio.h>

void ffd_cells_describe(const ffd_cell_figures *cells, char *text, size_t capacity)
{
    size_t used = 0;
    text[0] = '\0';
    if (cells->by_deformation)
        used =
            (size_t)snprintf(text, capacity, "%" PRIu64 " of %" PRIu64 " %s %s inverted by the deformation",
                             cells->by_deformation, cells->count, ffd_plural(cells->count, "cell", "cells"),
                             ffd_plural(cells->by_deformation, "is", "are"));
    if (!cells->unknown || used >= capacity)
        return;
    if (used)
        snprintf(text + used, capacity - used, ", and %" PRIu64 " more could not be decided", cells->unknown);
    else
        snprintf(text, capacity, "whether %" PRIu64 " of %" PRIu64 " %s inverted could not be decided",
                 cells->unknown, cells->count, ffd_plural(cells->count, "cell is", "cells are"));
}

void ffd_cells_warn(const ffd_job_result *result, const mesh_log *log)
{
    const ffd_cell_figures *const cells = &result->cells;
    char text[300], worst[120] = "";
    if (!cells->by_deformation && !(cells->unknown && result->moved))
        return;
    ffd_cells_describe(cells, text, sizeof text);
    if (cells->has_worst)
        snprintf(worst, sizeof worst, "; the worst is cell %" PRIu64 ", whose scaled Jacobian is %g",
                 cells->worst, cells->scaled_jacobian.after);
    ffd_log_line(log, FFD_LOG_WARNING, "%s%s (%s)", text, worst, SPELLED("see {fail_on=inverted}"));
}
