/* evaluate_many.c - ffd_lattice_evaluate_many: evaluates the volume at many u,v,w, cell by cell. */
#include "base/memory/memory.h"
#include "lattice/lattice.h"
#include "points/evaluate_kernel.h"
#include "points/point_run.h"
#include <math.h>
#include <string.h>

/* With more spans in a direction, sorting a tile would take longer than evaluating it. */
#define MOST_SPANS POINT_TILE

/* Scratch memory of a thread for a tile. */
typedef struct evaluate_scratch {
    double inside[3 * POINT_TILE], uvw[3 * POINT_TILE]; /* in the domain: as given, and cell by cell */
    uint32_t span[3][POINT_TILE];                       /* indices among the spans that are not empty */
    uint32_t which[2][POINT_TILE];                      /* the points, sorted */
    uint32_t starts[MOST_SPANS + 1];
    double points[3 * MAX_ORDER * MAX_ORDER * MAX_ORDER]; /* of a cell */
} evaluate_scratch;

typedef struct evaluate_work {
    const ffd_lattice *lattice;
    ffd_volume volume;
    const double *uvw;
    double *xyz, *jacobians;
    span_quotients *quotients[3]; /* of each span that is not empty; NULL: each point is evaluated alone */
    evaluate_kernel *kernel;
    evaluate_scratch *scratch; /* one for each thread */
} evaluate_work;

/* Returns the number of a quotient, and adds it if it is new. */
static uint8_t add_quotient(double knot, double width, size_t from, span_quotients *all)
{
    for (size_t i = from; i < all->count; i++)
        if (all->knot[i] == knot && all->width[i] == width)
            return (uint8_t)i;
    all->knot[all->count] = knot;
    all->width[all->count] = width;
    return (uint8_t)all->count++;
}

/* Lists the quotients of triangle_raise for each degree. */
static void list_quotients(const knot_vector *knots, int span, span_quotients *all)
{
    all->count = 0;
    for (int rising = 0; rising < 2; rising++) {
        const size_t from = all->count;
        for (int degree = 1, step = 0; degree <= knots->degree; degree++)
            for (int r = 0; r < degree; r++, step++) {
                const double left = knots->t[span + 1 - degree + r], right = knots->t[span + 1 + r];
                if (rising)
                    all->rise[step] = add_quotient(left, right - left, from, all);
                else
                    all->fall[step] = add_quotient(right, right - left, from, all);
            }
        all->falling = rising ? all->falling : all->count;
    }
}

/* Sorts points by their spans in a direction; those of one span keep their order. */
static void sort_by(const uint32_t *span, size_t spans, size_t count, const uint32_t *from, uint32_t *to,
                    uint32_t *starts)
{
    memset(starts, 0, (spans + 1) * sizeof *starts);
    for (size_t i = 0; i < count; i++)
        starts[span[i] + 1]++;
    for (size_t s = 0; s < spans; s++)
        starts[s + 1] += starts[s];
    for (size_t i = 0; i < count; i++)
        to[starts[span[from[i]]]++] = from[i];
}

/* Finds the cells of a tile's points. Returns false if a point is not a number. */
static bool find_cells(const evaluate_work *work, const double *uvw, size_t count, evaluate_scratch *s)
{
    for (size_t i = 0; i < count; i++)
        for (size_t a = 0; a < 3; a++) {
            const knot_vector *const knots = &work->lattice->knots[a];
            const double u = ffd_knots_wrap(knots, uvw[3 * i + a]);
            if (isnan(u))
                return false;
            s->inside[3 * i + a] = u;
            s->span[a][i] = knots->span_count > 1 ? (uint32_t)ffd_knots_span_index(knots, u) : 0;
        }
    return true;
}

static bool has_one_cell(const ffd_lattice *lattice)
{
    return lattice->knots[0].span_count * lattice->knots[1].span_count * lattice->knots[2].span_count == 1;
}

/* Sorts the points of a tile by cell. Returns their order. */
static const uint32_t *sort_points(const ffd_lattice *lattice, size_t count, evaluate_scratch *s)
{
    int now = 0;
    for (size_t i = 0; i < count; i++)
        s->which[0][i] = (uint32_t)i;
    for (int a = 0; a < 3; a++)
        if (lattice->knots[a].span_count > 1) {
            sort_by(s->span[a], lattice->knots[a].span_count, count, s->which[now], s->which[!now],
                    s->starts);
            now = !now;
        }
    for (size_t i = 0; i < count; i++)
        memcpy(s->uvw + 3 * i, s->inside + 3 * (size_t)s->which[now][i], 3 * sizeof *s->uvw);
    return s->which[now];
}

/* The same where the lattice has one cell. */
static const uint32_t *take_points(size_t count, evaluate_scratch *s)
{
    for (size_t i = 0; i < count; i++)
        s->which[0][i] = (uint32_t)i;
    return s->which[0];
}

static bool is_same_cell(const evaluate_scratch *s, uint32_t a, uint32_t b)
{
    return s->span[0][a] == s->span[0][b] && s->span[1][a] == s->span[1][b] && s->span[2][a] == s->span[2][b];
}

/* Evaluates the sorted points of a tile cell by cell. */
static void evaluate_cells(const evaluate_work *work, const uint32_t *which, const double *uvw, size_t count,
                           double *xyz, evaluate_scratch *s)
{
    const double *const field = ffd_lattice_get_points(work->lattice, work->volume);
    for (size_t first = 0, end; first < count; first = end) {
        evaluate_cell cell = {
            .points = s->points, .uvw = uvw + 3 * first, .which = which + first, .xyz = xyz};
        int span[3];
        for (end = first + 1; end < count && is_same_cell(s, which[first], which[end]);)
            end++;
        for (int a = 0; a < 3; a++) {
            const knot_vector *const knots = &work->lattice->knots[a];
            span[a] = knots->spans[s->span[a][which[first]]];
            cell.degree[a] = knots->degree;
            cell.span[a] = &work->quotients[a][s->span[a][which[first]]];
        }
        cell.count = end - first;
        ffd_lattice_cell_points(work->lattice, field, span, s->points);
        work->kernel(&cell);
    }
}

static ffd_status evaluate_tile(void *context, size_t first, size_t count, int worker, ffd_error *error)
{
    const evaluate_work *const work = context;
    evaluate_scratch *const s = work->scratch ? &work->scratch[worker] : NULL;
    (void)error;
    if (s && find_cells(work, work->uvw + 3 * first, count, s)) {
        const bool is_one = has_one_cell(work->lattice);
        const uint32_t *const which = is_one ? take_points(count, s) : sort_points(work->lattice, count, s);
        evaluate_cells(work, which, is_one ? s->inside : s->uvw, count, work->xyz + 3 * first, s);
        return FFD_OK;
    }
    for (size_t i = first; i < first + count; i++)
        ffd_lattice_evaluate(work->lattice, work->volume, work->uvw + 3 * i, work->xyz + 3 * i,
                             work->jacobians ? work->jacobians + 9 * i : NULL);
    return FFD_OK;
}

/* Returns the kernel of an instruction set. */
static evaluate_kernel *kernel_of(ffd_isa isa)
{
#define ROW(ISA, set, lanes) [FFD_ISA_##ISA] = ffd_evaluate_kernel_##set,
    static evaluate_kernel *const kernels[] = {[FFD_ISA_SCALAR] = ffd_evaluate_kernel_scalar,
                                               FOR_EACH_SIMD(ROW)};
    return kernels[ffd_isa_resolve(isa)];
}

/* With fewer points, or more spans than points, each is evaluated alone. */
#define FEW_POINTS ((size_t)64)

/* Prepares the evaluation cell by cell, where that is quicker. */
static ffd_status begin_cells(const point_run *run, evaluate_work *work, ffd_error *error)
{
    const ffd_lattice *const lattice = work->lattice;
    bool is_alone =
        run->total < FEW_POINTS || work->jacobians || ffd_lattice_get_weights(lattice, work->volume);
    for (int a = 0; a < 3; a++)
        is_alone = is_alone || lattice->knots[a].span_count > MOST_SPANS ||
                   lattice->knots[a].span_count > run->total;
    if (is_alone)
        return FFD_OK;
    work->kernel = kernel_of(run->options.isa);
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        work->quotients[a] = ffd_alloc(knots->span_count, sizeof *work->quotients[a]);
        if (!work->quotients[a])
            return ffd_fail_memory(error);
        for (size_t s = 0; s < knots->span_count; s++)
            list_quotients(knots, knots->spans[s], &work->quotients[a][s]);
    }
    work->scratch = ffd_alloc((size_t)run->options.threads, sizeof *work->scratch);
    return work->scratch ? FFD_OK : ffd_fail_memory(error);
}

ffd_status ffd_lattice_evaluate_many(const ffd_lattice *lattice, ffd_volume volume, const double *uvw,
                                     size_t count, double *xyz, double *jacobians,
                                     const ffd_run_options *options, ffd_error *error)
{
    evaluate_work work = {
        .lattice = lattice, .volume = volume, .uvw = uvw, .xyz = xyz, .jacobians = jacobians};
    point_run run = {.total = 0};
    if (!lattice->rest)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "the lattice has no control points yet: its box is that of a mesh");
    ffd_status status;
    TRY_END(ffd_point_run_begin(options, count, &run, error));
    TRY_END(begin_cells(&run, &work, error));
    TRY_END(ffd_point_run_tiles(&run, evaluate_tile, &work, error));
end:
    for (int a = 0; a < 3; a++)
        ffd_free(work.quotients[a]);
    ffd_free(work.scratch);
    ffd_point_run_end(&run);
    return status;
}
