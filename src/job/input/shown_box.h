/* shown_box.h - the box of what meshes show, for a lattice that goes round them (public: ffd/job.h). */
#ifndef FFD_JOB_INPUT_SHOWN_BOX_H
#define FFD_JOB_INPUT_SHOWN_BOX_H

#include "base/file/path_list.h"
#include "mesh/mesh_log.h"
#include <ffd/job.h>

/* Filled by ffd_shown_box_add, mesh by mesh. */
typedef struct shown_box {
    ffd_bounds shown; /* of the selected vertices that are shown */
    ffd_bounds all;   /* of all selected ones */
} shown_box;

struct ffd_shared_box {
    shown_box box;
    path_list files; /* that it was taken from */
};

/* A box round nothing. */
void ffd_shown_box_clear(shown_box *box);
/* Widens the box by another one. */
void ffd_shown_box_join(shown_box *box, const shown_box *other);
/* Widens the box by what the selectors (only_count) leave of a mesh, adds its files to files, and says its
   flaws, with its name, in log (each NULL: they are not wanted). Errors: those of reading the mesh. */
ffd_status ffd_shown_box_add(shown_box *box, const ffd_source *source, const char *const *only,
                             size_t only_count, path_list *files, const mesh_log *log, ffd_error *error);
/* The bounds that a lattice goes round: of what is shown; of all vertices where nothing is; of the unit cube
   where there are none. */
ffd_bounds ffd_shown_box_bounds(const shown_box *box);

#endif
