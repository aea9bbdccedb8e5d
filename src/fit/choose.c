#include "fit/choose.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include <math.h>
#include <string.h>

/* The most unknowns for which the trace is found, and control points along a direction of a coarser lattice.
 */
#define MOST_UNKNOWNS 1000
#define COARSE_POINTS ((size_t)10)
/* Fewer soft rows do not tell. */
#define LEAST_ROWS 5
/* So near to as many freedoms as rows nothing is left to judge by. */
#define FREEDOM_LEFT 1e-9
/* S is 10^(k/2) for k from the first to the last. */
#define FIRST_POWER (-4)
#define LAST_POWER 2

double ffd_half_power(int half)
{
    const int whole = (half < 0 ? -half : half) / 2;
    double power = 1;
    for (int i = 0; i < whole; i++)
        power *= 10;
    if (half % 2 != 0)
        power *= sqrt(10);
    return half < 0 ? 1 / power : power;
}

/* Returns the value for a solution. */
static double judge(const fit_system *system, const fit_solution *solution)
{
    const fit_places *const soft = system->soft;
    double sum = 0, weights = 0;
    for (size_t i = 0; i < soft->count && !ffd_deadline_passed_at(i); i++) {
        double value[3], square = 0;
        ffd_place_value(system->unknowns, soft->uvw + 3 * i, solution->offsets, value);
        for (size_t c = 0; c < 3; c++)
            square += (soft->wanted[3 * i + c] - value[c]) * (soft->wanted[3 * i + c] - value[c]);
        sum += soft->weights[i] * square;
        weights += soft->weights[i];
    }
    const double left = 1 - solution->freedom / (double)soft->count;
    return left > FREEDOM_LEFT ? sum / weights / (left * left) : (double)NAN;
}

/* Takes the S with the least value; of equal ones the largest. Exact rows that a coarser lattice cannot meet
   tell nothing. */
static ffd_status try_all(const fit_system *system, double *smooth, double *gcv, ffd_error *error)
{
    for (int power = LAST_POWER; power >= FIRST_POWER; power--) {
        const double tried = ffd_half_power(power);
        fit_solution solution;
        ffd_error unmet;
        const ffd_status status = ffd_system_solve(system, tried, true, &solution, &unmet);
        const double value = status ? (double)NAN : judge(system, &solution);
        ffd_solution_free(&solution);
        TRY(status == FFD_E_UNMET ? FFD_OK : ffd_fail_as(status, &unmet, error));
        TRY(ffd_deadline_check(error));
        if (value < *gcv || (isnan(*gcv) && !isnan(value))) {
            *gcv = value;
            *smooth = tried;
        }
    }
    return FFD_OK;
}

static ffd_status choose(const fit_system *system, double *smooth, double *gcv, ffd_error *error)
{
    band_matrix normal = {0};
    fit_system known = *system;
    ffd_status status;
    TRY_END(ffd_system_normal(system, &normal, error));
    known.normal = &normal;
    TRY_END(try_all(&known, smooth, gcv, error));
end:
    ffd_band_free(&normal);
    return status;
}

/* Returns how many control points a coarser lattice has along a direction. */
static size_t coarse_points(const knot_vector *fine)
{
    const size_t least = (size_t)fine->degree + 1, most = least > COARSE_POINTS ? least : COARSE_POINTS;
    return fine->points < most ? fine->points : most;
}

double ffd_smooth_choose_work(const fit_unknowns *unknowns, size_t places, bool has_exact)
{
    const knot_vector *const knots = unknowns->lattice->knots;
    double points = 1, fine = 1, coarse = 1; /* what is left of all points; along the longest directions */
    for (int a = 0; a < 3 && unknowns->count > MOST_UNKNOWNS; a++) {
        const double before = (double)knots[a].points, left = (double)coarse_points(&knots[a]);
        points *= left / before;
        fine = larger_of(fine, before);
        coarse = larger_of(coarse, left);
    }
    const double reach = points * fine / coarse;
    return ffd_normal_work(unknowns, places) + (LAST_POWER - FIRST_POWER + 1) *
                                                   (1 + has_exact + FREEDOM_WORK) * points * reach * reach *
                                                   ffd_factor_work(unknowns);
}

/* Makes the knots of a direction of a coarser lattice. */
static ffd_status make_knots(const knot_vector *fine, int a, knot_vector *knots, ffd_error *error)
{
    const knot_kind kind = fine->kind == KNOTS_LIST          ? KNOTS_CLAMPED
                           : fine->kind == KNOTS_CLOSED_LIST ? KNOTS_CLOSED
                                                             : fine->kind;
    return ffd_knots_make(kind, fine->degree, coarse_points(fine), NULL, 0, (char)('u' + a), knots, error);
}

static ffd_status make_lattice(const ffd_lattice *fine, ffd_lattice *lattice, ffd_error *error)
{
    lattice->count = 1;
    for (int a = 0; a < 3; a++) {
        TRY(make_knots(&fine->knots[a], a, &lattice->knots[a], error));
        lattice->size[a] = lattice->knots[a].points;
        lattice->count *= lattice->size[a];
    }
    return FFD_OK;
}

/* Copies places from the domain of their lattice to that of another one. */
static ffd_status move_places(const fit_places *from, const fit_unknowns *to, fit_places *moved,
                              ffd_error *error)
{
    double *const uvw = ffd_alloc(from->count, 3 * sizeof *uvw);
    for (size_t i = 0; i < 3 * from->count && uvw; i++) {
        const knot_vector *const a = &from->unknowns->lattice->knots[i % 3], *const b =
                                                                                 &to->lattice->knots[i % 3];
        const double share =
            (ffd_knots_wrap(a, from->uvw[i]) - ffd_knots_first(a)) / (ffd_knots_last(a) - ffd_knots_first(a));
        uvw[i] = ffd_knots_first(b) + share * (ffd_knots_last(b) - ffd_knots_first(b));
    }
    const ffd_status status = uvw ? ffd_fit_places_make(to, from->count, uvw, from->wanted, from->weights,
                                                        from->numbers, moved, error)
                                  : ffd_fail_memory(error);
    ffd_free(uvw);
    return status;
}

/* Chooses on a coarser lattice. */
static ffd_status choose_coarsely(const fit_system *system, const double lengths[3], double *smooth,
                                  double *gcv, ffd_error *error)
{
    ffd_lattice lattice = {.count = 0};
    fit_bending bending = {0};
    fit_places soft = {0}, exact = {0};
    fit_system coarse = *system;
    ffd_status status;
    TRY_END(make_lattice(system->unknowns->lattice, &lattice, error));
    const fit_unknowns unknowns = ffd_unknowns_make(&lattice);
    TRY_END(move_places(system->soft, &unknowns, &soft, error));
    TRY_END(move_places(system->exact, &unknowns, &exact, error));
    TRY_END(ffd_bending_make(&unknowns, lengths, &bending, error));
    coarse.unknowns = &unknowns;
    coarse.soft = &soft;
    coarse.exact = &exact;
    coarse.bending = &bending;
    TRY_END(choose(&coarse, smooth, gcv, error));
end:
    ffd_bending_free(&bending);
    ffd_fit_places_free(&soft);
    ffd_fit_places_free(&exact);
    for (int a = 0; a < 3; a++)
        ffd_knots_free(&lattice.knots[a]);
    return status;
}

ffd_status ffd_smooth_choose(const fit_system *system, const double lengths[3], double *smooth, double *gcv,
                             ffd_error *error)
{
    *smooth = FIT_DEFAULT_SMOOTH;
    *gcv = (double)NAN;
    if (system->soft->count < LEAST_ROWS)
        return FFD_OK;
    return system->unknowns->count <= MOST_UNKNOWNS ? choose(system, smooth, gcv, error)
                                                    : choose_coarsely(system, lengths, smooth, gcv, error);
}
