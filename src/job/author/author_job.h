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

/* The members that their descriptions share (ffd_lattice_refine_desc). */
typedef struct author_job {
    const ffd_lattice_source *lattices; /* lattice_count: the one that changes, then others that it needs */
    size_t lattice_count;
    const ffd_setting *set;
    size_t set_count;
    const ffd_source *meshes;
    size_t mesh_count;
    const char *const *only;
    size_t only_count;
    const ffd_source *reading;
    const char *output;
    bool force;
    ffd_output_set *output_set;
    mesh_log log;
    ffd_sink_function sink;
    void *sink_user;
} author_job;

/* The lattices that are read. All zeros: none yet. */
typedef struct author_input {
    ffd_lattice **lattices; /* count entries */
    size_t count;
    path_list files;      /* of the meshes that their boxes go round */
    memory_budget memory; /* what is left for the one that is made */
} author_input;

/* Registers meshes that are in memory under paths, in a copy of their array, which the caller frees; NULL:
   there are none. */
ffd_status ffd_author_take_meshes(job_memory *memory, const ffd_source *meshes, size_t count,
                                  ffd_source **copy, ffd_error *error);
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
