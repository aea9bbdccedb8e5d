#include "fit/system.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "fit/exact.h"
#include <math.h>
#include <string.h>

/* The least rho, and the greatest that is tried. */
#define LEAST_RHO 1e-14
#define MOST_RHO 1e-8

/* The numbers of a system for one S. */
typedef struct system_terms {
    double weight;       /* the sum of the weights; 1 without soft rows */
    double trace;        /* t: 1 without soft rows */
    double bending, rho; /* factors */
    double exact;        /* of B_e^T B_e */
} system_terms;

static double sum_of_weights(const fit_places *soft)
{
    double sum = 0;
    for (size_t i = 0; i < soft->count; i++)
        sum += soft->weights[i];
    return soft->count > 0 ? sum : 1;
}

/* Adds factor B_e^T B_e. */
static void add_exact(const fit_system *system, double factor, const band_matrix *band)
{
    const fit_unknowns *const unknowns = system->unknowns;
    double row[LONGEST_ROW];
    uint32_t seen[LONGEST_ROW];
    for (size_t r = 0; r < system->exact->count && factor > 0; r++) {
        ffd_unknowns_row(unknowns, system->exact->uvw + 3 * r, row);
        ffd_unknowns_seen(unknowns, system->exact->uvw + 3 * r, seen);
        for (size_t a = 0; a < unknowns->row; a++)
            for (size_t b = 0; b < unknowns->row; b++)
                if (seen[b] <= seen[a])
                    *ffd_band_entry(band, seen[a], seen[b]) += factor * row[a] * row[b];
    }
}

/* to += factor B_e^T (wanted - B_e x); x NULL: 0. */
static void add_exact_residual(const fit_system *system, double factor, const double *x, double *to)
{
    const fit_unknowns *const unknowns = system->unknowns;
    double row[LONGEST_ROW];
    uint32_t seen[LONGEST_ROW];
    for (size_t r = 0; r < system->exact->count && factor > 0; r++) {
        double left[3];
        memcpy(left, system->exact->wanted + 3 * r, sizeof left);
        ffd_unknowns_row(unknowns, system->exact->uvw + 3 * r, row);
        ffd_unknowns_seen(unknowns, system->exact->uvw + 3 * r, seen);
        for (size_t n = 0; n < unknowns->row && x; n++)
            for (size_t c = 0; c < 3; c++)
                left[c] -= row[n] * x[3 * (size_t)seen[n] + c];
        for (size_t n = 0; n < unknowns->row; n++)
            for (size_t c = 0; c < 3; c++)
                to[3 * (size_t)seen[n] + c] += factor * row[n] * left[c];
    }
}

double ffd_normal_work(const fit_unknowns *unknowns, size_t places)
{
    return (double)places * (double)unknowns->row * (double)unknowns->row;
}

double ffd_factor_work(const fit_unknowns *unknowns)
{
    return (double)unknowns->count * (double)unknowns->reach * (double)unknowns->reach;
}

ffd_status ffd_system_normal(const fit_system *system, band_matrix *normal, ffd_error *error)
{
    ffd_fit_step_begin(system->run.steps, ffd_normal_work(system->unknowns, system->soft->count));
    TRY(ffd_band_make(system->unknowns->count, system->unknowns->reach, normal, error));
    ffd_band_clear(normal, system->run.threads);
    return ffd_normal_add(system->soft, 1 / sum_of_weights(system->soft), system->run.threads, normal, error);
}

/* Makes the matrix, from its normal part on. rho: as a part of its unit. */
static ffd_status make_matrix(const fit_system *system, double smooth, double rho, band_matrix *band,
                              system_terms *terms, ffd_error *error)
{
    const size_t n = system->unknowns->count, m = system->exact->count;
    const bool has_soft = system->soft->count > 0;
    terms->weight = sum_of_weights(system->soft);
    if (has_soft && system->normal)
        ffd_band_copy(system->normal, band);
    else
        ffd_band_clear(band, system->run.threads);
    if (has_soft && !system->normal) {
        ffd_fit_step_begin(system->run.steps, ffd_normal_work(system->unknowns, system->soft->count));
        TRY(ffd_normal_add(system->soft, 1 / terms->weight, system->run.threads, band, error));
    }
    terms->trace = has_soft ? ffd_band_trace(band) : 1;
    terms->bending = smooth * (system->minimal ? 1 : terms->trace) / system->bending->trace;
    terms->rho = system->minimal ? 1 / (double)n : rho * terms->trace / (double)n;
    terms->exact = smooth > 0 && m > 0 ? terms->trace / (double)m : 0;
    if (smooth > 0)
        ffd_bending_add(system->bending, terms->bending, band);
    add_exact(system, terms->exact, band);
    for (size_t i = 0; i < n; i++)
        *ffd_band_entry(band, i, i) += terms->rho;
    return FFD_OK;
}

/* to = the right-hand side less the matrix times x; x NULL: 0. A rho that only makes the matrix regular is
   left out: a second step then leads to the solution without it. */
static void find_residual(const fit_system *system, const system_terms *terms, const double *x, double *to)
{
    const size_t n = system->unknowns->count;
    memset(to, 0, 3 * n * sizeof *to);
    ffd_normal_residual(system->soft, 1 / terms->weight, x, to);
    add_exact_residual(system, terms->exact, x, to);
    if (x && terms->bending > 0)
        ffd_bending_apply(system->bending, -terms->bending, x, to);
    for (size_t i = 0; i < 3 * n && x && system->minimal; i++)
        to[i] -= terms->rho * x[i];
}

/* Factors the matrix, with a greater rho where the data tell too little, or where S leaves them no digits. */
static ffd_status factor(const fit_system *system, double smooth, band_matrix *band, system_terms *terms,
                         fit_solution *solution, ffd_error *error)
{
    const double most = MOST_RHO * larger_of(1, smooth);
    bool is_positive = false;
    for (solution->rho = LEAST_RHO; !is_positive; solution->rho *= is_positive ? 1 : 10) {
        TRY(make_matrix(system, smooth, solution->rho, band, terms, error));
        ffd_fit_step_begin(system->run.steps, ffd_factor_work(system->unknowns));
        TRY(ffd_band_factor(band, &system->run, &is_positive, error));
        if (!is_positive && solution->rho >= most)
            return ffd_fail(error, FFD_E_UNMET,
                            "the places tell too little of the lattice, even with {smooth} %g", smooth);
    }
    return FFD_OK;
}

/* Finds the trace of A^-1 M for the normal part M of the matrix, from the entries of A^-1 in the band
   (Takahashi, Fagan & Chen 1973). */
static ffd_status find_freedom(const band_matrix *normal, const band_matrix *factor, double *freedom,
                               ffd_error *error)
{
    const size_t n = factor->n, reach = factor->reach;
    double *const z = ffd_alloc_zero(n * n, sizeof *z);
    if (!z)
        return ffd_fail_memory(error);
    *freedom = 0;
    for (size_t j = n; j-- > 0 && !ffd_deadline_passed();) {
        const size_t end = n - j > reach ? j + reach + 1 : n;
        const double pivot = *ffd_band_entry(factor, j, j);
        double *const own = z + n * j; /* row j: of the columns from j on */
        for (size_t k = j + 1; k < end; k++) {
            const double l = *ffd_band_entry(factor, k, j) / pivot;
            for (size_t i = j + 1; i < end; i++)
                own[i] -= l * z[n * k + i];
        }
        own[j] = 1 / (pivot * pivot);
        for (size_t k = j + 1; k < end; k++)
            own[j] -= *ffd_band_entry(factor, k, j) / pivot * own[k];
        for (size_t i = j + 1; i < end; i++)
            z[n * i + j] = own[i];
        for (size_t i = j; i < end; i++)
            *freedom += (i == j ? 1 : 2) * own[i] * *ffd_band_entry(normal, i, j);
    }
    ffd_free(z);
    return ffd_deadline_check(error);
}

/* Finds that trace for a solution: of the soft rows alone. The factor is made anew where it has exact rows.
 */
static ffd_status tell_freedom(const fit_system *system, double smooth, band_matrix *band,
                               fit_solution *solution, ffd_error *error)
{
    fit_system soft = *system;
    const fit_places none = {.unknowns = system->unknowns};
    system_terms terms;
    if (system->exact->count > 0) {
        fit_solution own = {.rho = 0};
        soft.exact = &none;
        TRY(factor(&soft, smooth, band, &terms, &own, error));
    }
    ffd_fit_step_begin(system->run.steps, FREEDOM_WORK * ffd_factor_work(system->unknowns));
    return find_freedom(system->normal, band, &solution->freedom, error);
}

/* Steps of a solution, each for what the ones before have left. Without smoothing some unknowns are hardly
   told: the sums of squares have lost half of their digits, which further steps find again. */
#define TURNS 2
#define TURNS_UNSMOOTHED 6

/* Solves with the factor, and again for what is left. */
static ffd_status solve(const fit_system *system, const band_matrix *factor, const system_terms *terms,
                        double *x, ffd_error *error)
{
    const size_t n = system->unknowns->count;
    const int turns = terms->bending > 0 || system->minimal ? TURNS : TURNS_UNSMOOTHED;
    double *const left = ffd_alloc(n, 3 * sizeof *left);
    if (!left)
        return ffd_fail_memory(error);
    for (int turn = 0; turn < turns && !ffd_deadline_passed(); turn++) {
        find_residual(system, terms, turn == 0 ? NULL : x, left);
        ffd_band_forward(factor, left, 3);
        ffd_band_backward(factor, left, 3);
        for (size_t i = 0; i < 3 * n; i++)
            x[i] = turn == 0 ? left[i] : x[i] + left[i];
    }
    ffd_free(left);
    return ffd_deadline_check(error);
}

ffd_status ffd_system_solve(const fit_system *system, double smooth, bool wants_freedom,
                            fit_solution *solution, ffd_error *error)
{
    const size_t n = system->unknowns->count, reach = system->unknowns->reach;
    system_terms terms;
    band_matrix band = {0};
    ffd_status status;
    *solution = (fit_solution){.flops = (uint64_t)n * reach * reach};
    solution->offsets = ffd_alloc_zero(n, 3 * sizeof *solution->offsets);
    TRY_END(solution->offsets ? ffd_band_make(n, reach, &band, error) : ffd_fail_memory(error));
    TRY_END(factor(system, smooth, &band, &terms, solution, error));
    TRY_END(solve(system, &band, &terms, solution->offsets, error));
    TRY_END(ffd_exact_correct(system->exact, system->diagonal, &band, solution->offsets, &solution->dependent,
                              error));
    if (wants_freedom)
        TRY_END(tell_freedom(system, smooth, &band, solution, error));
end:
    ffd_band_free(&band);
    return status;
}

void ffd_solution_free(fit_solution *solution)
{
    ffd_free(solution->offsets);
    *solution = (fit_solution){0};
}
