/* deform_job.h - what `ffd deform` and `ffd check` have in common: everything but the writing. */
#ifndef FFD_JOB_DEFORM_JOB_H
#define FFD_JOB_DEFORM_JOB_H

#include "job/input/embedding_file.h"
#include "job/pass/pass.h"

/* What a job holds while it runs. */
typedef struct deform_job {
    const ffd_deform_desc *desc;
    bool check;          /* nothing will be written; all figures are wanted */
    bool recomputes;     /* there are normals, and they are to be those of the deformed faces */
    bool only_positions; /* set before opening: nothing asked for looks at normals */
    int threads;
    mesh_log log;
    lattice_chain chain;
    mesh_document *document;
    bool document_is_shared;  /* it is the last job's */
    embedding_file embedding; /* where one is named */
    pass_totals totals;
    mesh_model base; /* the shape before, where a conversion adds the deformation to it as a morph target */
} deform_job;

/* No figures yet. */
void ffd_result_clear(ffd_job_result *result);

/* Clears result and takes desc, after a look at what does not concern the output. Errors: FFD_E_ARGUMENT,
   FFD_E_EXISTS, in result. */
ffd_status ffd_deform_job_begin(deform_job *job, const ffd_deform_desc *desc, bool check,
                                ffd_job_result *result);

/* Reads lattices and mesh. */
ffd_status ffd_deform_job_open(deform_job *job, ffd_job_result *result, ffd_error *error);

/* Deforms the document's vertices, fills result with the figures and judges them. The document is ready to be
   saved afterwards. */
ffd_status ffd_deform_job_run(deform_job *job, ffd_job_result *result, ffd_error *error);

/* Frees what the job holds, puts the outcome into result and *error (which may be NULL), and returns it. */
ffd_status ffd_deform_job_end(deform_job *job, ffd_status status, ffd_job_result *result, ffd_error *error);

#endif
