/* deform_many.c - deforms embedded points by many variants of the control points. */
#include "base/memory/memory.h"
#include "base/struct_size.h"
#include "base/vector/isa.h"
#include "points/point_run.h"
#include "points/span.h"
#include "points/variant_block.h"
#include <float.h>
#include <string.h>

/* The most memory of a thread for control points of a block of variants; larger lattices are read variant by
   variant, and only where there are points. */
#define MOST_MEMORY 0x1p28

/* The most cells in which a tile of a single call has many points each. */
#define FEW_CELLS 256

typedef struct many_work {
    const variant_set *variants;
    block_work block;
    const ffd_run_options *options;
    size_t lanes;           /* 1: no blocks */
    size_t blocks;          /* of so many variants, and then single ones */
    size_t pieces;          /* into which the points are divided */
    block_scratch *scratch; /* one for each thread */
} many_work;

/* Says which variant has failed, if there are several. */
static ffd_status fail_variant(const variant_set *all, size_t variant, ffd_status status,
                               const ffd_error *own, ffd_error *error)
{
    if (status == FFD_E_MEMORY || status == FFD_E_CANCELLED || all->of.count == 1)
        return ffd_fail_as(status, own, error);
    return status ? ffd_fail(error, status, "variant %zu: %s", variant, own->message) : FFD_OK;
}

/* Returns the points of a variant. */
static ffd_span row_of(const variant_set *all, ffd_span out, size_t variant)
{
    const size_t count = all->embedding->count;
    if (out.data)
        out.data = (char *)out.data + (ptrdiff_t)(count * variant) * out.stride;
    out.count = count;
    return out;
}

/* Deforms the points by the lattice that a variant is. */
static ffd_status deform_by_lattice(const variant_set *all, size_t variant, ffd_span in, ffd_span out,
                                    const ffd_run_options *options, ffd_error *error)
{
    ffd_lattice *lattice;
    ffd_error own = {0};
    ffd_status status = ffd_variant_lattice(all, variant, &lattice, &own);
    if (!status && all->of.weights)
        status = ffd_embedding_deform_weighted(all->embedding, lattice, all->of.weights, NULL, in, out, NULL,
                                               options, &own);
    else if (!status)
        status = ffd_embedding_deform(all->embedding, lattice, in, out, NULL, options, &own);
    ffd_lattice_destroy(&lattice);
    return fail_variant(all, variant, status, &own, error);
}

/* -- variants one after the other, each with all threads */

/* The caller's progress, of all variants. */
typedef struct shared_progress {
    const ffd_run_options *callers;
    size_t variant, count;
} shared_progress;

static bool tell_progress(void *user, double done)
{
    const shared_progress *const all = user;
    return all->callers->progress(all->callers->user, ((double)all->variant + done) / (double)all->count);
}

static ffd_status deform_one_by_one(const variant_set *all, ffd_span in, ffd_span out,
                                    const ffd_run_options *options, ffd_error *error)
{
    shared_progress progress = {options, 0, all->of.count};
    ffd_run_options each = *options;
    each.progress = options->progress ? tell_progress : NULL;
    each.user = &progress;
    for (size_t v = 0; v < all->of.count; v++) {
        progress.variant = v;
        TRY(deform_by_lattice(all, v, in, row_of(all, out, v), &each, error));
    }
    return FFD_OK;
}

/* -- blocks of variants */

static block_part part_of(const many_work *work, size_t piece)
{
    const size_t block = piece / work->pieces, share = piece % work->pieces;
    const size_t all = work->variants->of.count, points = work->block.cells->count;
    block_part part = {.variant = block * work->lanes, .count = work->lanes};
    if (block >= work->blocks) {
        part.variant = work->blocks * work->lanes + (block - work->blocks);
        part.count = 1;
        part.is_single = true;
    }
    part.count = part.count < all - part.variant ? part.count : all - part.variant;
    part.first = points / work->pieces * share;
    part.end = share + 1 < work->pieces ? part.first + points / work->pieces : points;
    return part;
}

/* Copies the points that no variant moves. */
static void copy_others(const many_work *work, size_t variant)
{
    const point_cells *const cells = work->block.cells;
    const ffd_embedding *const embedding = work->variants->embedding;
    const ffd_span row = row_of(work->variants, work->block.out, variant);
    for (size_t i = 0; i < cells->other_count; i++) {
        const size_t point = cells->others[i];
        double x[3];
        if (embedding->status[point] == FFD_VERTEX_INVALID && row.type == work->block.in.type) {
            ffd_span_copy(&work->block.in, &row, point);
            continue;
        }
        ffd_span_read(&work->block.in, point, 1, x);
        ffd_span_write(&row, point, 1, x);
    }
}

/* Finds the message for a part with a point that becomes too large: that of a single call, whose result is
   not kept. */
static ffd_status explain(const many_work *work, const block_part *part, ffd_error *error)
{
    ffd_run_options alone = *work->options;
    const size_t size = work->block.out.type == FFD_FLOAT32 ? sizeof(float) : sizeof(double);
    void *const room = ffd_alloc(work->block.in.count, 3 * size);
    const ffd_span out = {.data = room, .count = work->block.in.count, .type = work->block.out.type};
    ffd_status status = room ? FFD_OK : ffd_fail_memory(error);
    alone.threads = 1;
    alone.progress = NULL;
    for (size_t v = 0; v < part->count && !status; v++)
        status = deform_by_lattice(work->variants, part->variant + v, work->block.in, out, &alone, error);
    ffd_free(room);
    return status;
}

/* Deforms the points by variants that have numbers too large for a block, or that are refused. */
static ffd_status deform_large(const many_work *work, const block_part *part, ffd_error *error)
{
    ffd_run_options alone = *work->options;
    alone.threads = 1;
    alone.progress = NULL;
    for (size_t v = part->variant; v < part->variant + part->count; v++)
        TRY(deform_by_lattice(work->variants, v, work->block.in, row_of(work->variants, work->block.out, v),
                              &alone, error));
    return FFD_OK;
}

static ffd_status deform_piece(void *context, size_t piece, size_t count, int worker, ffd_error *error)
{
    const many_work *const work = context;
    const block_part part = part_of(work, piece);
    const bool is_first = piece % work->pieces == 0;
    block_scratch *const scratch = &work->scratch[worker];
    (void)count;
    if (!ffd_block_take(&work->block, &part, scratch))
        return is_first ? deform_large(work, &part, error) : FFD_OK;
    for (size_t v = 0; v < part.count && is_first; v++)
        copy_others(work, part.variant + v);
    return ffd_block_deform(&work->block, &part, scratch) ? FFD_OK : explain(work, &part, error);
}

/* Chooses blocks, and the pieces into which the points are divided: so many that all threads have work, and
   few enough, because each thread reads the variants anew. */
static void divide(many_work *work, int threads)
{
    const size_t all = work->variants->of.count, most = work->block.kernel->lanes;
    const point_cells *const cells = work->block.cells;
    const size_t entries = 3 * work->variants->rest->count, reached = 100 * cells->cell_count;
    const bool is_sparse = 4 * reached < entries;
    const bool has_lanes = all > 1 && !is_sparse && ffd_block_scratch_size(&work->block) <= MOST_MEMORY;
    work->lanes = has_lanes ? most : 1;
    work->blocks = has_lanes ? all / most + (2 * (all % most) > most) : 0;
    const size_t singles = all - (work->blocks * work->lanes < all ? work->blocks * work->lanes : all);
    const size_t blocks = work->blocks + singles, wanted = 4 * (size_t)threads;
    work->pieces = threads > 1 && blocks < wanted ? (wanted + blocks - 1) / blocks : 1;
    if (work->pieces < cells->count / 65536)
        work->pieces = cells->count / 65536;
    if (work->pieces > cells->count / 256 + 1)
        work->pieces = cells->count / 256 + 1;
}

static ffd_status make_scratch(const point_run *run, many_work *work, ffd_error *error)
{
    work->scratch = ffd_alloc_zero((size_t)run->options.threads, sizeof *work->scratch);
    for (int i = 0; work->scratch && i < run->options.threads; i++)
        if (!ffd_block_scratch_make(&work->block, work->blocks > 0, &work->scratch[i]))
            return ffd_fail_memory(error);
    return work->scratch ? FFD_OK : ffd_fail_memory(error);
}

static void free_scratch(const point_run *run, block_scratch *scratch)
{
    for (int i = 0; scratch && i < run->options.threads; i++)
        ffd_block_scratch_free(&scratch[i]);
    ffd_free(scratch);
}

static ffd_status deform_blocks(const variant_set *all, ffd_span in, ffd_span out,
                                const ffd_run_options *options, ffd_error *error)
{
    const point_cells *const cells = ffd_point_cells(all->embedding);
    many_work work = {.variants = all, .options = options};
    point_run run = {.total = 0};
    double *room = NULL;
    ffd_status status;
    if (!cells)
        return ffd_fail_memory(error);
    work.block = (block_work){.variants = all,
                              .cells = cells,
                              .in = in,
                              .out = out,
                              .largest = out.type == FFD_FLOAT32 ? FLT_MAX : DBL_MAX,
                              .kernel = ffd_variant_kernel(options->isa),
                              .in_doubles = ffd_span_doubles(&in, 0),
                              .out_doubles = ffd_span_doubles(&out, 0),
                              .out_floats = ffd_span_floats(&out, 0),
                              .single = ffd_cell_kernels(options->isa),
                              .arrays = ffd_array_kernel(options->isa)};
    divide(&work, ffd_threads_for(options->threads, all->of.count * (cells->count / 256 + 1)));
    const size_t blocks =
        work.blocks +
        (all->of.count > work.blocks * work.lanes ? all->of.count - work.blocks * work.lanes : 0);
    TRY_END(work.blocks > 0 ? ffd_variants_origin(all, &work.block.origin, &room, error) : FFD_OK);
    TRY_END(ffd_point_run_begin_pieces(options, blocks * work.pieces, &run, error));
    TRY_END(make_scratch(&run, &work, error));
    TRY_END(ffd_point_run_tiles(&run, deform_piece, &work, error));
end:
    free_scratch(&run, work.scratch);
    ffd_point_run_end(&run);
    ffd_free(room);
    return status;
}

/* Whether a single variant is better done by a call for its lattice: in place, in one cell, or where many
   points of a tile are in each cell and the points are not sorted. */
static bool is_one_call(const variant_set *all, const ffd_span *in, const ffd_span *out)
{
    const knot_vector *const knots = all->rest->knots;
    const size_t cells = knots[0].span_count * knots[1].span_count * knots[2].span_count;
    if (all->of.count != 1 || in->data == out->data)
        return all->of.count == 1;
    if (cells > FEW_CELLS || all->embedding->count / 8 < all->rest->count)
        return false;
    return cells == 1 || !ffd_point_cells_pay(all->embedding);
}

/* Checks a call, and fills in the strides of its arrays. */
static ffd_status check(const variant_set *all, ffd_span *in, ffd_span *out, const ffd_run_options *run,
                        ffd_error *error)
{
    const size_t points = all->embedding->count;
    if (points > 0 && all->of.count > SIZE_MAX / points)
        return ffd_fail(error, FFD_E_ARGUMENT, "%zu variants of %zu points are more than memory can hold",
                        all->of.count, points);
    TRY(ffd_span_check(in, points, "the array of points", error));
    TRY(ffd_span_check(out, all->of.count * points, "the array of results", error));
    TRY(ffd_threads_check(run->threads, error));
    if (run->isa != FFD_ISA_AUTO && !ffd_isa_available(run->isa))
        return ffd_fail(error, FFD_E_ARGUMENT, "instruction set %d is not available here", (int)run->isa);
    return FFD_OK;
}

ffd_status ffd_embedding_deform_variants(const ffd_embedding *embedding, const ffd_variants *variants,
                                         ffd_span in, ffd_span out, const ffd_run_options *options,
                                         ffd_error *error)
{
    variant_set all = {.places = NULL};
    ffd_run_options run;
    ffd_status status;
    ffd_run_options_init(&run, sizeof run);
    TRY_END(options ? ffd_struct_take(&run, sizeof run, options, "ffd_run_options", error) : FFD_OK);
    TRY_END(ffd_variants_begin(embedding, variants, &all, error));
    TRY_END(check(&all, &in, &out, &run, error));
    if (all.of.count == 0)
        goto end;
    TRY_END(all.is_rational || is_one_call(&all, &in, &out) ? deform_one_by_one(&all, in, out, &run, error)
                                                            : deform_blocks(&all, in, out, &run, error));
end:
    ffd_variants_end(&all);
    return status;
}

ffd_status ffd_embedding_deform_many(const ffd_embedding *embedding, size_t rows, const double *offsets,
                                     ffd_span in, ffd_span out, const ffd_run_options *options,
                                     ffd_error *error)
{
    ffd_variants wanted;
    ffd_variants_init(&wanted, sizeof wanted);
    wanted.count = rows;
    wanted.values = offsets;
    return ffd_embedding_deform_variants(embedding, &wanted, in, out, options, error);
}
