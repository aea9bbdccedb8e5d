/* core.c - what the package for npm calls beside the public functions: calls whose structs stay in C, and the
   error of the last call that failed. js/lattice.mjs is the other side. */
#include "base/arithmetic.h"
#include <ffd/ffd.h>
#include <math.h>
#include <stdio.h>

#define CALLED __attribute__((used, visibility("default")))

CALLED ffd_error *ffd_wasm_error(void);
CALLED const char *ffd_wasm_error_file(void);
CALLED const char *ffd_wasm_error_pointer(void);
CALLED const char *ffd_wasm_error_line(void);
CALLED ffd_status ffd_wasm_around(const double *xyz, size_t count, const int *shape, const double *margin,
                                  ffd_lattice **lattice);
CALLED ffd_status ffd_wasm_embed(ffd_lattice *lattice, void *points, size_t count, ffd_number type,
                                 ffd_outside outside, double falloff, double snap, ffd_embedding **embedding);
CALLED ffd_status ffd_wasm_deform(const ffd_embedding *embedding, const ffd_lattice *lattice, void *in,
                                  ffd_number in_type, void *out, ffd_number out_type);
CALLED ffd_status ffd_wasm_fit(ffd_lattice *base, void *source, ffd_number source_type, void *target,
                               ffd_number target_type, size_t count, const double *weights,
                               const size_t *exact, size_t exact_count, const int *choices,
                               const double *lengths, ffd_lattice **lattice);
CALLED const double *ffd_wasm_fit_figures(void);
CALLED const char *ffd_wasm_fit_chosen_by(void);
CALLED const char *ffd_wasm_fit_verdict(void);
CALLED const char *ffd_wasm_folds(const ffd_lattice *lattice, double figures[2]);

static ffd_error failure;

/* The record that functions with an ffd_error get. */
ffd_error *ffd_wasm_error(void)
{
    return &failure;
}

const char *ffd_wasm_error_file(void)
{
    return failure.file;
}

const char *ffd_wasm_error_pointer(void)
{
    return failure.pointer;
}

/* The line that the program would print. */
const char *ffd_wasm_error_line(void)
{
    static char line[2048];
    const int prefix = snprintf(line, sizeof line, "ffd: ");
    ffd_error_format(&failure, line + prefix, sizeof line - (size_t)prefix);
    return line;
}

/* shape: sizes, degrees and kinds of knots of u, v, w. */
ffd_status ffd_wasm_around(const double *xyz, size_t count, const int *shape, const double *margin,
                           ffd_lattice **lattice)
{
    ffd_lattice_desc desc;
    ffd_lattice_desc_init(&desc, sizeof desc);
    for (int d = 0; d < 3; d++) {
        desc.size[d] = (size_t)shape[d];
        desc.degree[d] = shape[3 + d];
        desc.knots[d] = (ffd_knots)shape[6 + d];
        desc.margin[d] = margin[d];
    }
    return ffd_lattice_create(&desc, xyz, count, lattice, &failure);
}

static double coordinate(const void *points, ffd_number type, size_t i)
{
    return type == FFD_FLOAT32 ? (double)((const float *)points)[i] : ((const double *)points)[i];
}

/* Lays a lattice whose box goes round a mesh round the points, without those that are not finite. */
static ffd_status lay(ffd_lattice *lattice, const void *points, size_t count, ffd_number type)
{
    if (!ffd_lattice_needs_bounds(lattice))
        return FFD_OK;
    double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (size_t i = 0; i < count; i++) {
        double p[3];
        for (int a = 0; a < 3; a++)
            p[a] = coordinate(points, type, 3 * i + (size_t)a);
        for (int a = 0; a < 3 && isfinite(p[0]) && isfinite(p[1]) && isfinite(p[2]); a++) {
            low[a] = minimum_number(low[a], p[a]);
            high[a] = maximum_number(high[a], p[a]);
        }
    }
    return ffd_lattice_fit(lattice, low, high, &failure);
}

ffd_status ffd_wasm_embed(ffd_lattice *lattice, void *points, size_t count, ffd_number type,
                          ffd_outside outside, double falloff, double snap, ffd_embedding **embedding)
{
    const ffd_status laid = lay(lattice, points, count, type);
    if (laid)
        return laid;
    ffd_embedding_desc desc;
    ffd_embedding_desc_init(&desc, sizeof desc);
    desc.lattice = lattice;
    desc.points = (ffd_span){.data = points, .count = count, .type = type};
    desc.outside = outside;
    desc.falloff = falloff;
    desc.snap = snap;
    return ffd_embedding_create(&desc, NULL, embedding, &failure);
}

/* in and out hold the points of the embedding. */
ffd_status ffd_wasm_deform(const ffd_embedding *embedding, const ffd_lattice *lattice, void *in,
                           ffd_number in_type, void *out, ffd_number out_type)
{
    const size_t count = ffd_embedding_get_count(embedding);
    return ffd_embedding_deform(embedding, lattice, (ffd_span){.data = in, .count = count, .type = in_type},
                                (ffd_span){.data = out, .count = count, .type = out_type}, NULL, NULL,
                                &failure);
}

/* Returns the verdict; NULL: it failed. figures: cells and min_det. */
const char *ffd_wasm_folds(const ffd_lattice *lattice, double figures[2])
{
    ffd_folds folds = {.struct_size = sizeof folds};
    if (ffd_folds_find(lattice, 1, &folds, &failure))
        return NULL;
    figures[0] = (double)folds.cells;
    figures[1] = folds.min_det;
    return ffd_fold_verdict_name(folds.verdict);
}

static ffd_fit_result fitted;

/* choices: handles, robust, symmetric, smoothing. lengths: smooth, within, snap. */
ffd_status ffd_wasm_fit(ffd_lattice *base, void *source, ffd_number source_type, void *target,
                        ffd_number target_type, size_t count, const double *weights, const size_t *exact,
                        size_t exact_count, const int *choices, const double *lengths, ffd_lattice **lattice)
{
    const ffd_status laid = lay(base, source, count, source_type);
    if (laid)
        return laid;
    ffd_fit_desc desc;
    ffd_fit_desc_init(&desc, sizeof desc);
    desc.base = base;
    desc.source = (ffd_span){.data = source, .count = count, .type = source_type};
    desc.target = (ffd_span){.data = target, .count = count, .type = target_type};
    desc.weights = weights;
    desc.exact = exact;
    desc.exact_count = exact_count;
    desc.handles = choices[0];
    desc.robust = choices[1];
    desc.symmetric = choices[2];
    desc.smoothing = (ffd_fit_smoothing)choices[3];
    desc.smooth = lengths[0];
    desc.within = lengths[1];
    desc.snap = lengths[2];
    fitted = (ffd_fit_result){.struct_size = sizeof fitted};
    return ffd_fit_points(&desc, NULL, lattice, NULL, &fitted, &failure);
}

static double *put(double *to, const double *numbers, size_t count)
{
    for (size_t i = 0; i < count; i++)
        to[i] = numbers[i];
    return to + count;
}

/* The figures of the last fit, in the order in which js/fit.mjs takes them. */
const double *ffd_wasm_fit_figures(void)
{
    static double figures[64];
    const ffd_fit_result *const r = &fitted;
    const ffd_fold_witness *const w = &r->folds.witness;
    const double found[] = {(double)r->pairs,
                            (double)r->used,
                            (double)r->outside,
                            (double)r->multiple,
                            (double)r->singular,
                            (double)r->exact,
                            (double)r->dependent,
                            r->smooth,
                            r->gcv,
                            r->residual_max,
                            r->residual_rms,
                            r->residual_p95,
                            (double)r->worst,
                            r->residual_exact,
                            r->largest_offset,
                            (double)r->points_without_data,
                            (double)r->downweighted,
                            (double)r->spread_positions,
                            r->spread_largest,
                            (double)r->flops,
                            (double)r->folds.cells,
                            r->folds.min_det,
                            (double)r->folds.relative_to,
                            (double)r->folds.folded_cells,
                            (double)r->folds.unknown_cells,
                            w->det};
    double *to = put(figures, found, sizeof found / sizeof *found);
    to = put(to, r->affine, 12);
    to = put(to, w->uvw, 3);
    to = put(to, w->xyz, 3);
    put(to, w->rest, 3);
    return figures;
}

const char *ffd_wasm_fit_chosen_by(void)
{
    return ffd_fit_choice_name(fitted.smooth_chosen_by);
}

const char *ffd_wasm_fit_verdict(void)
{
    return ffd_fold_verdict_name(fitted.folds.verdict);
}
