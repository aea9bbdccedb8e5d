/* run_view.h - the pictures of a run's jobs (--view): what they are called, and the page that compares them.
 */
#ifndef FFD_BATCH_RUN_VIEW_H
#define FFD_BATCH_RUN_VIEW_H

#include "batch/pool.h"

typedef struct run_view_desc {
    const char *folder;     /* of the pictures; made if it is not there */
    const char *out_dir;    /* of the outputs, which pictures leave out of their names; or NULL */
    const char *name;       /* of the manifest, table or pattern */
    uint64_t shard, shards; /* each has a page of its own */
    bool force;             /* an existing page is replaced */
    bool dry;               /* nothing is made */
} run_view_desc;

typedef struct run_view run_view;

/* Begins the page; it appears when all is written. desc's texts must outlive the view. Errors: FFD_E_EXISTS,
   FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_run_view_create(const run_view_desc *desc, run_view **view, ffd_error *error);
/* Returns the path of the page. */
const char *ffd_run_view_page(const run_view *view);
/* Names the picture of a job, and gives its identity: the path of OUT, as the job names it, below the folder,
   and ".png", without what leads up or to a root; or "row-ROW.png" where no mesh is written. Errors:
   FFD_E_MEMORY. */
ffd_status ffd_run_view_name(const run_view *view, pool_task *task, hash128 *file, ffd_error *error);
/* Adds a job that has ended, with its entry of a report, to the page. Jobs are added in their order. */
ffd_status ffd_run_view_add(run_view *view, const pool_task *task, const byte_buffer *entry,
                            ffd_error *error);
/* Finishes the page. */
ffd_status ffd_run_view_write(run_view *view, ffd_error *error);
/* Frees; a page that was not finished is not there. NULL and pointers to NULL are allowed. */
void ffd_run_view_destroy(run_view **view);

#endif
