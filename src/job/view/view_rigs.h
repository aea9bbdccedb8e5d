/* view_rigs.h - the animations of a view: skeletons and keys of the mesh before and after. */
#ifndef FFD_JOB_VIEW_VIEW_RIGS_H
#define FFD_JOB_VIEW_VIEW_RIGS_H

#include "mesh/mesh.h"
#include "view/view_scene.h"

/* Default number of poses in a picture. */
#define VIEW_POSES 5

typedef struct view_rigs_desc {
    mesh_document *before, *after; /* after: the deformed mesh as a file, or NULL */
    bool deformed;                 /* `before` has results, which are the mesh after */
    bool follows;                  /* its nodes have moved too */
    const double *gradients;       /* of the displacement, 9 a vertex; or NULL */
    bool shown;                    /* apply default weights of morph targets */
    const char *before_name, *after_name;
    const char *animation; /* name of the animation to show; NULL: none */
    bool all;              /* load all animations, for a page; unreadable ones are left out with a warning */
    const mesh_log *log;
} view_rigs_desc;

/* Fills the scene's rigs and animations, and finds the one to show. Errors: FFD_E_ARGUMENT (there is no such
   animation), those of reading its keys, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_view_make_rigs(const view_rigs_desc *desc, view_scene *scene, ffd_error *error);

#endif
