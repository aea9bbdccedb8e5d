/* volume_sample.h - random lattices whose rest volume is known to hold every point once. */
#ifndef FFD_TESTS_VOLUME_SAMPLE_H
#define FFD_TESTS_VOLUME_SAMPLE_H

#include "sample.h"

typedef enum volume_scale {
    SCALE_PLAIN,
    SCALE_THIN, /* one side 1e-6 of the others */
    SCALE_HUGE, /* 1e9 */
    SCALE_TINY, /* 1e-6 */
    SCALE_FAR,  /* 1e6 sides from the origin */
    SCALE_COUNT
} volume_scale;

/* Control points o + M (x + S): x the Greville grid over [0,1]^3, M a scaled rotation (or none), sometimes a
   mirror. S is a random displacement with |dS/dx| <= strength < 1 in the row-sum norm, which the control
   points of its derivative prove: x + S is then one to one. Strength 0: an affine lattice. */
void sample_warped(sample *s, draw *random, volume_scale scale, bool rotated, double strength);

/* Control points (x_i, y_j, z_k) with rising or falling sequences. */
void sample_separable(sample *s, draw *random, volume_scale scale);

/* A bar along an arc of so many degrees about z, radius 1 to 2 (u), v along the arc. Past 360 it overlaps
 * itself. */
void sample_arc(sample *s, draw *random, double degrees);

/* A ring about a random axis, v closed (the axes of s must say so), each control point moved a little.
 */
void sample_ring(sample *s, draw *random);

/* u,v,w in the domain: inside, and now and then on knots, faces, edges, corners. */
void sample_parameters(const sample *s, draw *random, long double uvw[3]);

/* Whether det J has one sign, not 0, on a grid of 4 parameters in each span. */
bool volume_has_one_sign(const oracle_volume *volume);

#endif
