#include "base/memory/memory.h"
#include "base/text/number.h"
#include "lattice/direction.h"
#include "lattice/spec_parse.h"
#include <stdio.h>

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* One control point index, from the end where negative. */
static ffd_status read_index(json_place *place, const json_t *value, size_t size, size_t *index)
{
    double number;
    const ffd_status status = ffd_json_read_integer(place, value, &number);
    if (status)
        return status;
    const double resolved = number < 0 ? number + (double)size : number;
    if (resolved < 0 || resolved >= (double)size)
        return ffd_place_fail(place, "index %.0f is outside 0 to %zu (or -%zu to -1)", number, size - 1,
                              size);
    *index = (size_t)resolved;
    return FFD_OK;
}

static ffd_status read_range(json_place *place, const json_t *value, size_t size, size_t *first, size_t *last)
{
    size_t *const ends[2] = {first, last};
    ffd_status status = ffd_json_read_array(place, value, 2, "indices");
    for (size_t i = 0; i < 2 && !status; i++) {
        const size_t before = ffd_place_enter_index(place, i);
        status = read_index(place, json_array_get(value, i), size, ends[i]);
        ffd_place_leave(place, before);
    }
    if (!status && *first > *last)
        return ffd_place_fail(place, "the range from %zu to %zu is empty", *first, *last);
    return status;
}

/* An index, an inclusive range [lo, hi], or "all". */
static ffd_status read_indices(json_place *place, const json_t *value, size_t size, size_t *first,
                               size_t *last)
{
    static const char *const names[] = {"all"};
    if (json_is_array(value))
        return read_range(place, value, size, first, last);
    if (json_is_string(value)) {
        size_t index;
        *first = 0;
        *last = size - 1;
        return ffd_json_read_word(place, value, names, COUNT_OF(names), &index);
    }
    const ffd_status status = read_index(place, value, size, first);
    *last = *first;
    return status;
}

static ffd_status read_at(json_place *place, const json_t *value, const lattice_spec *spec,
                          lattice_move *move)
{
    move->has_at = true;
    ffd_status status = ffd_json_read_array(place, value, 3, "selections");
    for (size_t a = 0; a < 3 && !status; a++) {
        const size_t before = ffd_place_enter_index(place, a);
        status = read_indices(place, json_array_get(value, a), spec->size[a], &move->at_first[a],
                              &move->at_last[a]);
        ffd_place_leave(place, before);
    }
    return status;
}

static ffd_status read_within(json_place *place, const json_t *value, lattice_move *move)
{
    static const char *const keys[] = {"min", "max"};
    move->has_within = true;
    ffd_status status = ffd_json_read_object(place, value, keys, COUNT_OF(keys));
    if (!status)
        status = ffd_json_member_doubles(place, value, "min", 3, move->within_min);
    if (!status)
        status = ffd_json_member_doubles(place, value, "max", 3, move->within_max);
    for (int c = 0; c < 3 && !status; c++)
        if (move->within_max[c] < move->within_min[c])
            return ffd_place_fail(place, "max %s is less than min %s",
                                  ffd_number_text(move->within_max[c]).text,
                                  ffd_number_text(move->within_min[c]).text);
    return status;
}

static ffd_status read_by(json_place *place, const json_t *value, lattice_move *move)
{
    return ffd_json_read_doubles(place, value, 3, move->vector);
}

/* "about" is optional everywhere. */
static ffd_status read_about(json_place *place, const json_t *object, lattice_move *move)
{
    move->has_about = json_object_get(object, "about") != NULL;
    return move->has_about ? ffd_json_member_doubles(place, object, "about", 3, move->about) : FFD_OK;
}

static ffd_status read_scale(json_place *place, const json_t *value, lattice_move *move)
{
    static const char *const keys[] = {"factor", "about"};
    const json_t *factor;
    ffd_status status = ffd_json_read_object(place, value, keys, COUNT_OF(keys));
    if (!status)
        status = ffd_json_require(place, value, "factor", &factor);
    if (status)
        return status;
    const size_t before = ffd_place_enter(place, "factor");
    if (json_is_array(factor)) {
        status = ffd_json_read_doubles(place, factor, 3, move->vector);
    } else {
        status = ffd_json_read_double(place, factor, &move->vector[0]);
        move->vector[1] = move->vector[2] = move->vector[0];
    }
    ffd_place_leave(place, before);
    return status ? status : read_about(place, value, move);
}

/* rotate, twist: an axis, degrees. */
static ffd_status read_turn(json_place *place, const json_t *value, lattice_move *move)
{
    static const char *const keys[] = {"axis", "degrees", "about"};
    ffd_status status = ffd_json_read_object(place, value, keys, COUNT_OF(keys));
    if (!status)
        status = ffd_spec_parse_axis(place, value, "axis", move->axis);
    if (!status)
        status = ffd_json_member_double(place, value, "degrees", &move->amount);
    return status ? status : read_about(place, value, move);
}

static ffd_status read_taper(json_place *place, const json_t *value, lattice_move *move)
{
    static const char *const keys[] = {"axis", "factor", "about"};
    ffd_status status = ffd_json_read_object(place, value, keys, COUNT_OF(keys));
    if (!status)
        status = ffd_spec_parse_axis(place, value, "axis", move->axis);
    if (!status)
        status = ffd_json_member_double(place, value, "factor", &move->amount);
    return status ? status : read_about(place, value, move);
}

static ffd_status read_bend(json_place *place, const json_t *value, lattice_move *move)
{
    static const char *const keys[] = {"axis", "toward", "degrees", "about"};
    ffd_status status = ffd_json_read_object(place, value, keys, COUNT_OF(keys));
    if (!status)
        status = ffd_spec_parse_axis(place, value, "axis", move->axis);
    if (!status)
        status = ffd_spec_parse_axis(place, value, "toward", move->vector);
    if (!status)
        status = ffd_json_member_double(place, value, "degrees", &move->amount);
    if (!status)
        status = read_about(place, value, move);
    if (status || ffd_direction_perpendicular(move->axis, move->vector))
        return status;
    ffd_place_enter(place, "toward");
    return ffd_place_fail(place, "points along the axis; it must lead away from it");
}

static ffd_status read_matrix(json_place *place, const json_t *value, lattice_move *move)
{
    const ffd_status status = ffd_json_read_doubles(place, value, 16, move->matrix);
    if (status)
        return status;
    const double *const last = move->matrix + 12;
    if (last[0] == 0 && last[1] == 0 && last[2] == 0 && last[3] == 1)
        return FFD_OK;
    return ffd_place_fail(place, "the last row is %s %s %s %s, not 0 0 0 1", ffd_number_text(last[0]).text,
                          ffd_number_text(last[1]).text, ffd_number_text(last[2]).text,
                          ffd_number_text(last[3]).text);
}

static const struct action_reader {
    const char *key;
    move_action action;
    ffd_status (*read)(json_place *place, const json_t *value, lattice_move *move);
} actions[] = {
    {"by", MOVE_BY, read_by},
    {"to", MOVE_TO, read_by},
    {"scale", MOVE_SCALE, read_scale},
    {"rotate", MOVE_ROTATE, read_turn},
    {"matrix", MOVE_MATRIX, read_matrix},
    {"twist", MOVE_TWIST, read_turn},
    {"taper", MOVE_TAPER, read_taper},
    {"bend", MOVE_BEND, read_bend},
};

static ffd_status read_action(json_place *place, const json_t *value, lattice_move *move)
{
    const struct action_reader *chosen = NULL;
    for (size_t i = 0; i < COUNT_OF(actions); i++) {
        if (!json_object_get(value, actions[i].key))
            continue;
        if (chosen)
            return ffd_place_fail(place, "has two actions, \"%s\" and \"%s\"; a move has one", chosen->key,
                                  actions[i].key);
        chosen = &actions[i];
    }
    if (!chosen)
        return ffd_place_fail(place, "has no action: by, to, scale, rotate, matrix, twist, taper or bend");
    move->action = chosen->action;
    const size_t before = ffd_place_enter(place, chosen->key);
    const ffd_status status = chosen->read(place, json_object_get(value, chosen->key), move);
    ffd_place_leave(place, before);
    return status;
}

static ffd_status read_selection(json_place *place, const json_t *value, const lattice_spec *spec,
                                 lattice_move *move)
{
    const json_t *const at = json_object_get(value, "at"), *const within = json_object_get(value, "within");
    if (at && within)
        return ffd_place_fail(place,
                              "has both \"at\" and \"within\"; a move selects its points by one of them");
    if (!at && !within)
        return FFD_OK;
    const size_t before = ffd_place_enter(place, at ? "at" : "within");
    const ffd_status status = at ? read_at(place, at, spec, move) : read_within(place, within, move);
    ffd_place_leave(place, before);
    return status;
}

static ffd_status read_weight(json_place *place, const json_t *value, lattice_move *move)
{
    move->weight = 1;
    if (!json_object_get(value, "weight"))
        return FFD_OK;
    const ffd_status status = ffd_json_member_double(place, value, "weight", &move->weight);
    if (status || (move->weight >= 0 && move->weight <= 1))
        return status;
    ffd_place_enter(place, "weight");
    return ffd_place_fail(place, "weight %s is not between 0 and 1", ffd_number_text(move->weight).text);
}

static ffd_status read_move(json_place *place, const json_t *value, const lattice_spec *spec,
                            lattice_move *move)
{
    static const char *const keys[] = {"at",     "within", "weight", "by",    "to",  "scale",
                                       "rotate", "matrix", "twist",  "taper", "bend"};
    snprintf(move->pointer, sizeof move->pointer, "%s", place->pointer);
    ffd_status status = ffd_json_read_object(place, value, keys, COUNT_OF(keys));
    if (!status)
        status = read_selection(place, value, spec, move);
    if (!status)
        status = read_weight(place, value, move);
    return status ? status : read_action(place, value, move);
}

ffd_status ffd_spec_parse_moves(json_place *place, const json_t *value, lattice_spec *spec)
{
    if (!json_is_array(value))
        return ffd_place_fail(place, "must be an array of moves, not %s", ffd_json_describe(value).text);
    const size_t count = json_array_size(value);
    spec->moves = ffd_alloc_zero(count, sizeof *spec->moves);
    if (!spec->moves)
        return ffd_fail_memory(place->error);
    spec->move_count = count;
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < count && !status; i++) {
        const size_t before = ffd_place_enter_index(place, i);
        status = read_move(place, json_array_get(value, i), spec, &spec->moves[i]);
        ffd_place_leave(place, before);
    }
    return status;
}
