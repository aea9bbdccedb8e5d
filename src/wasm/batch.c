/* batch.c - what stands in the program for npm in place of src/batch: WebAssembly has no processes to do jobs
 * in. */
#include "base/fail.h"
#include "base/struct_size.h"
#include <ffd/ffd.h>

void ffd_batch_desc_init(ffd_batch_desc *desc, size_t size)
{
    const ffd_batch_desc none = {.struct_size = sizeof none};
    ffd_struct_give(&none, sizeof none, desc, size);
}

ffd_status ffd_batch_desc_check(const ffd_batch_desc *desc, ffd_error *error)
{
    (void)desc;
    (void)error;
    return FFD_OK;
}

ffd_status ffd_batch_run(const ffd_batch_desc *desc, ffd_batch_result *result, ffd_error *error)
{
    (void)desc;
    (void)result;
    return ffd_fail(
        error, FFD_E_UNSUPPORTED,
        "batch: the jobs of a batch run in processes, which this build for WebAssembly does not have (the "
        "program for your system does them)");
}

bool ffd_worker_main(int argc, char **argv, int *exit_code)
{
    (void)argc;
    (void)argv;
    (void)exit_code;
    return false;
}
