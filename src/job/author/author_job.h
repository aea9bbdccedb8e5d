/* author_job.h - what the jobs that make a lattice of a lattice share: they read one, and write another. */
#ifndef FFD_JOB_AUTHOR_AUTHOR_JOB_H
#define FFD_JOB_AUTHOR_AUTHOR_JOB_H

#include "base/file/output.h"
#include "base/file/path_list.h"
#include "job/input/in_memory.h"
#include "lattice/lattice.h"
#include "mesh/memory_budget.h"
#include "mesh/mesh_log.h"
#include <ffd/job.h>

/* A job, as the library has it. */
typedef struct author_job {
    ffd_author_desc desc;               /* what is in memory has names */
    ffd_source *meshes;                 /* desc.meshes, which belong to the job */
    const ffd_lattice_source *lattices; /* lattice_count: desc.lattice, then others that the job needs */
    size_t lattice_count;
    const ffd_lattice_source *tables; /* table_count lattices in other formats, which it reads itself */
    size_t table_count;
    bool writes_formats;        /* the output may be of another format than JSON: the job checks its ending */
    const ffd_shared_box *laid; /* the box that lattices go round; NULL: that of the meshes */
    bool meshes_cut; /* the meshes also tell which faces are held, so that no box has to go round them */
    mesh_log log;
    job_memory memory;
} author_job;

/* The lattices that are read. All zeros: none yet. */
typedef struct author_input {
    ffd_lattice **lattices; /* count entries */
    size_t count;
    path_list files;      /* of the meshes that their boxes go round */
    memory_budget memory; /* what is left for the one that is made */
} author_input;

/* Takes a caller's description. Call ffd_author_leave in every case. Errors: FFD_E_ARGUMENT, FFD_E_MEMORY. */
ffd_status ffd_author_take(const ffd_author_desc *callers, author_job *job, ffd_error *error);
/* Frees what belongs to the job. Returns status, or the failure of a callback that reads. */
ffd_status ffd_author_leave(author_job *job, ffd_status status, ffd_error *error);
/* Checks the description and the output. Errors: those of ffd_lattice_refine_run before it reads. */
ffd_status ffd_author_check(const author_job *job, ffd_error *error);
/* Checks the output, reads the lattices, and lays their boxes round the meshes. Errors: those of
   ffd_lattice_refine_run up to the refinement. Call ffd_author_end in every case. */
ffd_status ffd_author_begin(const author_job *job, author_input *input, ffd_error *error);
/* Frees the lattices and the list. */
void ffd_author_end(author_input *input);
/* Makes the output of a job, which the caller begins, commits and destroys. Errors: FFD_E_MEMORY. */
ffd_status ffd_author_output(const author_job *job, file_output **output, ffd_error *error);
/* Writes the lattice that was made, as JSON. */
ffd_status ffd_author_write(const author_job *job, const ffd_lattice *made, ffd_error *error);

#endif
