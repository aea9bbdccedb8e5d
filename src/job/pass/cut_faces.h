/* cut_faces.h - the faces of lattices that a mesh cuts: those that it is beyond where one of its edges leads
   from inside to outside (ffd_deform_desc.seam_faces). */
#ifndef FFD_JOB_PASS_CUT_FACES_H
#define FFD_JOB_PASS_CUT_FACES_H

#include "job/pass/mesh_pass.h"

typedef struct cut_faces {
    unsigned faces;    /* bit 2 a + side, as of ffd_lattice_seal */
    uint64_t vertices; /* how many outside of the lattice have neighbours inside */
} cut_faces;

/* Fills cuts[0] for the link behind the first pass->links ones, as the mesh of the pass reaches it; of blocks
   (links 0) an element for each: a vertex outside is outside of all, and faces between two blocks are not
   cut. The pass has a document, a state, a chain and threads; an embedding or locations, if they are of the
   link, are used or filled. Hidden parts do not count. Errors: FFD_E_MEMORY, FFD_E_LIMIT, and those of
   reading faces. */
ffd_status ffd_cut_faces_find(const mesh_pass *pass, cut_faces *cuts, ffd_error *error);

#endif
