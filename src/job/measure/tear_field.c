#include "job/measure/tear_field.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "embed/locator_border.h"
#include "job/chain/pace.h"
#include "job/chain/point_outcome.h"
#include "lattice/lattice.h"
#include <math.h>
#include <string.h>

/* What a link does at a place. */
typedef enum link_action {
    LEAVES, /* nothing */
    HOLDS,  /* it displaces the place if it holds it */
    EXTENDS /* it displaces the place, from the nearest border point if it does not hold it */
} link_action;

static bool takes(const tear_field *field, uint32_t vertex, size_t link)
{
    return !field->chain->links[link].is_still && ffd_marks_take(&field->marks, vertex, link);
}

static link_action action_of(const tear_field *field, const field_place *place, size_t link)
{
    const bool first = takes(field, place->ends[0], link), second = takes(field, place->ends[1], link);
    if (place->by != FIELD_BETWEEN)
        return (place->by == FIELD_FIRST ? first : second) ? EXTENDS : LEAVES;
    return first && second ? EXTENDS : field->chain->links[link].is_still ? LEAVES : HOLDS;
}

/* Lists the places that a link may act on, and locates them in it. */
static ffd_status locate(const tear_field *field, size_t link, const field_place *places, size_t count,
                         size_t *asked, field_scratch *scratch, ffd_error *error)
{
    *asked = 0;
    for (size_t i = 0; i < count; i++) {
        scratch->actions[i] = (uint8_t)action_of(field, &places[i], link);
        if (scratch->actions[i] == LEAVES)
            continue;
        memcpy(scratch->link_x + 3 * *asked, scratch->x + 3 * i, 3 * sizeof *scratch->x);
        scratch->asked[(*asked)++] = (uint32_t)i;
    }
    TRY(ffd_pace_find(&field->chain->links[link], scratch->link_x, *asked, NULL, scratch->chain.locations,
                      error));
    long long taken = 0;
    for (size_t k = 0; k < *asked; k++)
        taken += scratch->chain.locations[k].evaluations;
    return ffd_field_take(field, taken, error);
}

/* Finds the foot of an asked place. One that the link neither holds nor extends to gets no foot. */
static ffd_status find_foot(const tear_field *field, size_t link, size_t k, field_foot *foot,
                            field_scratch *scratch, ffd_error *error)
{
    const uint32_t i = scratch->asked[k];
    const ffd_location *const location = &scratch->chain.locations[k];
    *foot = (field_foot){.link = link};
    if (ffd_location_is_placed(location)) {
        foot->found = foot->inside = true;
        memcpy(foot->point.uvw, location->uvw, sizeof foot->point.uvw);
        scratch->held[i] |= scratch->actions[i] == HOLDS;
        return FFD_OK;
    }
    if (scratch->actions[i] != HOLDS)
        return ffd_foot_on_border(field, link, scratch->link_x + 3 * k, foot, error);
    scratch->actions[i] = LEAVES;
    return FFD_OK;
}

/* Whether a link moves both ends of an edge. */
static bool takes_both(const tear_field *field, const field_place *place, size_t link)
{
    return takes(field, place->ends[0], link) && takes(field, place->ends[1], link);
}

/* Finds the displacements of the asked places by a link; those that it holds are listed in the batch. */
static ffd_status displace(const tear_field *field, size_t link, field_place *places, size_t asked,
                           displacement_batch *batch, field_scratch *scratch, ffd_error *error)
{
    for (size_t k = 0; k < asked; k++) {
        field_place *const place = &places[scratch->asked[k]];
        field_foot foot;
        TRY(find_foot(field, link, k, &foot, scratch, error));
        if (foot.inside)
            scratch->chain.inside[batch->count++] = (uint32_t)k;
        else
            ffd_foot_displacement(field, &foot, batch->delta + 3 * k, batch->gradient + 9 * k);
        if (foot.inside && place->along && !takes_both(field, place, link))
            ffd_foot_exits(field, &foot, place);
    }
    ffd_displacements(ffd_link_mover(&field->chain->links[link]), field->chain->isa, batch,
                      &scratch->chain.displacement);
    return FFD_OK;
}

/* Notes why a link may displace the places of a pair differently. */
static void note_cause(const tear_field *field, const field_foot feet[2], const uint8_t actions[2],
                       ffd_tear_cause *cause)
{
    if (*cause)
        return;
    if ((actions[0] == LEAVES) != (actions[1] == LEAVES))
        *cause = FFD_TEAR_LATTICES;
    else
        *cause = ffd_feet_cause(field, &feet[0], &feet[1]);
}

/* The same for pairs of places, and why they differ. */
static ffd_status displace_pairs(const tear_field *field, size_t link, size_t count, size_t asked,
                                 displacement_batch *batch, ffd_tear_cause *causes, field_scratch *scratch,
                                 ffd_error *error)
{
    field_foot *const feet = scratch->feet;
    for (size_t i = 0; i < count; i++)
        feet[i] = (field_foot){.link = link};
    for (size_t k = 0; k < asked; k++)
        TRY(find_foot(field, link, k, &feet[scratch->asked[k]], scratch, error));
    for (size_t i = 0; i < count; i += 2) {
        ffd_feet_join(field, &feet[i], &feet[i + 1]);
        note_cause(field, &feet[i], &scratch->actions[i], &causes[i / 2]);
    }
    for (size_t k = 0; k < asked; k++) {
        const field_foot *const foot = &feet[scratch->asked[k]];
        if (foot->inside && !foot->on_seam) {
            memcpy(scratch->chain.locations[k].uvw, foot->point.uvw, sizeof foot->point.uvw);
            scratch->chain.inside[batch->count++] = (uint32_t)k;
        } else
            ffd_foot_displacement(field, foot, batch->delta + 3 * k, batch->gradient + 9 * k);
    }
    ffd_displacements(field->chain->links[link].lattice, field->chain->isa, batch,
                      &scratch->chain.displacement);
    return FFD_OK;
}

/* Adds the displacement by a link: F = F2 F1, written with E = F - I. */
static void add(field_place *place, double x[3], const double delta[3], const double gradient[9])
{
    double product[9];
    for (int a = 0; a < 3; a++) {
        x[a] += delta[a];
        place->delta[a] += delta[a];
    }
    mat_multiply(gradient, place->gradient, product);
    for (int i = 0; i < 9; i++)
        place->gradient[i] += gradient[i] + product[i];
}

/* Displaces the places by one link. causes: of pairs of places; or NULL. */
static ffd_status apply_link(const tear_field *field, size_t link, field_place *places, size_t count,
                             ffd_tear_cause *causes, field_scratch *scratch, ffd_error *error)
{
    chain_scratch *const chain = &scratch->chain;
    displacement_batch batch = {.uvw = chain->locations[0].uvw,
                                .stride = sizeof *chain->locations,
                                .which = chain->inside,
                                .delta = scratch->delta,
                                .gradient = scratch->gradient,
                                .moves = chain->moves};
    size_t asked;
    TRY(locate(field, link, places, count, &asked, scratch, error));
    TRY(causes ? displace_pairs(field, link, count, asked, &batch, causes, scratch, error)
               : displace(field, link, places, asked, &batch, scratch, error));
    for (size_t k = 0; k < asked; k++)
        add(&places[scratch->asked[k]], scratch->x + 3 * (size_t)scratch->asked[k], scratch->delta + 3 * k,
            scratch->gradient + 9 * k);
    return FFD_OK;
}

/* causes: of pairs of places; or NULL. */
static ffd_status apply_links(const tear_field *field, field_place *places, size_t count,
                              const field_visitor *visitor, ffd_tear_cause *causes, field_scratch *scratch,
                              ffd_error *error)
{
    for (size_t i = 0; i < count; i++) {
        memcpy(scratch->x + 3 * i, places[i].x, 3 * sizeof *scratch->x);
        memset(places[i].delta, 0, sizeof places[i].delta);
        memset(places[i].gradient, 0, sizeof places[i].gradient);
        places[i].exits[0] = -HUGE_VAL;
        places[i].exits[1] = HUGE_VAL;
        places[i].holder = 0;
        scratch->held[i] = false;
    }
    for (size_t l = 0; l < field->chain->count; l++) {
        if (visitor)
            visitor->visit(visitor->context, l, scratch->x);
        TRY(apply_link(field, l, places, count, causes, scratch, error));
    }
    return FFD_OK;
}

/* Whether a link moves this end of an edge and not the other one. */
static bool moves_alone(const tear_field *field, const field_place *place, int end, size_t link)
{
    return takes(field, place->ends[end], link) && !takes(field, place->ends[1 - end], link);
}

/* Whether links move the first end alone, and others the second. */
static bool may_be_in_gap(const tear_field *field, const field_place *place)
{
    bool alone[2] = {false, false};
    for (size_t l = 0; l < field->chain->count; l++)
        for (int end = 0; end < 2; end++)
            alone[end] = alone[end] || moves_alone(field, place, end, l);
    return alone[0] && alone[1];
}

/* Finds the distance of a place from the nearest of the links that move this end alone; HUGE_VAL: none is
   within its falloff. */
static ffd_status find_distance(const tear_field *field, const field_place *place, int end, double *distance,
                                ffd_error *error)
{
    *distance = HUGE_VAL;
    for (size_t l = 0; l < field->chain->count; l++) {
        field_foot foot;
        if (!moves_alone(field, place, end, l))
            continue;
        TRY(ffd_foot_on_border(field, l, place->x, &foot, error));
        if (foot.found)
            *distance = lesser_of(*distance, foot.point.distance);
    }
    return FFD_OK;
}

/* Lists the places in a gap between links that move one end and links that move the other, and decides whose
   act there. */
static ffd_status find_gaps(const tear_field *field, const field_place *places, size_t count, size_t *gaps,
                            field_scratch *scratch, ffd_error *error)
{
    *gaps = 0;
    for (size_t i = 0; i < count; i++) {
        double first, second;
        if (places[i].by != FIELD_BETWEEN || scratch->held[i] || !may_be_in_gap(field, &places[i]))
            continue;
        TRY(find_distance(field, &places[i], 0, &first, error));
        TRY(find_distance(field, &places[i], 1, &second, error));
        if (first == HUGE_VAL || second == HUGE_VAL)
            continue;
        scratch->in_gaps[*gaps] = places[i];
        scratch->in_gaps[*gaps].by = first <= second ? FIELD_FIRST : FIELD_SECOND;
        scratch->gaps[(*gaps)++] = (uint32_t)i;
    }
    return FFD_OK;
}

/* Lattices one after the other. causes: of pairs of places; or NULL. */
static ffd_status find_in_links(const tear_field *field, field_place *places, size_t count,
                                const field_visitor *visitor, ffd_tear_cause *causes, field_scratch *scratch,
                                ffd_error *error)
{
    size_t gaps = 0;
    TRY(apply_links(field, places, count, visitor, causes, scratch, error));
    if (field->chain->count > 1 && !field->chain->outside.extend)
        TRY(find_gaps(field, places, count, &gaps, scratch, error));
    if (gaps == 0)
        return FFD_OK;
    TRY(apply_links(field, scratch->in_gaps, gaps, NULL, NULL, scratch, error));
    for (size_t k = 0; k < gaps; k++) {
        field_place *const place = &places[scratch->gaps[k]];
        memcpy(place->delta, scratch->in_gaps[k].delta, sizeof place->delta);
        memcpy(place->gradient, scratch->in_gaps[k].gradient, sizeof place->gradient);
        if (causes)
            causes[scratch->gaps[k] / 2] = FFD_TEAR_LATTICES;
    }
    return FFD_OK;
}

ffd_status ffd_tear_field_find(const tear_field *field, field_place *places, size_t count,
                               const field_visitor *visitor, field_scratch *scratch, ffd_error *error)
{
    return field->chain->blocks ? ffd_tear_blocks_find(field, places, count, scratch, error)
                                : find_in_links(field, places, count, visitor, NULL, scratch, error);
}

ffd_status ffd_tear_field_compare(const tear_field *field, field_place *pairs, size_t count,
                                  field_scratch *scratch, ffd_tear_cause *causes, ffd_error *error)
{
    for (size_t i = 0; i < count; i++)
        causes[i] = FFD_TEAR_NONE;
    if (!field->chain->blocks)
        return find_in_links(field, pairs, 2 * count, NULL, causes, scratch, error);
    for (size_t i = 0; i < count; i++)
        TRY(ffd_tear_blocks_compare(field, &pairs[2 * i], &causes[i], error));
    return FFD_OK;
}

tear_field ffd_tear_field_make(const lattice_chain *chain, const mesh_faces *faces, const mark_planes *marks,
                               bool parts)
{
    tear_field field = {.chain = chain, .faces = faces, .marks = *marks, .plain = *chain, .parts = parts};
    field.plain.outside = (chain_outside){0};
    return field;
}

tear_field ffd_tear_field_continue(const tear_field *field, lattice_chain *room)
{
    tear_field made = *field;
    *room = *field->chain;
    room->outside.extend = true;
    made.chain = room;
    made.continues = true;
    return made;
}

field_scratch *ffd_tear_field_scratch(void)
{
    return ffd_alloc_zero(1, sizeof(field_scratch));
}
