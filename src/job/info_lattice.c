#include "job/info_lattice.h"
#include "base/vector/vec.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include "mesh/bounds.h"
#include <ffd/embedding.h>

static const char *knot_word(knot_kind kind)
{
    switch (kind) {
    case KNOTS_CLAMPED:
        return "clamped";
    case KNOTS_OPEN:
        return "open";
    case KNOTS_UNIFORM:
        return "uniform";
    case KNOTS_CLOSED:
        return "closed";
    case KNOTS_LIST:
        return "list";
    case KNOTS_CLOSED_LIST:
        return "closed list";
    }
    return NULL;
}

static const char *rest_word(rest_kind kind)
{
    switch (kind) {
    case SPEC_BOX:
        return "box";
    case SPEC_BOX_MESH:
        return "mesh";
    case SPEC_CYLINDER:
        return "cylinder";
    case SPEC_POINTS:
        return "points";
    }
    return NULL;
}

static void write_directions(const ffd_lattice *lattice, json_text *json)
{
    static const char *const direction[3] = {"u", "v", "w"};
    ffd_json_array(json, "size", true);
    for (int a = 0; a < 3; a++)
        ffd_json_count(json, NULL, lattice->size[a]);
    ffd_json_end(json, ']');
    ffd_json_array(json, "degree", true);
    for (int a = 0; a < 3; a++)
        ffd_json_count(json, NULL, (uint64_t)lattice->knots[a].degree);
    ffd_json_end(json, ']');
    ffd_json_array(json, "knots", true);
    for (int a = 0; a < 3; a++)
        ffd_json_string(json, NULL, knot_word(lattice->knots[a].kind));
    ffd_json_end(json, ']');
    ffd_json_object(json, "domain", false);
    for (int a = 0; a < 3; a++) {
        const double ends[2] = {ffd_knots_first(&lattice->knots[a]), ffd_knots_last(&lattice->knots[a])};
        ffd_json_vector(json, direction[a], ends, 2);
    }
    ffd_json_end(json, '}');
}

static ffd_bounds bounds_of(const double *points, size_t count)
{
    ffd_bounds bounds = ffd_bounds_empty();
    for (size_t i = 0; i < count; i++)
        ffd_bounds_widen(&bounds, points + 3 * i);
    return bounds;
}

static void write_moves(const ffd_lattice *lattice, json_text *json)
{
    size_t moved = 0;
    double largest = 0;
    for (size_t i = 0; i < lattice->count; i++) {
        const double length = vec_length(lattice->difference + 3 * i);
        moved += lattice->moved[i] != 0;
        largest = length > largest ? length : largest;
    }
    ffd_json_count(json, "moved", moved);
    ffd_json_number(json, "largest_move", largest);
    ffd_json_bool(json, "weights_moved", lattice->weights_moved);
}

/* A lattice that cannot be inverted can still be described. */
static ffd_status write_inversion(const ffd_lattice *lattice, json_text *json, ffd_error *error)
{
    ffd_locator *locator = NULL;
    ffd_error reason = {0};
    const ffd_status status = ffd_locator_create(lattice, &locator, &reason);
    if (status == FFD_OK)
        ffd_json_string(json, "inversion", ffd_locator_get_method(locator));
    ffd_locator_destroy(&locator);
    if (status == FFD_OK)
        return FFD_OK;
    if (status != FFD_E_INVALID && status != FFD_E_LIMIT) {
        if (error)
            *error = reason;
        return status;
    }
    ffd_json_null(json, "inversion");
    ffd_json_string(json, "inversion_unknown", reason.message);
    return FFD_OK;
}

static ffd_status write_volume(const ffd_lattice *lattice, json_text *json, ffd_error *error)
{
    const ffd_bounds rest = bounds_of(lattice->rest, lattice->count);
    const ffd_bounds deformed = bounds_of(lattice->deformed, lattice->count);
    ffd_bounds_json(json, "rest_bounds", &rest);
    ffd_bounds_json(json, "deformed_bounds", &deformed);
    ffd_json_number(json, "diagonal", lattice->diagonal);
    write_moves(lattice, json);
    return write_inversion(lattice, json, error);
}

ffd_status ffd_info_lattice(const char *path, json_text *json, ffd_error *error)
{
    ffd_lattice *lattice = NULL;
    ffd_status status = ffd_lattice_load(path, &lattice, error);
    if (status != FFD_OK)
        return status;
    write_directions(lattice, json);
    ffd_json_count(json, "control_points", lattice->count);
    ffd_json_string(json, "rest", rest_word(lattice->spec->rest));
    if (ffd_lattice_needs_bounds(lattice)) {
        /* The rest is decided by the mesh that the lattice is used on. */
        ffd_json_bool(json, "rational", lattice->spec->weights || lattice->spec->deformed_weights);
        static const char *const unknown[] = {"rest_bounds",  "deformed_bounds", "diagonal", "moved",
                                              "largest_move", "weights_moved",   "inversion"};
        for (size_t i = 0; i < sizeof unknown / sizeof *unknown; i++)
            ffd_json_null(json, unknown[i]);
        ffd_json_count(json, "moves", lattice->spec->move_count);
    } else {
        ffd_json_bool(json, "rational", lattice->rest_weights != NULL);
        status = write_volume(lattice, json, error);
    }
    ffd_lattice_destroy(&lattice);
    return status;
}
