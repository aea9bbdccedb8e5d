/* author_job.h - what the jobs that make a lattice of a lattice share: they read one, and write another. */
#ifndef FFD_JOB_AUTHOR_AUTHOR_JOB_H
#define FFD_JOB_AUTHOR_AUTHOR_JOB_H

#include "base/file/path_list.h"
#include "lattice/lattice.h"
#include "mesh/memory_budget.h"
#include "mesh/mesh_log.h"
#include <ffd/job.h>

/* The members that their descriptions share (ffd_lattice_refine_desc). */
typedef struct author_job {
    const ffd_lattice_source *lattice;
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

/* The lattice that is read. All zeros: none yet. */
typedef struct author_input {
    ffd_lattice *lattice;
    path_list files;      /* of the meshes that its box goes round */
    memory_budget memory; /* what is left for the one that is made */
} author_input;

/* Checks the output, reads the lattice, and lays its box round the meshes. Errors: those of
   ffd_lattice_refine_run up to the refinement. Call ffd_author_end in every case. */
ffd_status ffd_author_begin(const author_job *job, author_input *input, ffd_error *error);
/* Frees the lattice and the list. */
void ffd_author_end(author_input *input);
/* Writes the lattice that was made. */
ffd_status ffd_author_write(const author_job *job, const ffd_lattice *made, ffd_error *error);

#endif
