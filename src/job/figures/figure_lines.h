/* figure_lines.h - the lines of figures for people. */
#ifndef FFD_JOB_FIGURES_FIGURE_LINES_H
#define FFD_JOB_FIGURES_FIGURE_LINES_H

#include "base/text/buffer.h"
#include <ffd/result.h>

/* Lines for people. */
typedef struct figure_text {
    const ffd_job_result *result;
    const char *lattice; /* name of the lattice of the folds' witness */
    byte_buffer *out;
} figure_text;
/* Writes lines such as "  torn edges     3\n"; of a single number that is not finite, none. */
typedef void figure_lines(const figure_text *text);

figure_lines ffd_lines_of_statuses, ffd_lines_of_moved, ffd_lines_of_folds, ffd_lines_of_flipped,
    ffd_lines_of_tear, ffd_lines_of_extent, ffd_lines_of_det, ffd_lines_of_edges, ffd_lines_of_rig;

#endif
