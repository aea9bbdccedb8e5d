/* check_folds.c - no sample contradicts "no folds", and det J < 0 at the witness of a fold. */
#include "check_folds.h"
#include "promise.h"
#include <ffd/fold.h>
#include <math.h>
#include <string.h>

/* det J at uvw, and a bound of what the library's rounding may make of it. */
typedef struct determinant {
    long double value, error;
} determinant;

static bool determinant_at(const probe *of, ffd_volume volume, const double uvw[3], determinant *det)
{
    precise_sample sample;
    double miss[3];
    precise_evaluate(of->lattice, volume, uvw, of->centre, &sample);
    det->value = precise_determinant(sample.jacobian);
    if (!of->is_resolved || !probe_error(of, volume, uvw, &sample, miss))
        return false;
    long double product = 1;
    for (int a = 0; a < 3; a++) {
        long double column = 0;
        for (int r = 0; r < 3; r++)
            column += sample.sway[3 * r + a];
        product *= column;
    }
    det->error = 1e-10L * product * of->weight_ratio * of->weight_ratio;
    return true;
}

/* The sign that det J_P has wherever it was looked at; 0 where it has both or none. */
static int sign_at_rest(const probe *of, const probe_point *points, size_t count)
{
    int sign = 0;
    for (size_t i = 0; i < count; i++) {
        determinant det;
        if (!points[i].is_known)
            continue;
        if (!determinant_at(of, FFD_VOLUME_REST, points[i].uvw, &det))
            return 0;
        const int here = det.value > det.error ? 1 : det.value < -det.error ? -1 : 0;
        if (here == 0 || here == -sign)
            return 0;
        sign = here;
    }
    return sign;
}

static void check_counts(const probe *of, const ffd_folds *folds)
{
    uint64_t cells = 1;
    for (int a = 0; a < 3; a++)
        cells *= of->lattice->knots[a].span_count;
    PROMISE(folds->cells == cells, "%llu cells, not %llu", (unsigned long long)folds->cells,
            (unsigned long long)cells);
    PROMISE(folds->folded_cells + folds->unknown_cells <= cells,
            "more cells folded and unknown than there are");
    PROMISE((folds->verdict == FFD_FOLDS_SOME) == (folds->folded_cells > 0),
            "verdict %d with %llu folded cells", (int)folds->verdict,
            (unsigned long long)folds->folded_cells);
    PROMISE(folds->verdict != FFD_FOLDS_NONE || folds->unknown_cells == 0, "no folds, but unknown cells");
    PROMISE(folds->verdict != FFD_FOLDS_UNKNOWN || folds->unknown_cells > 0, "unknown, but no cell is");
    PROMISE(folds->witness.is_there == (folds->verdict == FFD_FOLDS_SOME), "a witness %d of verdict %d",
            folds->witness.is_there, (int)folds->verdict);
    PROMISE(!isnan(folds->min_det), "min_det is not a number");
}

static void check_place(const probe *of, ffd_volume volume, const double uvw[3], const double xyz[3])
{
    precise_sample sample;
    double miss[3];
    precise_evaluate(of->lattice, volume, uvw, of->centre, &sample);
    if (!probe_error(of, volume, uvw, &sample, miss))
        return;
    for (int a = 0; a < 3; a++) {
        const long double off = fabsl(sample.point[a] + of->centre[a] - xyz[a]);
        PROMISE(off <= 16 * miss[a] + 1e-12 * (of->magnitude[a] + fabs(xyz[a])),
                "the witness's %c is %.17g, off by %.3Lg", "xyz"[a], xyz[a], off);
    }
}

static void check_witness(const probe *of, const ffd_folds *folds, int sign)
{
    determinant det;
    const double *const uvw = folds->witness.uvw;
    for (int a = 0; a < 3; a++)
        PROMISE(uvw[a] >= of->lo[a] && uvw[a] <= of->hi[a], "the witness's %c = %.17g is not in the domain",
                "uvw"[a], uvw[a]);
    PROMISE(folds->witness.det <= 0, "the witness's determinant is %g", folds->witness.det);
    PROMISE(folds->min_det <= folds->witness.det, "least determinant %g, but %g at the witness",
            folds->min_det, folds->witness.det);
    if (!of->is_ordinary)
        return;
    check_place(of, FFD_VOLUME_DEFORMED, uvw, folds->witness.xyz);
    check_place(of, FFD_VOLUME_REST, uvw, folds->witness.rest);
    if (sign != 0 && determinant_at(of, FFD_VOLUME_DEFORMED, uvw, &det))
        PROMISE(sign * det.value <= det.error,
                "a witness at %.17g, %.17g, %.17g, where the determinant is %.3Lg, rounding %.3Lg", uvw[0],
                uvw[1], uvw[2], sign * det.value, det.error);
}

/* "No folds" holds at every u,v,w that is tried. */
static void check_none(const probe *of, const probe_point *points, size_t count, int sign)
{
    for (size_t i = 0; i < count; i++) {
        determinant det;
        if (points[i].is_known && determinant_at(of, FFD_VOLUME_DEFORMED, points[i].uvw, &det))
            PROMISE(sign * det.value >= -det.error,
                    "no folds, but at %.17g, %.17g, %.17g the determinant is %.3Lg, rounding %.3Lg",
                    points[i].uvw[0], points[i].uvw[1], points[i].uvw[2], sign * det.value, det.error);
    }
}

static bool is_same(const ffd_folds *a, const ffd_folds *b)
{
    return a->verdict == b->verdict && a->cells == b->cells && a->folded_cells == b->folded_cells &&
           a->unknown_cells == b->unknown_cells && a->min_det == b->min_det &&
           a->witness.is_there == b->witness.is_there &&
           (!a->witness.is_there || (!memcmp(a->witness.uvw, b->witness.uvw, sizeof a->witness.uvw) &&
                                     !memcmp(a->witness.xyz, b->witness.xyz, sizeof a->witness.xyz) &&
                                     !memcmp(a->witness.rest, b->witness.rest, sizeof a->witness.rest) &&
                                     a->witness.det == b->witness.det));
}

void check_folds(const probe *of, const probe_point *points, size_t count)
{
    ffd_folds folds = {.struct_size = sizeof folds}, again = folds;
    ffd_error error;
    PROMISE(ffd_folds_find(of->lattice, 1, &folds, &error) == FFD_OK, "%s", error.message);
    PROMISE(ffd_folds_find(of->lattice, 3, &again, &error) == FFD_OK, "%s", error.message);
    PROMISE(is_same(&folds, &again), "three threads find other folds than one");
    check_counts(of, &folds);
    const int sign = of->is_ordinary ? sign_at_rest(of, points, count) : 0;
    if (folds.witness.is_there)
        check_witness(of, &folds, sign);
    if (folds.verdict == FFD_FOLDS_NONE)
        check_none(of, points, count, sign);
}
