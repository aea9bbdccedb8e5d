#include "job/chain/coverage.h"
#include "lattice/lattice.h"
#include "lattice/shape_border.h"
#include "lattice/shapes.h"
#include "lattice/spec.h"
#include "mesh/bounds.h"
#include <stdio.h>

/* Samples of the domain along each direction. */
#define SAMPLES 17

/* Returns whether the knots of a direction leave the volume short of its outermost control points. */
static bool is_open(const knot_vector *knots)
{
    return !ffd_knots_closed(knots) && !ffd_shape_is_clamped(knots);
}

static bool covers_less(const ffd_lattice *lattice)
{
    if (lattice->spec->rest != SPEC_POINTS)
        return false;
    for (int a = 0; a < 3; a++)
        if (is_open(&lattice->knots[a]))
            return true;
    return false;
}

static double sample(const knot_vector *knots, int i)
{
    const double t = (double)i / (SAMPLES - 1);
    return (1 - t) * ffd_knots_first(knots) + t * ffd_knots_last(knots);
}

static ffd_bounds volume_bounds(const ffd_lattice *lattice)
{
    ffd_bounds box = ffd_bounds_empty();
    for (int n = 0; n < SAMPLES * SAMPLES * SAMPLES; n++) {
        const int index[3] = {n % SAMPLES, n / SAMPLES % SAMPLES, n / (SAMPLES * SAMPLES)};
        double uvw[3], p[3];
        for (int a = 0; a < 3; a++)
            uvw[a] = sample(&lattice->knots[a], index[a]);
        ffd_lattice_evaluate(lattice, FFD_VOLUME_REST, uvw, p, NULL);
        ffd_bounds_widen(&box, p);
    }
    return box;
}

void ffd_chain_coverage(const lattice_chain *chain, char *text, size_t capacity)
{
    *text = 0;
    for (size_t l = 0; l < chain->count; l++) {
        const ffd_lattice *lattice = chain->links[l].lattice;
        if (!covers_less(lattice))
            continue;
        const ffd_bounds box = volume_bounds(lattice);
        snprintf(
            text, capacity,
            "%s covers only x %.7g to %.7g, y %.7g to %.7g, z %.7g to %.7g, less than its control points "
            "reach: \"clamped\" knots or a rest \"box\" cover all",
            lattice->spec->name, box.min[0], box.max[0], box.min[1], box.max[1], box.min[2], box.max[2]);
        return;
    }
}

void ffd_chain_places(const lattice_chain *chain, const ffd_bounds *mesh, char *text, size_t capacity)
{
    ffd_bounds box = ffd_bounds_empty();
    *text = 0;
    if (!(mesh->min[0] <= mesh->max[0]))
        return;
    for (size_t l = 0; l < chain->count; l++) {
        const ffd_bounds one = volume_bounds(chain->links[l].lattice);
        ffd_bounds_widen(&box, one.min);
        ffd_bounds_widen(&box, one.max);
    }
    snprintf(text, capacity, "; %s from %g %g %g to %g %g %g, the mesh from %g %g %g to %g %g %g",
             chain->count == 1 ? "the lattice lies" : "the lattices lie", box.min[0], box.min[1], box.min[2],
             box.max[0], box.max[1], box.max[2], mesh->min[0], mesh->min[1], mesh->min[2], mesh->max[0],
             mesh->max[1], mesh->max[2]);
}

/* Writes why weights pull the border of the volume away from its shape. */
static void describe_cause(const ffd_lattice *lattice, char *text, size_t capacity)
{
    char open[8] = "";
    int length = 0;
    for (int a = 0; a < 3; a++)
        if (is_open(&lattice->knots[a]))
            length +=
                snprintf(open + length, sizeof open - (size_t)length, "%s%c", *open ? ", " : "", "uvw"[a]);
    if (*open)
        snprintf(text, capacity, "weights and knots along %s that are not clamped", open);
    else
        snprintf(text, capacity, "weights that are no product f(u,w) g(v)");
}

void ffd_coverage_warn(const lattice_chain *chain, const mesh_log *log)
{
    for (size_t l = 0; l < chain->count; l++) {
        const ffd_lattice *const lattice = chain->links[l].lattice;
        const double off = ffd_lattice_off_shape(lattice);
        char cause[80];
        if (!(off > 0))
            continue;
        describe_cause(lattice, cause, sizeof cause);
        ffd_log_line(log, FFD_LOG_WARNING,
                     "the volume of %s is not its whole %s: with %s its border is up to %.3g off",
                     lattice->spec->name, lattice->spec->rest == SPEC_CYLINDER ? "cylinder" : "box", cause,
                     off);
    }
}
