/* splat_types.h - what a Gaussian splat is, and how it turns. */
#ifndef FFD_SPLAT_SPLAT_TYPES_H
#define FFD_SPLAT_SPLAT_TYPES_H

#include <stdbool.h>

/* How a file holds the sizes of its splats. */
typedef struct splat_form {
    bool is_logarithmic; /* natural logarithms of the standard deviations; else these themselves */
    bool is_flat;        /* a disk: there is no third size */
    int degree;          /* of the spherical harmonics that turn; 0: there are none */
} splat_form;

/* The covariance is R S S R^T: R of the rotation, S of the sizes along its axes. */
typedef struct splat_ellipsoid {
    double rotation[4]; /* a quaternion w, x, y, z of any length */
    double scale[3];
} splat_ellipsoid;

/* How directions turn. */
typedef struct splat_turn {
    double quaternion[4]; /* of length 1, w not negative */
    bool is_turn;         /* false: it is the identity, and mirrors nothing */
    bool is_mirrored;     /* directions are turned, and then reversed */
} splat_turn;

typedef enum splat_outcome {
    SPLAT_KEPT,      /* F is the identity */
    SPLAT_CARRIED,   /* it follows F */
    SPLAT_FLATTENED, /* it follows F, which has no inverse: a size is only that of a rounding */
    SPLAT_BROKEN     /* it has no rotation or sizes that are numbers, or F is not a number: it stays */
} splat_outcome;

#endif
