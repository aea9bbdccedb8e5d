#include "lattice/drag.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/vector/vec.h"
#include <ffd/embedding.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A pivot of the Gram matrix below this fraction of the first is 0: two places nearer to each other than
   about 3e-7 of a cell are one, and what they ask beyond that is a miss. */
#define SINGULAR 1e-13

/* Rounds of iterative refinement, which end before where the miss no longer halves. */
#define ROUNDS 4

uint64_t ffd_drag_bytes(uint64_t places, uint64_t per_place)
{
    const uint64_t entry = 2 * sizeof(uint32_t) + sizeof(double) + 2 * 3 * sizeof(double);
    return places * (per_place * entry + places * sizeof(double) + 24 * sizeof(double));
}

static ffd_status refuse(const drag_places *places, size_t place, uint8_t status, ffd_error *error)
{
    const double *const p = places->xyz + 3 * place;
    const bool is_image = place >= places->own;
    const size_t own = is_image ? place - places->own : place;
    char pointer[64];
    snprintf(pointer, sizeof pointer, "%s/drag/%zu/point", places->move->pointer, own);
    return ffd_fail_at(error, FFD_E_INVALID, places->file, places->move->drags[own].line, pointer,
                       "%s %s %s %s is not inside the volume at rest, but %s",
                       is_image ? "the mirror image" : "the place", ffd_number_text(p[0]).text,
                       ffd_number_text(p[1]).text, ffd_number_text(p[2]).text,
                       ffd_vertex_status_name((ffd_vertex_status)status));
}

static ffd_status locate(ffd_lattice *lattice, const drag_places *places, ffd_location *locations,
                         ffd_error *error)
{
    ffd_locator *locator = NULL;
    ffd_status status;
    /* The locator asks for the figures of a lattice that is ready. */
    TRY_END(ffd_lattice_finish_moved(lattice, error));
    TRY_END(ffd_locator_create(lattice, &locator, error));
    TRY_END(
        ffd_locator_locate(locator, places->xyz, places->count, NULL, locations, sizeof *locations, error));
    for (size_t i = 0; i < places->count; i++)
        if (locations[i].status != FFD_VERTEX_INSIDE)
            TRY_END(refuse(places, i, locations[i].status, error));
end:
    ffd_locator_destroy(&locator);
    return status;
}

/* An entry of a row, before columns are known. */
typedef struct entry {
    uint32_t point;
    double value;
} entry;

static int by_point(const void *a, const void *b)
{
    const uint32_t p = ((const entry *)a)->point, q = ((const entry *)b)->point;
    return (p > q) - (p < q);
}

/* Fills a row with the basis functions R of the deformed volume at u,v,w, of the selected control points, in
   ascending order. Returns their number. */
static size_t fill_row(const ffd_lattice *lattice, const double uvw[3], const unsigned char *selected,
                       entry *row)
{
    const double *const weights = lattice->deformed_weights;
    const knot_vector *const knots = lattice->knots;
    lattice_basis basis;
    double sum = 0;
    size_t count = 0;
    ffd_lattice_basis(lattice, uvw, &basis);
    for (int k = 0; k <= knots[2].degree; k++)
        for (int j = 0; j <= knots[1].degree; j++)
            for (int i = 0; i <= knots[0].degree; i++) {
                const int at[3] = {i, j, k};
                size_t index[3];
                for (int a = 0; a < 3; a++)
                    index[a] = ffd_knots_point(&knots[a], (size_t)(basis.span[a] - knots[a].degree + at[a]));
                const size_t point = index[0] + lattice->size[0] * (index[1] + lattice->size[1] * index[2]);
                const double value = (weights ? weights[point] : 1) *
                                     (basis.value[0][i] * basis.value[1][j] * basis.value[2][k]);
                sum += value;
                if (selected[point] && value != 0)
                    row[count++] = (entry){(uint32_t)point, value};
            }
    for (size_t i = 0; i < count; i++)
        row[i].value /= weights ? sum : 1;
    qsort(row, count, sizeof *row, by_point);
    return count;
}

/* Numbers the control points of all entries, and lays out the rows. */
static ffd_status number_columns(const entry *entries, drag_solver *solver, ffd_error *error)
{
    const size_t count = solver->start[solver->places];
    entry *const sorted = ffd_alloc(count, sizeof *sorted);
    solver->column = ffd_alloc(count, sizeof *solver->column);
    solver->value = ffd_alloc(count, sizeof *solver->value);
    solver->point = ffd_alloc(count, sizeof *solver->point);
    if (!sorted || !solver->column || !solver->value || !solver->point) {
        ffd_free(sorted);
        return ffd_fail_memory(error);
    }
    memcpy(sorted, entries, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, by_point);
    for (size_t i = 0; i < count; i++)
        if (i == 0 || sorted[i].point != sorted[i - 1].point)
            solver->point[solver->columns++] = sorted[i].point;
    ffd_free(sorted);
    for (size_t r = 0; r < solver->places; r++) {
        size_t column = 0;
        for (size_t i = solver->start[r]; i < solver->start[r + 1]; i++) {
            while (solver->point[column] != entries[i].point)
                column++;
            solver->column[i] = (uint32_t)column;
            solver->value[i] = entries[i].value;
        }
    }
    return FFD_OK;
}

static ffd_status make_rows(const ffd_lattice *lattice, const drag_places *places,
                            const ffd_location *locations, drag_solver *solver, ffd_error *error)
{
    size_t most = 1, total;
    for (int a = 0; a < 3; a++)
        most *= (size_t)lattice->knots[a].degree + 1;
    entry *const entries =
        ffd_multiply_size(most, places->count, &total) ? ffd_alloc(total, sizeof *entries) : NULL;
    ffd_status status;
    TRY_END(entries ? FFD_OK : ffd_fail_memory(error));
    solver->start[0] = 0;
    for (size_t r = 0; r < places->count; r++)
        solver->start[r + 1] = solver->start[r] + fill_row(lattice, locations[r].uvw, places->selected,
                                                           entries + solver->start[r]);
    TRY_END(number_columns(entries, solver, error));
end:
    ffd_free(entries);
    return status;
}

/* The product of two rows of B. */
static double product(const drag_solver *solver, size_t a, size_t b)
{
    size_t i = solver->start[a], j = solver->start[b];
    double sum = 0;
    while (i < solver->start[a + 1] && j < solver->start[b + 1]) {
        if (solver->column[i] == solver->column[j])
            sum += solver->value[i++] * solver->value[j++];
        else if (solver->column[i] < solver->column[j])
            i++;
        else
            j++;
    }
    return sum;
}

static double *row_of(const drag_solver *solver, size_t row)
{
    return solver->factor + row * solver->places;
}

static void swap_rows(drag_solver *solver, size_t a, size_t b)
{
    const size_t pivot = solver->pivot[a];
    const double diagonal = solver->diagonal[a];
    solver->pivot[a] = solver->pivot[b];
    solver->pivot[b] = pivot;
    solver->diagonal[a] = solver->diagonal[b];
    solver->diagonal[b] = diagonal;
    for (size_t c = 0; c < solver->rank && a != b; c++) {
        const double kept = row_of(solver, a)[c];
        row_of(solver, a)[c] = row_of(solver, b)[c];
        row_of(solver, b)[c] = kept;
    }
}

/* Cholesky's factorisation with diagonal pivoting, which ends at the rank (Higham, Accuracy and Stability of
   Numerical Algorithms, 2nd ed., 10.3). */
static void factorise(drag_solver *solver)
{
    const size_t n = solver->places;
    double first = 0;
    for (size_t i = 0; i < n; i++) {
        solver->pivot[i] = i;
        solver->diagonal[i] = product(solver, i, i);
        first = larger_of(first, solver->diagonal[i]);
    }
    for (size_t j = 0; j < n; j++) {
        size_t next = j;
        for (size_t i = j + 1; i < n; i++)
            if (solver->diagonal[i] > solver->diagonal[next])
                next = i;
        if (!(solver->diagonal[next] > SINGULAR * first))
            break;
        swap_rows(solver, j, next);
        double *const own = row_of(solver, j);
        own[j] = sqrt(solver->diagonal[j]);
        for (size_t i = j + 1; i < n; i++) {
            double *const row = row_of(solver, i), sum = product(solver, solver->pivot[i], solver->pivot[j]);
            for (size_t c = 0; c < j; c++)
                sum -= row[c] * own[c];
            row[j] = sum / own[j];
            solver->diagonal[i] -= row[j] * row[j];
        }
        solver->rank = j + 1;
    }
}

/* Applies the reflection of a column, I - v v^T / (v^T v / 2), to a vector whose numbers are `stride` apart.
 */
static void reflect(const drag_solver *solver, size_t column, double half, double *x, size_t stride)
{
    double sum = 0;
    for (size_t i = column; i < solver->places; i++)
        sum += row_of(solver, i)[column] * x[i * stride];
    for (size_t i = column; i < solver->places; i++)
        x[i * stride] -= sum / half * row_of(solver, i)[column];
}

static double half_square(const drag_solver *solver, size_t column)
{
    double sum = 0;
    for (size_t i = column; i < solver->places; i++)
        sum += row_of(solver, i)[column] * row_of(solver, i)[column];
    return 0.5 * sum;
}

/* Replaces L, which has more rows than columns, by Q R (Householder). The diagonal of R goes to `diagonal`.
 */
static void make_orthogonal(drag_solver *solver)
{
    for (size_t j = 0; j < solver->rank; j++) {
        double *const head = row_of(solver, j) + j;
        const double length = sqrt(2 * half_square(solver, j));
        solver->diagonal[j] = *head > 0 ? -length : length;
        *head -= solver->diagonal[j];
        const double half = half_square(solver, j);
        for (size_t c = j + 1; c < solver->rank; c++)
            reflect(solver, j, half, solver->factor + c, solver->places);
    }
}

ffd_status ffd_drag_prepare(ffd_lattice *lattice, const drag_places *places, drag_solver *solver,
                            ffd_error *error)
{
    const size_t n = places->count;
    ffd_location *const locations = ffd_alloc(n, sizeof *locations);
    double *const numbers = ffd_alloc(n, 12 * sizeof *numbers);
    *solver = (drag_solver){.places = n,
                            .start = ffd_alloc(n + 1, sizeof *solver->start),
                            .factor = ffd_alloc_zero(n, n * sizeof *solver->factor),
                            .diagonal = ffd_alloc(n, sizeof *solver->diagonal),
                            .pivot = ffd_alloc(n, sizeof *solver->pivot),
                            .lambda = numbers};
    ffd_status status;
    if (!locations || !numbers || !solver->start || !solver->factor || !solver->diagonal || !solver->pivot)
        TRY_END(ffd_fail_memory(error));
    solver->miss = numbers + 3 * n;
    solver->step = numbers + 6 * n;
    solver->sorted = numbers + 9 * n;
    TRY_END(locate(lattice, places, locations, error));
    TRY_END(make_rows(lattice, places, locations, solver, error));
    factorise(solver);
    if (solver->rank < n)
        make_orthogonal(solver);
end:
    ffd_free(locations);
    return status;
}

/* x = (L L^T)^-1 x, for one coordinate. */
static void solve_whole(const drag_solver *solver, double *x)
{
    const size_t n = solver->places;
    for (size_t i = 0; i < n; i++) {
        for (size_t c = 0; c < i; c++)
            x[i] -= row_of(solver, i)[c] * x[c];
        x[i] /= row_of(solver, i)[i];
    }
    for (size_t i = n; i-- > 0;) {
        for (size_t r = i + 1; r < n; r++)
            x[i] -= row_of(solver, r)[i] * x[r];
        x[i] /= row_of(solver, i)[i];
    }
}

/* x = Q R^-T R^-1 Q^T x, the pseudoinverse of Q R R^T Q^T. */
static void solve_part(const drag_solver *solver, double *x)
{
    const size_t rank = solver->rank;
    for (size_t j = 0; j < rank; j++)
        reflect(solver, j, half_square(solver, j), x, 1);
    for (size_t i = rank; i-- > 0;) {
        for (size_t c = i + 1; c < rank; c++)
            x[i] -= row_of(solver, i)[c] * x[c];
        x[i] /= solver->diagonal[i];
    }
    for (size_t i = 0; i < rank; i++) {
        for (size_t r = 0; r < i; r++)
            x[i] -= row_of(solver, r)[i] * x[r];
        x[i] /= solver->diagonal[i];
    }
    for (size_t i = rank; i < solver->places; i++)
        x[i] = 0;
    for (size_t j = rank; j-- > 0;)
        reflect(solver, j, half_square(solver, j), x, 1);
}

/* solver->step = G^+ solver->miss. */
static void find_step(drag_solver *solver)
{
    double *const x = solver->sorted;
    for (size_t c = 0; c < 3; c++) {
        for (size_t i = 0; i < solver->places; i++)
            x[i] = solver->miss[3 * solver->pivot[i] + c];
        (solver->rank < solver->places ? solve_part : solve_whole)(solver, x);
        for (size_t i = 0; i < solver->places; i++)
            solver->step[3 * solver->pivot[i] + c] = x[i];
    }
}

/* Returns the power of two of the largest number: squares of numbers in its units neither overflow nor
   underflow. */
static double unit_of(const double *numbers, size_t count)
{
    double largest = 0;
    int exponent = 0;
    for (size_t i = 0; i < count; i++)
        largest = larger_of(largest, fabs(numbers[i]));
    frexp(largest, &exponent);
    return largest > 0 ? ldexp(1, exponent - 1) : 1;
}

/* change = B^T lambda; miss = by - B change. Returns the sum of the squares of miss, in units of `unit`. */
static double find_miss(drag_solver *solver, const double *by, double unit, double *change)
{
    double square = 0;
    memset(change, 0, solver->columns * 3 * sizeof *change);
    for (size_t r = 0; r < solver->places; r++)
        for (size_t i = solver->start[r]; i < solver->start[r + 1]; i++)
            for (size_t c = 0; c < 3; c++)
                change[3 * solver->column[i] + c] += solver->value[i] * solver->lambda[3 * r + c];
    for (size_t r = 0; r < solver->places; r++) {
        double *const miss = solver->miss + 3 * r;
        double moved[3] = {0, 0, 0}, scaled[3];
        for (size_t i = solver->start[r]; i < solver->start[r + 1]; i++)
            for (size_t c = 0; c < 3; c++)
                moved[c] += solver->value[i] * change[3 * solver->column[i] + c];
        for (size_t c = 0; c < 3; c++) {
            miss[c] = by[3 * r + c] - moved[c];
            scaled[c] = miss[c] / unit;
        }
        square += vec_dot(scaled, scaled);
    }
    return square;
}

void ffd_drag_solve(drag_solver *solver, const double *by, double *change)
{
    const size_t n = 3 * solver->places;
    const double unit = unit_of(by, n);
    double best = INFINITY;
    memset(solver->lambda, 0, n * sizeof *solver->lambda);
    for (int round = 0; round <= ROUNDS; round++) {
        const double square = find_miss(solver, by, unit, change);
        if (round > 0 && !(square < best)) {
            for (size_t i = 0; i < n; i++)
                solver->lambda[i] -= solver->step[i];
            find_miss(solver, by, unit, change);
            return;
        }
        if (square == 0 || (round > 1 && square > 0.25 * best))
            return;
        best = square;
        if (round == ROUNDS)
            return;
        find_step(solver);
        for (size_t i = 0; i < n; i++)
            solver->lambda[i] += solver->step[i];
    }
}

void ffd_drag_free(drag_solver *solver)
{
    ffd_free(solver->start);
    ffd_free(solver->column);
    ffd_free(solver->value);
    ffd_free(solver->point);
    ffd_free(solver->factor);
    ffd_free(solver->diagonal);
    ffd_free(solver->pivot);
    ffd_free(solver->lambda);
    *solver = (drag_solver){0};
}
