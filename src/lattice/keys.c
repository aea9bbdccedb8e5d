#include "lattice/keys.h"
#include "base/memory/memory.h"
#include "lattice/lattice.h"
#include <string.h>

key_place ffd_keys_find(const spec_keys *keys)
{
    size_t low = 0, high = keys->count - 1;
    const double time = keys->time;
    if (time <= keys->list[low].time)
        return (key_place){low, 0};
    if (time >= keys->list[high].time)
        return (key_place){high, 0};
    while (high - low > 1) {
        const size_t middle = low + (high - low) / 2;
        *(keys->list[middle].time <= time ? &low : &high) = middle;
    }
    const double from = keys->list[low].time;
    return (key_place){low, (time - from) / (keys->list[high].time - from)};
}

/* The deformed control points before the keys, or those of a key. */
typedef struct points_state {
    double *deformed, *difference, *weights; /* weights NULL: the lattice has none */
} points_state;

static void free_state(points_state *state)
{
    ffd_free(state->deformed);
    ffd_free(state->difference);
    ffd_free(state->weights);
}

static double *copy_of(const double *numbers, size_t count)
{
    double *const copy = ffd_alloc_whole(count, sizeof *copy);
    if (copy)
        memcpy(copy, numbers, count * sizeof *copy);
    return copy;
}

static ffd_status keep_state(const ffd_lattice *lattice, points_state *state, ffd_error *error)
{
    const double *const weights = lattice->deformed_weights;
    state->deformed = copy_of(lattice->deformed, 3 * lattice->count);
    state->difference = copy_of(lattice->difference, 3 * lattice->count);
    state->weights = weights ? copy_of(weights, lattice->count) : NULL;
    return state->deformed && state->difference && (state->weights || !weights) ? FFD_OK
                                                                                : ffd_fail_memory(error);
}

/* Exchanges what was kept and what the lattice has. */
static void swap_state(points_state *state, ffd_lattice *lattice)
{
    const points_state kept = *state;
    *state = (points_state){lattice->deformed, lattice->difference, lattice->deformed_weights};
    lattice->deformed = kept.deformed;
    lattice->difference = kept.difference;
    lattice->deformed_weights = kept.weights;
}

static ffd_status apply_key(const lattice_spec *spec, const rest_region *region, const spec_key *key,
                            ffd_lattice *lattice, ffd_error *error)
{
    lattice_spec of_key = *spec;
    if (key->offsets) {
        memcpy(lattice->difference, key->offsets, 3 * spec->count * sizeof *key->offsets);
        for (size_t c = 0; c < 3 * spec->count; c++)
            lattice->deformed[c] = lattice->rest[c] + key->offsets[c];
        return FFD_OK;
    }
    of_key.moves = key->moves;
    of_key.move_count = key->move_count;
    of_key.drags = key->drags;
    of_key.drag_count = key->drag_count;
    return key->move_count > 0 ? ffd_moves_apply(&of_key, region, lattice, NULL, error) : FFD_OK;
}

/* Sets the control points of the lattice, which are those of the later key, to those in between. Control
   points go straight, so that their displacements are those between both: a displacement of 0 stays 0. */
static void mix_states(double part, const points_state *earlier, ffd_lattice *lattice)
{
    for (size_t c = 0; c < 3 * lattice->count; c++) {
        lattice->difference[c] = ffd_keys_mix(part, earlier->difference[c], lattice->difference[c]);
        lattice->deformed[c] = ffd_keys_mix(part, earlier->deformed[c], lattice->deformed[c]);
    }
    for (size_t i = 0; earlier->weights && i < lattice->count; i++)
        lattice->deformed_weights[i] = ffd_keys_mix(part, earlier->weights[i], lattice->deformed_weights[i]);
}

ffd_status ffd_keys_apply(const lattice_spec *spec, const rest_region *region, ffd_lattice *lattice,
                          ffd_error *error)
{
    const spec_keys *const keys = &spec->keys;
    const key_place place = ffd_keys_find(keys);
    points_state state = {0};
    ffd_status status = FFD_OK;
    if (place.part > 0)
        TRY_END(keep_state(lattice, &state, error));
    TRY_END(apply_key(spec, region, &keys->list[place.first], lattice, error));
    if (place.part > 0) {
        swap_state(&state, lattice); /* the later key starts from where the earlier one did */
        TRY_END(apply_key(spec, region, &keys->list[place.first + 1], lattice, error));
        mix_states(place.part, &state, lattice);
    }
end:
    free_state(&state);
    return status;
}
