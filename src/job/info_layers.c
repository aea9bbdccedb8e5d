/* info_layers.c - positions of the layers of control points. */
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include "job/info.h"
#include "lattice/lattice.h"
#include "lattice/shapes.h"
#include "lattice/spec.h"
#include <math.h>

/* Directions with more layers than this are not listed. */
#define MOST_LAYERS 4096
/* Distances from a side of the box, relative to its length, that count as rounding. */
#define ON_THE_SIDE 1e-12
/* Angles are rounded to this part of a degree, as smaller digits are rounding of the arc tangent. */
#define ANGLE_STEPS 1e9

static const char *const direction[3] = {"u", "v", "w"};

static double fraction_of(const ffd_lattice *lattice, int a, size_t layer)
{
    return ffd_shape_fraction(&lattice->knots[a], layer, lattice->spec->spacing);
}

static double box_place(const ffd_lattice *lattice, const ffd_bounds *box, int a, size_t layer)
{
    const double fraction = fraction_of(lattice, a, layer);
    return box->min[a] <= box->max[a] ? ffd_shape_between(box->min[a], box->max[a], fraction) : fraction;
}

/* Finds the coordinates of a control point in the plane across a cylinder's axis. */
static void point_across(const ffd_lattice *lattice, size_t point, double *x, double *y)
{
    const lattice_spec *const spec = lattice->spec;
    double side[3], p[3];
    vec_cross(spec->axis, spec->zero, side);
    for (int c = 0; c < 3; c++)
        p[c] = lattice->rest[3 * point + (size_t)c] - spec->center[c];
    *x = vec_dot(p, spec->zero);
    *y = vec_dot(p, side);
}

/* Returns the angle of a layer in degrees, within half a turn of the angle where v begins. */
static double ring_angle(const ffd_lattice *lattice, size_t layer)
{
    const size_t outer = lattice->size[0] - 1;
    double x, y;
    point_across(lattice, outer + lattice->size[0] * layer, &x, &y);
    const double angle = nearest_integer(ffd_angle_degrees(y, x) * ANGLE_STEPS) / ANGLE_STEPS;
    const double first = lattice->spec->angle[0];
    return angle + 360 * nearest_integer((first - angle) / 360);
}

static double cylinder_place(const ffd_lattice *lattice, const ffd_bounds *box, int a, size_t layer)
{
    const double half = 0.5 * lattice->spec->height;
    double x, y;
    (void)box;
    if (a == 1)
        return ring_angle(lattice, layer);
    if (a == 2)
        return ffd_shape_between(-half, half, fraction_of(lattice, a, layer));
    point_across(lattice, layer, &x, &y);
    return vec_length((const double[3]){x, y, 0});
}

typedef double place_function(const ffd_lattice *lattice, const ffd_bounds *box, int a, size_t layer);

/* turns: the places are angles, to be written in ascending order. */
static void write_direction(const ffd_lattice *lattice, const ffd_bounds *box, int a, place_function *place,
                            bool turns, json_text *json)
{
    double before = -HUGE_VAL;
    if (lattice->size[a] > MOST_LAYERS) {
        ffd_json_null(json, direction[a]);
        return;
    }
    ffd_json_array(json, direction[a], true);
    for (size_t i = 0; i < lattice->size[a]; i++) {
        const double at = place(lattice, box, a, i);
        before = turns && at < before ? at + 360 * ceil_of((before - at) / 360) : at;
        ffd_json_number(json, NULL, before);
    }
    ffd_json_end(json, ']');
}

static void write_places(const ffd_lattice *lattice, const ffd_bounds *box, const char *key,
                         place_function *place, json_text *json)
{
    ffd_json_object(json, key, false);
    for (int a = 0; a < 3; a++)
        write_direction(lattice, box, a, place, place == cylinder_place && a == 1, json);
    ffd_json_end(json, '}');
}

static size_t count_beyond(const ffd_lattice *lattice, int a)
{
    size_t count = 0;
    for (size_t i = 0; i < lattice->size[a]; i++) {
        const double fraction = fraction_of(lattice, a, i);
        count += fraction < -ON_THE_SIDE || fraction > 1 + ON_THE_SIDE;
    }
    return count;
}

/* Writes the number of layers beyond the box, if there are any. */
static void write_beyond(const ffd_lattice *lattice, json_text *json)
{
    const size_t beyond[3] = {count_beyond(lattice, 0), count_beyond(lattice, 1), count_beyond(lattice, 2)};
    if (beyond[0] + beyond[1] + beyond[2] == 0)
        return;
    ffd_json_object(json, "layers_beyond_the_box", false);
    for (int a = 0; a < 3; a++)
        ffd_json_count(json, direction[a], beyond[a]);
    ffd_json_end(json, '}');
    ffd_json_string(
        json, "note",
        lattice->spec->weights
            ? "control points stand beyond the box: their knots are not clamped. Weights that differ pull "
              "the "
              "volume's border away from that of the box"
            : "control points stand beyond the box that the volume covers: their knots are not clamped");
}

void ffd_info_layers(const ffd_lattice *lattice, const ffd_bounds *box, json_text *json)
{
    switch (lattice->spec->rest) {
    case SPEC_BOX:
    case SPEC_BOX_MESH:
        write_places(lattice, box, box->min[0] <= box->max[0] ? "layers" : "layer_fractions", box_place,
                     json);
        write_beyond(lattice, json);
        break;
    case SPEC_CYLINDER:
        if (!lattice->rest) {
            ffd_json_null(json, "layers");
            break;
        }
        write_places(lattice, box, "layers", cylinder_place, json);
        break;
    case SPEC_POINTS:
        ffd_json_null(json, "layers");
        break;
    }
}
