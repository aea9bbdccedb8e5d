/* motion.h - the rigid motion, or the similarity, that takes points nearest to others in least squares
   (src/maths.md 9.8), with + - * / and square roots only. */
#ifndef FFD_BASE_VECTOR_MOTION_H
#define FFD_BASE_VECTOR_MOTION_H

#include <stdbool.h>
#include <stdint.h>

/* Sums over pairs of points x and y. Zeros at first. All pairs are added by ffd_motion_add, then
   ffd_motion_middle is called, and all pairs are added again by ffd_motion_add_product. The result depends on
   the order. */
typedef struct motion_sums {
    uint64_t count;
    bool moves;             /* some y is not its x */
    double first[3], by[3]; /* of the first pair: x, and y - x */
    double x[3], d[3];      /* sums of x - first, and of y - x - by; then the means */
    double reach[2];        /* largest coordinate of x - first, and of y - first - by */
    double size;            /* largest coordinate of all points */
    double scale[2];        /* powers of 2 that make the reaches about 1 */
    double product[9];      /* of scaled y and x relative to their means, row by row */
    double square;          /* the sum of the squares of scaled x relative to their mean */
} motion_sums;

/* x goes to x + by + gradient (x - from), where gradient is scale * rotation - I. */
typedef struct rigid_motion {
    double gradient[9], from[3], by[3];
    double rotation[9], scale;
} rigid_motion;

/* Adds a pair to the first sums. */
void ffd_motion_add(motion_sums *sums, const double x[3], const double y[3]);
/* Turns the sums into means. */
void ffd_motion_middle(motion_sums *sums);
/* Adds a pair to the products. */
void ffd_motion_add_product(motion_sums *sums, const double x[3], const double y[3]);

/* Finds the motion. uniform: a similarity. Points on a line turn by the least rotation that fits, one point
   does not turn. Where no y differs from its x, nothing moves at all. */
void ffd_motion_find(const motion_sums *sums, bool uniform, rigid_motion *motion);

/* Fills the displacement of a point. */
void ffd_motion_displace(const rigid_motion *motion, const double x[3], double delta[3]);

/* Returns the angle of the rotation in degrees, 0 to 180. */
double ffd_motion_degrees(const rigid_motion *motion);

/* Finds the singular values of a matrix, in descending order. */
void ffd_singular_values(const double m[9], double values[3]);

#endif
