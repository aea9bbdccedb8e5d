#include "lattice/moves.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "lattice/lattice.h"
#include "lattice/move_action.h"
#include "lattice/shapes.h"
#include "lattice/spec.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* With "units": "box" what is a length or a position (by, to, about, within, and what a matrix acts
   on) is in fractions of the rest region's sides, along them; directions, angles and factors are
   the same in both units. */

/* The moves of one lattice while they are applied. */
typedef struct move_work {
    const ffd_lattice *lattice;
    double *points;          /* those that move */
    double *difference;      /* their displacements from rest */
    unsigned char *selected; /* of the current move, one byte a control point */
    bool box_units;
    rest_region region;
    double inverse[9]; /* of the region's frame; only in box units */
    double slack[3];   /* rounding of the coordinates that `within` compares */
    const char *file;
    ffd_error *error;
} move_work;

static void to_world(const move_work *work, double position[3])
{
    mat_apply(work->region.frame, position, position);
    for (int c = 0; c < 3; c++)
        position[c] += work->region.origin[c];
}

/* Where `within` looks for a rest point: in world units or in fractions of the region. */
static void coordinates_of(const move_work *work, const double point[3], double coordinates[3])
{
    for (int c = 0; c < 3; c++)
        coordinates[c] = work->box_units ? point[c] - work->region.origin[c] : point[c];
    if (work->box_units)
        mat_apply(work->inverse, coordinates, coordinates);
}

/* The matrix maps positions: in box units B M B^-1 with B the map from fractions to the world. */
static void matrix_to_world(const move_work *work, double matrix[16])
{
    double linear[9], offset[3], product[9], world[9], origin[3];
    for (int r = 0; r < 3; r++) {
        offset[r] = matrix[4 * r + 3];
        for (int c = 0; c < 3; c++)
            linear[3 * r + c] = matrix[4 * r + c];
    }
    mat_multiply(work->region.frame, linear, product);
    mat_multiply(product, work->inverse, world);
    to_world(work, offset);
    mat_apply(world, work->region.origin, origin);
    for (int r = 0; r < 3; r++) {
        matrix[4 * r + 3] = offset[r] - origin[r];
        for (int c = 0; c < 3; c++)
            matrix[4 * r + c] = world[3 * r + c];
    }
}

static void move_to_world(const move_work *work, lattice_move *move)
{
    if (!work->box_units)
        return;
    if (move->has_about)
        to_world(work, move->about);
    if (move->action == MOVE_BY)
        mat_apply(work->region.frame, move->vector, move->vector);
    else if (move->action == MOVE_TO)
        to_world(work, move->vector);
    else if (move->action == MOVE_MATRIX)
        matrix_to_world(work, move->matrix);
}

/* Control points on a face of the box that `within` names belong to it, whatever their last bit: a
   coordinate's rounding is allowed for, as in the embedding's tolerance. */
static void find_slack(move_work *work)
{
    double size[3] = {0, 0, 0};
    for (size_t i = 0; i < work->lattice->count; i++)
        for (int c = 0; c < 3; c++)
            size[c] = larger_of(size[c], fabs(work->lattice->rest[3 * i + c]));
    for (int c = 0; c < 3; c++) {
        const double *const row = work->inverse + 3 * c;
        const double largest = work->box_units
                                   ? fabs(row[0]) * size[0] + fabs(row[1]) * size[1] + fabs(row[2]) * size[2]
                                   : size[c];
        work->slack[c] = 16 * DBL_EPSILON * largest;
    }
}

static bool is_within(const move_work *work, const lattice_move *move, size_t point)
{
    double x[3];
    coordinates_of(work, work->lattice->rest + 3 * point, x);
    for (int c = 0; c < 3; c++)
        if (!(x[c] >= move->within_min[c] - work->slack[c] && x[c] <= move->within_max[c] + work->slack[c]))
            return false;
    return true;
}

static size_t select_points(move_work *work, const lattice_move *move)
{
    const size_t *const size = work->lattice->size;
    size_t first[3] = {0, 0, 0}, last[3] = {size[0] - 1, size[1] - 1, size[2] - 1}, count = 0;
    if (move->has_at) {
        memcpy(first, move->at_first, sizeof first);
        memcpy(last, move->at_last, sizeof last);
    }
    memset(work->selected, 0, work->lattice->count);
    for (size_t k = first[2]; k <= last[2]; k++)
        for (size_t j = first[1]; j <= last[1]; j++)
            for (size_t i = first[0]; i <= last[0]; i++) {
                const size_t point = (k * size[1] + j) * size[0] + i;
                work->selected[point] = !move->has_within || is_within(work, move, point);
                count += work->selected[point];
            }
    return count;
}

/* The centroid, summed up as distances from the first point: an offset of all points costs no digits. */
static void find_centroid(const move_work *work, size_t count, double centroid[3])
{
    const double *origin = NULL;
    double sum[3] = {0, 0, 0};
    for (size_t i = 0; i < work->lattice->count; i++) {
        if (!work->selected[i])
            continue;
        const double *const p = work->points + 3 * i;
        origin = origin ? origin : p;
        for (int c = 0; c < 3; c++)
            sum[c] += p[c] - origin[c];
    }
    for (int c = 0; c < 3; c++)
        centroid[c] = (origin ? origin[c] : 0) + sum[c] / (double)count;
}

static void find_extent(const move_work *work, ready_move *ready)
{
    double first = INFINITY, last = -INFINITY;
    for (size_t i = 0; i < work->lattice->count; i++) {
        if (!work->selected[i])
            continue;
        const double s = ffd_move_along(&ready->move, work->points + 3 * i);
        first = lesser_of(first, s);
        last = larger_of(last, s);
    }
    ready->first = first;
    ready->length = last - first;
}

/* Moves one coordinate of a point to where the action has it. `by` adds to the displacement as it is; another
   action adds what the point gains, and where it takes the point back to its place at rest nothing is left.
 */
static void move_coordinate(const lattice_move *move, int c, double to, double rest, double *p,
                            double *difference)
{
    const double from = *p;
    if (move->action == MOVE_BY) {
        *p += move->weight * move->vector[c];
        *difference += move->weight * move->vector[c];
        return;
    }
    *p = move->weight == 1 ? to : from + move->weight * (to - from);
    if (*p != from)
        *difference = *p == rest ? 0 : *difference + (*p - from);
}

static ffd_status move_point(const move_work *work, ready_move *ready, size_t point)
{
    double *const p = work->points + 3 * point, *const difference = work->difference + 3 * point;
    double moved[3] = {p[0], p[1], p[2]};
    ffd_move_act(ready, moved);
    for (int c = 0; c < 3; c++)
        move_coordinate(&ready->move, c, moved[c], work->lattice->rest[3 * point + (size_t)c], &p[c],
                        &difference[c]);
    if (vec_is_finite(p))
        return FFD_OK;
    const size_t *const size = work->lattice->size;
    return ffd_fail_at(work->error, FFD_E_INVALID, work->file, ready->move.pointer,
                       "moves control point %zu,%zu,%zu to a position that is not finite", point % size[0],
                       point / size[0] % size[1], point / size[0] / size[1]);
}

static ffd_status apply_move(move_work *work, const lattice_move *move)
{
    ready_move ready = {.move = *move, .degrees = NAN};
    const size_t count = select_points(work, move);
    if (count == 0)
        return ffd_fail_at(work->error, FFD_E_INVALID, work->file, move->pointer,
                           "selects no control point: none is within these bounds at rest");
    if (move->weight == 0)
        return FFD_OK;
    move_to_world(work, &ready.move);
    if (!move->has_about && ffd_move_has_centre(move->action))
        find_centroid(work, count, ready.move.about);
    if (ffd_move_has_extent(move->action))
        find_extent(work, &ready);
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < work->lattice->count && !status; i++)
        if (work->selected[i])
            status = move_point(work, &ready, i);
    return status;
}

ffd_status ffd_moves_apply(const lattice_spec *spec, const rest_region *region, ffd_lattice *lattice,
                           ffd_error *error)
{
    move_work work = {.lattice = lattice,
                      .points = lattice->deformed,
                      .difference = lattice->difference,
                      .box_units = spec->box_units,
                      .region = *region,
                      .file = spec->name,
                      .error = error};
    if (work.box_units && !mat_invert(region->frame, work.inverse))
        return ffd_fail_at(error, FFD_E_INVALID, spec->name, "/units",
                           "the rest points lie in a plane: there is no box to take fractions of");
    find_slack(&work);
    work.selected = ffd_alloc(lattice->count, 1);
    if (!work.selected)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < spec->move_count && !status; i++)
        status = apply_move(&work, &spec->moves[i]);
    ffd_free(work.selected);
    return status;
}
