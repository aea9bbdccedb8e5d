/* figures.h - the figures of a job that cost time and memory of their own: folds, flipped faces, det F,
 * edges.
 */
#ifndef FFD_JOB_JUDGE_FIGURES_H
#define FFD_JOB_JUDGE_FIGURES_H

#include "job/judge/job_state.h"

/* What the pass must leave for them. */
typedef struct figure_arrays {
    mesh_faces faces;
    bool has_faces;
    double *deformed, *gradients; /* see mesh_pass */
    memory_budget budget;         /* the document's, as it is beside them */
} figure_arrays;

/* Reads the mesh's faces (at rest: before the pass) and makes the arrays, out of arrays->budget. Faces that
   are not valid, or that the memory budget does not allow, refuse a check and normals that are to be computed
   from them; else a deformation goes on without their figures after a warning. */
ffd_status ffd_figures_prepare(const deform_job *job, figure_arrays *arrays, ffd_error *error);
/* Frees the arrays and the faces. */
void ffd_figures_free(figure_arrays *arrays);

/* Adds the folds of a further volume: the worst verdict, sums of cells, the first witness. */
void ffd_figures_join_folds(ffd_folds *all, const ffd_folds *next);

/* Proves for each lattice of the chain that it does not fold, and joins the outcomes. */
ffd_status ffd_figures_folds(lattice_chain *chain, int threads, ffd_job_result *result, ffd_error *error);

/* After the pass: det F, flipped faces, for a check the edges; of selected faces, which are all that it
   leaves in arrays. */
ffd_status ffd_figures_faces(const deform_job *job, figure_arrays *arrays, ffd_job_result *result,
                             ffd_error *error);

/* Warns of what the user of a deformation should know although no gate asks for it. */
void ffd_figures_warn(const deform_job *job, const ffd_job_result *result);

/* "folds in 3 of 27 cells, at u,v,w = (0.5, 0.5, 0.5), x,y,z = (1, 2, 3) of b.json"; "may fold in 2 of 27
   cells that could not be decided". Only for verdicts other than none. */
void ffd_figures_describe_folds(const ffd_deform_desc *desc, const ffd_job_result *result, char *text,
                                size_t capacity);

#endif
