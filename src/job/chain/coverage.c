#include "job/chain/coverage.h"
#include "lattice/lattice.h"
#include "lattice/spec.h"
#include "mesh/bounds.h"
#include <stdio.h>

/* Samples of the domain along each direction. */
#define SAMPLES 17

static bool is_clamped(const knot_vector *knots)
{
    return knots->t[0] == ffd_knots_first(knots) &&
           knots->t[knots->functions + (size_t)knots->degree] == ffd_knots_last(knots);
}

static bool covers_less(const ffd_lattice *lattice)
{
    if (lattice->spec->rest != SPEC_POINTS)
        return false;
    for (int a = 0; a < 3; a++)
        if (!ffd_knots_closed(&lattice->knots[a]) && !is_clamped(&lattice->knots[a]))
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
