/* fuzz_pairs.c - a table of pairs: what is accepted gives a lattice that carries the exact ones where they
   are wanted, what is not is refused by one line. */
#include "fuzz_target.h"
#include "mutate_text.h"
#include "promise.h"
#include <ffd/fit.h>
#include <math.h>
#include <string.h>

static const char mesh[] = "ply\nformat ascii 1.0\nelement vertex 6\nproperty double x\nproperty double y\n"
                           "property double z\nelement face 0\nproperty list uchar int vertex_indices\n"
                           "end_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 0 1\n1 1 1\n";
static const char lattice[] = "{\"format\":\"ffd-lattice\",\"version\":1,\"size\":[3,3,3],\"degree\":[2,2,2],"
                              "\"rest\":{\"box\":{\"min\":[-1,-1,-1],\"max\":[2,2,2]}},\"moves\":[]}";

static ffd_status take(void *user, const char *name, const void *bytes, size_t size)
{
    (void)name;
    PROMISE(bytes && size > 0, "an empty lattice is written");
    ++*(int *)user;
    return FFD_OK;
}

static void check_result(const ffd_fit_job_result *result)
{
    const ffd_fit_result *const r = &result->fit;
    PROMISE(result->is_fitted && result->has_rows, "the figures are missing");
    PROMISE(r->used > 0 && r->used + r->outside + r->multiple + r->singular == r->pairs,
            "the pairs do not add up");
    PROMISE(r->exact <= r->used && r->dependent <= r->exact, "more exact pairs than pairs");
    PROMISE(r->worst < r->pairs && r->residual_rms <= r->residual_max * (1 + 1e-12),
            "the residuals do not fit");
}

/* Coordinates of 1e300 have no products: such a fit may say that its result is not finite. */
static void fit(const uint8_t *data, size_t size, bool handles)
{
    const ffd_source source = {.path = "in.ply", .bytes = {mesh, sizeof mesh - 1}};
    ffd_author_desc author;
    ffd_fit_job job;
    ffd_fit_job_result result = {.struct_size = sizeof result};
    ffd_error error;
    int written = 0;
    ffd_author_desc_init(&author, sizeof author);
    author.lattice = (ffd_lattice_source){.text = {lattice, sizeof lattice - 1}};
    author.output = "out.json";
    author.sink = take;
    author.sink_user = &written;
    author.threads = 1;
    ffd_fit_job_init(&job, sizeof job);
    job.job = &author;
    job.before = &source;
    job.pairs_bytes = (ffd_bytes){data, size};
    job.handles = handles;
    const ffd_status status = ffd_fit_run(&job, &result, &error);
    PROMISE(written == !status, "status %d, and %d outputs", status, written);
    PROMISE(!status || (error.status == status && error.message[0] && !strpbrk(error.message, "\r\n")),
            "status %d says '%s'", status, error.message);
    PROMISE(!status || status == FFD_E_INVALID || status == FFD_E_EMBEDDING || status == FFD_E_UNMET ||
                status == FFD_E_LIMIT,
            "status %d: %s", status, error.message);
    if (!status)
        check_result(&result);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    fit(data, size, false);
    fit(data, size, true);
    return 0;
}

size_t fuzz_mutate(uint8_t *data, size_t size, size_t capacity, uint64_t seed)
{
    return mutate_text(data, size, capacity, seed, ",;\"xyzpvertwigh0123456789.e-\n\r\xef");
}
