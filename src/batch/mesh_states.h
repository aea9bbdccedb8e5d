/* mesh_states.h - detects that jobs of a run have read different states of a mesh, so that their outputs are
   not mixed without a warning. */
#ifndef FFD_BATCH_MESH_STATES_H
#define FFD_BATCH_MESH_STATES_H

#include "base/memory/file_table.h"
#include "base/text/buffer.h"
#include "batch/pool.h"

/* All zeros: empty. */
typedef struct mesh_states {
    file_table first; /* for each mesh: its first state, and whether a warning was given */
} mesh_states;

/* Records the state of the mesh that an ended job has read. Appends a warning to its log, once for each mesh,
   if an earlier job has read another state. Errors: FFD_E_MEMORY. */
ffd_status ffd_states_note(mesh_states *states, pool_task *task, ffd_error *error);
/* Frees the table; leaves all zeros. */
void ffd_states_free(mesh_states *states);

#endif
