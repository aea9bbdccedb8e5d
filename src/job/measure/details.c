#include "job/measure/details.h"
#include "base/memory/memory.h"

ffd_status ffd_details_begin(job_details *details, size_t vertex_count, memory_budget *budget,
                             ffd_error *error)
{
    TRY(ffd_budget_take(budget, vertex_count, sizeof *details->statuses, error));
    details->statuses = ffd_alloc_zero(vertex_count, sizeof *details->statuses);
    return details->statuses ? FFD_OK : ffd_fail_memory(error);
}

void ffd_details_free(job_details *details)
{
    ffd_free(details->statuses);
    ffd_mesh_faces_free(&details->faces);
    ffd_free(details->deformed);
    ffd_free(details->gradients);
    ffd_free(details->collapsed);
    ffd_free(details->tears.list);
    *details = (job_details){0};
}
