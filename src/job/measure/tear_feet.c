/* tear_feet.c - the point of a lattice's volume whose displacement a place gets: its foot. Internal to
   tear_field.h. */
#include "base/system/deadline.h"
#include "base/vector/vec.h"
#include "deform/extension.h"
#include "embed/locator_border.h"
#include "job/chain/point_outcome.h"
#include "job/chain/seams.h"
#include "job/measure/tear_field.h"
#include <math.h>
#include <string.h>

/* Feet that differ by more than this part of the domain are in different parts of a volume or a border. */
#define APART 1e-3
/* Feet no farther than this part of the domain from a seam are beside it. */
#define BESIDE 1e-5

ffd_status ffd_foot_on_border(const tear_field *field, size_t link, const double x[3], field_foot *foot,
                              ffd_error *error)
{
    const chain_link *const of = &field->chain->links[link];
    const boundary *border;
    *foot = (field_foot){.link = link};
    TRY(ffd_deadline_check(error));
    TRY(ffd_locator_border(of->locator, &border, error));
    TRY(ffd_boundary_find(border, x, of->falloff > 0 ? of->falloff : HUGE_VAL, &foot->point, error));
    foot->found = foot->point.found;
    return FFD_OK;
}

void ffd_foot_displacement(const tear_field *field, const field_foot *foot, double delta[3],
                           double gradient[9])
{
    const chain_link *const of = &field->chain->links[foot->link];
    memset(delta, 0, 3 * sizeof *delta);
    memset(gradient, 0, 9 * sizeof *gradient);
    if (foot->found && foot->inside)
        ffd_displacement(ffd_link_mover(of), foot->point.uvw, delta, gradient);
    else if (foot->found)
        ffd_extension_displacement(ffd_link_mover(of), &foot->point, of->falloff, delta, gradient);
    if (foot->on_seam)
        memset(gradient, 0, 9 * sizeof *gradient);
}

/* How u,v,w change along a direction. Returns false where the volume is not invertible. */
static bool find_speed(const ffd_lattice *lattice, const double uvw[3], const double along[3],
                       double speed[3])
{
    double x[3], jacobian[9], inverse[9];
    if (!lattice->has_uvw_by_p) {
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, x, jacobian);
        if (!mat_invert(jacobian, inverse))
            return false;
    }
    mat_apply(lattice->has_uvw_by_p ? lattice->uvw_by_p : inverse, along, speed);
    return true;
}

void ffd_foot_exits(const tear_field *field, const field_foot *foot, field_place *place)
{
    const ffd_lattice *const lattice = field->chain->links[foot->link].lattice;
    double along[3], speed[3];
    mat_apply(place->gradient, place->along, along); /* the links before bend the edge */
    for (int c = 0; c < 3; c++)
        along[c] += place->along[c];
    place->holder = foot->link + 1;
    if (!find_speed(lattice, foot->point.uvw, along, speed))
        return;
    for (int d = 0; d < 3; d++) {
        const knot_vector *const knots = &lattice->knots[d];
        if (ffd_knots_closed(knots) || speed[d] == 0)
            continue;
        const double to_first = (ffd_knots_first(knots) - foot->point.uvw[d]) / speed[d];
        const double to_last = (ffd_knots_last(knots) - foot->point.uvw[d]) / speed[d];
        place->exits[0] = larger_of(place->exits[0], lesser_of(to_first, to_last));
        place->exits[1] = lesser_of(place->exits[1], larger_of(to_first, to_last));
    }
}

/* Moves two feet onto the seams that are between them, and that they are beside. */
static void move_onto_seams(const lattice_chain *chain, field_foot *first, field_foot *second)
{
    for (size_t s = 0; s < chain->seam_count; s++) {
        const int direction = chain->seams[s].direction;
        const knot_vector *const knots = &chain->links[first->link].lattice->knots[direction];
        const double begin = ffd_knots_first(knots), end = ffd_knots_last(knots);
        double *const a = &first->point.uvw[direction], *const b = &second->point.uvw[direction];
        double *const low = *a < *b ? a : b, *const high = *a < *b ? b : a;
        if (chain->seams[s].link != first->link || *low - begin > BESIDE * (end - begin) ||
            end - *high > BESIDE * (end - begin))
            continue;
        *low = begin;
        *high = end;
        first->on_seam = second->on_seam = true;
    }
}

void ffd_feet_join(const tear_field *field, field_foot *first, field_foot *second)
{
    if (!first->found || !second->found || first->link != second->link)
        return;
    if (ffd_seams_part(field->chain, first->link, first->point.uvw, second->point.uvw))
        move_onto_seams(field->chain, first, second);
    else if (!field->chain->outside.extend && !second->inside)
        *second = *first;
    else if (!field->chain->outside.extend && !first->inside)
        *first = *second;
}

/* Whether two feet are in different parts of a volume or of its border. */
static bool are_apart(const ffd_lattice *lattice, const double a[3], const double b[3])
{
    for (int d = 0; d < 3; d++) {
        const knot_vector *const knots = &lattice->knots[d];
        const double domain = ffd_knots_last(knots) - ffd_knots_first(knots), distance = fabs(a[d] - b[d]);
        const double round = ffd_knots_closed(knots) ? domain - distance : distance;
        if (lesser_of(distance, round) > APART * domain)
            return true;
    }
    return false;
}

/* Whether two feet are on one face of the domain. */
static bool share_face(const ffd_lattice *lattice, const double a[3], const double b[3])
{
    const face_ends ends = ffd_face_ends(lattice, APART);
    return ffd_faces_at(&ends, a) & ffd_faces_at(&ends, b);
}

ffd_tear_cause ffd_feet_cause(const tear_field *field, const field_foot *first, const field_foot *second)
{
    const chain_link *const of = &field->chain->links[first->link];
    const double *const a = first->point.uvw, *const b = second->point.uvw;
    if (!first->found || !second->found || !are_apart(of->lattice, a, b))
        return FFD_TEAR_NONE;
    if (ffd_seams_part(field->chain, first->link, a, b))
        return FFD_TEAR_SEAM;
    if (!first->inside || !second->inside)
        return FFD_TEAR_BORDER;
    return of->opens_axis && share_face(of->lattice, a, b) ? FFD_TEAR_AXIS : FFD_TEAR_OVERLAP;
}
