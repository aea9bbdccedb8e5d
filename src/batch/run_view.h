/* run_view.h - names the pictures of a run's jobs (--view), and writes the page that compares them. */
#ifndef FFD_BATCH_RUN_VIEW_H
#define FFD_BATCH_RUN_VIEW_H

#include "batch/pool.h"

typedef struct run_view_desc {
    const char *folder;     /* of the pictures; made if missing */
    const char *out_dir;    /* of outputs, which is dropped from pictures' names; or NULL */
    const char *name;       /* of the manifest, table or pattern */
    uint64_t shard, shards; /* each shard has its own page */
    bool force;             /* replace an existing page */
    bool dry;               /* write nothing */
    bool pages;             /* jobs have pages of their own beside their pictures */
} run_view_desc;

typedef struct run_view run_view;

/* Returns the path of the page in a folder. Free with ffd_free; NULL: out of memory. */
char *ffd_run_view_page_of(const char *folder, uint64_t shard, uint64_t shards);
/* Begins the page, which appears once it is complete. The texts of desc must outlive the view. Errors:
   FFD_E_EXISTS, FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_run_view_create(const run_view_desc *desc, run_view **view, ffd_error *error);
/* Returns the path of the page, owned by the view. */
const char *ffd_run_view_page(const run_view *view);
/* Names the picture of a job, and its page, if it is to have one, and returns their identities: the job's
   path of OUT plus ".png" and ".html", below the folder, without a root and parts that lead upwards; or
   "row-ROW" with these endings if no mesh is written. Errors: FFD_E_MEMORY. */
ffd_status ffd_run_view_name(const run_view *view, pool_task *task, hash128 files[2], ffd_error *error);
/* Adds an ended job to the page. entry: of the report. Jobs must be added in order. Errors: FFD_E_IO,
   FFD_E_MEMORY. */
ffd_status ffd_run_view_add(run_view *view, const pool_task *task, const byte_buffer *entry,
                            ffd_error *error);
/* Finishes the page. Errors: FFD_E_IO, FFD_E_MEMORY. */
ffd_status ffd_run_view_write(run_view *view, ffd_error *error);
/* Frees the view; an unfinished page disappears. Accepts NULL and pointers to NULL. */
void ffd_run_view_destroy(run_view **view);

#endif
