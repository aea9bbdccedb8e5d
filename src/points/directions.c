/* directions.c - transforms arrays of normals and tangents. */
#include "base/memory/memory.h"
#include "deform/attribute.h"
#include "points/point_run.h"
#include "points/span.h"

typedef struct direction_scratch {
    double directions[3 * POINT_TILE], normals[3 * POINT_TILE];
    uint8_t outcomes[POINT_TILE];
} direction_scratch;

typedef struct direction_work {
    const double *gradients;
    ffd_span in, out, normals;
    bool tangents;
    ffd_isa isa;
    direction_scratch *scratch; /* one for each thread */
    atomic_size_t collapsed;
} direction_work;

static ffd_status carry_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    direction_work *const work = context;
    direction_scratch *const s = &work->scratch[worker];
    const bool has_normals = work->tangents && work->normals.count > 0;
    const attribute_batch batch = {.gradients = work->gradients + 9 * first,
                                   .count = count,
                                   .directions = s->directions,
                                   .step = 3,
                                   .normals = has_normals ? s->normals : NULL,
                                   .outcomes = s->outcomes};
    size_t collapsed = 0;
    (void)error;
    ffd_span_read(&work->in, first, count, s->directions);
    if (has_normals)
        ffd_span_read(&work->normals, first, count, s->normals);
    if (work->tangents)
        ffd_deform_tangents(work->isa, &batch);
    else
        ffd_deform_normals(work->isa, &batch);
    for (size_t i = 0; i < count; i++) {
        collapsed += s->outcomes[i] == FFD_DIRECTION_COLLAPSED;
        if (s->outcomes[i] == FFD_DIRECTION_CARRIED || work->in.type != work->out.type)
            ffd_span_write(&work->out, first + i, 1, s->directions + 3 * i);
        else if (work->in.data != work->out.data)
            ffd_span_copy(&work->in, &work->out, first + i);
    }
    atomic_fetch_add(&work->collapsed, collapsed);
    return FFD_OK;
}

static ffd_status check(direction_work *work, ffd_error *error)
{
    const char *const what = work->tangents ? "the array of tangents" : "the array of normals";
    TRY(ffd_span_check(&work->in, work->in.count, what, error));
    TRY(ffd_span_check(&work->out, work->in.count, "the array of results", error));
    if (work->normals.count > 0)
        TRY(ffd_span_check(&work->normals, work->in.count, "the array of normals", error));
    if (!work->gradients && work->in.count > 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "there are no gradients");
    return FFD_OK;
}

static ffd_status carry(direction_work *work, size_t *collapsed, const ffd_run_options *options,
                        ffd_error *error)
{
    point_run run = {.total = 0};
    atomic_init(&work->collapsed, 0);
    ffd_status status;
    TRY_END(check(work, error));
    TRY_END(ffd_point_run_begin(options, work->in.count, &run, error));
    work->isa = run.options.isa;
    work->scratch = ffd_alloc((size_t)run.options.threads, sizeof *work->scratch);
    TRY_END(work->scratch ? ffd_point_run_tiles(&run, carry_tile, work, error) : ffd_fail_memory(error));
end:
    if (collapsed)
        *collapsed = atomic_load(&work->collapsed);
    ffd_free(work->scratch);
    ffd_point_run_end(&run);
    return status;
}

ffd_status ffd_normals_deform(const double *gradients, ffd_span in, ffd_span out, size_t *collapsed,
                              const ffd_run_options *options, ffd_error *error)
{
    direction_work work = {.gradients = gradients, .in = in, .out = out};
    return carry(&work, collapsed, options, error);
}

ffd_status ffd_tangents_deform(const double *gradients, ffd_span normals, ffd_span in, ffd_span out,
                               size_t *collapsed, const ffd_run_options *options, ffd_error *error)
{
    direction_work work = {
        .gradients = gradients, .normals = normals, .in = in, .out = out, .tangents = true};
    return carry(&work, collapsed, options, error);
}
