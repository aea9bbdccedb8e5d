/* index.h - the page that compares the jobs of a batch by their pictures and figures: a table that a browser
   sorts. Its policy allows pictures from where the page itself comes from, and nothing else. */
#ifndef FFD_VIEW_INDEX_H
#define FFD_VIEW_INDEX_H

#include "view/page_writer.h"
#include <stdint.h>

typedef enum index_folds {
    INDEX_FOLDS_NOT_KNOWN,
    INDEX_FOLDS_NONE,
    INDEX_FOLDS_UNKNOWN, /* could not be decided */
    INDEX_FOLDS_SOME
} index_folds;

/* A job. Texts are of any bytes; NULL where there is none. Counts are as a report has them. */
typedef struct index_row {
    uint64_t number; /* its line */
    const char *input, *output;
    const char *picture;  /* relative to the page */
    const char *settings; /* "NAME=VALUE, NAME=VALUE" */
    const char *status;   /* "ok", "skipped", "failed" */
    const char *error;
    bool has_displacement, has_tear, has_flipped;
    index_folds folds;
    double displacement, torn_edges, largest_step, folded_cells, min_det, flipped_faces;
} index_row;

/* A page on its way into a file. All zeros: none. */
typedef struct view_index {
    page_writer writer;
    uint64_t jobs, skipped, failed;
} view_index;

/* Begins a page, with the name of what the jobs come from, in the file begun last. Errors: FFD_E_IO,
   FFD_E_MEMORY. */
ffd_status ffd_index_begin(view_index *index, const char *name, file_output *output, ffd_error *error);
/* Adds a job. Errors: the same. */
ffd_status ffd_index_add(view_index *index, const index_row *row, ffd_error *error);
/* Ends the page. Errors: the same. */
ffd_status ffd_index_end(view_index *index, ffd_error *error);
/* Frees what a page holds while it is written. */
void ffd_index_free(view_index *index);

#endif
