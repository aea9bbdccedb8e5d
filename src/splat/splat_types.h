/* splat_types.h - Gaussian splats and rotations. */
#ifndef FFD_SPLAT_SPLAT_TYPES_H
#define FFD_SPLAT_SPLAT_TYPES_H

#include <stdbool.h>

/* How a file stores the scales of splats. */
typedef struct splat_form {
    bool is_logarithmic; /* scales are natural logarithms of standard deviations; false: standard
                            deviations */
    bool is_flat;        /* disks, without a third scale */
    int degree;          /* degree of the spherical harmonics to be rotated; 0: none */
} splat_form;

/* An ellipsoid with the covariance R S S R^T: R the rotation matrix, S the diagonal matrix of scales. */
typedef struct splat_ellipsoid {
    double rotation[4]; /* a quaternion w, x, y, z of any length */
    double scale[3];
} splat_ellipsoid;

/* A rotation of directions. */
typedef struct splat_turn {
    double quaternion[4]; /* unit length, w >= 0 */
    bool is_turn;         /* false: the identity, without reflection */
    bool is_mirrored;     /* directions are rotated and then reversed */
} splat_turn;

typedef enum splat_outcome {
    SPLAT_KEPT,      /* F is the identity */
    SPLAT_CARRIED,   /* transformed by F */
    SPLAT_FLATTENED, /* transformed by F, which is not invertible: a scale has the size of rounding */
    SPLAT_BROKEN     /* its rotation or scale, or F, is not finite: unchanged */
} splat_outcome;

#endif
