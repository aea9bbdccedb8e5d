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
/* Which figures. */
typedef enum figure_lines {
    LINES_NONE = 0,
    LINES_OF_STATUSES,
    LINES_OF_MOVED,
    LINES_OF_FOLDS,
    LINES_OF_FLIPPED,
    LINES_OF_TEAR,
    LINES_OF_EXTENT,
    LINES_OF_DET,
    LINES_OF_EDGES,
    LINES_OF_CELLS,
    LINES_OF_RIG,
    LINES_OF_RIGID
} figure_lines;

/* Writes lines such as "  torn edges     3\n"; of a single number that is not finite, none. */
void ffd_lines_write(figure_lines lines, const figure_text *text);

#endif
