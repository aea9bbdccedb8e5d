#include "lattice/shapes.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/vector/vec.h"
#include "lattice/lattice.h"

/* A side below this fraction of the diagonal counts as flat: it is the rounding of equal coordinates, or the
   volume would be too thin for a stable inversion. It is widened about its middle to FLAT_WIDTH of the
   diagonal, which is enough for moves to act on, and small compared with the mesh. */
#define FLAT_SIDE 1e-9
#define FLAT_WIDTH 0.01

/* Returns the diagonal. If the bounds are a single point to rounding, returns the magnitude of its
   coordinates, or 1 if they are 0. */
static double diagonal_of(const double min[3], const double max[3])
{
    double side[3], size = 0;
    for (int c = 0; c < 3; c++) {
        side[c] = max[c] - min[c];
        size = maximum_number(size, maximum_number(fabs(min[c]), fabs(max[c])));
    }
    const double diagonal = vec_length(side);
    if (diagonal > FLAT_SIDE * size)
        return diagonal;
    return size > 1 ? size : 1;
}

ffd_status ffd_shape_grow_box(const double min[3], const double max[3], const double margin[3],
                              double grown_min[3], double grown_max[3], ffd_error *error)
{
    const double diagonal = diagonal_of(min, max);
    for (int c = 0; c < 3; c++) {
        if (!(min[c] <= max[c]) || !isfinite(max[c] - min[c]))
            return ffd_fail(error, FFD_E_INVALID, "no lattice fits around bounds from %s to %s along %c",
                            ffd_number_text(min[c]).text, ffd_number_text(max[c]).text, "xyz"[c]);
        const double side = max[c] - min[c];
        const bool flat = !(side > FLAT_SIDE * diagonal);
        const double half = flat ? 0.5 * FLAT_WIDTH * diagonal : 0;
        const double out = margin[c] * (flat ? FLAT_WIDTH * diagonal : side);
        grown_min[c] = (flat ? 0.5 * min[c] + 0.5 * max[c] - half : min[c]) - out;
        grown_max[c] = (flat ? 0.5 * min[c] + 0.5 * max[c] + half : max[c]) + out;
        if (!isfinite(grown_max[c] - grown_min[c]))
            return ffd_fail(error, FFD_E_INVALID, "a box from %s to %s along %c is too large for a double",
                            ffd_number_text(grown_min[c]).text, ffd_number_text(grown_max[c]).text, "xyz"[c]);
    }
    return FFD_OK;
}

double ffd_shape_fraction(const knot_vector *knots, size_t point, ffd_spacing spacing)
{
    if (spacing == FFD_SPACING_UNIFORM)
        return (double)point / (double)(knots->points - 1);
    /* Sums differences of knots, so that a common offset of the knots costs no digits. */
    const double first = ffd_knots_first(knots), length = ffd_knots_last(knots) - first;
    double sum = 0;
    for (int k = 1; k <= knots->degree; k++)
        sum += knots->t[point + (size_t)k] - first;
    return sum / knots->degree / length;
}

bool ffd_shape_is_clamped(const knot_vector *knots)
{
    const double *const t = knots->t;
    const size_t n = knots->functions, d = (size_t)knots->degree;
    return !ffd_knots_closed(knots) && t[0] == t[d] && t[n] == t[n + d];
}

void ffd_shape_box_region(const double min[3], const double max[3], const double axes[9], rest_region *region)
{
    for (int c = 0; c < 3; c++) {
        region->origin[c] = axes[c] * min[0] + axes[3 + c] * min[1] + axes[6 + c] * min[2];
        for (int a = 0; a < 3; a++)
            region->frame[3 * c + a] = axes[3 * a + c] * (max[a] - min[a]);
    }
}

static void fill_box(const ffd_lattice *lattice, double *const along[3], const double axes[9], double *points)
{
    double *p = points;
    for (size_t k = 0; k < lattice->size[2]; k++)
        for (size_t j = 0; j < lattice->size[1]; j++)
            for (size_t i = 0; i < lattice->size[0]; i++, p += 3)
                for (int c = 0; c < 3; c++)
                    p[c] = axes[c] * along[0][i] + axes[3 + c] * along[1][j] + axes[6 + c] * along[2][k];
}

ffd_status ffd_shape_box(const ffd_lattice *lattice, const double min[3], const double max[3],
                         const double axes[9], ffd_spacing spacing, double *points, ffd_error *error)
{
    for (int a = 0; a < 3; a++)
        if (spacing == FFD_SPACING_UNIFORM && !ffd_shape_is_clamped(&lattice->knots[a]))
            return ffd_fail(error, FFD_E_INVALID,
                            "uniform spacing needs clamped knots, which direction %c does not have",
                            "uvw"[a]);
    double *const block = ffd_alloc(lattice->size[0] + lattice->size[1] + lattice->size[2], sizeof *block);
    if (!block)
        return ffd_fail_memory(error);
    double *const along[3] = {block, block + lattice->size[0], block + lattice->size[0] + lattice->size[1]};
    for (int a = 0; a < 3; a++)
        for (size_t i = 0; i < lattice->size[a]; i++)
            along[a][i] =
                ffd_shape_between(min[a], max[a], ffd_shape_fraction(&lattice->knots[a], i, spacing));
    fill_box(lattice, along, axes, points);
    ffd_free(block);
    return FFD_OK;
}
