#include "fold/scratch.h"
#include "base/memory/memory.h"
#include "fold/bernstein.h"
#include "fold/determinant.h"
#include "fold/sizes.h"
#include "fold/zeros.h"

static size_t larger(size_t a, size_t b)
{
    return a > b ? a : b;
}

static size_t working_size(const fold_plan *plan, size_t coefficients)
{
    const size_t form = ffd_cell_form_scratch(plan->order),
                 determinant = ffd_determinant_scratch(plan->order, plan->rational),
                 zeros = ffd_zeros_scratch(plan->order, plan->rational);
    return larger(larger(coefficients, form), larger(determinant, zeros));
}

fold_scratch *ffd_fold_scratch_create(const fold_plan *plan)
{
    int order[3];
    ffd_determinant_order(plan->order, plan->rational, order);
    fold_scratch *scratch = ffd_alloc_zero(1, sizeof *scratch);
    if (!scratch)
        return NULL;
    const size_t large = ffd_bernstein_count(order), rows = ffd_cell_form_size(plan->order, plan->rational),
                 sizes = plan->rational ? ffd_sizes_count(plan->order) : 0,
                 working = working_size(plan, large);
    scratch->depth = large > LARGE_CELL_COUNT ? LARGE_CELL_DEPTH : CELL_DEPTH;
    const size_t slots = (size_t)scratch->depth + 1;
    double *next = scratch->block =
        ffd_alloc(working + 2 * rows + (slots + 6) * large + (slots + 1) * sizes, sizeof(double));
    if (!next) {
        ffd_free(scratch);
        return NULL;
    }
    scratch->working = next;
    scratch->rows = next += working;
    scratch->rest_rows = next += rows;
    scratch->rest = next += rows;
    scratch->rest_part = next += large;
    for (int volume = 0; volume < 2; volume++) {
        scratch->other[volume] = next += large;
        scratch->other_part[volume] = next += large;
    }
    for (int depth = 0; depth <= scratch->depth; depth++)
        scratch->coefficients[depth] = next += large;
    next += large;
    for (int depth = 0; depth <= scratch->depth; depth++, next += sizes)
        scratch->sizes[depth] = next;
    scratch->part_sizes = next;
    return scratch;
}

void ffd_fold_scratch_destroy(fold_scratch *scratch)
{
    if (!scratch)
        return;
    ffd_free(scratch->block);
    ffd_free(scratch);
}
