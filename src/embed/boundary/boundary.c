#include "embed/boundary/boundary.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "embed/boundary/boundary_faces.h"
#include <string.h>

/* The greatest binary exponent of the search's units: products neither overflow nor underflow. */
#define MOST_EXPONENT 1000
/* A point that is farther away is replaced by one at this distance in the same direction, so that squares do
   not overflow. */
#define FARTHEST 0x1p400

/* Returns the power of two that scales size to [0.5, 1). */
static double scale_of(double size)
{
    int exponent = 0;
    if (size > 0)
        frexp(size, &exponent);
    exponent = exponent > MOST_EXPONENT ? MOST_EXPONENT : exponent;
    return ldexp(1, exponent < -MOST_EXPONENT ? MOST_EXPONENT : -exponent);
}

static void set_units(boundary *border)
{
    const ffd_lattice *lattice = border->lattice;
    double extent = 0, weight = 0;
    bounds box;
    memcpy(box.lo, lattice->rest, sizeof box.lo);
    memcpy(box.hi, lattice->rest, sizeof box.hi);
    for (size_t i = 1; i < lattice->count; i++)
        bounds_add(&box, lattice->rest + 3 * i);
    for (int a = 0; a < 3; a++) {
        border->origin[a] = 0.5 * box.lo[a] + 0.5 * box.hi[a];
        extent = maximum_number(extent,
                                maximum_number(box.hi[a] - border->origin[a], border->origin[a] - box.lo[a]));
    }
    for (size_t i = 0; lattice->rest_weights && i < lattice->count; i++)
        if (lattice->rest_weights[i] > weight)
            weight = lattice->rest_weights[i];
    border->scale = scale_of(extent);
    border->weight_scale = scale_of(weight);
}

static void set_box_units(boundary *border)
{
    double extent = 0;
    for (int i = 0; i < 9; i++)
        extent = maximum_number(extent, fabs(border->lattice->frame[i]));
    border->scale = scale_of(extent);
    for (int i = 0; i < 9; i++)
        border->frame[i] = border->lattice->frame[i] * border->scale;
    memcpy(border->origin, border->lattice->origin, sizeof border->origin);
}

ffd_status ffd_boundary_create(const ffd_lattice *lattice, boundary **made, ffd_error *error)
{
    *made = NULL;
    boundary *border = ffd_alloc_zero(1, sizeof *border);
    if (!border)
        return ffd_fail_memory(error);
    border->lattice = lattice;
    ffd_status status = FFD_OK;
    if (lattice->form == REST_BOX_AFFINE) {
        set_box_units(border);
    } else {
        set_units(border);
        status = ffd_boundary_build(border, error);
    }
    if (status)
        ffd_boundary_destroy(&border);
    *made = border;
    return status;
}

void ffd_boundary_destroy(boundary **made)
{
    if (!made || !*made)
        return;
    ffd_boundary_free_patches((*made)->patches);
    for (int i = 0; i < (*made)->face_count; i++)
        ffd_free((*made)->faces[i].points);
    ffd_free((*made)->nodes);
    ffd_free(*made);
    *made = NULL;
}

/* Converts p to the search's units. Differences of quarters cannot overflow. Returns whether p is too far
   away for these units. */
static bool make_query(const boundary *border, const double p[3], boundary_query *query)
{
    double farthest = 0;
    for (int a = 0; a < 3; a++) {
        query->x[a] = 0.25 * p[a] - 0.25 * border->origin[a];
        farthest = maximum_number(farthest, fabs(query->x[a]));
    }
    const bool is_far = !(farthest * border->scale <= 0.25 * FARTHEST);
    for (int a = 0; a < 3; a++)
        query->x[a] = is_far ? query->x[a] / farthest * FARTHEST : query->x[a] * border->scale * 4;
    query->unit = is_far ? farthest / (0.25 * FARTHEST) : 1 / border->scale;
    query->length = vec_length(query->x);
    return is_far;
}

/* The residual is scaled, because its square could underflow. */
static void report_distance(const boundary_query *query, const boundary_foot *foot, boundary_point *nearest)
{
    const double *r = foot->residual;
    const double size = maximum_number(fabs(r[0]), maximum_number(fabs(r[1]), fabs(r[2])));
    if (!(size > 0))
        return;
    const double part[3] = {r[0] / size, r[1] / size, r[2] / size};
    const double length = vec_length(part);
    nearest->distance = size * length * query->unit;
    for (int a = 0; a < 3; a++)
        nearest->direction[a] = part[a] / length;
}

static void report_derivative(const boundary_query *query, const boundary_foot *foot, boundary_point *nearest)
{
    double rows[9] = {0};
    for (int f = 0; f < foot->free_count; f++)
        for (int c = 0; c < 3; c++) {
            const double value = foot->by_x[f][c] / query->unit;
            if (!isfinite(value))
                return;
            rows[3 * foot->free[f] + c] = value;
        }
    memcpy(nearest->uvw_by_p, rows, sizeof rows);
}

ffd_status ffd_boundary_find(const boundary *border, const double p[3], double reach, boundary_point *nearest,
                             ffd_error *error)
{
    boundary_query query;
    boundary_foot foot = {.free_count = 0};
    bool found = true;
    memset(nearest, 0, sizeof *nearest);
    if (!vec_is_finite(p) || !(reach >= 0))
        return FFD_OK;
    make_query(border, p, &query);
    if (border->lattice->form == REST_BOX_AFFINE) {
        ffd_boundary_box_find(border, &query, &foot);
    } else {
        found = false;
        TRY(ffd_boundary_search(border, &query, reach / query.unit, &found, &foot, error));
    }
    nearest->cut_short = foot.cut_short;
    if (!found)
        return FFD_OK;
    report_distance(&query, &foot, nearest);
    if (!(nearest->distance <= reach)) {
        *nearest = (boundary_point){.cut_short = foot.cut_short};
        return FFD_OK;
    }
    nearest->found = true;
    memcpy(nearest->uvw, foot.uvw, sizeof foot.uvw);
    report_derivative(&query, &foot, nearest);
    return FFD_OK;
}

ffd_status ffd_boundary_meets(const boundary *border, const double p[3], const double each[3],
                              boundary_verdict *verdict, ffd_error *error)
{
    static const boundary_verdict verdicts[] = {[PATCH_MISSES] = BOUNDARY_MISSES,
                                                [PATCH_MEETS] = BOUNDARY_MEETS,
                                                [PATCH_UNKNOWN] = BOUNDARY_UNDECIDED};
    boundary_query query;
    patch_cell cell;
    patch_view view = PATCH_UNKNOWN;
    *verdict = BOUNDARY_UNDECIDED;
    if (!vec_is_finite(p) || make_query(border, p, &query))
        return FFD_OK;
    for (int a = 0; a < 3; a++) {
        cell.centre[a] = query.x[a];
        cell.half[a] = each[a] / query.unit;
    }
    const ffd_status status = ffd_boundary_view_cell(border, &cell, &view, error);
    *verdict = verdicts[view];
    return status;
}
