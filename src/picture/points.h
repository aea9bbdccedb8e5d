/* points.h - draws the points of a mesh into samples: discs, which are opaque, and Gaussian splats. */
#ifndef FFD_PICTURE_POINTS_H
#define FFD_PICTURE_POINTS_H

#include "picture/bands.h"
#include "picture/camera.h"
#include "picture/linear.h"
#include "picture/samples.h"

/* A point in the picture. A splat's weight at (x, y) from its middle falls with a x^2 + 2 b x y + c y^2. */
typedef struct placed_point {
    double at[3];            /* in pixels */
    double reach_x, reach_y; /* half the sides of its bounds */
    float a, b, c;           /* of a splat; a disc has none */
    bool is_splat;
} placed_point;

typedef struct placed_points {
    const picture_points *of;
    placed_point *list; /* of->count */
} placed_points;

/* Projects the points. Errors: FFD_E_MEMORY; there is nothing to free then. */
ffd_status ffd_points_make(const picture_points *of, const projection *by, int threads, placed_points *result,
                           ffd_error *error);
/* Frees the list and empties the struct. */
void ffd_points_free(placed_points *of);
/* The rows of a point. (A band_rows callback.) */
bool ffd_points_rows(const void *placed, size_t point, int64_t *first, int64_t *last);
/* Draws a point where it is nearer than the stored depth: a disc into the samples, a splat into their layers
   (without these as a disc of its colour, where it hides at least half). */
void ffd_points_draw(const placed_points *of, const linear_tables *tables, size_t point, samples *into);

#endif
