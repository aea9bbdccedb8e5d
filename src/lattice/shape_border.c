#include "lattice/shape_border.h"
#include "base/vector/trig.h"
#include "base/vector/vec.h"
#include "lattice/border.h"
#include "lattice/shapes.h"
#include "lattice/spec.h"
#include <float.h>
#include <math.h>

/* Distances below this part of the lattice's size are rounding; so are those below this multiple of eps times
   the largest coordinate. */
#define ROUNDING 1e-9
#define ROUNDINGS 64
/* Samples of a cylinder's inner and outer surface along v and along w, at most. */
#define SAMPLES 64
#define SAMPLES_A_SPAN 8

/* Returns the largest distance of the control points of a face from the plane of all p with
   normal . (p - point) = 0; the normal is a unit vector. */
static double off_plane(const ffd_lattice *lattice, int direction, int end, const double normal[3],
                        const double point[3])
{
    const size_t *const size = lattice->size;
    const int across = (direction + 1) % 3, along = (direction + 2) % 3;
    size_t index[3] = {0, 0, 0};
    border_face face;
    double most = 0;
    ffd_border_face(lattice, FFD_VOLUME_REST, direction, end, &face);
    for (index[across] = 0; index[across] < size[across]; index[across]++)
        for (index[along] = 0; index[along] < size[along]; index[along]++) {
            double of[4];
            ffd_border_point(&face, index, point, of);
            most = larger_of(most, fabs(vec_dot(normal, of)) / of[3]);
        }
    return most;
}

static double off_box(const ffd_lattice *lattice)
{
    const lattice_spec *const spec = lattice->spec;
    double side[2][3], most = 0;
    for (int a = 0; a < 3; a++) {
        side[0][a] = spec->box_min[a];
        side[1][a] = spec->box_max[a];
    }
    if (spec->rest == SPEC_BOX_MESH &&
        ffd_shape_grow_box(lattice->fitted.min, lattice->fitted.max, spec->margin, side[0], side[1], NULL))
        return 0;
    for (int a = 0; a < 3; a++)
        for (int end = 0; end < 2 && !ffd_knots_closed(&lattice->knots[a]); end++) {
            const double *const normal = spec->box_axes + 3 * a;
            const double point[3] = {side[end][a] * normal[0], side[end][a] * normal[1],
                                     side[end][a] * normal[2]};
            most = larger_of(most, off_plane(lattice, a, end, normal, point));
        }
    return most;
}

/* The bottom and the top of a cylinder. */
static double off_ends(const ffd_lattice *lattice)
{
    const lattice_spec *const spec = lattice->spec;
    double most = 0;
    for (int end = 0; end < 2 && !ffd_knots_closed(&lattice->knots[2]); end++) {
        double point[3];
        for (int c = 0; c < 3; c++)
            point[c] = spec->center[c] + (end ? 0.5 : -0.5) * spec->height * spec->axis[c];
        most = larger_of(most, off_plane(lattice, 2, end, spec->axis, point));
    }
    return most;
}

/* The faces at the first and the last angle. */
static double off_angles(const ffd_lattice *lattice)
{
    const lattice_spec *const spec = lattice->spec;
    double side[3], normal[3], most = 0;
    vec_cross(spec->axis, spec->zero, side);
    for (int end = 0; end < 2 && !ffd_knots_closed(&lattice->knots[1]); end++) {
        double sine, cosine;
        ffd_sincos_degrees(spec->angle[end], &sine, &cosine);
        for (int c = 0; c < 3; c++)
            normal[c] = cosine * side[c] - sine * spec->zero[c];
        most = larger_of(most, off_plane(lattice, 1, end, normal, spec->center));
    }
    return most;
}

static int sample_count(const knot_vector *knots)
{
    return knots->span_count < SAMPLES / SAMPLES_A_SPAN ? SAMPLES_A_SPAN * (int)knots->span_count : SAMPLES;
}

static double sample(const knot_vector *knots, int i, int count)
{
    const double share = (double)i / count;
    return (1 - share) * ffd_knots_first(knots) + share * ffd_knots_last(knots);
}

static double distance_from_axis(const ffd_lattice *lattice, const double uvw[3])
{
    const lattice_spec *const spec = lattice->spec;
    double p[3], across[3];
    ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, NULL);
    for (int c = 0; c < 3; c++)
        p[c] -= spec->center[c];
    vec_cross(spec->axis, p, across);
    return vec_length(across);
}

/* How far the inner and the outer surface are from the radii that the volume is to reach. */
static double short_of_radii(const ffd_lattice *lattice)
{
    const knot_vector *const knots = lattice->knots;
    const double *const radius = lattice->spec->radius;
    const int rows = sample_count(&knots[1]), layers = sample_count(&knots[2]);
    double most = 0;
    for (int k = 0; k <= layers && !ffd_knots_closed(&knots[0]); k++)
        for (int j = 0; j <= rows; j++) {
            double uvw[3] = {ffd_knots_first(&knots[0]), sample(&knots[1], j, rows),
                             sample(&knots[2], k, layers)};
            most = larger_of(most, distance_from_axis(lattice, uvw) - radius[0]);
            uvw[0] = ffd_knots_last(&knots[0]);
            most = larger_of(most, radius[1] - distance_from_axis(lattice, uvw));
        }
    return most;
}

static bool has_weights(const ffd_lattice *lattice)
{
    for (size_t i = 1; lattice->rest_weights && i < lattice->count; i++)
        if (lattice->rest_weights[i] != lattice->rest_weights[0])
            return true;
    return false;
}

double ffd_lattice_off_shape(const ffd_lattice *lattice)
{
    double off = 0, size = 0;
    if (!lattice->spec || !lattice->rest || !has_weights(lattice))
        return 0;
    switch (lattice->spec->rest) {
    case SPEC_BOX:
    case SPEC_BOX_MESH:
        off = off_box(lattice);
        break;
    case SPEC_CYLINDER:
        off = larger_of(off_ends(lattice), larger_of(off_angles(lattice), short_of_radii(lattice)));
        break;
    case SPEC_POINTS:
        return 0;
    }
    for (size_t i = 0; i < 3 * lattice->count; i++)
        size = larger_of(size, fabs(lattice->rest[i]));
    return off > ROUNDING * lattice->diagonal + ROUNDINGS * DBL_EPSILON * size ? off : 0;
}
