/* mesh_states.h - in which state the jobs of a run have read each mesh: outputs of two states are not to be
   mixed without a word. */
#ifndef FFD_BATCH_MESH_STATES_H
#define FFD_BATCH_MESH_STATES_H

#include "base/text/buffer.h"
#include "batch/manifest/file_table.h"
#include "batch/pool.h"

/* All zeros: none is known. */
typedef struct mesh_states {
    file_table first; /* of each mesh: of the state that was read first, and whether another one was told */
} mesh_states;

/* Notes the state that an ended job has read its mesh in, and adds a line to the job's log where a job before
   it has read another one: once for each mesh. Errors: FFD_E_MEMORY. */
ffd_status ffd_states_note(mesh_states *states, pool_task *task, ffd_error *error);
/* Leaves none. */
void ffd_states_free(mesh_states *states);

#endif
