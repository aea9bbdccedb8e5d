/* transform.c - ffd_lattice_transform: the lattice placed elsewhere, with the same deformation there. */
#include "author/made.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "lattice/lattice.h"
#include <ffd/author.h>
#include <math.h>
#include <string.h>

/* How far the axes of a box may be from right angles, as a cosine, to be those of a box still. */
#define ANGLE_TOLERANCE 1e-15

typedef struct affine_map {
    double linear[9], shift[3]; /* linear: row by row */
} affine_map;

/* Whether a map flattens space. Rows are scaled first, so that no product of small numbers is lost. */
static bool is_flat(const double linear[9])
{
    double rows[9];
    for (int r = 0; r < 3; r++) {
        const double *const row = linear + 3 * r;
        const double largest = maximum_number(fabs(row[0]), maximum_number(fabs(row[1]), fabs(row[2])));
        int exponent;
        frexp(largest, &exponent);
        for (int c = 0; c < 3; c++)
            rows[3 * r + c] = ldexp(row[c], -exponent);
    }
    return mat_determinant(rows) == 0;
}

static ffd_status take_matrix(const double matrix[16], affine_map *map, ffd_error *error)
{
    for (int i = 0; i < 16; i++)
        if (!isfinite(matrix[i]))
            return ffd_fail(error, FFD_E_ARGUMENT, "number %d of the matrix is not finite", i);
    if (matrix[12] != 0 || matrix[13] != 0 || matrix[14] != 0 || matrix[15] != 1)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "the last row of the matrix is %g %g %g %g, not 0 0 0 1: it is given row by row",
                        matrix[12], matrix[13], matrix[14], matrix[15]);
    for (int r = 0; r < 3; r++) {
        memcpy(map->linear + 3 * r, matrix + 4 * r, 3 * sizeof *matrix);
        map->shift[r] = matrix[4 * r + 3];
    }
    return is_flat(map->linear)
               ? ffd_fail(error, FFD_E_INVALID, "the determinant of the matrix is 0: it flattens the lattice")
               : FFD_OK;
}

/* Places a box. Returns false if it would be none. */
static bool place_box(const affine_map *by, made_box *box)
{
    double axes[9], min[3], max[3];
    for (int a = 0; a < 3; a++) {
        mat_apply(by->linear, box->axes + 3 * a, axes + 3 * a);
        const double length = vec_length(axes + 3 * a);
        for (int c = 0; c < 3; c++)
            axes[3 * a + c] /= length;
        min[a] = length * box->min[a] + vec_dot(axes + 3 * a, by->shift);
        max[a] = length * box->max[a] + vec_dot(axes + 3 * a, by->shift);
    }
    for (int a = 0; a < 3; a++)
        if (!(fabs(vec_dot(axes + 3 * a, axes + 3 * ((a + 1) % 3))) <= ANGLE_TOLERANCE))
            return false;
    memcpy(box->axes, axes, sizeof axes);
    memcpy(box->min, min, sizeof min);
    memcpy(box->max, max, sizeof max);
    return true;
}

/* Refuses a box whose file could not be read. */
static ffd_status check_box(const made_box *box, ffd_error *error)
{
    for (int a = 0; a < 3; a++)
        if (!(box->max[a] > box->min[a]) || !isfinite(box->max[a] - box->min[a]))
            return ffd_fail(error, FFD_E_INVALID,
                            "the box would have no extent along %c there: it would reach from %g to %g",
                            "uvw"[a], box -> min[a], box -> max[a]);
    return FFD_OK;
}

static bool is_box(const ffd_lattice *lattice)
{
    return lattice->spec->rest == SPEC_BOX || lattice->spec->rest == SPEC_BOX_MESH;
}

/* A box stays one, if its sides stay at right angles; all else becomes control points. */
static ffd_status place_rest(const affine_map *by, made_lattice *made, ffd_error *error)
{
    if (is_box(made->from)) {
        TRY(ffd_made_find_box(made, &made->box, error));
        made->has_box = place_box(by, &made->box);
        if (made->has_box)
            return check_box(&made->box, error);
    }
    TRY(ffd_made_take_points(made, error));
    for (size_t i = 0; i < made->from->count; i++) {
        double *const p = made->points + 3 * i, place[3];
        mat_apply(by->linear, p, place);
        for (int c = 0; c < 3; c++)
            p[c] = place[c] + by->shift[c];
    }
    return FFD_OK;
}

ffd_status ffd_lattice_transform(const ffd_lattice *lattice, const double matrix[16], ffd_lattice **result,
                                 ffd_error *error)
{
    made_lattice made = {0};
    affine_map by;
    ffd_status status;
    *result = NULL;
    TRY_END(take_matrix(matrix, &by, error));
    TRY_END(ffd_made_begin_same(lattice, &made, error));
    TRY_END(place_rest(&by, &made, error));
    for (size_t i = 0; i < lattice->count; i++) {
        double *const d = made.offsets + 3 * i, turned[3];
        mat_apply(by.linear, d, turned);
        memcpy(d, turned, sizeof turned);
    }
    TRY_END(ffd_made_finish(&made, result, error));
end:
    ffd_made_free(&made);
    return status;
}
