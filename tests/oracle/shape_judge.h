/* shape_judge.h - what the oracle expects of a point in a lattice, and whether the library says so. */
#ifndef FFD_TESTS_SHAPE_JUDGE_H
#define FFD_TESTS_SHAPE_JUDGE_H

#include "sample.h"

enum { JUDGE_POINTS = 64 };

/* A lattice under test, what it is measured with, and the points of one call. */
typedef struct judge {
    trial *t;
    const sample *s;
    ffd_lattice *lattice;
    ffd_locator *locator;
    oracle_volume volume; /* seen from origin, so that long double holds thin and far lattices too */
    long double origin[3], lo[3], hi[3];
    long double most_det; /* the largest |det J| of a grid */
    int sign;             /* of the signed volume */
    double xyz[3 * JUDGE_POINTS];
    ffd_location found[JUDGE_POINTS];
    int count;
    long seen[FFD_VERTEX_STATUS_COUNT], left_out, judged;
} judge;

/* Parses the sample and prepares the search. */
bool judge_open(judge *j, trial *t, sample *s);
void judge_close(judge *j);

/* Adds C(uvw), rounded to double; a point within the bounds of the control points, grown by a tenth; C(uvw)
   moved by up to so much of the extents. */
void judge_add_known(judge *j, const long double uvw[3]);
void judge_add_within(judge *j, draw *random);
void judge_add_near(judge *j, draw *random, const long double uvw[3], double distance);
/* A point far from the control points. */
void judge_add_far(judge *j, draw *random);
/* The point so many tolerances (src/maths.md 6.6) out of face u_a = face[a], opposite to C(face). */
void judge_add_beside(judge *j, const long double face[3], int a, long double tolerance_count);
bool judge_find(judge *j);

/* Judges found[i] by all roots that the oracle finds: none, one or several; the tie rule. Left out is a point
   whose count depends on rounding: near the border, or near a fold. known: a root that the oracle must find,
   or NULL. */
void judge_counted(judge *j, int i, const long double known[3]);

/* Expects the status and u,v,w next to this root, and equal to it in the directions of exact (may be NULL).
   Left out is a point that rounding took away from the root, or to which a range of roots would do. */
void judge_expect(judge *j, int i, int status, const long double uvw[3], const bool exact[3]);

/* Expects inside or singular, the latter perhaps without u,v,w, next to this root. Left out is a point that
   rounding took out of the volume. */
void judge_next_to_singular(judge *j, int i, const long double known[3]);

/* Expects that a point of judge_add_beside is outside from 2 tolerances on, inside up to half of one. */
void judge_beside(judge *j, int i, const long double face[3], int a);

/* Expects outside for no evaluation. */
void judge_far(judge *j, int i);

/* The bits of every point alone, twice, shuffled, and among strangers. */
void judge_order(judge *j, draw *random);

#endif
