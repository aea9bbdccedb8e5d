/* details.h - the per-vertex and per-edge results of a job, for a picture. */
#ifndef FFD_JOB_MEASURE_DETAILS_H
#define FFD_JOB_MEASURE_DETAILS_H

#include "job/measure/torn_edges.h"
#include "mesh/mesh.h"

/* Filled by ffd_deform_job_run if job->details is set. Arrays are in the order of `ffd embed`. */
typedef struct job_details {
    uint8_t *statuses;            /* ffd_vertex_status of each vertex */
    bool has_faces;               /* the following members are set: */
    mesh_faces faces;             /* at rest, selected faces only */
    double *deformed, *gradients; /* as in mesh_pass */
    uint8_t *collapsed;           /* likewise */
    torn_edges tears;
} job_details;

/* Allocates statuses, charged to the budget. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_details_begin(job_details *details, size_t vertex_count, memory_budget *budget,
                             ffd_error *error);
/* Frees the arrays; leaves all zeros. */
void ffd_details_free(job_details *details);

#endif
