/* index.h - the page that compares the jobs of a batch by their pictures and figures: a table that the
   browser sorts. The page's Content-Security-Policy allows pictures from its own origin and nothing else. */
#ifndef FFD_VIEW_INDEX_H
#define FFD_VIEW_INDEX_H

#include "view/page_writer.h"
#include <stdint.h>

typedef enum index_folds {
    INDEX_FOLDS_NOT_KNOWN,
    INDEX_FOLDS_NONE,
    INDEX_FOLDS_UNKNOWN, /* the proof was not conclusive */
    INDEX_FOLDS_SOME
} index_folds;

/* One job. Texts may hold any bytes, and are NULL where absent. Counts are those of the report. */
typedef struct index_row {
    uint64_t number; /* line of the manifest */
    const char *input, *output;
    const char *picture;  /* relative to the page */
    const char *settings; /* "NAME=VALUE, NAME=VALUE" */
    const char *status;   /* "ok", "skipped", "failed" */
    const char *error;
    bool has_displacement, has_tear, has_flipped;
    index_folds folds;
    double displacement, torn_edges, largest_step, folded_cells, min_det, flipped_faces;
} index_row;

/* A page while it is written. All zeros: no page. */
typedef struct view_index {
    page_writer writer;
    uint64_t jobs, skipped, failed;
} view_index;

/* Begins a page in the file that output began last. name: the manifest's, for the title. Errors: FFD_E_IO,
   FFD_E_MEMORY. */
ffd_status ffd_index_begin(view_index *index, const char *name, file_output *output, ffd_error *error);
/* Adds a row for a job. Errors: as of ffd_index_begin. */
ffd_status ffd_index_add(view_index *index, const index_row *row, ffd_error *error);
/* Ends the page. Errors: as of ffd_index_begin. */
ffd_status ffd_index_end(view_index *index, ffd_error *error);
/* Frees the writer's memory. May be called in every case. */
void ffd_index_free(view_index *index);

#endif
