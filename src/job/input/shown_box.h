/* shown_box.h - the box of the visible shape of meshes, for a lattice that goes round them (public:
   ffd/job.h). */
#ifndef FFD_JOB_INPUT_SHOWN_BOX_H
#define FFD_JOB_INPUT_SHOWN_BOX_H

#include "base/file/path_list.h"
#include "lattice/lattice.h"
#include "mesh/mesh.h"
#include <ffd/job.h>

/* Accumulated by ffd_shown_box_add, mesh by mesh. */
typedef struct shown_box {
    ffd_bounds shown; /* of the selected vertices that are visible */
    ffd_bounds all;   /* of all selected vertices */
    /* The same of one shape only, that which default weights of morph targets show. */
    ffd_bounds shape_shown, shape_all;
} shown_box;

struct ffd_shared_box {
    shown_box box;
    path_list files; /* read for this box */
};

/* Joins the bounds of all shapes and of the shape shown. */
static inline fit_extent ffd_fit_extent(const ffd_bounds *all, const ffd_bounds *shown)
{
    fit_extent extent;
    for (int a = 0; a < 3; a++) {
        extent.min[a] = all->min[a];
        extent.max[a] = all->max[a];
        extent.shown_min[a] = shown->min[a];
        extent.shown_max[a] = shown->max[a];
    }
    return extent;
}

/* Makes the box empty. */
void ffd_shown_box_clear(shown_box *box);
/* Widens the box to include another one. */
void ffd_shown_box_join(shown_box *box, const shown_box *other);
/* Widens the box by the selected vertices of an open mesh, whose used vertices are marked. */
void ffd_shown_box_add_document(shown_box *box, const mesh_document *document);
/* Widens the box by the selected vertices of a mesh (only_count selectors). Adds its files to `files`, and
   logs its flaws, with its name, in `log`; each may be NULL. Errors: those of reading the mesh. */
ffd_status ffd_shown_box_add(shown_box *box, const ffd_source *source, const char *const *only,
                             size_t only_count, path_list *files, const mesh_log *log, ffd_error *error);
/* Returns the bounds that a lattice goes round: of the visible vertices; if there are none, of all selected
   ones; without vertices, the unit cube. */
fit_extent ffd_shown_box_extent(const shown_box *box);

#endif
