#include "lattice/moves.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/vector/vec.h"
#include "lattice/drag.h"
#include "lattice/lattice.h"
#include "lattice/mirror.h"
#include "lattice/move_action.h"
#include "lattice/move_exact.h"
#include "lattice/noise.h"
#include "lattice/shapes.h"
#include "lattice/spec.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* A drag misses a place by more than rounding where it misses more than this part of what was asked. */
#define MISSED 1e-9

/* With "units": "box" or "mesh", lengths and positions (by, to, about, within, the argument of a matrix, the
   positions in a pull and in a falloff) are fractions of the sides of the rest region, along these sides.
   Directions, angles and factors are the same in both units. */

/* The state while the moves of a lattice are applied. */
typedef struct move_work {
    ffd_lattice *lattice;
    double *points;          /* the deformed control points */
    double *difference;      /* their displacements from rest */
    unsigned char *selected; /* by the current move; one byte for each control point */
    bool in_region;          /* lengths and positions are fractions of the region */
    rest_region region;
    double inverse[9]; /* inverse of the region's frame; only if in_region */
    double slack[3];   /* tolerance of the coordinates that `within` compares */
    mirror_tree rest;  /* for lookups of mirror images; built for the first mirrored move */
    const char *file;
    const move_observer *observer; /* may be NULL */
    ffd_error *error;
} move_work;

static void to_world(const move_work *work, double position[3])
{
    mat_apply(work->region.frame, position, position);
    for (int c = 0; c < 3; c++)
        position[c] += work->region.origin[c];
}

/* Returns the coordinates of a rest point as `within` compares them: in world units, or in fractions of the
   region. */
static void coordinates_of(const move_work *work, const double point[3], double coordinates[3])
{
    for (int c = 0; c < 3; c++)
        coordinates[c] = work->in_region ? point[c] - work->region.origin[c] : point[c];
    if (work->in_region)
        mat_apply(work->inverse, coordinates, coordinates);
}

/* Converts a matrix that acts on fractions of the region: B M B^-1, with B the map from fractions to world
   units. */
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

/* Returns whether the action adds a vector to the point and to its displacement. */
static bool adds_vector(const lattice_move *move)
{
    return move->action == MOVE_BY || move->action == MOVE_PULL || move->action == MOVE_JITTER;
}

static void move_to_world(const move_work *work, lattice_move *move)
{
    if (!work->in_region)
        return;
    if (move->has_about)
        to_world(work, move->about);
    if (adds_vector(move) && move->action != MOVE_JITTER)
        mat_apply(work->region.frame, move->vector, move->vector);
    else if (move->action == MOVE_TO)
        to_world(work, move->vector);
    else if (move->action == MOVE_MATRIX)
        matrix_to_world(work, move->matrix);
}

/* Control points on the border of a `within` box are inside even if their last bits differ, so the tolerance
   is the rounding of a coordinate, as for the embedding. */
static void find_slack(move_work *work)
{
    double size[3] = {0, 0, 0};
    for (size_t i = 0; i < work->lattice->count; i++)
        for (int c = 0; c < 3; c++)
            size[c] = larger_of(size[c], fabs(work->lattice->rest[3 * i + c]));
    for (int c = 0; c < 3; c++) {
        const double *const row = work->inverse + 3 * c;
        const double largest = work->in_region
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

/* Computes the centroid from distances to the first point, so that a common offset of all points costs no
   digits. */
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

/* What rounding makes of the coordinate of points that lie in one plane across the axis, relative to the size
   of their coordinates: of positions that were computed along axes of a box, or turned by the moves before.
 */
#define FLAT_ROUNDING (64 * DBL_EPSILON)

static void find_extent(const move_work *work, ready_move *ready)
{
    double first = INFINITY, last = -INFINITY, greatest = vec_greatest(ready->move.about);
    for (size_t i = 0; i < work->lattice->count; i++) {
        if (!work->selected[i])
            continue;
        const double s = ffd_move_along(&ready->move, work->points + 3 * i);
        first = lesser_of(first, s);
        last = larger_of(last, s);
        greatest = larger_of(greatest, vec_greatest(work->points + 3 * i));
    }
    ready->first = first;
    ready->length = last - first > FLAT_ROUNDING * greatest ? last - first : 0;
}

/* Returns the distance of a rest position from a position of the file, divided by the radius. */
static double radii_from(const double x[3], const double center[3], double radius)
{
    const double away[3] = {x[0] - center[0], x[1] - center[1], x[2] - center[2]};
    return vec_length(away) / radius;
}

/* Returns the extent of the region along a unit vector. */
static double extent_along(const rest_region *region, const double axis[3])
{
    double extent = 0;
    for (int a = 0; a < 3; a++) {
        const double side[3] = {region->frame[a], region->frame[3 + a], region->frame[6 + a]};
        extent += fabs(vec_dot(axis, side));
    }
    return extent;
}

/* Returns the position between `from` (0) and `to` (1) of a rest point along the axis; in fractions along the
   whole region, from its lower corner. Terms are halved, because a difference could overflow. */
static double way_along(const move_work *work, const move_falloff *falloff, const double rest[3])
{
    double from_origin[3];
    for (int c = 0; c < 3; c++)
        from_origin[c] = work->in_region ? rest[c] - work->region.origin[c] : rest[c];
    const double extent = work->in_region ? extent_along(&work->region, falloff->axis) : 1;
    const double s = vec_dot(falloff->axis, from_origin) / extent;
    return (0.5 * s - 0.5 * falloff->from) / (0.5 * falloff->to - 0.5 * falloff->from);
}

/* Returns the factor of the falloff at a rest position: 1 - (3x^2 - 2x^3). */
static double falloff_at(const move_work *work, const move_falloff *falloff, const double rest[3])
{
    double place[3];
    coordinates_of(work, rest, place);
    const double x = falloff->kind == FALLOFF_AXIS ? way_along(work, falloff, rest)
                                                   : radii_from(place, falloff->center, falloff->radius);
    if (!(x > 0))
        return 1;
    return x < 1 ? 1 - x * x * (3 - 2 * x) : 0;
}

/* Returns the factor of a pull: (1 - x^2)^2 within the radius, else 0. */
static double pull_at(const move_work *work, const lattice_move *move, const double rest[3])
{
    double place[3];
    coordinates_of(work, rest, place);
    const double x = radii_from(place, move->point, move->radius);
    return x < 1 ? (1 - x * x) * (1 - x * x) : 0;
}

static double weight_at(const move_work *work, const lattice_move *move, const double rest[3])
{
    double weight = move->weight;
    if (move->falloff.kind != FALLOFF_NONE)
        weight *= falloff_at(work, &move->falloff, rest);
    if (move->action == MOVE_PULL)
        weight *= pull_at(work, move, rest);
    return weight;
}

static ffd_status check_finite(const move_work *work, const lattice_move *move, size_t point)
{
    const size_t *const size = work->lattice->size;
    if (vec_is_finite(work->points + 3 * point))
        return FFD_OK;
    return ffd_fail_at(work->error, FFD_E_INVALID, work->file, move->line, move->pointer,
                       "moves control point %zu,%zu,%zu to a position that is not finite", point % size[0],
                       point / size[0] % size[1], point / size[0] / size[1]);
}

/* Returns the noise of a point in world units. */
static void jitter_of(const move_work *work, const lattice_move *move, size_t point, double by[3])
{
    for (int c = 0; c < 3; c++)
        by[c] = move->vector[c] * noise_at((uint64_t)move->seed, point, c);
    if (work->in_region)
        mat_apply(work->region.frame, by, by);
}

/* Moves a point. For a mirrored move (plane), the action is applied to the image of the point, and the result
   is reflected back. */
static ffd_status move_point(const move_work *work, ready_move *ready, const mirror_plane *plane,
                             size_t point)
{
    const lattice_move *const move = &ready->move;
    const double *const rest = work->lattice->rest + 3 * point;
    double *const p = work->points + 3 * point, *const difference = work->difference + 3 * point;
    double from[3] = {p[0], p[1], p[2]}, from_rest[3] = {rest[0], rest[1], rest[2]};
    if (plane) {
        ffd_mirror_point(plane, p, from);
        ffd_mirror_point(plane, rest, from_rest);
    }
    const double weight = weight_at(work, move, from_rest);
    if (weight == 0)
        return FFD_OK;
    double to[3] = {from[0], from[1], from[2]};
    ffd_move_act(ready, to);
    if (move->action == MOVE_JITTER)
        jitter_of(work, move, point, to);
    else if (plane && adds_vector(move))
        ffd_mirror_vector(plane, move->vector, to);
    else if (adds_vector(move))
        memcpy(to, move->vector, sizeof to);
    else if (plane)
        ffd_mirror_back(plane, p, from, to, to);
    for (int c = 0; c < 3; c++) {
        if (adds_vector(move)) {
            p[c] += weight * to[c];
            difference[c] += weight * to[c];
            continue;
        }
        ffd_move_put(weight == 1 ? to[c] : p[c] + weight * (to[c] - p[c]), rest[c], &p[c], &difference[c]);
    }
    return check_finite(work, move, point);
}

void ffd_drag_targets(const move_step *step, const spec_drag *from, double *targets)
{
    const size_t own = step->move->drag_count;
    for (size_t i = 0; i < own; i++) {
        double *const by = targets + 3 * i;
        memcpy(by, from[i].by, 3 * sizeof *by);
        if (step->inverse)
            mat_apply(step->region->frame, by, by);
        if (step->plane)
            ffd_mirror_vector(step->plane, by, by + 3 * own);
    }
}

/* Fills xyz with the places of a drag in world units, and their mirror images. */
static void find_places(const move_work *work, const lattice_move *move, const mirror_plane *plane,
                        double *xyz)
{
    for (size_t i = 0; i < move->drag_count; i++) {
        double *const place = xyz + 3 * i;
        memcpy(place, move->drags[i].point, 3 * sizeof *place);
        if (work->in_region)
            to_world(work, place);
        if (plane)
            ffd_mirror_point(plane, place, place + 3 * move->drag_count);
    }
}

/* Drops the points from the selection that rest beyond the radius of all places. Returns how many are left.
 */
static size_t keep_near(move_work *work, const double *xyz, size_t places, double radius)
{
    size_t count = 0;
    for (size_t i = 0; i < work->lattice->count; i++) {
        double rest[3], place[3];
        bool is_near = !(radius > 0);
        coordinates_of(work, work->lattice->rest + 3 * i, rest);
        for (size_t k = 0; k < places && work->selected[i] && !is_near; k++) {
            coordinates_of(work, xyz + 3 * k, place);
            is_near = radii_from(rest, place, radius) <= 1;
        }
        work->selected[i] = work->selected[i] && is_near;
        count += work->selected[i];
    }
    return count;
}

/* Notes the largest miss of a drag, if it is more than rounding and more than those of the moves before. */
static void note_miss(move_work *work, const lattice_move *move, const drag_solver *solver, const double *xyz,
                      const double *by)
{
    drag_miss *const missed = &work->lattice->missed;
    double asked = 0, most = 0;
    size_t worst = 0;
    for (size_t i = 0; i < solver->places; i++) {
        const double miss = vec_length(solver->miss + 3 * i);
        asked = larger_of(asked, vec_length(by + 3 * i));
        worst = miss > most ? i : worst;
        most = larger_of(most, miss);
    }
    if (!(most > MISSED * asked) || !(most > missed->miss))
        return;
    *missed = (drag_miss){.miss = most, .asked = vec_length(by + 3 * worst)};
    memcpy(missed->pointer, move->pointer, sizeof missed->pointer);
    memcpy(missed->place, xyz + 3 * worst, sizeof missed->place);
}

/* Changes the control points by what a drag asks for. numbers: room for 6 numbers for each place. */
static ffd_status move_places(move_work *work, move_step *step, double *numbers)
{
    const lattice_move *const move = step->move;
    drag_solver solver = {0};
    const size_t places = step->plane ? 2 * move->drag_count : move->drag_count;
    double *const by = numbers + 3 * places, *change = NULL;
    ffd_status status;
    find_places(work, move, step->plane, numbers);
    if (keep_near(work, numbers, places, move->radius) == 0)
        TRY_END(ffd_fail_at(work->error, FFD_E_INVALID, work->file, move->line, move->pointer,
                            "no control point that it selects rests within %s of a place",
                            ffd_number_text(move->radius).text));
    TRY_END(ffd_drag_prepare(
        work->lattice, &(drag_places){numbers, places, move->drag_count, work->selected, work->file, move},
        &solver, work->error));
    step->drag = &solver;
    TRY_END(work->observer ? work->observer->see(work->observer->context, step, work->error) : FFD_OK);
    change = ffd_alloc(solver.columns, 3 * sizeof *change);
    TRY_END(change ? FFD_OK : ffd_fail_memory(work->error));
    ffd_drag_targets(step, move->drags, by);
    ffd_drag_solve(&solver, by, change);
    for (size_t i = 0; i < solver.columns; i++) {
        for (size_t c = 0; c < 3; c++) {
            work->points[3 * solver.point[i] + c] += change[3 * i + c];
            work->difference[3 * solver.point[i] + c] += change[3 * i + c];
        }
        TRY_END(check_finite(work, move, solver.point[i]));
    }
    note_miss(work, move, &solver, numbers, by);
end:
    ffd_drag_free(&solver);
    ffd_free(change);
    return status;
}

static move_step step_of(const move_work *work, size_t index, const lattice_move *move,
                         const ready_move *ready, const mirror_plane *plane)
{
    return (move_step){.move = move,
                       .index = index,
                       .ready = ready,
                       .plane = plane,
                       .selected = work->selected,
                       .lattice = work->lattice,
                       .region = &work->region,
                       .inverse = work->in_region ? work->inverse : NULL};
}

static ffd_status observe(const move_work *work, size_t index, const lattice_move *move,
                          const ready_move *ready, const mirror_plane *plane)
{
    const move_step step = step_of(work, index, move, ready, plane);
    return work->observer ? work->observer->see(work->observer->context, &step, work->error) : FFD_OK;
}

/* Moves the selected points. plane: for the mirror images of a mirrored move; else NULL. */
static ffd_status move_points(const move_work *work, size_t index, const lattice_move *move,
                              ready_move *ready, const mirror_plane *plane)
{
    const exact_bend bend = {work->lattice, work->selected, ready, plane, work->file};
    TRY(observe(work, index, move, ready, plane));
    if (ready->move.exact)
        TRY(ffd_move_bend_exactly(&bend, work->error));
    for (size_t i = 0; i < work->lattice->count; i++) {
        if (!work->selected[i])
            continue;
        TRY(ready->move.exact ? check_finite(work, &ready->move, i) : move_point(work, ready, plane, i));
    }
    return FFD_OK;
}

/* Returns the plane in world units. With fractions, `at` counts along the normal, as in way_along. */
static mirror_plane plane_of(const move_work *work, const move_mirror *mirror)
{
    const rest_region *const region = &work->region;
    const double *const normal = mirror->normal;
    double point[3] = {mirror->point[0], mirror->point[1], mirror->point[2]}, offset = mirror->at;
    if (mirror->kind == MIRROR_MIDDLE)
        return ffd_mirror_middle(work->lattice, normal[0] != 0 ? 0 : normal[1] != 0 ? 1 : 2);
    if (mirror->kind == MIRROR_POINT) {
        if (work->in_region)
            to_world(work, point);
        offset = vec_dot(normal, point);
    } else if (work->in_region) {
        offset = vec_dot(normal, region->origin) + mirror->at * extent_along(region, normal);
    }
    return ffd_mirror_plane(work->lattice, normal, offset);
}

/* Applies the action again, reflected: to the mirror images of the points, or, where the weight depends on
   the position, to the same points with the mirrored weight. */
static ffd_status move_images(move_work *work, size_t index, const lattice_move *move, ready_move *ready)
{
    const size_t *const size = work->lattice->size, count = work->lattice->count;
    const mirror_plane plane = plane_of(work, &move->mirror);
    size_t missing = count;
    if (ffd_move_weighs_places(move))
        return move_points(work, index, move, ready, &plane);
    TRY(ffd_mirror_select(work->lattice, &plane, &work->rest, work->selected, &missing, work->error));
    if (missing == count)
        return move_points(work, index, move, ready, &plane);
    return ffd_fail_at(work->error, FFD_E_INVALID, work->file, move->line, move->pointer,
                       "control point %zu,%zu,%zu has no mirror image: no other rests across the plane %s",
                       missing % size[0], missing / size[0] % size[1], missing / size[0] / size[1],
                       ffd_mirror_describe(&plane).text);
}

static ffd_status apply_drag(move_work *work, size_t index, const lattice_move *move)
{
    const bool mirrors = move->mirror.kind != MIRROR_NONE;
    const mirror_plane plane = mirrors ? plane_of(work, &move->mirror) : (mirror_plane){0};
    const ready_move ready = {.move = *move};
    move_step step = step_of(work, index, move, &ready, mirrors ? &plane : NULL);
    double *const numbers = ffd_alloc(move->drag_count, 12 * sizeof *numbers);
    if (!numbers)
        return ffd_fail_memory(work->error);
    const ffd_status status = move_places(work, &step, numbers);
    ffd_free(numbers);
    return status;
}

static ffd_status apply_move(move_work *work, const lattice_spec *spec, size_t index)
{
    const lattice_move *const move = &spec->moves[index];
    ready_move ready = {.move = *move, .degrees = NAN};
    const size_t count = select_points(work, move);
    if (count == 0)
        return ffd_fail_at(work->error, FFD_E_INVALID, work->file, move->line, move->pointer,
                           "selects no control point: none is within these bounds at rest");
    if (move->action == MOVE_DRAG)
        return apply_drag(work, index, move);
    move_to_world(work, &ready.move);
    if (!move->has_about && ffd_move_has_centre(move->action))
        find_centroid(work, count, ready.move.about);
    if (ffd_move_has_extent(move->action))
        find_extent(work, &ready);
    TRY(move_points(work, index, move, &ready, NULL));
    return move->mirror.kind != MIRROR_NONE ? move_images(work, index, move, &ready) : FFD_OK;
}

ffd_status ffd_moves_apply(const lattice_spec *spec, const rest_region *region, ffd_lattice *lattice,
                           const move_observer *observer, ffd_error *error)
{
    move_work work = {.lattice = lattice,
                      .points = lattice->deformed,
                      .difference = lattice->difference,
                      .in_region = spec->units != UNITS_WORLD,
                      .region = *region,
                      .file = spec->name,
                      .observer = observer,
                      .error = error};
    if (work.in_region && !mat_invert(region->frame, work.inverse))
        return ffd_fail_at(error, FFD_E_INVALID, spec->name, spec->units_line, "/units",
                           "the rest points lie in a plane: there is no box to take fractions of");
    find_slack(&work);
    work.selected = ffd_alloc(lattice->count, 1);
    if (!work.selected)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < spec->move_count; i++)
        TRY_END(apply_move(&work, spec, i));
end:
    ffd_mirror_tree_free(&work.rest);
    ffd_free(work.selected);
    return status;
}
