#include "job/measure/quality_edges.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "base/vector/vec.h"
#include "embed/frame/box_tree.h"
#include "job/chain/chain_apply.h"
#include "job/chain/chain_boxes.h"
#include "job/measure/edge_list.h"
#include "job/pass/pass.h"
#include "job/pass/vertex_rounding.h"
#include "lattice/lattice.h"
#include <float.h>
#include <string.h>

/* An edge is sampled at slots 0 .. PIECES of its window: the part of the edge within reach of the lattices,
   or all of it. A piece at level k is PIECES >> k slots wide. */
#define PIECES 64
#define SLOTS (PIECES + 1)
#define FIRST_LEVEL 2 /* every edge is sampled to this level */
#define LAST_LEVEL 6

#define TILE ((size_t)256)   /* edges */
#define BATCH ((size_t)1024) /* points sent through the chain at once */

/* The rules of quality_edges.h. An extent is measured in span cells, or in quarters of a lattice's
   diagonal. */
#define LONG_QUARTER (1.0 / 16)
#define WIDEST_PIECE (1.0 / 2)
#define DIAGONAL_EXTENT 4.0
#define OVERSHOOT (1 + 1.0 / 64)
/* Deviations below this, relative to the coordinates, may be rounding and do not cause refinement. */
#define ROUNDING (256 * DBL_EPSILON)

typedef struct sampled_edge {
    double start[3], along[3]; /* position at rest: start + t along */
    double start_delta[3],
        along_delta[3];          /* displacement of the straight deformed edge: start_delta + t along_delta */
    double weight, along_weight; /* weight + t along_weight at t */
    double chord[3], chord_square; /* from end to end of the straight deformed edge, and its squared length */
    double first, share;           /* the window: t from first to first + share */
    double length;                 /* of the window at rest */
    double rounding, largest;
    uint64_t sampled; /* bit set of inner slots */
    uint64_t open;    /* bit set of pieces at the current level that may be halved */
    bool is_long, left_out;
} sampled_edge;

typedef struct sample_request {
    uint16_t edge; /* index in the tile */
    uint8_t slot;
} sample_request;

/* Scratch memory of one worker. */
typedef struct edge_scratch {
    sampled_edge edges[TILE];
    double offset[TILE][SLOTS][3]; /* from the nearest point of the straight deformed edge */
    double *cells; /* TILE x SLOTS x layers x 3: u,v,w in span cells; NaN: outside, or not sampled */
    uint32_t owners[TILE * SLOTS]; /* blocks that cells refers to */
    size_t first;                  /* index of the tile's first edge */
    size_t requested;
    sample_request requests[BATCH];
    double x[3 * BATCH], delta[3 * BATCH]; /* delta: by all links */
    double link_delta[3 * BATCH];
    point_outcome point_outcomes[BATCH];
    chain_scratch chain;
} edge_scratch;

typedef struct edge_tile {
    uint64_t edges;
    double largest, sum;
    uint64_t worst; /* edge with the largest deviation */
    ffd_status status;
} edge_tile;

typedef struct edge_work {
    const mesh_faces *faces;
    mesh_state state;     /* what the faces are of */
    vertex_owners owners; /* for rounding cells; document NULL: coordinates are exact */
    const double *deformed;
    const vertex_weights *weights;
    const rigid_parts *rigid;
    const lattice_chain *chain;
    size_t layers;
    bounds *reach; /* of each layer: a box outside of which nothing moves */
    edge_list list;
    edge_scratch *scratch; /* one for each worker */
    edge_tile *tiles;
} edge_work;

static double *cells_of(const edge_work *work, edge_scratch *scratch, size_t edge, size_t slot)
{
    return scratch->cells + (edge * SLOTS + slot) * work->layers * 3;
}

/* Returns u as the number of its non-empty span plus the fraction within it. */
static double cell_coordinate(const knot_vector *knots, double u)
{
    const size_t index = ffd_knots_span_index(knots, u);
    const double from = knots->t[knots->spans[index]], to = knots->t[knots->spans[index] + 1];
    return (double)index + (u - from) / (to - from);
}

/* Returns the distance of two parameters in span cells, the shorter way round in a closed direction. HUGE_VAL
   if only one of them is in the lattice: the displacement may jump between them. */
static double cells_between(const knot_vector *knots, double a, double b)
{
    if (isnan(a) || isnan(b))
        return isnan(a) && isnan(b) ? 0 : HUGE_VAL;
    const double distance = fabs(a - b), round = (double)knots->span_count - distance;
    return ffd_knots_closed(knots) && round < distance ? round : distance;
}

/* The extent from slot l to slot r in one lattice. left, right: u,v,w there, in span cells. */
static double lattice_extent(const ffd_lattice *lattice, double length, const double left[3],
                             const double right[3])
{
    double result = DIAGONAL_EXTENT * length / lattice->diagonal;
    for (int a = 0; a < 3; a++)
        result = maximum_number(result, cells_between(&lattice->knots[a], left[a], right[a]));
    return result;
}

/* The extent from slot l to slot r in their block. HUGE_VAL if they are in different blocks: the displacement
   may jump between them. */
static double block_extent(const edge_work *work, const edge_scratch *scratch, double length, size_t l,
                           size_t r)
{
    const uint32_t owner = scratch->owners[l];
    if (owner != scratch->owners[r])
        return HUGE_VAL;
    return owner == BLOCK_NONE ? 0
                               : lattice_extent(work->chain->links[owner].lattice, length,
                                                scratch->cells + 3 * l, scratch->cells + 3 * r);
}

/* The largest extent of the edge from slot l to slot r in any lattice. */
static double extent(const edge_work *work, edge_scratch *scratch, size_t edge, size_t l, size_t r)
{
    const double *left = cells_of(work, scratch, edge, l), *right = cells_of(work, scratch, edge, r);
    const double length = scratch->edges[edge].length * ((double)(r - l) / PIECES);
    double result = 0;
    if (work->chain->blocks)
        return block_extent(work, scratch, length, edge * SLOTS + l, edge * SLOTS + r);
    for (size_t k = 0; k < work->chain->count; k++)
        result = maximum_number(
            result, lattice_extent(work->chain->links[k].lattice, length, left + 3 * k, right + 3 * k));
    return result;
}

/* Clips the segment start + t along, t in 0 .. 1, to a box. *from > *to if it misses the box. */
static void clip(const bounds *box, const double start[3], const double along[3], double *from, double *to)
{
    *from = 0;
    *to = 1;
    for (int a = 0; a < 3; a++) {
        const double lo = (box->lo[a] - start[a]) / along[a], hi = (box->hi[a] - start[a]) / along[a];
        if (along[a] != 0) {
            *from = maximum_number(*from, minimum_number(lo, hi));
            *to = minimum_number(*to, maximum_number(lo, hi));
        } else if (start[a] < box->lo[a] || start[a] > box->hi[a]) {
            *to = -1;
        }
    }
}

/* Half the extents of an edge's rounding cells: in each coordinate the larger of its two ends'. x: where
   links have moved a point; NULL: at rest. */
static void edge_rounding(const edge_work *work, uint64_t key, const double x[3], double half[3])
{
    double other[3];
    ffd_vertex_rounding(&work->owners, work->state, (size_t)(key >> 32), x, half);
    ffd_vertex_rounding(&work->owners, work->state, (size_t)(key & UINT32_MAX), x, other);
    for (int a = 0; a < 3; a++)
        half[a] = larger_of(half[a], other[a]);
}

/* Only the part of an edge within reach of the lattices is sampled. A point beyond them all is moved by no
   link. */
static void find_window(const edge_work *work, const double half[3], sampled_edge *edge)
{
    double first = 2, last = -1;
    for (size_t k = 0; k < work->layers; k++) {
        bounds reach = work->reach[k];
        double from, to;
        for (int a = 0; a < 3; a++) {
            reach.lo[a] -= half[a];
            reach.hi[a] += half[a];
        }
        clip(&reach, edge->start, edge->along, &from, &to);
        if (from <= to) {
            first = minimum_number(first, from);
            last = maximum_number(last, to);
        }
    }
    const bool passes = first < last;
    edge->first = passes ? first : 0;
    edge->share = passes ? last - first : 1;
}

static double parameter_of(const sampled_edge *edge, size_t slot)
{
    return edge->first + (double)slot / PIECES * edge->share;
}

/* Whether the slot is an end of the edge, where the deviation is 0. */
static bool is_end(const sampled_edge *edge, size_t slot)
{
    return (slot == 0 && edge->first == 0) || (slot == PIECES && edge->first + edge->share >= 1);
}

static void begin_edge(const edge_work *work, uint64_t key, sampled_edge *edge)
{
    const size_t a = (size_t)(key >> 32), b = (size_t)(key & UINT32_MAX);
    const double *rest[2] = {work->faces->positions + 3 * a, work->faces->positions + 3 * b};
    const double *after[2] = {work->deformed + 3 * a, work->deformed + 3 * b};
    static const double none[3] = {0, 0, 0};
    double size = 0, half[3];
    memset(edge, 0, sizeof *edge);
    edge->weight = work->weights ? ffd_vertex_weight(work->weights, a) : 1;
    edge->along_weight = work->weights ? ffd_vertex_weight(work->weights, b) - edge->weight : 0;
    for (int c = 0; c < 3; c++) {
        edge->start[c] = rest[0][c];
        edge->along[c] = rest[1][c] - rest[0][c];
        edge->start_delta[c] = after[0][c] - rest[0][c];
        edge->along_delta[c] = after[1][c] - rest[1][c] - edge->start_delta[c];
        edge->chord[c] = after[1][c] - after[0][c];
        for (int i = 0; i < 2; i++)
            size = maximum_number(size, maximum_number(fabs(rest[i][c]), fabs(after[i][c])));
    }
    edge->rounding = ROUNDING * size;
    find_window(work, none, edge);
    if (work->owners.document && edge->share < 1) { /* widen the window by the rounding cells */
        edge_rounding(work, key, NULL, half);
        find_window(work, half, edge);
    }
    edge->length = vec_length(edge->along) * edge->share;
    edge->chord_square = vec_dot(edge->chord, edge->chord);
    edge->left_out = ffd_rigid_motion_of(work->rigid, a) || ffd_rigid_motion_of(work->rigid, b) ||
                     !isfinite(edge->length) || !isfinite(edge->chord_square) ||
                     !vec_is_finite(edge->start_delta) || !vec_is_finite(edge->along_delta);
}

/* Finds the vector from the nearest point of the straight deformed edge to the deformed point at t. Both are
   taken relative to start + t along, so that it is exactly 0 if nothing moves. */
static void find_offset(const sampled_edge *edge, double t, const double delta[3], double offset[3])
{
    double shift = 0;
    for (int a = 0; a < 3; a++)
        offset[a] = delta[a] - (edge->start_delta[a] + t * edge->along_delta[a]);
    if (edge->chord_square > 0)
        shift = minimum_number(maximum_number(vec_dot(offset, edge->chord) / edge->chord_square, -t), 1 - t);
    for (int a = 0; a < 3; a++)
        offset[a] -= shift * edge->chord[a];
}

/* delta: by the lattices, not weighted. */
static void keep_sample(const sample_request *request, const double delta[3], edge_scratch *scratch)
{
    sampled_edge *edge = &scratch->edges[request->edge];
    double *offset = scratch->offset[request->edge][request->slot], weighted[3];
    const double t = parameter_of(edge, request->slot), weight = edge->weight + t * edge->along_weight;
    if (is_end(edge, request->slot)) /* only its u,v,w are needed */
        return;
    for (int a = 0; a < 3; a++)
        weighted[a] = weight * delta[a];
    find_offset(edge, t, weighted, offset);
    const double deviation = vec_length(offset);
    if (request->slot < PIECES)
        edge->sampled |= (uint64_t)1 << request->slot;
    edge->left_out = edge->left_out || !isfinite(deviation);
    edge->largest = maximum_number(edge->largest, deviation);
}

static void count_cells(const ffd_lattice *lattice, const double uvw[3], double cell[3])
{
    for (int a = 0; a < 3; a++)
        cell[a] = isfinite(uvw[a]) ? cell_coordinate(&lattice->knots[a], uvw[a]) : NAN;
}

static void keep_cells(const edge_work *work, edge_scratch *scratch, size_t link)
{
    for (size_t i = 0; i < scratch->requested; i++) {
        const sample_request *request = &scratch->requests[i];
        count_cells(work->chain->links[link].lattice, scratch->chain.locations[i].uvw,
                    cells_of(work, scratch, request->edge, request->slot) + 3 * link);
    }
}

/* Context of find_rounding. */
typedef struct tile_rounding {
    const edge_work *work;
    const edge_scratch *scratch;
    size_t link;
} tile_rounding;

static void find_rounding(const void *context, size_t point, bool is_first, const double x[3], double half[3])
{
    const tile_rounding *tile = context;
    const size_t edge = tile->scratch->first + tile->scratch->requests[point].edge;
    (void)is_first; /* links are applied one at a time */
    edge_rounding(tile->work, tile->work->list.keys[edge], tile->link == 0 ? NULL : x, half);
}

/* Sends the requested points through blocks. */
static ffd_status take_blocks(const edge_work *work, edge_scratch *scratch)
{
    const tile_rounding tile = {work, scratch, 0};
    const chain_rounding rounding = {find_rounding, &tile};
    chain_run run = {.x = scratch->x,
                     .count = scratch->requested,
                     .scratch = &scratch->chain,
                     .delta = scratch->delta,
                     .outcomes = scratch->point_outcomes,
                     .rounding = work->owners.document ? &rounding : NULL};
    TRY(ffd_chain_apply(work->chain, work->chain->count, &run, NULL));
    for (size_t i = 0; i < scratch->requested; i++) {
        const sample_request *request = &scratch->requests[i];
        const uint32_t owner = scratch->chain.owners[i];
        scratch->owners[request->edge * SLOTS + request->slot] = owner;
        if (owner != BLOCK_NONE)
            count_cells(work->chain->links[owner].lattice, scratch->chain.locations[i].uvw,
                        cells_of(work, scratch, request->edge, request->slot));
    }
    return FFD_OK;
}

/* Sends the requested points through the chain, one link at a time to get the u,v,w in each. */
static ffd_status take_links(const edge_work *work, edge_scratch *scratch)
{
    tile_rounding tile = {work, scratch, 0};
    const chain_rounding rounding = {find_rounding, &tile};
    memset(scratch->delta, 0, 3 * scratch->requested * sizeof(double));
    for (size_t k = 0; k < work->chain->count; k++) {
        tile.link = k;
        const lattice_chain link = {.links = &work->chain->links[k],
                                    .count = 1,
                                    .outside = work->chain->outside,
                                    .isa = work->chain->isa};
        chain_run run = {.x = scratch->x,
                         .count = scratch->requested,
                         .rounding = work->owners.document ? &rounding : NULL,
                         .scratch = &scratch->chain,
                         .delta = scratch->link_delta,
                         .outcomes = scratch->point_outcomes};
        TRY(ffd_chain_apply(&link, 1, &run, NULL));
        keep_cells(work, scratch, k);
        for (size_t i = 0; i < 3 * scratch->requested; i++)
            scratch->delta[i] += scratch->link_delta[i];
    }
    return FFD_OK;
}

static ffd_status take_samples(const edge_work *work, edge_scratch *scratch)
{
    TRY(work->chain->blocks ? take_blocks(work, scratch) : take_links(work, scratch));
    for (size_t i = 0; i < scratch->requested; i++)
        keep_sample(&scratch->requests[i], scratch->delta + 3 * i, scratch);
    scratch->requested = 0;
    return FFD_OK;
}

static ffd_status request_sample(const edge_work *work, edge_scratch *scratch, size_t index, size_t slot)
{
    const sampled_edge *edge = &scratch->edges[index];
    const size_t request = scratch->requested++;
    scratch->requests[request] = (sample_request){(uint16_t)index, (uint8_t)slot};
    for (size_t a = 0; a < 3; a++)
        scratch->x[3 * request + a] = edge->start[a] + parameter_of(edge, slot) * edge->along[a];
    return scratch->requested == BATCH ? take_samples(work, scratch) : FFD_OK;
}

/* The sagitta from slot l to slot r: the deviation of the middle sample from the mean of both ends. */
static void find_sagitta(double (*offset)[3], size_t l, size_t r, double sagitta[3])
{
    for (int a = 0; a < 3; a++)
        sagitta[a] = offset[l + (r - l) / 2][a] - (offset[l][a] + offset[r][a]) / 2;
}

/* Upper estimate of the sagitta of a piece that has not been halved. Its parent and its grandparent (`whole`)
   have been halved, and possibly its parent's sibling. */
static double expected_sagitta(const sampled_edge *edge, double (*offset)[3], size_t l, size_t width)
{
    const size_t parent = l & ~(2 * width - 1), whole = l & ~(4 * width - 1);
    double own[3], of_whole[3], missed = 0;
    find_sagitta(offset, parent, parent + 2 * width, own);
    find_sagitta(offset, whole, whole + 4 * width, of_whole);
    for (size_t half = whole; half < whole + 4 * width; half += 2 * width) {
        double of_half[3];
        if (!(edge->sampled >> (half + width) & 1))
            continue;
        find_sagitta(offset, half, half + 2 * width, of_half);
        for (int a = 0; a < 3; a++)
            of_half[a] -= of_whole[a] / 4;
        missed = maximum_number(missed, vec_length(of_half));
    }
    return vec_length(own) / 4 + missed;
}

/* Returns the maximum of the parabola with these end values and this sagitta. */
static double parabola_peak(double left, double right, double sagitta)
{
    const double rise = right - left;
    if (4 * sagitta <= fabs(rise))
        return maximum_number(left, right);
    return (left + right) / 2 + sagitta + rise * rise / (16 * sagitta);
}

static bool must_halve(const edge_work *work, edge_scratch *scratch, size_t index, size_t l, size_t width)
{
    const sampled_edge *edge = &scratch->edges[index];
    double(*offset)[3] = scratch->offset[index];
    if (edge->is_long && (width > PIECES / 8 || extent(work, scratch, index, l, l + width) > WIDEST_PIECE))
        return true;
    const double peak = parabola_peak(vec_length(offset[l]), vec_length(offset[l + width]),
                                      expected_sagitta(edge, offset, l, width));
    return peak > OVERSHOOT * edge->largest + edge->rounding;
}

/* Requests the midpoints of the open pieces that must be halved; their halves become open. All decisions come
   before the first request, because a request may take a full batch of samples. */
static ffd_status halve_pieces(const edge_work *work, edge_scratch *scratch, size_t index, int level)
{
    sampled_edge *edge = &scratch->edges[index];
    const size_t width = PIECES >> level;
    uint64_t halved = 0;
    for (size_t piece = 0; piece < PIECES / width && !edge->left_out; piece++)
        if (edge->open >> piece & 1 && must_halve(work, scratch, index, piece * width, width))
            halved |= (uint64_t)1 << piece;
    edge->open = 0;
    for (size_t piece = 0; piece < PIECES / width; piece++)
        if (halved >> piece & 1) {
            edge->open |= (uint64_t)3 << 2 * piece;
            TRY(request_sample(work, scratch, index, piece * width + width / 2));
        }
    return FFD_OK;
}

/* Requests the ends of a window that is shorter than the edge: there nothing moves, but the straight edge may
   deviate. */
static ffd_status begin_window(const edge_work *work, edge_scratch *scratch, size_t index)
{
    static const double still[3] = {0, 0, 0};
    for (size_t slot = 0; slot <= PIECES; slot += PIECES) {
        sampled_edge *edge = &scratch->edges[index];
        double offset[3];
        if (is_end(edge, slot) || edge->left_out)
            continue;
        find_offset(edge, parameter_of(edge, slot), still, offset);
        edge->largest = maximum_number(edge->largest, vec_length(offset));
        TRY(request_sample(work, scratch, index, slot));
    }
    return FFD_OK;
}

/* Takes the first samples of all edges of the tile, and decides which edges are long. */
static ffd_status begin_samples(const edge_work *work, edge_scratch *scratch, size_t count)
{
    const size_t quarter = PIECES >> FIRST_LEVEL;
    for (size_t i = 0; i < count; i++) {
        sampled_edge *edge = &scratch->edges[i];
        memset(scratch->offset[i][0], 0, sizeof scratch->offset[i][0]);
        memset(scratch->offset[i][PIECES], 0, sizeof scratch->offset[i][PIECES]);
        TRY(begin_window(work, scratch, i));
        for (size_t slot = quarter; slot < PIECES && !edge->left_out; slot += quarter)
            TRY(request_sample(work, scratch, i, slot));
    }
    TRY(take_samples(work, scratch));
    for (size_t i = 0; i < count; i++) {
        sampled_edge *edge = &scratch->edges[i];
        if (edge->left_out)
            continue;
        edge->open = 15;
        edge->is_long = extent(work, scratch, i, quarter, 2 * quarter) > LONG_QUARTER ||
                        extent(work, scratch, i, 2 * quarter, 3 * quarter) > LONG_QUARTER;
        if (edge->is_long)
            TRY(request_sample(work, scratch, i, 0));
        if (edge->is_long)
            TRY(request_sample(work, scratch, i, PIECES));
    }
    return FFD_OK;
}

static ffd_status measure_edges(const edge_work *work, edge_scratch *scratch, size_t first, size_t count)
{
    scratch->requested = 0;
    scratch->first = first;
    TRY(ffd_deadline_check(NULL));
    for (size_t i = 0; i < count; i++)
        begin_edge(work, work->list.keys[first + i], &scratch->edges[i]);
    TRY(begin_samples(work, scratch, count));
    for (int level = FIRST_LEVEL; level < LAST_LEVEL; level++) {
        for (size_t i = 0; i < count; i++)
            TRY(halve_pieces(work, scratch, i, level));
        TRY(take_samples(work, scratch));
    }
    return FFD_OK;
}

static void run_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const edge_work *work = context;
    edge_scratch *scratch = &work->scratch[worker];
    edge_tile *result = &work->tiles[tile];
    result->status = measure_edges(work, scratch, first, last - first);
    for (size_t i = 0; i < last - first && !result->status; i++) {
        const sampled_edge *edge = &scratch->edges[i];
        if (edge->left_out)
            continue;
        if (result->edges++ == 0 || edge->largest > result->largest) {
            result->largest = edge->largest;
            result->worst = work->list.keys[first + i];
        }
        result->sum += edge->largest;
    }
}

static ffd_status join_tiles(const edge_work *work, size_t tiles, edge_quality *result, ffd_error *error)
{
    double sum = 0;
    for (size_t i = 0; i < tiles; i++) {
        const edge_tile *tile = &work->tiles[i];
        if (tile->status == FFD_E_LIMIT)
            return ffd_deadline_check(error)
                       ? FFD_E_LIMIT
                       : ffd_fail(error, FFD_E_LIMIT, "too many parts to measure edges");
        if (tile->status)
            return ffd_fail(error, tile->status, "out of memory while measuring edges");
        if (tile->edges && (result->edges == 0 || tile->largest > result->deviation_max)) {
            result->deviation_max = tile->largest;
            result->worst[0] = (uint32_t)(tile->worst >> 32);
            result->worst[1] = (uint32_t)(tile->worst & UINT32_MAX);
        }
        result->edges += tile->edges;
        sum += tile->sum;
    }
    if (result->edges)
        result->deviation_mean = sum / (double)result->edges;
    return FFD_OK;
}

/* Finds the boxes of the layers; with blocks, one box round all of them. */
static bool find_reach(edge_work *work)
{
    work->reach = ffd_alloc(work->layers, sizeof *work->reach);
    for (size_t k = 0; work->reach && k < work->chain->count; k++) {
        const bounds reach = ffd_chain_reach(work->chain, k);
        if (k < work->layers) {
            work->reach[k] = reach;
            continue;
        }
        bounds_add(&work->reach[0], reach.lo);
        bounds_add(&work->reach[0], reach.hi);
    }
    return work->reach;
}

static void free_scratch(edge_scratch *scratch, size_t workers)
{
    for (size_t i = 0; scratch && i < workers; i++)
        ffd_free(scratch[i].cells);
    ffd_free(scratch);
}

_Static_assert(sizeof(edge_scratch) - sizeof(kept_cells) < THREAD_BYTES &&
                   TILE * SLOTS * 3 * sizeof(double) <= THREAD_LINK_BYTES,
               "a thread takes more than is counted");

static edge_scratch *make_scratch(size_t workers, size_t layers)
{
    edge_scratch *scratch = ffd_alloc_zero(workers, sizeof *scratch);
    for (size_t i = 0; scratch && i < workers; i++) {
        scratch[i].chain.displacement.kept.threads = (int)workers;
        scratch[i].cells = ffd_alloc(layers, TILE * SLOTS * 3 * sizeof(double));
        if (!scratch[i].cells) {
            free_scratch(scratch, workers);
            return NULL;
        }
    }
    return scratch;
}

ffd_status ffd_quality_edges(const mesh_document *document, mesh_state state, const mesh_faces *faces,
                             const double *deformed, const lattice_chain *chain,
                             const vertex_weights *weights, const rigid_parts *rigid, int threads,
                             edge_quality *result, ffd_error *error)
{
    edge_work work = {.state = state,
                      .faces = faces,
                      .deformed = deformed,
                      .weights = weights,
                      .rigid = rigid,
                      .chain = chain,
                      .layers = ffd_chain_layers(chain)};
    size_t workers = 0, tiles = 0;
    *result = (edge_quality){0};
    TRY(ffd_edges_collect(faces, &work.list, error));
    tiles = work.list.count / TILE + (work.list.count % TILE != 0);
    workers = (size_t)ffd_threads_for(threads, tiles);
    work.scratch = make_scratch(workers, work.layers);
    work.tiles = ffd_alloc_zero(tiles, sizeof *work.tiles);
    ffd_status status;
    TRY_END(work.scratch && work.tiles && find_reach(&work) ? FFD_OK : ffd_fail_memory(error));
    if (document)
        TRY_END(ffd_vertex_owners_list(document, &work.owners, error));
    ffd_parallel_tiles(work.list.count, TILE, (int)workers, run_tile, &work);
    TRY_END(join_tiles(&work, tiles, result, error));
end:
    ffd_vertex_owners_free(&work.owners);
    ffd_free(work.tiles);
    ffd_free(work.reach);
    free_scratch(work.scratch, workers);
    ffd_edges_free(&work.list);
    return status;
}
