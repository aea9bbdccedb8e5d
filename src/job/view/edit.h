/* edit.h - the steps in which `ffd edit` finds what its page needs, each in a source of its own: the points
   (edit_points.c), the lattice (edit_lattice.c). */
#ifndef FFD_JOB_VIEW_EDIT_H
#define FFD_JOB_VIEW_EDIT_H

#include "job/measure/job_state.h"
#include "view/view_edit.h"
#include "view/view_scene.h"

/* Numbers of vertices of the document: selected ones by where they are in the edited lattice. */
typedef struct edit_counts {
    uint64_t inside, outside;
} edit_counts;

/* Finds where the vertices of a scene are in the last lattice of an open job, whose lattices are fitted, and
   likewise the points of morph targets with a weight. Errors: FFD_E_LIMIT, FFD_E_MEMORY, those of the
   search. */
ffd_status ffd_edit_find_points(deform_job *job, const view_scene *scene, edit_points *points,
                                edit_counts *counts, ffd_error *error);
/* Fills all other members of an edit. The scene has its cages. Errors: FFD_E_MEMORY. */
ffd_status ffd_edit_take_lattice(const deform_job *job, const view_scene *scene, view_edit *edit,
                                 ffd_error *error);

#endif
