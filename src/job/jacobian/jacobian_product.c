/* jacobian_product.c - products with the matrix, which need not be stored. */
#include "base/file/output.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "io/npy/npy.h"
#include "job/jacobian/jacobian.h"
#include <string.h>

/* Vertices per block. The sums of blocks are joined in order, so that the number of threads does not
   matter. */
#define BLOCK ((size_t)4096)

typedef struct product {
    const jacobian *j;
    jacobian_rows rows;
    const double *in;
    double *out;
    double *block; /* transposed product: the sums of one block, as many as out has */
} product;

/* Returns the length of a vector on the side of the columns: 3 a control point, or 1 a parameter. */
static size_t column_width(const jacobian *j)
{
    return j->desc->by == FFD_BY_PARAMETERS ? j->columns : 3 * j->links[0].embedding->rest->count;
}

/* Without blocks, a row applies to x, y and z alike. */
static void times_vertex(product *p, size_t vertex)
{
    double *const to = p->out + 3 * vertex;
    for (int a = 0; a < 3; a++) {
        const int row = p->j->blocks ? a : 0;
        double sum = 0;
        for (size_t e = 0; e < p->rows.counts[row]; e++) {
            const jacobian_entry *const entry = &p->rows.entries[row][e];
            sum += entry->value * p->in[p->j->blocks ? entry->column : 3 * entry->column + (uint64_t)a];
        }
        to[a] = sum;
    }
}

static void transposed_vertex(product *p, size_t vertex)
{
    const double *const from = p->in + 3 * vertex;
    for (int a = 0; a < 3; a++) {
        const int row = p->j->blocks ? a : 0;
        for (size_t e = 0; e < p->rows.counts[row]; e++) {
            const jacobian_entry *const entry = &p->rows.entries[row][e];
            p->block[p->j->blocks ? entry->column : 3 * entry->column + (uint64_t)a] +=
                entry->value * from[a];
        }
    }
}

static void multiply(product *p, bool transposed)
{
    const size_t count = p->j->count, width = column_width(p->j);
    ffd_jacobian_rows_begin(p->j, 0, &p->rows);
    for (size_t first = 0; first < count && !ffd_deadline_passed(); first += BLOCK) {
        const size_t last = count - first < BLOCK ? count : first + BLOCK;
        if (transposed)
            memset(p->block, 0, width * sizeof *p->block);
        for (size_t i = first; i < last; i++) {
            ffd_jacobian_rows_fill(p->j, i, &p->rows);
            if (transposed)
                transposed_vertex(p, i);
            else
                times_vertex(p, i);
        }
        for (size_t n = 0; n < width && transposed; n++)
            p->out[n] += p->block[n];
    }
}

static ffd_status write(const jacobian *j, const double *numbers, size_t rows, size_t columns,
                        ffd_error *error)
{
    file_output *output;
    TRY(ffd_output_create(&output, error));
    ffd_output_redirect(output, j->desc->job->sink, j->desc->job->sink_user);
    ffd_status status;
    TRY_END(ffd_output_begin(output, j->desc->output, j->desc->job->force, error));
    TRY_END(ffd_npy_begin(output, "<f8", rows, columns, error));
    for (size_t n = 0; n < rows * (columns ? columns : 1); n++) {
        unsigned char stored[8];
        store_double(stored, numbers[n]);
        TRY_END(ffd_output_write(output, stored, sizeof stored, error));
    }
    TRY_END(ffd_output_commit(output, error));
end:
    ffd_output_destroy(&output);
    return status;
}

ffd_status ffd_jacobian_multiply(const jacobian *j, ffd_error *error)
{
    const bool transposed = j->desc->transposed != NULL, by_points = j->desc->by == FFD_BY_POINTS;
    const size_t columns = column_width(j), vertices = 3 * j->count;
    double *in = NULL;
    product p = {.j = j};
    TRY(ffd_npy_read(transposed ? j->desc->transposed : j->desc->times,
                     transposed ? j->desc->transposed_bytes : j->desc->times_bytes,
                     transposed ? vertices : columns, &in, error));
    p.in = in;
    p.out = ffd_alloc_zero(transposed ? columns : vertices, sizeof *p.out);
    p.block = ffd_alloc(transposed ? columns : 0, sizeof *p.block);
    ffd_status status;
    TRY_END(ffd_jacobian_rows_make(j, &p.rows, error));
    if (!p.out || !p.block)
        TRY_END(ffd_fail_memory(error));
    multiply(&p, transposed);
    TRY_END(ffd_deadline_check(error));
    TRY_END(transposed ? write(j, p.out, by_points ? columns / 3 : columns, by_points ? 3 : 0, error)
                       : write(j, p.out, j->count, 3, error));
end:
    ffd_jacobian_rows_free(&p.rows);
    ffd_free(in);
    ffd_free(p.out);
    ffd_free(p.block);
    return status;
}
