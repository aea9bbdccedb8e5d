#include "batch/mesh_states.h"
#include "base/little_endian.h"
#include "base/one_line.h"

/* Bits of a state that fit into the table: its numbers have 39 bits, and one says whether a warning was
   given. */
#define STATE_BITS 38
#define TOLD 1u

ffd_status ffd_states_note(mesh_states *states, pool_task *task, ffd_error *error)
{
    uint64_t known;
    if (!task->has_mesh_state)
        return FFD_OK;
    const uint64_t state = load_u64(task->mesh_state.bytes) >> (64 - STATE_BITS) << 1;
    if (!ffd_files_find(&states->first, &task->mesh, &known))
        return ffd_files_put(&states->first, &task->mesh, state, error);
    if (known & TOLD || known == state)
        return FFD_OK;
    const size_t before = task->log.size;
    ffd_buffer_format(&task->log,
                      "%s: has changed while the run reads it: jobs before this one have read another state",
                      task->job.input);
    ffd_make_one_line(task->log.data + before, task->log.size - before);
    ffd_buffer_text(&task->log, "\n");
    return task->log.failed ? ffd_fail_memory(error)
                            : ffd_files_put(&states->first, &task->mesh, known | TOLD, error);
}

void ffd_states_free(mesh_states *states)
{
    ffd_files_free(&states->first);
}
