/* plan.h - the outputs of a run of several jobs, and whether a job reads one that another job writes: its
   result would depend on their order. */
#ifndef FFD_JOB_PLAN_H
#define FFD_JOB_PLAN_H

#include "base/file/path_list.h"
#include "base/file/place.h"
#include "base/memory/file_table.h"
#include <ffd/job.h>

/* All zeros: no jobs. */
typedef struct job_plan {
    file_places places;
    file_table outputs;   /* number of the job that writes each */
    path_list inputs;     /* of the jobs, for messages */
    intern_table folders; /* places of the folders of outputs and of those above them */
    bool replaces;        /* an output exists already */
    bool has_lattices;    /* the lattices were checked */
} job_plan;

/* Adds a job. Errors: FFD_E_INVALID (another job writes that file, under another name), FFD_E_MEMORY. */
ffd_status ffd_plan_write(job_plan *plan, const char *input, const char *output, ffd_error *error);
/* Refuses a job that reads the output of another one (FFD_E_INVALID); number: of the job, in the order in
   which they were added. All jobs have the same lattices. Errors: FFD_E_MEMORY too. */
ffd_status ffd_plan_read(job_plan *plan, size_t index, const ffd_deform_desc *desc, ffd_error *error);
/* Frees the jobs; leaves none. */
void ffd_plan_free(job_plan *plan);

#endif
