#include "points/weights.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "mesh/slopes.h"
#include "mesh/twins.h"
#include "points/point_run.h"
#include "points/span.h"
#include <string.h>

ffd_status ffd_weights_check(const double *weights, const uint32_t *list, size_t count, ffd_error *error)
{
    if (!weights && count > 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "there are no weights");
    for (size_t i = 0; i < count; i++) {
        const size_t point = list ? list[i] : i;
        if (!(weights[point] >= 0 && weights[point] <= 1))
            return ffd_fail(error, FFD_E_INVALID, "the weight of point %zu is %g, not a number from 0 to 1",
                            point, weights[point]);
    }
    return FFD_OK;
}

typedef struct slope_call {
    const ffd_span *points;
    const uint32_t *triangles;
    size_t count; /* of triangles */
    double *positions;
    slope_sums found;
    double *slopes;
} slope_call;

static ffd_status check_triangles(const slope_call *call, ffd_error *error)
{
    if (!call->triangles && call->count > 0)
        return ffd_fail(error, FFD_E_ARGUMENT, "there are no triangles");
    for (size_t i = 0; i < 3 * call->count; i++)
        if (call->triangles[i] >= call->points->count)
            return ffd_fail(error, FFD_E_ARGUMENT, "triangle %zu has point %u, but there are %zu", i / 3,
                            (unsigned)call->triangles[i], call->points->count);
    return FFD_OK;
}

static ffd_status read_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const slope_call *const call = context;
    (void)worker, (void)error;
    ffd_span_read(call->points, first, count, call->positions + 3 * first);
    return FFD_OK;
}

static void write_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const slope_call *const call = context;
    (void)tile, (void)worker;
    for (size_t i = first; i < last; i++)
        ffd_slope_at(&call->found, i, call->slopes + 3 * i);
}

/* Triangles that are passed at a time. */
#define RUN ((size_t)1 << 12)

static ffd_status walk(const void *surface, mesh_triangle_visitor *visit, void *context, ffd_error *error)
{
    const slope_call *const call = surface;
    for (size_t first = 0; first < call->count; first += RUN) {
        TRY(ffd_deadline_check(error));
        visit(context, call->triangles + 3 * first, call->count - first < RUN ? call->count - first : RUN);
    }
    return FFD_OK;
}

ffd_status ffd_weight_slopes(ffd_span points, const double *weights, const uint32_t *triangles, size_t count,
                             double *slopes, const ffd_run_options *options, ffd_error *error)
{
    slope_call call = {.points = &points, .triangles = triangles, .count = count, .slopes = slopes};
    point_run run = {.total = 0};
    uint32_t *twins = NULL;
    ffd_status status;
    TRY_END(ffd_span_check(&points, points.count, "the array of points", error));
    TRY_END(ffd_weights_check(weights, NULL, points.count, error));
    TRY_END(check_triangles(&call, error));
    TRY_END(slopes || points.count == 0
                ? FFD_OK
                : ffd_fail(error, FFD_E_ARGUMENT, "there is no array for the slopes"));
    call.positions = ffd_alloc_whole(points.count, 3 * sizeof *call.positions);
    call.found.sums = ffd_alloc_whole(points.count, SLOPE_STRIDE * sizeof *call.found.sums);
    twins = ffd_alloc_whole(points.count, sizeof *twins);
    TRY_END(call.positions && call.found.sums && twins ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_point_run_begin(options, points.count, &run, error));
    TRY_END(ffd_point_run_tiles(&run, read_tile, &call, error));
    const weighted_surface surface = {.positions = call.positions,
                                      .weights = weights,
                                      .vertex_count = points.count,
                                      .walk = walk,
                                      .surface = &call,
                                      .isa = run.options.isa};
    TRY_END(ffd_positions_twins(call.positions, points.count, run.options.threads, twins, error));
    TRY_END(ffd_slopes_find(&surface, twins, run.options.threads, &call.found, NULL, error));
    ffd_parallel_tiles(points.count, RUN, run.options.threads, write_tile, &call);
end:
    ffd_point_run_end(&run);
    ffd_free(call.positions);
    ffd_free(call.found.sums);
    ffd_free(twins);
    return status;
}
