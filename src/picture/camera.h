/* camera.h - from where a picture is seen: a parallel projection, y upwards. */
#ifndef FFD_PICTURE_CAMERA_H
#define FFD_PICTURE_CAMERA_H

#include <ffd/job.h>
#include <stdbool.h>
#include <stddef.h>

/* Axes of length 1 in the world. */
typedef struct camera {
    double right[3], up[3];
    double back[3]; /* from what is seen to the eye */
} camera;

/* Where the world comes to lie in a panel: x to the right, y downwards, z away from the eye, in pixels. */
typedef struct projection {
    camera camera;
    double scale;     /* pixels for a unit of the world */
    double offset[3]; /* of x, y, z in pixels */
} projection;

/* Looks from a direction: front (from +z), back, left (from -x), right, top, iso, or "x,y,z", any finite
   numbers that are not all 0. Returns false where text is none of these. */
bool ffd_camera_parse(const char *text, camera *result);
/* The camera that looks from there. Returns false where it is no direction. */
bool ffd_camera_from(const double direction[3], camera *result);

/* Widens bounds along right, up and back to hold points of the world; those that are not finite are passed
 * over. */
void ffd_camera_widen(const camera *from, const double *points, size_t count, ffd_bounds *seen);

/* The projection by which what the bounds along right, up and back hold just fills a panel, whose middle is
 * at (x, y). */
projection ffd_camera_fit(const camera *from, const ffd_bounds *seen, double x, double y, double width,
                          double height);

/* A point in pixels. It may be not finite. */
static inline void projection_apply(const projection *by, const double point[3], double seen[3])
{
    const double *const r = by->camera.right, *const u = by->camera.up, *const b = by->camera.back;
    const double x = point[0], y = point[1], z = point[2], s = by->scale;
    seen[0] = by->offset[0] + s * (r[0] * x + r[1] * y + r[2] * z);
    seen[1] = by->offset[1] - s * (u[0] * x + u[1] * y + u[2] * z);
    seen[2] = by->offset[2] - s * (b[0] * x + b[1] * y + b[2] * z);
}

#endif
