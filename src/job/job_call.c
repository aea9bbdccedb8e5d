#include "job/job_call.h"
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "job/chain/chain_load.h"
#include "job/figures/figure_values.h"
#include "job/input/deform_desc.h"
#include "job/report/output_set.h"

/* Replaces the caller's results of morph targets by own ones. */
static ffd_status make_morph_results(job_call *call, ffd_error *error)
{
    call->callers_morphs = call->desc.morph_results;
    if (!call->callers_morphs)
        return FFD_OK;
    call->desc.morph_results = ffd_alloc_zero(call->desc.lattice_count, sizeof *call->desc.morph_results);
    return call->desc.morph_results ? FFD_OK : ffd_fail_memory(error);
}

work_watch ffd_job_watch(const ffd_deform_desc *desc)
{
    return (work_watch){.progress = desc->progress, .user = desc->progress_user, .cancel = desc->cancel};
}

void ffd_job_watch_end(const work_watch *watch, ffd_status status)
{
    if (!status && watch->progress)
        watch->progress(watch->user, 1);
}

ffd_status ffd_job_call_begin(job_call *call, const ffd_deform_desc *desc, ffd_job_result *result,
                              ffd_error *error)
{
    ffd_error *const own = &call->result.error;
    *call = (job_call){.callers_result = result};
    ffd_result_clear(&call->result);
    TRY(ffd_struct_check(sizeof call->result, result, "ffd_job_result", error));
    call->size = result->struct_size;
    const ffd_status taken = ffd_deform_desc_take(desc, &call->desc, own);
    if (!taken && call->desc.output_list)
        ffd_paths_free(&call->desc.output_list->names);
    if (!taken)
        call->watch = ffd_job_watch(&call->desc);
    call->before = ffd_deadline_begin(&call->own, taken ? 0 : call->desc.timeout, &call->watch);
    TRY(taken);
    call->callers_lattices = call->desc.lattices;
    TRY(ffd_chain_check_count(call->desc.lattice_count, own));
    TRY(ffd_in_memory_desc(&call->memory, &call->desc, own));
    return make_morph_results(call, own);
}

ffd_status ffd_job_call_end(job_call *call, ffd_status status, ffd_error *error)
{
    ffd_job_result *const result = &call->result;
    if (call->size == 0)
        return status;
    for (size_t k = 0; call->callers_morphs && call->desc.morph_results && k < call->desc.lattice_count; k++)
        ffd_struct_give(&call->desc.morph_results[k], sizeof *call->desc.morph_results,
                        (char *)call->callers_morphs + k * call->size, call->size);
    if (call->callers_morphs)
        ffd_free(call->desc.morph_results);
    status = ffd_in_memory_end(&call->memory, status, &result->error);
    if (result->morphs.results)
        result->morphs.results = call->callers_morphs;
    if (result->morphs.lattices)
        result->morphs.lattices = call->callers_lattices;
    result->outputs = call->desc.output_list;
    if (status && result->outputs)
        ffd_paths_free(&call->desc.output_list->names);
    ffd_job_watch_end(&call->watch, status);
    ffd_deadline_end(call->before);
    if (status && error)
        *error = result->error;
    result->status = status;
    ffd_struct_give(result, sizeof *result, call->callers_result, call->size);
    return status;
}
