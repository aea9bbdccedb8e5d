/* figures.h - the figures of a job that take extra time and memory: folds, flipped faces, det F, edges. */
#ifndef FFD_JOB_MEASURE_FIGURES_H
#define FFD_JOB_MEASURE_FIGURES_H

#include "job/measure/job_state.h"

/* Arrays that the pass must fill for the figures. */
typedef struct figure_arrays {
    mesh_faces faces;
    bool has_faces;
    double *deformed, *gradients; /* as in mesh_pass */
    uint8_t *collapsed;           /* likewise */
    memory_budget budget;         /* the document's, to which these arrays are charged */
} figure_arrays;

/* Whether folds, flipped faces and det F are wanted. */
bool ffd_figures_wanted(const deform_job *job);
/* Whether flipped faces are counted: where they are wanted, and also of a coarse mesh that is written, whose
   faces may turn over although det F > 0 at every vertex. */
bool ffd_figures_count_flipped(const deform_job *job);

/* Reads the mesh's faces (at rest, so before the pass) and allocates the arrays, charged to arrays->budget.
   If the faces are invalid or exceed the budget, a check or a recomputation of normals fails; a deformation
   goes on without these figures, with a warning if they are wanted. */
ffd_status ffd_figures_prepare(const deform_job *job, mesh_state state, figure_arrays *arrays,
                               ffd_error *error);
/* Frees the arrays and the faces. */
void ffd_figures_free(figure_arrays *arrays);

/* Proves for each lattice of the chain that it does not fold, or finds folds, and combines the outcomes. */
ffd_status ffd_figures_folds(lattice_chain *chain, int threads, ffd_job_result *result, ffd_error *error);

/* After the pass: counts flipped faces; computes det F, area and volume if they are wanted and, for a check,
   the deviation of edges. arrays->faces is reduced to selected faces. */
ffd_status ffd_figures_faces(const deform_job *job, figure_arrays *arrays, ffd_job_result *result,
                             ffd_error *error);

#endif
