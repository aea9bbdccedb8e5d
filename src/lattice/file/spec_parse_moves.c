#include "lattice/file/spec_parse_moves.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/vector/direction.h"
#include "lattice/drag.h"
#include "lattice/file/spec_values.h"
#include "lattice/noise.h"
#include <stdio.h>
#include <string.h>

#define COUNT_OF(array) (sizeof(array) / sizeof *(array))

/* Finds the index that a word stands for. */
static bool find_layer(json_cursor cursor, size_t size, size_t *index)
{
    static const char *const firsts[] = {"first", "bottom"}, *const lasts[] = {"last", "top"};
    for (size_t i = 0; i < COUNT_OF(firsts); i++) {
        const bool is_last = ffd_json_tree_string_is(cursor.tree, cursor.value, lasts[i]);
        *index = is_last ? size - 1 : 0;
        if (is_last || ffd_json_tree_string_is(cursor.tree, cursor.value, firsts[i]))
            return true;
    }
    return false;
}

/* Reads an index of control points, or a word for one; a negative one counts from the end. */
static ffd_status read_index(json_cursor cursor, size_t size, size_t *index)
{
    double number;
    if (ffd_cursor_is(cursor, JSON_STRING) && find_layer(cursor, size, index))
        return FFD_OK;
    TRY(ffd_json_read_integer(cursor, &number));
    const double resolved = number < 0 ? number + (double)size : number;
    if (resolved < 0 || resolved >= (double)size)
        return ffd_cursor_fail(cursor, "index %.0f is outside 0 to %zu (or -%zu to -1)", number, size - 1,
                               size);
    *index = (size_t)resolved;
    return FFD_OK;
}

static ffd_status read_range(json_cursor cursor, size_t size, size_t *first, size_t *last)
{
    size_t *const ends[2] = {first, last};
    TRY(ffd_json_read_array(cursor, 2, "indices"));
    json_cursor index = ffd_cursor_first(cursor);
    for (size_t i = 0; i < 2; i++, index = ffd_cursor_next(index))
        TRY(read_index(index, size, ends[i]));
    if (*first > *last)
        return ffd_cursor_fail(cursor, "the range from %zu to %zu is empty", *first, *last);
    return FFD_OK;
}

/* Reads an index, an inclusive range [lo, hi], or "all". */
static ffd_status read_indices(json_cursor cursor, size_t size, size_t *first, size_t *last)
{
    if (ffd_cursor_is(cursor, JSON_ARRAY))
        return read_range(cursor, size, first, last);
    if (ffd_cursor_is(cursor, JSON_STRING) && !find_layer(cursor, size, first)) {
        *first = 0;
        *last = size - 1;
        if (!ffd_json_tree_string_is(cursor.tree, cursor.value, "all"))
            return ffd_cursor_fail(cursor,
                                   "is %s, not an index (0, \"first\" or \"bottom\": the first layer; -1, "
                                   "\"last\" or \"top\": the last), a range [lo, hi] or \"all\"",
                                   ffd_json_describe(cursor).text);
        return FFD_OK;
    }
    const ffd_status status = read_index(cursor, size, first);
    *last = *first;
    return status;
}

static ffd_status read_at(json_cursor cursor, const lattice_spec *spec, lattice_move *move)
{
    move->has_at = true;
    TRY(ffd_json_read_array(cursor, 3, "selections"));
    json_cursor indices = ffd_cursor_first(cursor);
    for (size_t a = 0; a < 3; a++, indices = ffd_cursor_next(indices))
        TRY(read_indices(indices, spec->size[a], &move->at_first[a], &move->at_last[a]));
    return FFD_OK;
}

static ffd_status read_within(json_cursor cursor, lattice_move *move)
{
    static const char *const keys[] = {"min", "max", SPEC_NOTES};
    move->has_within = true;
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    TRY(ffd_spec_read_ends(cursor, move->within_min, move->within_max));
    for (int c = 0; c < 3; c++)
        if (move->within_max[c] < move->within_min[c])
            return ffd_cursor_fail(cursor, "max %s is less than min %s",
                                   ffd_number_text(move->within_max[c]).text,
                                   ffd_number_text(move->within_min[c]).text);
    return FFD_OK;
}

static ffd_status read_by(json_cursor cursor, lattice_move *move)
{
    return ffd_json_read_doubles(cursor, 3, move->vector);
}

/* "about" is optional everywhere. */
static ffd_status read_about(json_cursor object, lattice_move *move)
{
    const json_cursor about = ffd_cursor_member(object, "about");
    move->has_about = ffd_cursor_exists(about);
    return move->has_about ? ffd_json_read_doubles(about, 3, move->about) : FFD_OK;
}

static ffd_status read_factor(json_cursor cursor, double factor[3])
{
    if (ffd_cursor_is(cursor, JSON_ARRAY))
        return ffd_json_read_doubles(cursor, 3, factor);
    for (int c = 0; c < 3; c++)
        TRY(ffd_json_read_double(cursor, &factor[c]));
    return FFD_OK;
}

static ffd_status read_scale(json_cursor cursor, lattice_move *move)
{
    static const char *const keys[] = {"factor", "about", SPEC_NOTES};
    json_cursor factor;
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    TRY(ffd_json_require(cursor, "factor", &factor));
    TRY(read_factor(factor, move->vector));
    return read_about(cursor, move);
}

/* Reads an axis as it is written, without normalising it. */
static ffd_status read_raw_axis(json_cursor object, const char *key, const double axis[3], double raw[3])
{
    const json_cursor member = ffd_cursor_member(object, key);
    memcpy(raw, axis, 3 * sizeof *raw);
    return ffd_cursor_is(member, JSON_ARRAY) ? ffd_json_read_doubles(member, 3, raw) : FFD_OK;
}

/* Reads an axial action: its axis, for a bend the direction "toward", the amount under the given key, and
   "about". */
static ffd_status read_axial(json_cursor cursor, const char *const *known, size_t count, const char *amount,
                             lattice_move *move)
{
    TRY(ffd_spec_read_object(cursor, known, count));
    TRY(ffd_spec_read_axis(cursor, "axis", move->axis));
    TRY(read_raw_axis(cursor, "axis", move->axis, move->raw_axis));
    if (move->action == MOVE_BEND)
        TRY(ffd_spec_read_axis(cursor, "toward", move->vector));
    if (move->action == MOVE_BEND)
        TRY(read_raw_axis(cursor, "toward", move->vector, move->raw_toward));
    TRY(ffd_json_member_double(cursor, amount, &move->amount));
    return read_about(cursor, move);
}

/* rotate, twist */
static ffd_status read_turn(json_cursor cursor, lattice_move *move)
{
    static const char *const keys[] = {"axis", "degrees", "about", SPEC_NOTES};
    return read_axial(cursor, keys, COUNT_OF(keys), "degrees", move);
}

static ffd_status read_taper(json_cursor cursor, lattice_move *move)
{
    static const char *const keys[] = {"axis", "factor", "about", SPEC_NOTES};
    return read_axial(cursor, keys, COUNT_OF(keys), "factor", move);
}

static ffd_status read_exact(json_cursor cursor, lattice_move *move)
{
    if (!ffd_cursor_exists(cursor))
        return FFD_OK;
    move->exact = ffd_cursor_is(cursor, JSON_TRUE);
    if (!move->exact && !ffd_cursor_is(cursor, JSON_FALSE))
        return ffd_cursor_fail(cursor, "must be true or false, not %s", ffd_json_describe(cursor).text);
    if (!move->exact || (move->weight == 1 && move->falloff.kind == FALLOFF_NONE))
        return FFD_OK;
    return ffd_cursor_fail(cursor, "a bend with %s is not exact: what it leaves is no circle",
                           move->weight == 1 ? "a falloff" : "a weight other than 1");
}

static ffd_status read_bend(json_cursor cursor, lattice_move *move)
{
    static const char *const keys[] = {"axis", "toward", "degrees", "about", "exact", SPEC_NOTES};
    TRY(read_axial(cursor, keys, COUNT_OF(keys), "degrees", move));
    TRY(read_exact(ffd_cursor_member(cursor, "exact"), move));
    if (ffd_direction_perpendicular(move->axis, move->vector))
        return FFD_OK;
    return ffd_cursor_fail(ffd_cursor_member(cursor, "toward"),
                           "is parallel to the axis, which it must not be");
}

static ffd_status read_matrix(json_cursor cursor, lattice_move *move)
{
    TRY(ffd_json_read_doubles(cursor, 16, move->matrix));
    const double *const last = move->matrix + 12;
    if (last[0] == 0 && last[1] == 0 && last[2] == 0 && last[3] == 1)
        return FFD_OK;
    return ffd_cursor_fail(cursor, "the last row is %s %s %s %s, not 0 0 0 1", ffd_number_text(last[0]).text,
                           ffd_number_text(last[1]).text, ffd_number_text(last[2]).text,
                           ffd_number_text(last[3]).text);
}

static ffd_status read_pull(json_cursor cursor, lattice_move *move)
{
    static const char *const keys[] = {"point", "by", "radius", SPEC_NOTES};
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    TRY(ffd_json_member_doubles(cursor, "point", 3, move->point));
    TRY(ffd_json_member_doubles(cursor, "by", 3, move->vector));
    return ffd_spec_read_positive(cursor, "radius", &move->radius);
}

/* Sets the place of each member of the list, of which move->drags has room for all. */
static ffd_status read_drag(json_cursor cursor, lattice_move *move)
{
    static const char *const keys[] = {"point", "by", SPEC_NOTES};
    const size_t most = move->mirror.kind == MIRROR_NONE ? FFD_MAX_DRAGGED : FFD_MAX_DRAGGED / 2;
    if (!ffd_cursor_is(cursor, JSON_ARRAY) || ffd_cursor_count(cursor) == 0)
        return ffd_cursor_fail(cursor, "must be an array of {\"point\": [..], \"by\": [..]}, not %s",
                               ffd_json_describe(cursor).text);
    if (ffd_cursor_count(cursor) > most)
        return ffd_cursor_fail_as(cursor, FFD_E_LIMIT, "drags %zu places, more than %zu",
                                  ffd_cursor_count(cursor), most);
    json_cursor drag = ffd_cursor_first(cursor);
    for (; ffd_cursor_exists(drag); drag = ffd_cursor_next(drag)) {
        spec_drag *const to = &move->drags[move->drag_count++];
        TRY(ffd_spec_read_object(drag, keys, COUNT_OF(keys)));
        TRY(ffd_json_member_doubles(drag, "point", 3, to->point));
        TRY(ffd_json_member_doubles(drag, "by", 3, to->by));
    }
    return FFD_OK;
}

/* Noise is not its own mirror image. */
static ffd_status read_jitter(json_cursor cursor, lattice_move *move)
{
    static const char *const keys[] = {"sigma", "seed", SPEC_NOTES};
    json_cursor sigma, seed;
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    TRY(ffd_json_require(cursor, "sigma", &sigma));
    TRY(ffd_json_require(cursor, "seed", &seed));
    TRY(read_factor(sigma, move->vector));
    for (int c = 0; c < 3; c++)
        if (!(move->vector[c] >= 0))
            return ffd_cursor_fail(sigma, "sigma %s is less than 0", ffd_number_text(move->vector[c]).text);
    TRY(ffd_json_read_double(seed, &move->seed));
    if (!(move->seed >= 0 && move->seed <= (double)NOISE_MOST_SEED) || floor_of(move->seed) != move->seed)
        return ffd_cursor_fail(seed, "seed %s is not a whole number from 0 to 9007199254740991",
                               ffd_number_text(move->seed).text);
    return move->mirror.kind == MIRROR_NONE
               ? FFD_OK
               : ffd_cursor_fail(cursor,
                                 "noise has no mirror image: symmetrize the lattice that it makes instead");
}

/* form: of an action that is an object, for who writes a number or an array. */
static const struct action_reader {
    const char *key;
    move_action action;
    ffd_status (*read)(json_cursor cursor, lattice_move *move);
    const char *form;
} actions[] = {
    {"by", MOVE_BY, read_by, NULL},
    {"to", MOVE_TO, read_by, NULL},
    {"scale", MOVE_SCALE, read_scale, "{\"factor\": %s}"},
    {"rotate", MOVE_ROTATE, read_turn, "{\"axis\": \"y\", \"degrees\": %s}"},
    {"matrix", MOVE_MATRIX, read_matrix, NULL},
    {"twist", MOVE_TWIST, read_turn, "{\"axis\": \"y\", \"degrees\": %s}"},
    {"taper", MOVE_TAPER, read_taper, "{\"axis\": \"y\", \"factor\": %s}"},
    {"bend", MOVE_BEND, read_bend, "{\"axis\": \"y\", \"toward\": \"x\", \"degrees\": %s}"},
    {"pull", MOVE_PULL, read_pull, "{\"point\": [x, y, z], \"by\": %s, \"radius\": r}"},
    {"drag", MOVE_DRAG, read_drag, NULL},
    {"jitter", MOVE_JITTER, read_jitter, "{\"sigma\": %s, \"seed\": 1}"},
};

/* Refuses a number or an array in place of an object; shows where it belongs. */
static ffd_status check_form(json_cursor cursor, const struct action_reader *reader)
{
    const json_value *const value = &cursor.tree->values[cursor.value];
    const uint32_t length = value->end - value->begin;
    char own[60], form[160];
    if (!reader->form || !(ffd_cursor_is(cursor, JSON_NUMBER) || ffd_cursor_is(cursor, JSON_ARRAY)))
        return FFD_OK;
    snprintf(own, sizeof own, "%.*s", length < sizeof own ? (int)length : 3,
             length < sizeof own ? cursor.tree->text + value->begin : "...");
    const char *const place = strstr(reader->form, "%s");
    snprintf(form, sizeof form, "%.*s%s%s", (int)(place - reader->form), reader->form, own, place + 2);
    return ffd_cursor_fail(cursor, "must be an object, not %s; write {\"%s\": %s}",
                           ffd_json_describe(cursor).text, reader->key, form);
}

ffd_status ffd_spec_refuse_actions(json_cursor root)
{
    for (size_t i = 0; i < COUNT_OF(actions); i++) {
        const json_cursor member = ffd_cursor_member(root, actions[i].key);
        if (ffd_cursor_exists(member))
            return ffd_cursor_fail(member, "\"%s\" is an action of a move; write \"moves\": [{\"%s\": ..}]",
                                   actions[i].key, actions[i].key);
    }
    return FFD_OK;
}

static ffd_status read_action(json_cursor cursor, lattice_move *move)
{
    const struct action_reader *chosen = NULL;
    json_cursor action = cursor;
    for (size_t i = 0; i < COUNT_OF(actions); i++) {
        const json_cursor member = ffd_cursor_member(cursor, actions[i].key);
        if (!ffd_cursor_exists(member))
            continue;
        if (chosen)
            return ffd_cursor_fail(cursor, "has two actions, \"%s\" and \"%s\"; a move has one", chosen->key,
                                   actions[i].key);
        chosen = &actions[i];
        action = member;
    }
    if (!chosen)
        return ffd_cursor_fail(
            cursor, "has no action: by, to, scale, rotate, matrix, twist, taper, bend, pull, drag or jitter");
    move->action = chosen->action;
    TRY(check_form(action, chosen));
    return chosen->read(action, move);
}

static ffd_status read_selection(json_cursor cursor, const lattice_spec *spec, lattice_move *move)
{
    const json_cursor at = ffd_cursor_member(cursor, "at"), within = ffd_cursor_member(cursor, "within");
    if (ffd_cursor_exists(at) && ffd_cursor_exists(within))
        return ffd_cursor_fail(cursor,
                               "has both \"at\" and \"within\"; a move selects its points by one of them");
    if (ffd_cursor_exists(at))
        return read_at(at, spec, move);
    return ffd_cursor_exists(within) ? read_within(within, move) : FFD_OK;
}

static ffd_status read_weight(json_cursor cursor, lattice_move *move)
{
    const json_cursor weight = ffd_cursor_member(cursor, "weight");
    move->weight = 1;
    if (!ffd_cursor_exists(weight))
        return FFD_OK;
    TRY(ffd_json_read_double(weight, &move->weight));
    if ((move->weight >= 0 && move->weight <= 1))
        return FFD_OK;
    return ffd_cursor_fail(weight, "weight %s is not between 0 and 1", ffd_number_text(move->weight).text);
}

static ffd_status read_axis_falloff(json_cursor cursor, move_falloff *falloff)
{
    falloff->kind = FALLOFF_AXIS;
    TRY(ffd_spec_read_axis(cursor, "axis", falloff->axis));
    TRY(read_raw_axis(cursor, "axis", falloff->axis, falloff->raw_axis));
    TRY(ffd_json_member_double(cursor, "from", &falloff->from));
    TRY(ffd_json_member_double(cursor, "to", &falloff->to));
    if (falloff->from != falloff->to)
        return FFD_OK;
    return ffd_cursor_fail(cursor, "from and to are both %s: there is nothing to fall off between",
                           ffd_number_text(falloff->to).text);
}

/* Returns the first of the keys that the object has; the last one if it has none. */
static const char *first_member(json_cursor object, const char *const *keys, size_t count)
{
    size_t i = 0;
    while (i + 1 < count && !ffd_cursor_exists(ffd_cursor_member(object, keys[i])))
        i++;
    return keys[i];
}

/* Reads a falloff along an axis or round a centre. */
static ffd_status read_falloff(json_cursor cursor, move_falloff *falloff)
{
    static const char *const keys[] = {"axis", "from", "to", "center", "radius", SPEC_NOTES};
    if (!ffd_cursor_exists(cursor))
        return FFD_OK;
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    const char *const along = first_member(cursor, keys, 3), *const round = first_member(cursor, keys + 3, 2);
    const bool is_along = ffd_cursor_exists(ffd_cursor_member(cursor, along));
    const bool is_round = ffd_cursor_exists(ffd_cursor_member(cursor, round));
    if (is_along && is_round)
        return ffd_cursor_fail(cursor,
                               "has both \"%s\" and \"%s\"; a falloff has axis, from and to, or center and "
                               "radius",
                               along, round);
    if (!is_along && !is_round)
        return ffd_cursor_fail(cursor, "is empty; a falloff has axis, from and to, or center and radius");
    if (is_along)
        return read_axis_falloff(cursor, falloff);
    falloff->kind = FALLOFF_BALL;
    TRY(ffd_json_member_doubles(cursor, "center", 3, falloff->center));
    return ffd_spec_read_positive(cursor, "radius", &falloff->radius);
}

/* Reads the plane of a mirror: a coordinate along an axis, or a point and the normal. */
static ffd_status read_plane(json_cursor cursor, move_mirror *mirror)
{
    static const char *const keys[] = {"axis", "at", "point", "normal", SPEC_NOTES};
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    const char *const along = first_member(cursor, keys, 2), *const through =
                                                                 first_member(cursor, keys + 2, 2);
    const bool is_along = ffd_cursor_exists(ffd_cursor_member(cursor, along));
    const bool is_through = ffd_cursor_exists(ffd_cursor_member(cursor, through));
    if (is_along && is_through)
        return ffd_cursor_fail(cursor,
                               "has both \"%s\" and \"%s\"; a plane has axis and at, or point and normal",
                               along, through);
    if (!is_along && !is_through)
        return ffd_cursor_fail(cursor, "is empty; a plane has axis and at, or point and normal");
    mirror->kind = is_along ? MIRROR_AT : MIRROR_POINT;
    TRY(ffd_spec_read_axis(cursor, is_along ? "axis" : "normal", mirror->normal));
    return is_along ? ffd_json_member_double(cursor, "at", &mirror->at)
                    : ffd_json_member_doubles(cursor, "point", 3, mirror->point);
}

static ffd_status read_mirror(json_cursor cursor, lattice_move *move)
{
    static const char *const names[] = {"x", "y", "z"};
    size_t axis;
    if (!ffd_cursor_exists(cursor))
        return FFD_OK;
    if (ffd_cursor_is(cursor, JSON_OBJECT))
        return read_plane(cursor, &move->mirror);
    if (!ffd_cursor_is(cursor, JSON_STRING))
        return ffd_cursor_fail(cursor,
                               "must be \"x\", \"y\", \"z\", or a plane by axis and at, or point and "
                               "normal, not %s",
                               ffd_json_describe(cursor).text);
    TRY(ffd_json_read_word(cursor, names, COUNT_OF(names), &axis));
    move->mirror.kind = MIRROR_MIDDLE;
    move->mirror.normal[axis] = 1;
    return FFD_OK;
}

/* Reads what stands beside a drag: the radius, which no other move has. A drag goes as far as it says:
   weights would contradict that. */
static ffd_status read_reach(json_cursor cursor, lattice_move *move)
{
    static const char *const keys[] = {"weight", "falloff"};
    const json_cursor radius = ffd_cursor_member(cursor, "radius");
    if (move->action != MOVE_DRAG)
        return !ffd_cursor_exists(radius)
                   ? FFD_OK
                   : ffd_cursor_fail(radius,
                                     "a radius beside the action is one of \"drag\"; that of a pull or a "
                                     "falloff is within it");
    for (size_t i = 0; i < COUNT_OF(keys); i++) {
        const json_cursor member = ffd_cursor_member(cursor, keys[i]);
        if (ffd_cursor_exists(member))
            return ffd_cursor_fail(member, "a drag has no \"%s\": its places move by exactly what it says",
                                   keys[i]);
    }
    return ffd_cursor_exists(radius) ? ffd_spec_read_positive(cursor, "radius", &move->radius) : FFD_OK;
}

static ffd_status read_move(json_cursor cursor, const lattice_spec *spec, lattice_move *move)
{
    static const char *const keys[] = {"at",   "within", "weight", "falloff", "mirror", "by",
                                       "to",   "scale",  "rotate", "matrix",  "twist",  "taper",
                                       "bend", "pull",   "drag",   "jitter",  "radius", SPEC_NOTES};
    const json_cursor exact = ffd_cursor_member(cursor, "exact");
    if (ffd_cursor_exists(exact)) /* a suggestion of the most similar key would mislead */
        return ffd_cursor_fail(exact, "unknown key \"exact\" of a move; it is one of \"bend\"");
    TRY(ffd_spec_read_object(cursor, keys, COUNT_OF(keys)));
    TRY(read_selection(cursor, spec, move));
    TRY(read_weight(cursor, move));
    TRY(read_falloff(ffd_cursor_member(cursor, "falloff"), &move->falloff));
    TRY(read_mirror(ffd_cursor_member(cursor, "mirror"), move));
    TRY(read_action(cursor, move));
    return read_reach(cursor, move);
}

/* Allocates the places of all drags: a pointer to a number that is read must stay valid. */
static ffd_status make_drags(json_cursor moves, lattice_spec *spec)
{
    json_cursor move = ffd_cursor_first(moves);
    for (; ffd_cursor_exists(move); move = ffd_cursor_next(move)) {
        const json_cursor drag = ffd_cursor_member(move, "drag");
        if (ffd_cursor_is(drag, JSON_ARRAY))
            spec->drag_count += ffd_cursor_count(drag);
    }
    spec->drags = ffd_alloc_zero(spec->drag_count, sizeof *spec->drags);
    return spec->drags ? FFD_OK : ffd_fail_memory(moves.file->error);
}

/* Notes the lines of a move and of its dragged places, for messages when it is applied. */
static void note_lines(json_cursor cursor, json_line_mark *mark, lattice_move *move)
{
    json_cursor drag = ffd_cursor_first(ffd_cursor_member(cursor, "drag"));
    move->line = ffd_cursor_line_from(cursor, mark);
    for (size_t i = 0; i < move->drag_count; i++, drag = ffd_cursor_next(drag))
        move->drags[i].line = ffd_cursor_line_from(ffd_cursor_member(drag, "point"), mark);
}

ffd_status ffd_spec_parse_moves(json_cursor cursor, const char *pointer, lattice_spec *spec)
{
    if (!ffd_cursor_is(cursor, JSON_ARRAY))
        return ffd_cursor_fail(cursor, "must be an array of moves, not %s", ffd_json_describe(cursor).text);
    const size_t count = ffd_cursor_count(cursor);
    spec->moves = ffd_alloc_zero(count, sizeof *spec->moves);
    if (!spec->moves)
        return ffd_fail_memory(cursor.file->error);
    spec->move_count = count;
    TRY(make_drags(cursor, spec));
    spec_drag *drags = spec->drags;
    json_line_mark mark = {0};
    json_cursor move = ffd_cursor_first(cursor);
    for (size_t i = 0; i < count; i++, move = ffd_cursor_next(move)) {
        spec->moves[i].drags = drags;
        snprintf(spec->moves[i].pointer, sizeof spec->moves[i].pointer, "%s/%zu", pointer, i);
        TRY(read_move(move, spec, &spec->moves[i]));
        note_lines(move, &mark, &spec->moves[i]);
        drags += spec->moves[i].drag_count;
    }
    return FFD_OK;
}
