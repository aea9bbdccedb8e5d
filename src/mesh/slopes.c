#include "mesh/slopes.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "base/vector/array_kernel.h"
#include "base/vector/vec.h"
#include "mesh/triangle_kernel.h"
#include <string.h>

/* Vertices that are finished at a time. */
#define TILE ((size_t)1 << 14)

/* Positions that a thread holds, where not all are: half of what the nearer cache holds. */
#define WINDOW ((size_t)1 << 14)
/* So many times the vertices of its share a thread reads at most. */
#define MOST_READS 4

#define ROW(ISA, set, lanes) [FFD_ISA_##ISA] = ffd_triangle_kernel_##set,
static triangle_kernel *const kernels[] = {[FFD_ISA_SCALAR] = ffd_triangle_kernel_scalar, FOR_EACH_SIMD(ROW)};

typedef struct slope_work {
    const weighted_surface *surface;
    const double *positions; /* of all vertices; NULL: each thread reads them */
    const uint32_t *twins;
    triangle_kernel *kernel;
    const array_kernel *arrays;
    double scale;         /* a power of two: lengths times this are near 1 */
    double *sums;         /* of each position, at its first vertex */
    ffd_status *statuses; /* of each thread's walk */
    ffd_error *errors;
    bool *have_triangles, *gave_up;
} slope_work;

/* The positions of the vertices [first, first + count): of all, or of those near the triangles at hand. */
typedef struct position_window {
    const double *positions;
    size_t first, count;
    double *room; /* WINDOW positions; NULL: the window holds all */
    size_t left;  /* so many may still be read */
} position_window;

/* A thread's walk: it makes the sums of the vertices [first, first + count). */
typedef struct slope_walk {
    const slope_work *work;
    size_t first, count;
    position_window window;
    bool has_triangles, gave_up;
} slope_walk;

/* Moves the window to vertices from `low` to `high`: to begin or end with them, by the way it came. Returns
   false if they are too far apart, or it has been moved too often. */
static bool move_window(const weighted_surface *surface, position_window *window, size_t low, size_t high)
{
    const size_t all = surface->vertex_count, count = all < WINDOW ? all : WINDOW;
    const bool returns = low < window->first;
    if (high - low >= count || window->left < count)
        return false;
    window->first = !returns ? low : high + 1 > count ? high + 1 - count : 0;
    if (window->first > all - count)
        window->first = all - count;
    window->count = count;
    window->left -= count;
    surface->read(surface->surface, window->first, count, window->room);
    return true;
}

/* Sees to it that the window holds vertices from `low` to `high`. Returns false if it cannot. */
static bool hold(slope_walk *walk, uint32_t low, uint32_t high)
{
    position_window *const window = &walk->window;
    return (low >= window->first && high - window->first < window->count) ||
           move_window(walk->work->surface, window, low, high);
}

/* Adds triangles, unless all of them are before the thread's share or behind it. */
static void add_run(slope_walk *walk, const uint32_t *corners, size_t count)
{
    const slope_work *const work = walk->work;
    uint32_t twins[3 * TRIANGLE_RUN];
    for (size_t i = 0; i < 3 * count && work->twins; i++)
        twins[i] = work->twins[corners[i]];
    const uint32_t *const owners = work->twins ? twins : corners;
    uint32_t low, high;
    work->arrays->span(owners, 3 * count, &low, &high);
    if (high < walk->first || low >= walk->first + walk->count)
        return;
    if (work->twins)
        work->arrays->span(corners, 3 * count, &low, &high);
    walk->gave_up = !hold(walk, low, high);
    const triangle_run run = {.count = count,
                              .corners = corners,
                              .owners = owners,
                              .positions = walk->window.positions,
                              .base = walk->window.first,
                              .weights = work->surface->weights,
                              .scale = work->scale,
                              .sums = work->sums + SLOPE_STRIDE * walk->first,
                              .first = (uint32_t)walk->first,
                              .share = (uint32_t)walk->count};
    if (!walk->gave_up)
        work->kernel(&run);
}

static void add_triangles(void *context, const uint32_t *corners, size_t count)
{
    slope_walk *const walk = context;
    walk->has_triangles = walk->has_triangles || count > 0;
    for (size_t run; count > 0 && !walk->gave_up; count -= run, corners += 3 * run) {
        run = count < TRIANGLE_RUN ? count : TRIANGLE_RUN;
        add_run(walk, corners, run);
    }
}

/* Returns false if memory runs out. */
static bool begin_window(slope_walk *walk)
{
    const slope_work *const work = walk->work;
    const size_t most = (MOST_READS * walk->count / WINDOW + MOST_READS) * WINDOW;
    walk->window = (position_window){work->positions, 0, work->surface->vertex_count, NULL, 0};
    memset(work->sums + SLOPE_STRIDE * walk->first, 0, SLOPE_STRIDE * walk->count * sizeof *work->sums);
    if (work->positions)
        return true;
    double *const room = ffd_alloc(WINDOW, 3 * sizeof *room);
    walk->window = (position_window){room, 0, 0, room, most};
    return room;
}

static void sum_share(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const slope_work *const work = context;
    slope_walk walk = {.work = work, .first = first, .count = last - first};
    (void)worker;
    if (begin_window(&walk))
        work->statuses[tile] =
            work->surface->walk(work->surface->surface, add_triangles, &walk, &work->errors[tile]);
    else
        work->statuses[tile] = ffd_fail_memory(&work->errors[tile]);
    ffd_free(walk.window.room);
    work->have_triangles[tile] = walk.has_triangles;
    work->gave_up[tile] = walk.gave_up;
}

/* Copies the sums of a position to its other vertices. */
static void copy_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const slope_work *const work = context;
    (void)tile, (void)worker;
    for (size_t v = first; v < last; v++)
        if (work->twins[v] != v)
            memcpy(work->sums + SLOPE_STRIDE * v, work->sums + SLOPE_STRIDE * (size_t)work->twins[v],
                   SLOPE_STRIDE * sizeof *work->sums);
}

/* The greatest magnitude of the coordinates of each tile. */
typedef struct tile_sizes {
    const weighted_surface *surface;
    double *largest;
} tile_sizes;

static void measure_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const tile_sizes *const work = context;
    (void)worker;
    work->largest[tile] = ffd_array_kernel(work->surface->isa)
                              ->magnitude(work->surface->positions + 3 * first, 3 * (last - first));
}

static ffd_status find_largest(const weighted_surface *surface, int threads, double *largest,
                               ffd_error *error)
{
    const size_t count = surface->vertex_count;
    tile_sizes work = {surface, ffd_alloc_zero(count / TILE + 1, sizeof *work.largest)};
    *largest = 0;
    if (!work.largest)
        return ffd_fail_memory(error);
    ffd_parallel_tiles(count, TILE, threads, measure_tile, &work);
    for (size_t t = 0; t <= count / TILE; t++)
        *largest = larger_of(*largest, work.largest[t]);
    ffd_free(work.largest);
    return ffd_deadline_check(error);
}

/* Finds the power of two that takes the largest finite coordinate near 1, so that no product of four lengths
   underflows or overflows. */
static ffd_status find_scale(const weighted_surface *surface, int threads, double *scale, ffd_error *error)
{
    double largest = surface->largest;
    int exponent;
    TRY(surface->positions ? find_largest(surface, threads, &largest, error) : FFD_OK);
    frexp(largest, &exponent);
    *scale = ldexp(1, exponent < -1000 ? 1000 : -exponent);
    return FFD_OK;
}

/* Each thread walks over all triangles and makes the sums of some vertices: in nearly all meshes the
   triangles round near vertices are together. */
static ffd_status sum_up(const slope_work *work, int threads, ffd_error *error)
{
    const size_t count = work->surface->vertex_count, share = count / (size_t)threads + 1;
    ffd_parallel_tiles(count, share, threads, sum_share, (void *)work);
    for (int t = 0; t < threads; t++)
        if (work->statuses[t]) {
            if (error)
                *error = work->errors[t];
            return work->statuses[t];
        }
    return ffd_deadline_check(error);
}

/* Reads the positions of all vertices. */
typedef struct read_work {
    const weighted_surface *surface;
    double *positions;
} read_work;

static void read_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const read_work *const work = context;
    (void)tile, (void)worker;
    work->surface->read(work->surface->surface, first, last - first, work->positions + 3 * first);
}

/* Makes the sums once more by the positions of all vertices, if a thread gave up. */
static ffd_status sum_by_all(slope_work *work, int threads, ffd_error *error)
{
    const size_t count = work->surface->vertex_count;
    bool gave_up = false;
    for (int t = 0; t < threads; t++)
        gave_up = gave_up || work->gave_up[t];
    if (!gave_up)
        return FFD_OK;
    read_work reading = {work->surface, ffd_alloc_whole(count, SLOPE_BYTES)};
    if (!reading.positions)
        return ffd_fail_memory(error);
    ffd_parallel_tiles(count, TILE, threads, read_tile, &reading);
    work->positions = reading.positions;
    const ffd_status status = sum_up(work, threads, error);
    ffd_free(reading.positions);
    return status;
}

ffd_status ffd_slopes_find(const weighted_surface *surface, const uint32_t *twins, int threads,
                           slope_sums *slopes, bool *has_triangles, ffd_error *error)
{
    const size_t count = surface->vertex_count;
    const int used = ffd_threads_for(threads, count / TILE + 1);
    slope_work work = {.surface = surface,
                       .positions = surface->positions,
                       .twins = twins,
                       .kernel = kernels[ffd_isa_resolve(surface->isa)],
                       .arrays = ffd_array_kernel(surface->isa),
                       .sums = slopes->sums,
                       .statuses = ffd_alloc_zero((size_t)used, sizeof *work.statuses),
                       .errors = ffd_alloc_zero((size_t)used, sizeof *work.errors),
                       .have_triangles = ffd_alloc_zero((size_t)used, sizeof *work.have_triangles),
                       .gave_up = ffd_alloc_zero((size_t)used, sizeof *work.gave_up)};
    ffd_status status;
    TRY_END(work.statuses && work.errors && work.have_triangles && work.gave_up ? FFD_OK
                                                                                : ffd_fail_memory(error));
    TRY_END(find_scale(surface, used, &work.scale, error));
    TRY_END(sum_up(&work, used, error));
    TRY_END(sum_by_all(&work, used, error));
    slopes->scale = work.scale;
    if (twins)
        ffd_parallel_tiles(count, TILE, used, copy_tile, &work);
    if (has_triangles) /* each walk sees all */
        *has_triangles = work.have_triangles[0];
end:
    ffd_free(work.statuses);
    ffd_free(work.errors);
    ffd_free(work.have_triangles);
    ffd_free(work.gave_up);
    return status;
}

ffd_status ffd_slopes_walk_faces(const void *surface, mesh_triangle_visitor *visit, void *context,
                                 ffd_error *error)
{
    const mesh_faces *const faces = surface;
    for (size_t f = 0; f < faces->face_count; f++) {
        const uint32_t *const corners = faces->corners + faces->start[f];
        const size_t count = faces->start[f + 1] - faces->start[f];
        TRY(ffd_deadline_check_at(f, error));
        for (size_t c = 2; c < count; c++)
            visit(context, (const uint32_t[]){corners[0], corners[c - 1], corners[c]}, 1);
    }
    return FFD_OK;
}
