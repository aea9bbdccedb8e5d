#include "lattice/cylinder.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "lattice/lattice.h"
#include "lattice/ring.h"
#include "lattice/shapes.h"
#include "lattice/spec.h"

/* The volume is C(u,v,w) = center + rho(u) c(v) + z(w) axis. c is a curve round the origin with control
   points on the unit circle; rho and z are linear (control values at the Greville abscissae). With least <=
   |c(v)| <= greatest for all v (ring.h), control rings of radius r0/greatest and r1/least at the ends of u
   make the volume cover the radii r0 to r1 at every v, and c passes every angle of the turn. This also holds
   for weights that are a product f(u,w) g(v): g enters c, and clamped u and w keep their ends for any f. For
   other weights the rings are placed as without weights, and the author of the file is responsible for what
   they cover. */

/* A ring that comes nearer to the axis than this fraction of the radius of its control points is refused,
   because its volume would have to be larger by the reciprocal. */
#define LEAST_RADIUS (1.0 / 32)
#define WEIGHT_TOLERANCE 1e-9

/* Finds the factor g(v) of the weights. Returns false if they are not a product f(u,w) g(v). */
static bool weights_along_v(const lattice_spec *spec, ring_point *points)
{
    const size_t *const size = spec->size;
    for (size_t j = 0; j < size[1]; j++)
        points[j].weight = spec->weights ? spec->weights[size[0] * j] / spec->weights[0] : 1;
    for (size_t i = 0; spec->weights && i < spec->count; i++) {
        const size_t j = i / size[0] % size[1];
        const double product = spec->weights[i - size[0] * j] * points[j].weight;
        if (!(fabs(spec->weights[i] - product) <= WEIGHT_TOLERANCE * product))
            return false;
    }
    return true;
}

static ffd_status place_ring(const ffd_lattice *lattice, const lattice_spec *spec, ring_point *points,
                             double radius[2], ffd_error *error)
{
    const knot_vector *const knots = &lattice->knots[1];
    if (!weights_along_v(spec, points))
        for (size_t j = 0; j < knots->points; j++)
            points[j].weight = 1;
    TRY(ffd_ring_rotate(knots, spec->angle[0], spec->angle[1], ffd_spec_full_turn(spec), points, error));
    double least, greatest;
    ffd_ring_radius(knots, points, &least, &greatest);
    if (!(least >= LEAST_RADIUS))
        return ffd_fail(error, FFD_E_INVALID,
                        "%zu control points of degree %d along v are too few for this angle of the cylinder",
                        knots->points, knots->degree);
    /* A curve with control points on the circle stays within it; a value above 1 is rounding. */
    radius[0] = spec->radius[0] / minimum_number(greatest, 1);
    radius[1] = spec->radius[1] / least;
    return FFD_OK;
}

static void fill_cylinder(const ffd_lattice *lattice, const lattice_spec *spec, const ring_point *ring,
                          const double radius[2], double *points)
{
    double side[3], *p = points;
    vec_cross(spec->axis, spec->zero, side);
    for (size_t k = 0; k < lattice->size[2]; k++) {
        const double z = ffd_shape_between(-0.5 * spec->height, 0.5 * spec->height,
                                           ffd_shape_fraction(&lattice->knots[2], k, FFD_SPACING_GREVILLE));
        for (size_t j = 0; j < lattice->size[1]; j++)
            for (size_t i = 0; i < lattice->size[0]; i++, p += 3) {
                const double rho = ffd_shape_between(
                    radius[0], radius[1], ffd_shape_fraction(&lattice->knots[0], i, FFD_SPACING_GREVILLE));
                const double x = rho * ring[j].x, y = rho * ring[j].y;
                for (int c = 0; c < 3; c++)
                    p[c] = spec->center[c] + (x * spec->zero[c] + y * side[c] + z * spec->axis[c]);
            }
    }
}

ffd_status ffd_shape_cylinder(const ffd_lattice *lattice, const lattice_spec *spec, double *points,
                              ffd_error *error)
{
    ring_point *const ring = ffd_alloc(lattice->size[1], sizeof *ring);
    if (!ring)
        return ffd_fail_memory(error);
    double radius[2] = {0, 0};
    ffd_status status;
    TRY_END(place_ring(lattice, spec, ring, radius, error));
    fill_cylinder(lattice, spec, ring, radius, points);
end:
    ffd_free(ring);
    return status;
}

void ffd_shape_cylinder_region(const lattice_spec *spec, rest_region *region)
{
    for (int c = 0; c < 3; c++) {
        const double along = spec->axis[c];
        const double across = sqrt(maximum_number(0, 1 - along * along));
        const double half = spec->radius[1] * across + 0.5 * spec->height * fabs(along);
        region->origin[c] = spec->center[c] - half;
        for (int a = 0; a < 3; a++)
            region->frame[3 * c + a] = a == c ? 2 * half : 0;
    }
}
