#include "lattice/place_moves.h"
#include "base/vector/vec.h"
#include "lattice/build.h"
#include "lattice/moves.h"
#include "lattice/spec.h"
#include <string.h>

/* The move whose place is watched, and where the place was before it. */
typedef struct place_watch {
    const ffd_lattice *lattice;
    const ffd_locator *locator;
    place_move *found;
    size_t count;
    bool is_open; /* found[count] waits for the end of its move */
    lattice_basis basis;
    double before[3];
} place_watch;

/* Where the place of the basis is now. */
static void place_of(const place_watch *watch, const ffd_lattice *lattice, double place[3])
{
    ffd_lattice_sum_rational(lattice, &watch->basis, lattice->deformed, lattice->deformed_weights, place,
                             NULL);
}

static void end_move(place_watch *watch, const ffd_lattice *lattice)
{
    double now[3], by[3];
    if (!watch->is_open)
        return;
    place_of(watch, lattice, now);
    for (int c = 0; c < 3; c++)
        by[c] = now[c] - watch->before[c];
    watch->found[watch->count++].moved = vec_length(by);
    watch->is_open = false;
}

/* The distance of the Greville abscissae on both sides of u. */
static double gap_at(const knot_vector *knots, int span, double u)
{
    const size_t last = (size_t)span;
    size_t i = last - (size_t)knots->degree;
    while (i + 1 < last && ffd_knots_greville(knots, i + 1) <= u)
        i++;
    return ffd_knots_greville(knots, i + 1) - ffd_knots_greville(knots, i);
}

static double layers_apart(const ffd_lattice *lattice, const lattice_basis *basis, const double uvw[3])
{
    double place[3], derivative[9], most = 0;
    ffd_lattice_sum_rational(lattice, basis, lattice->rest, lattice->rest_weights, place, derivative);
    for (int a = 0; a < 3; a++) {
        const double along[3] = {derivative[a], derivative[3 + a], derivative[6 + a]};
        most = larger_of(most, vec_length(along) * gap_at(&lattice->knots[a], basis->span[a], uvw[a]));
    }
    return most;
}

/* Returns how far the full action takes the place. */
static double asked_by(const place_watch *watch, const move_step *step)
{
    const lattice_move *const move = &step->ready->move;
    ready_move ready = *step->ready;
    double to[3], by[3];
    memcpy(to, watch->before, sizeof to);
    ffd_move_act(&ready, to);
    for (int c = 0; c < 3; c++)
        by[c] = to[c] - watch->before[c];
    return move->weight * vec_length(by);
}

static ffd_status begin_move(place_watch *watch, const move_step *step, ffd_error *error)
{
    const lattice_move *const move = step->move;
    const bool is_pull = move->action == MOVE_PULL;
    place_move *const entry = &watch->found[watch->count];
    ffd_location location;
    double place[3];
    if (step->plane || (!is_pull && move->falloff.kind != FALLOFF_BALL))
        return FFD_OK;
    memcpy(place, is_pull ? move->point : move->falloff.center, sizeof place);
    if (step->inverse)
        mat_apply(step->region->frame, place, place);
    for (int c = 0; c < 3 && step->inverse; c++)
        place[c] += step->region->origin[c];
    TRY(ffd_locator_locate(watch->locator, place, 1, NULL, &location, sizeof location, error));
    if (location.status != FFD_VERTEX_INSIDE)
        return FFD_OK;
    ffd_lattice_basis(watch->lattice, location.uvw, &watch->basis);
    place_of(watch, step->lattice, watch->before);
    *entry = (place_move){.move = step->index,
                          .asked = asked_by(watch, step),
                          .apart = layers_apart(watch->lattice, &watch->basis, location.uvw)};
    watch->is_open = true;
    return FFD_OK;
}

static ffd_status see(void *context, const move_step *step, ffd_error *error)
{
    place_watch *const watch = context;
    if (watch->is_open && watch->found[watch->count].move != step->index)
        end_move(watch, step->lattice);
    return begin_move(watch, step, error);
}

ffd_status ffd_lattice_place_moves(const ffd_lattice *lattice, const ffd_locator *locator, place_move *found,
                                   size_t *count, ffd_error *error)
{
    place_watch watch = {.lattice = lattice, .locator = locator, .found = found};
    TRY(ffd_lattice_replay(lattice, &(move_observer){see, &watch}, error));
    end_move(&watch, lattice);
    *count = watch.count;
    return FFD_OK;
}
