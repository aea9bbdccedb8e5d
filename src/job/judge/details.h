/* details.h - what a job knows of single vertices and edges, for a picture of it. */
#ifndef FFD_JOB_JUDGE_DETAILS_H
#define FFD_JOB_JUDGE_DETAILS_H

#include "job/judge/torn_edges.h"
#include "mesh/mesh.h"

/* Filled by ffd_deform_job_run where job->details is set; arrays are in the order of `ffd embed`. */
typedef struct job_details {
    uint8_t *statuses;            /* ffd_vertex_status */
    bool has_faces;               /* these are known, and with them: */
    mesh_faces faces;             /* at rest, those that are selected */
    double *deformed, *gradients; /* as mesh_pass has them */
    torn_edges tears;
} job_details;

/* Makes the array of statuses, out of the budget. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_details_begin(job_details *details, size_t vertex_count, memory_budget *budget,
                             ffd_error *error);
/* Frees what there is; leaves all zeros. */
void ffd_details_free(job_details *details);

#endif
