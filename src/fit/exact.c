#include "fit/exact.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/vector/vec.h"
#include <math.h>
#include <string.h>

/* Rows whose pivots are below this part of the first one depend on others. */
#define DEPENDENT 1e-12

typedef struct exact_work {
    const fit_places *places;
    double diagonal;
    size_t count;
    double *rows;    /* the basis functions of each row: count * unknowns->row */
    uint32_t *seen;  /* and of what unknowns they are */
    double *inner;   /* count * count: the products of rows; then their factor, of rows in their order */
    size_t *order;   /* the rows by their pivots */
    size_t rank;     /* the first ones, which depend on no others */
    double *missing; /* 3 of each row: what is wanted, less what is there */
} exact_work;

static void find_rows(const exact_work *work)
{
    const fit_unknowns *const unknowns = work->places->unknowns;
    for (size_t r = 0; r < work->count; r++) {
        const double *const uvw = work->places->uvw + 3 * r;
        ffd_unknowns_row(unknowns, uvw, work->rows + unknowns->row * r);
        ffd_unknowns_seen(unknowns, uvw, work->seen + unknowns->row * r);
    }
}

static void find_missing(const exact_work *work, const double *x)
{
    const fit_unknowns *const unknowns = work->places->unknowns;
    for (size_t r = 0; r < work->count; r++)
        for (size_t c = 0; c < 3; c++) {
            double value = 0;
            for (size_t n = 0; n < unknowns->row; n++)
                value +=
                    work->rows[unknowns->row * r + n] * x[3 * (size_t)work->seen[unknowns->row * r + n] + c];
            work->missing[3 * r + c] = work->places->wanted[3 * r + c] - value;
        }
}

/* The products of the columns of L^-1 B_e^T, or, without a factor, of the rows themselves. */
static ffd_status find_products(const exact_work *work, const band_matrix *factor, ffd_error *error)
{
    const fit_unknowns *const unknowns = work->places->unknowns;
    const size_t m = work->count;
    double *const columns = ffd_alloc_zero(unknowns->count * m, sizeof *columns);
    if (!columns)
        return ffd_fail_memory(error);
    for (size_t r = 0; r < m; r++)
        for (size_t n = 0; n < unknowns->row; n++)
            columns[m * work->seen[unknowns->row * r + n] + r] += work->rows[unknowns->row * r + n];
    if (factor)
        ffd_band_forward(factor, columns, m);
    memset(work->inner, 0, m * m * sizeof *work->inner);
    for (size_t i = 0; i < unknowns->count && !ffd_deadline_passed_at(i); i++) {
        const double *const row = columns + m * i;
        for (size_t a = 0; a < m; a++) {
            if (row[a] == 0) /* most are: L^-1 B_e^T begins where a row sees something */
                continue;
            for (size_t b = 0; b < m; b++)
                work->inner[m * a + b] += row[a] * row[b];
        }
    }
    ffd_free(columns);
    return ffd_deadline_check(error);
}

static void swap_rows(const exact_work *work, size_t a, size_t b)
{
    const size_t m = work->count, kept = work->order[a];
    work->order[a] = work->order[b];
    work->order[b] = kept;
    for (size_t i = 0; i < m; i++) {
        const double entry = work->inner[m * a + i];
        work->inner[m * a + i] = work->inner[m * b + i];
        work->inner[m * b + i] = entry;
    }
    for (size_t i = 0; i < m; i++) {
        const double entry = work->inner[m * i + a];
        work->inner[m * i + a] = work->inner[m * i + b];
        work->inner[m * i + b] = entry;
    }
}

static size_t largest_pivot(const exact_work *work, size_t from)
{
    const size_t m = work->count;
    size_t at = from;
    for (size_t i = from + 1; i < m; i++)
        if (work->inner[(m + 1) * i] > work->inner[(m + 1) * at])
            at = i;
    return at;
}

/* Replaces the products by their factor, with the largest pivots first (Golub & Van Loan 4.2.8), as far as
   rows depend on no others. Both halves are kept up: rows are then next to each other in memory. */
static void factor_products(exact_work *work)
{
    const size_t m = work->count;
    double *const k = work->inner, first = m > 0 ? k[(m + 1) * largest_pivot(work, 0)] : 0;
    for (work->rank = 0; work->rank < m; work->rank++) {
        const size_t p = work->rank;
        if (p % 64 == 0 && ffd_deadline_passed()) /* correct() checks it */
            return;
        swap_rows(work, p, largest_pivot(work, p));
        if (!(k[(m + 1) * p] > DEPENDENT * first))
            return;
        const double root = sqrt(k[(m + 1) * p]);
        for (size_t i = p; i < m; i++)
            k[m * p + i] = k[m * i + p] = i == p ? root : k[m * p + i] / root;
        for (size_t i = p + 1; i < m; i++)
            for (size_t j = p + 1; j < m && k[m * p + i] != 0; j++)
                k[m * i + j] -= k[m * p + i] * k[m * p + j];
    }
}

/* Solves for `columns` numbers of each of the first rows, in their order, in place. */
static void solve_products(const exact_work *work, double *x, size_t columns)
{
    const size_t m = work->count;
    for (size_t c = 0; c < columns; c++) {
        for (size_t i = 0; i < work->rank; i++) {
            for (size_t j = 0; j < i; j++)
                x[columns * i + c] -= work->inner[m * i + j] * x[columns * j + c];
            x[columns * i + c] /= work->inner[(m + 1) * i];
        }
        for (size_t i = work->rank; i-- > 0;) {
            for (size_t j = i + 1; j < work->rank; j++)
                x[columns * i + c] -= work->inner[m * j + i] * x[columns * j + c];
            x[columns * i + c] /= work->inner[(m + 1) * i];
        }
    }
}

/* x += A^-1 B_e^T (what is missing), or B_e^T of it without a factor. */
static ffd_status add_missing(const exact_work *work, const band_matrix *factor, double *x, ffd_error *error)
{
    const fit_unknowns *const unknowns = work->places->unknowns;
    double *const parts = ffd_alloc(work->rank, 3 * sizeof *parts);
    double *const change = ffd_alloc_zero(unknowns->count, 3 * sizeof *change);
    ffd_status status;
    TRY_END(parts && change ? FFD_OK : ffd_fail_memory(error));
    for (size_t i = 0; i < work->rank; i++)
        memcpy(parts + 3 * i, work->missing + 3 * work->order[i], 3 * sizeof *parts);
    solve_products(work, parts, 3);
    for (size_t i = 0; i < work->rank; i++)
        for (size_t n = 0; n < unknowns->row; n++) {
            const size_t at = unknowns->row * work->order[i] + n;
            for (size_t c = 0; c < 3; c++)
                change[3 * (size_t)work->seen[at] + c] += work->rows[at] * parts[3 * i + c];
        }
    if (factor) {
        ffd_band_forward(factor, change, 3);
        ffd_band_backward(factor, change, 3);
    }
    for (size_t i = 0; i < 3 * unknowns->count; i++)
        x[i] += change[i];
end:
    ffd_free(parts);
    ffd_free(change);
    return status;
}

ffd_status ffd_exact_fail(size_t a, size_t b, double by, ffd_error *error)
{
    if (a == b)
        return ffd_fail(error, FFD_E_UNMET, "the exact row %zu contradicts its mirror image by %.6g", a, by);
    return ffd_fail(error, FFD_E_UNMET, "the exact rows %zu and %zu contradict each other by %.6g",
                    a < b ? a : b, a < b ? b : a, by);
}

/* Fails with the two rows that contradict each other: one that depends on others, and that of these which has
   the largest part in it. */
static ffd_status fail_at(const exact_work *work, size_t left, double by, ffd_error *error)
{
    const size_t m = work->count;
    double *const parts = ffd_alloc(work->rank, sizeof *parts);
    size_t most = 0;
    if (!parts)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < work->rank; i++) /* the factor's row gives the products again */
        parts[i] = work->inner[m * left + i];
    for (size_t i = work->rank; i-- > 0;) {
        for (size_t j = i + 1; j < work->rank; j++)
            parts[i] -= work->inner[m * j + i] * parts[j];
        parts[i] /= work->inner[(m + 1) * i];
    }
    for (size_t i = 1; i < work->rank; i++)
        if (fabs(parts[i]) > fabs(parts[most]))
            most = i;
    ffd_free(parts);
    const size_t a = work->places->numbers[work->order[left]], b = work->places->numbers[work->order[most]];
    return ffd_exact_fail(a, b, by, error);
}

/* Whether the rows that depend on others hold. */
static ffd_status check_dependent(const exact_work *work, ffd_error *error)
{
    for (size_t i = work->rank; i < work->count; i++) {
        const double by = vec_length(work->missing + 3 * work->order[i]);
        if (!(by <= EXACT_HOLDS * work->diagonal))
            return fail_at(work, i, by, error);
    }
    return FFD_OK;
}

/* Counts the rows that others imply. Of rows of one number, which a mirror image has too, all must be. */
static size_t count_dependent(const exact_work *work)
{
    const size_t *const numbers = work->places->numbers;
    size_t count = 0;
    for (size_t i = work->rank; i < work->count; i++) {
        bool counts = true;
        for (size_t j = 0; j < i && counts; j++)
            counts = numbers[work->order[j]] != numbers[work->order[i]];
        count += counts;
    }
    return count;
}

/* Makes the rows hold by the least change in terms of the factor, or else of the offsets. */
static ffd_status correct(exact_work *work, const band_matrix *factor, double *x, ffd_error *error)
{
    for (size_t r = 0; r < work->count; r++)
        work->order[r] = r;
    TRY(find_products(work, factor, error));
    factor_products(work);
    TRY(ffd_deadline_check(error));
    find_missing(work, x);
    TRY(add_missing(work, factor, x, error));
    TRY(ffd_deadline_check(error));
    find_missing(work, x);
    return check_dependent(work, error);
}

ffd_status ffd_exact_correct(const fit_places *rows, double diagonal, const band_matrix *factor, double *x,
                             size_t *dependent, ffd_error *error)
{
    const size_t m = rows->count, row = rows->unknowns->row;
    exact_work work = {.places = rows, .diagonal = diagonal, .count = m};
    ffd_status status;
    *dependent = 0;
    if (m == 0)
        return FFD_OK;
    work.rows = ffd_alloc(m * row, sizeof *work.rows);
    work.seen = ffd_alloc(m * row, sizeof *work.seen);
    work.inner = ffd_alloc(m * m, sizeof *work.inner);
    work.order = ffd_alloc(m, sizeof *work.order);
    work.missing = ffd_alloc(m, 3 * sizeof *work.missing);
    TRY_END(work.rows && work.seen && work.inner && work.order && work.missing ? FFD_OK
                                                                               : ffd_fail_memory(error));
    find_rows(&work);
    TRY_END(correct(&work, factor, x, error));
    *dependent = count_dependent(&work);
    TRY_END(correct(&work, NULL, x, error));
end:
    ffd_free(work.rows);
    ffd_free(work.seen);
    ffd_free(work.inner);
    ffd_free(work.order);
    ffd_free(work.missing);
    return status;
}
