/* index.h - the page that compares the jobs of a batch by their pictures and figures: a table that the
   browser sorts. The page's Content-Security-Policy allows pictures from its own origin and nothing else. */
#ifndef FFD_VIEW_INDEX_H
#define FFD_VIEW_INDEX_H

#include "view/page_writer.h"
#include <ffd/result.h>
#include <stdint.h>

/* What became of a job, in the order in which rows are sorted. */
typedef enum index_state { INDEX_SKIPPED, INDEX_DONE, INDEX_FAILED } index_state;

/* One job. Texts may hold any bytes, and are NULL where absent. */
typedef struct index_row {
    uint64_t line; /* of the manifest */
    const char *input, *output;
    const char *picture;  /* relative to the index */
    const char *page;     /* of the job, likewise */
    const char *frame;    /* why the picture has a frame of its own; NULL: it can be compared with others */
    const char *settings; /* "NAME=VALUE, NAME=VALUE" */
    index_state state;
    const char *error;
    const char *pointer; /* the JSON pointer in it, which is not a path; NULL or "": there is none */
    const ffd_job_result *figures; /* NULL: not known. A number that is not known is NaN */
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
