/* jacobian_rows.c - computes the rows of the matrix, vertex by vertex. */
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "job/jacobian/jacobian.h"
#include "points/row_tangent.h"
#include <string.h>

static const double identity[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

ffd_status ffd_jacobian_rows_make(const jacobian *j, jacobian_rows *rows, ffd_error *error)
{
    const bool by_points = j->desc->by == FFD_BY_POINTS;
    const size_t most = by_points ? 3 * BASIS_ENTRIES : j->columns;
    *rows = (jacobian_rows){.counts = {0}};
    rows->next = ffd_alloc_zero(j->link_count, sizeof *rows->next);
    rows->sums = ffd_alloc(by_points ? 0 : j->columns, 3 * sizeof *rows->sums);
    bool whole = rows->next && rows->sums;
    for (int a = 0; a < 3; a++) {
        rows->entries[a] = ffd_alloc(most, sizeof *rows->entries[a]);
        whole = whole && rows->entries[a];
    }
    return whole ? FFD_OK : ffd_fail_memory(error);
}

void ffd_jacobian_rows_free(jacobian_rows *rows)
{
    for (int a = 0; a < 3; a++)
        ffd_free(rows->entries[a]);
    ffd_free(rows->sums);
    ffd_free(rows->next);
}

void ffd_jacobian_rows_begin(const jacobian *j, size_t vertex, jacobian_rows *rows)
{
    for (size_t l = 0; l < j->link_count; l++)
        rows->next[l] = ffd_embedding_first_extended(j->links[l].embedding, vertex);
}

/* Returns the matrix that maps a link's displacement of a vertex to the result: F of the later links, then
   M^-1. It is product or borrowed memory. */
static const double *block_of(const jacobian *j, const jacobian_link *link, size_t vertex, double product[9])
{
    const double *const later = link->later ? link->later + 9 * vertex : NULL;
    const double *const inverse = j->inverses ? j->inverses + 9 * vertex : NULL;
    if (later && inverse) {
        mat_multiply(inverse, later, product);
        return product;
    }
    return later ? later : inverse ? inverse : identity;
}

static void add(jacobian_rows *rows, int row, uint64_t column, double value)
{
    if (value != 0)
        rows->entries[row][rows->counts[row]++] = (jacobian_entry){column, value};
}

static void fill_by_points(const jacobian *j, size_t vertex, jacobian_rows *rows)
{
    const jacobian_link *const link = &j->links[0];
    double product[9];
    ffd_basis_row(link->embedding, ffd_jacobian_weights(j, link), ffd_jacobian_seal(link), BASIS_BY_U, vertex,
                  &rows->next[0], &rows->basis);
    const double *const block = block_of(j, link, vertex, product);
    const double weight = ffd_jacobian_weight(j, vertex);
    for (size_t e = 0; e < rows->basis.count; e++) {
        const uint64_t column = rows->basis.columns[e];
        const double value = weight * rows->basis.values[e];
        if (!j->blocks)
            add(rows, 0, column, value);
        for (int a = 0; a < 3 && j->blocks; a++)
            for (uint64_t b = 0; b < 3; b++)
                add(rows, a, 3 * column + b, block[3 * a + (int)b] * value);
    }
}

/* The place of a row of a sealed lattice, which does not have all of the volume. */
static void find_sealed_place(const jacobian_link *link, size_t vertex, size_t next, double x[3])
{
    double uvw[3];
    if (ffd_basis_uvw(link->embedding, vertex, next, uvw))
        ffd_lattice_evaluate(link->seal.sealed, FFD_VOLUME_DEFORMED, uvw, x, NULL);
}

static void add_link(const jacobian *j, size_t index, size_t vertex, jacobian_rows *rows)
{
    const jacobian_link *const link = &j->links[index];
    const ffd_lattice *const lattice = j->job.chain.links[link->index].lattice;
    double product[9], x[3];
    ffd_basis_row(link->embedding, ffd_jacobian_weights(j, link), ffd_jacobian_seal(link), BASIS_BY_U, vertex,
                  &rows->next[index], &rows->basis);
    const double *const block = block_of(j, link, vertex, product);
    const double weight = ffd_jacobian_weight(j, vertex);
    ffd_row_place(lattice, &rows->basis, x);
    if (link->seal.sealed)
        find_sealed_place(link, vertex, rows->next[index], x);
    for (size_t k = 0; k < link->tangents.columns && rows->basis.count > 0; k++) {
        double tangent[3];
        const control_change change = ffd_tangents_column(&link->tangents, lattice->count, k);
        ffd_row_tangent(lattice, &change, &rows->basis, x, tangent);
        mat_apply(block, tangent, tangent);
        for (size_t c = 0; c < 3; c++)
            rows->sums[3 * link->columns[k] + c] += weight * tangent[c];
    }
}

void ffd_jacobian_rows_fill(const jacobian *j, size_t vertex, jacobian_rows *rows)
{
    memset(rows->counts, 0, sizeof rows->counts);
    if (j->desc->by == FFD_BY_POINTS) {
        fill_by_points(j, vertex, rows);
        return;
    }
    memset(rows->sums, 0, 3 * j->columns * sizeof *rows->sums);
    for (size_t l = 0; l < j->link_count; l++)
        add_link(j, l, vertex, rows);
    for (size_t k = 0; k < j->columns; k++)
        for (int a = 0; a < 3; a++)
            add(rows, a, k, rows->sums[3 * k + (size_t)a]);
}
