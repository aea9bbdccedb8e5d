/* probe.h - a lattice, measured for what rounding can do to it, and the points that it is tried with. */
#ifndef FFD_TESTS_FUZZ_PROBE_H
#define FFD_TESTS_FUZZ_PROBE_H

#include "precise.h"

typedef struct probe {
    const ffd_lattice *lattice;
    double lo[3], hi[3]; /* the domain */
    double centre[3];    /* of the bounds of the control points */
    double extent[3];    /* from there to the bounds */
    double magnitude[3]; /* max |P_a| */
    double weight_ratio; /* greatest rest weight / least */
    double u_error[3];   /* what rounding u,v,w to doubles, and the knots to the domain's size, can do */
    bool is_resolved;    /* all spans are much wider than that */
    bool is_ordinary;    /* no size is near the ends of the range of doubles, no weight beyond reason */
} probe;

void probe_measure(const ffd_lattice *lattice, probe *made);

/* The nearest u,v,w of the domain to these fractions of it. */
void probe_uvw(const probe *of, const double fraction[3], double uvw[3]);

/* sample is that at uvw of the volume. error[r]: how far C_r may be from the point that the library means by
   uvw, and by its own sums. False where a span at uvw is too narrow to say. */
bool probe_error(const probe *of, ffd_volume volume, const double uvw[3], const precise_sample *sample,
                 double error[3]);

/* Points that were made by evaluating C at known u,v,w, and any others. */
#define PROBE_MOST 96
typedef struct probe_point {
    double p[3];
    bool is_known;
    double uvw[3]; /* with C(uvw) = p, where known */
} probe_point;

/* The points of the input's tail (size bytes of raw doubles), or a fixed set, and the known ones. */
size_t probe_points(const probe *of, const unsigned char *tail, size_t size, probe_point points[PROBE_MOST]);

#endif
