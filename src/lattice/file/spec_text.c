#include "lattice/file/spec_text.h"
#include "json/json_text.h"
#include <string.h>

static void write_counts(json_text *json, const char *key, const size_t values[], size_t count)
{
    ffd_json_array(json, key, true);
    for (size_t i = 0; i < count; i++)
        ffd_json_count(json, NULL, values[i]);
    ffd_json_end(json, ']');
}

static void write_points(json_text *json, const char *key, const double *points, size_t count)
{
    ffd_json_array(json, key, false);
    for (size_t i = 0; i < count; i++)
        ffd_json_vector(json, NULL, points + 3 * i, 3);
    ffd_json_end(json, ']');
}

static void write_degree(json_text *json, const lattice_spec *spec)
{
    ffd_json_array(json, "degree", true);
    for (int a = 0; a < 3; a++)
        ffd_json_count(json, NULL, (uint64_t)spec->degree[a]);
    ffd_json_end(json, ']');
}

static void write_knots(json_text *json, const lattice_spec *spec)
{
    bool lists = false;
    for (int a = 0; a < 3; a++)
        lists = lists || spec->list[a];
    ffd_json_array(json, "knots", !lists);
    for (int a = 0; a < 3; a++) {
        switch (spec->kind[a]) {
        case KNOTS_CLAMPED:
            ffd_json_string(json, NULL, "clamped");
            break;
        case KNOTS_OPEN:
            ffd_json_string(json, NULL, "open");
            break;
        case KNOTS_UNIFORM:
            ffd_json_string(json, NULL, "uniform");
            break;
        case KNOTS_CLOSED:
            ffd_json_string(json, NULL, "closed");
            break;
        case KNOTS_LIST:
            ffd_json_vector(json, NULL, spec->list[a], spec->list_count[a]);
            break;
        case KNOTS_CLOSED_LIST:
            ffd_json_object(json, NULL, true);
            ffd_json_vector(json, "closed", spec->list[a], spec->list_count[a]);
            ffd_json_end(json, '}');
            break;
        }
    }
    ffd_json_end(json, ']');
}

static void write_box(json_text *json, const lattice_spec *spec)
{
    ffd_json_object(json, "box", false);
    ffd_json_vector(json, "min", spec->box_min, 3);
    ffd_json_vector(json, "max", spec->box_max, 3);
    ffd_json_string(json, "spacing", spec->spacing == FFD_SPACING_UNIFORM ? "uniform" : "greville");
    if (spec->has_axes)
        write_points(json, "axes", spec->box_axes, 3);
    ffd_json_end(json, '}');
}

static void write_mesh_box(json_text *json, const lattice_spec *spec)
{
    if (spec->mesh_count == 0) {
        ffd_json_string(json, "box", "mesh");
    } else {
        ffd_json_object(json, "box", false);
        ffd_json_array(json, "meshes", false);
        for (size_t i = 0; i < spec->mesh_count; i++)
            ffd_json_string(json, NULL, spec->meshes[i]);
        ffd_json_end(json, ']');
        ffd_json_end(json, '}');
    }
    const bool is_one = memcmp(spec->margin, spec->margin + 1, 2 * sizeof *spec->margin) == 0;
    if (is_one)
        ffd_json_number(json, "margin", *spec->margin);
    else
        ffd_json_vector(json, "margin", spec->margin, 3);
}

static void write_cylinder(json_text *json, const lattice_spec *spec)
{
    ffd_json_object(json, "cylinder", false);
    ffd_json_vector(json, "center", spec->center, 3);
    ffd_json_vector(json, "axis", spec->axis, 3);
    ffd_json_vector(json, "zero", spec->zero, 3);
    ffd_json_vector(json, "radius", spec->radius, 2);
    ffd_json_number(json, "height", spec->height);
    ffd_json_vector(json, "angle", spec->angle, 2);
    ffd_json_end(json, '}');
}

static void write_rest(json_text *json, const lattice_spec *spec)
{
    ffd_json_object(json, "rest", false);
    switch (spec->rest) {
    case SPEC_BOX:
        write_box(json, spec);
        break;
    case SPEC_BOX_MESH:
        write_mesh_box(json, spec);
        break;
    case SPEC_CYLINDER:
        write_cylinder(json, spec);
        break;
    case SPEC_POINTS:
        write_points(json, "points", spec->points, spec->count);
        break;
    }
    ffd_json_end(json, '}');
}

static void write_deformed(json_text *json, const lattice_spec *spec)
{
    ffd_json_object(json, "deformed", false);
    if (spec->deformed_points)
        write_points(json, "points", spec->deformed_points, spec->count);
    if (spec->deformed_offsets)
        write_points(json, "offsets", spec->deformed_offsets, spec->count);
    if (spec->deformed_weights)
        ffd_json_vector(json, "weights", spec->deformed_weights, spec->count);
    ffd_json_end(json, '}');
}

static void write_selection(json_text *json, const lattice_move *move)
{
    if (move->has_at) {
        ffd_json_array(json, "at", true);
        for (int a = 0; a < 3; a++) {
            if (move->at_first[a] == move->at_last[a])
                ffd_json_count(json, NULL, move->at_first[a]);
            else
                write_counts(json, NULL, (const size_t[]){move->at_first[a], move->at_last[a]}, 2);
        }
        ffd_json_end(json, ']');
    }
    if (move->has_within) {
        ffd_json_object(json, "within", true);
        ffd_json_vector(json, "min", move->within_min, 3);
        ffd_json_vector(json, "max", move->within_max, 3);
        ffd_json_end(json, '}');
    }
    if (move->weight != 1)
        ffd_json_number(json, "weight", move->weight);
}

static void write_falloff(json_text *json, const move_falloff *falloff)
{
    ffd_json_object(json, "falloff", true);
    if (falloff->kind == FALLOFF_AXIS) {
        ffd_json_vector(json, "axis", falloff->axis, 3);
        ffd_json_number(json, "from", falloff->from);
        ffd_json_number(json, "to", falloff->to);
    } else {
        ffd_json_vector(json, "center", falloff->center, 3);
        ffd_json_number(json, "radius", falloff->radius);
    }
    ffd_json_end(json, '}');
}

static void write_mirror(json_text *json, const move_mirror *mirror)
{
    if (mirror->kind == MIRROR_MIDDLE) {
        ffd_json_string(json, "mirror", mirror->normal[0] != 0 ? "x" : mirror->normal[1] != 0 ? "y" : "z");
        return;
    }
    ffd_json_object(json, "mirror", true);
    if (mirror->kind == MIRROR_AT) {
        ffd_json_vector(json, "axis", mirror->normal, 3);
        ffd_json_number(json, "at", mirror->at);
    } else {
        ffd_json_vector(json, "point", mirror->point, 3);
        ffd_json_vector(json, "normal", mirror->normal, 3);
    }
    ffd_json_end(json, '}');
}

static void write_pull(json_text *json, const lattice_move *move)
{
    ffd_json_object(json, "pull", true);
    ffd_json_vector(json, "point", move->point, 3);
    ffd_json_vector(json, "by", move->vector, 3);
    ffd_json_number(json, "radius", move->radius);
    ffd_json_end(json, '}');
}

static void write_drag(json_text *json, const lattice_move *move)
{
    if (move->radius > 0)
        ffd_json_number(json, "radius", move->radius);
    ffd_json_array(json, "drag", true);
    for (size_t i = 0; i < move->drag_count; i++) {
        ffd_json_object(json, NULL, true);
        ffd_json_vector(json, "point", move->drags[i].point, 3);
        ffd_json_vector(json, "by", move->drags[i].by, 3);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

/* Writes an action that is an object, with its members in the order of data/schema/lattice.md. */
static void write_action_object(json_text *json, const char *key, const lattice_move *move)
{
    ffd_json_object(json, key, true);
    if (move->action == MOVE_SCALE)
        ffd_json_vector(json, "factor", move->vector, 3);
    else
        ffd_json_vector(json, "axis", move->axis, 3);
    if (move->action == MOVE_BEND)
        ffd_json_vector(json, "toward", move->vector, 3);
    if (move->action == MOVE_TAPER)
        ffd_json_number(json, "factor", move->amount);
    else if (move->action != MOVE_SCALE)
        ffd_json_number(json, "degrees", move->amount);
    if (move->has_about)
        ffd_json_vector(json, "about", move->about, 3);
    if (move->exact)
        ffd_json_bool(json, "exact", true);
    ffd_json_end(json, '}');
}

static void write_action(json_text *json, const lattice_move *move)
{
    switch (move->action) {
    case MOVE_BY:
        ffd_json_vector(json, "by", move->vector, 3);
        break;
    case MOVE_TO:
        ffd_json_vector(json, "to", move->vector, 3);
        break;
    case MOVE_MATRIX:
        ffd_json_vector(json, "matrix", move->matrix, 16);
        break;
    case MOVE_SCALE:
        write_action_object(json, "scale", move);
        break;
    case MOVE_ROTATE:
        write_action_object(json, "rotate", move);
        break;
    case MOVE_TWIST:
        write_action_object(json, "twist", move);
        break;
    case MOVE_TAPER:
        write_action_object(json, "taper", move);
        break;
    case MOVE_BEND:
        write_action_object(json, "bend", move);
        break;
    case MOVE_PULL:
        write_pull(json, move);
        break;
    case MOVE_DRAG:
        write_drag(json, move);
        break;
    case MOVE_JITTER:
        ffd_json_object(json, "jitter", true);
        ffd_json_vector(json, "sigma", move->vector, 3);
        ffd_json_count(json, "seed", (uint64_t)move->seed);
        ffd_json_end(json, '}');
        break;
    }
}

static void write_moves(json_text *json, const lattice_move *moves, size_t count)
{
    ffd_json_array(json, "moves", false);
    for (size_t i = 0; i < count; i++) {
        ffd_json_object(json, NULL, true);
        write_selection(json, &moves[i]);
        if (moves[i].falloff.kind != FALLOFF_NONE)
            write_falloff(json, &moves[i].falloff);
        if (moves[i].mirror.kind != MIRROR_NONE)
            write_mirror(json, &moves[i].mirror);
        write_action(json, &moves[i]);
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

/* Writes the values that placeholders without keys have as their defaults. */
static void write_others(json_text *json, const spec_keys *keys)
{
    intern_table written = {0};
    uint32_t index;
    if (keys->other_count == 0)
        return;
    ffd_json_object(json, "parameters", false);
    for (size_t i = 0; i < keys->other_count; i++) {
        const spec_value *const other = &keys->others[i];
        const uint32_t before = written.count;
        if (!ffd_intern(&written, other->name, strlen(other->name), &index))
            json->out->failed = true;
        if (written.count == before) /* the first of a name counts */
            continue;
        ffd_json_object(json, other->name, true);
        ffd_json_raw(json, "default", other->value, strlen(other->value));
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, '}');
    ffd_intern_free(&written);
}

static void write_keys(json_text *json, const lattice_spec *spec)
{
    const spec_keys *const keys = &spec->keys;
    ffd_json_array(json, "keys", false);
    for (size_t k = 0; k < keys->count; k++) {
        const spec_key *const key = &keys->list[k];
        ffd_json_object(json, NULL, keys->kind == KEYS_VALUES);
        ffd_json_number(json, "time", key->time);
        if (key->offsets)
            write_points(json, "offsets", key->offsets, spec->count);
        else if (keys->kind == KEYS_POINTS)
            write_moves(json, key->moves, key->move_count);
        else
            ffd_json_object(json, "set", true);
        for (size_t n = 0; n < keys->name_count; n++)
            ffd_json_raw(json, keys->names[n], key->values[n], strlen(key->values[n]));
        if (keys->kind == KEYS_VALUES)
            ffd_json_end(json, '}');
        ffd_json_end(json, '}');
    }
    ffd_json_end(json, ']');
}

char *ffd_spec_text(const lattice_spec *spec, size_t *size)
{
    byte_buffer buffer = {0};
    json_text json;
    ffd_json_begin(&json, &buffer);
    ffd_json_object(&json, NULL, false);
    ffd_json_string(&json, "format", SPEC_FORMAT);
    ffd_json_count(&json, "version", SPEC_VERSION);
    write_counts(&json, "size", spec->size, 3);
    write_degree(&json, spec);
    write_knots(&json, spec);
    write_rest(&json, spec);
    if (spec->weights)
        ffd_json_vector(&json, "weights", spec->weights, spec->count);
    if (spec->deformed_points || spec->deformed_offsets || spec->deformed_weights)
        write_deformed(&json, spec);
    if (spec->units != UNITS_WORLD)
        ffd_json_string(&json, "units", spec->units == UNITS_BOX ? "box" : "mesh");
    if (spec->keys.kind == KEYS_VALUES) {
        write_others(&json, &spec->keys);
        ffd_json_raw(&json, "moves", spec->keys.moves, strlen(spec->keys.moves));
    } else {
        /* Also if there are none: a new file shows where moves are to be added. */
        write_moves(&json, spec->moves, spec->move_count);
    }
    if (spec->keys.kind != KEYS_NONE)
        write_keys(&json, spec);
    ffd_json_end(&json, '}');
    *size = buffer.size;
    return ffd_buffer_finish(&buffer);
}
