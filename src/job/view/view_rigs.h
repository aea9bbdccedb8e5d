/* view_rigs.h - the animations of a view: what moves the mesh before and after, and its poses for a picture.
 */
#ifndef FFD_JOB_VIEW_VIEW_RIGS_H
#define FFD_JOB_VIEW_VIEW_RIGS_H

#include "mesh/mesh.h"
#include "view/view_scene.h"

/* Poses of a picture, unless it is said how many. */
#define VIEW_POSES 5

typedef struct view_rigs_desc {
    mesh_document *before, *after; /* after: NULL, or the deformed mesh as a file */
    bool deformed;                 /* before has results: they are the mesh after */
    bool follows;                  /* and its nodes have moved with it */
    const double *gradients;       /* of the displacement, 9 a vertex; or NULL */
    bool shown;                    /* default weights of morph targets count */
    const char *before_name, *after_name;
    const char *animation; /* that is wanted; NULL: none in particular */
    bool all;              /* for a page, which has all of them; what cannot be read is left out, and said */
    const mesh_log *log;
} view_rigs_desc;

/* Fills the scene's rigs and animations, and finds the one that is wanted. Errors: FFD_E_ARGUMENT (there is
   no such animation), what its keys have, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_view_make_rigs(const view_rigs_desc *desc, view_scene *scene, ffd_error *error);

#endif
