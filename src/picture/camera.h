/* camera.h - the camera of a picture: a parallel projection. */
#ifndef FFD_PICTURE_CAMERA_H
#define FFD_PICTURE_CAMERA_H

#include <ffd/job.h>
#include <stdbool.h>
#include <stddef.h>

/* Unit vectors in world space. */
typedef struct camera {
    double right[3], up[3];
    double back[3]; /* from the scene to the eye */
} camera;

/* The map from world space to a panel, in pixels: x to the right, y downwards, z away from the eye. */
typedef struct projection {
    camera camera;
    double scale;     /* pixels for a world unit */
    double offset[3]; /* offset of x, y, z in pixels */
} projection;

/* Turns a direction from axes in which y points upwards to those of a scene in which `up` does: turned about
   x for z upwards, about z for x upwards. */
void ffd_camera_turn(ffd_up up, double direction[3]);
/* Fills the direction from the scene to the eye of a named side: front (from +z where y points upwards),
   back, left (from -x), right, top, bottom. Returns false for another name. */
bool ffd_camera_side(const char *name, ffd_up up, double direction[3]);
/* Makes the camera for a direction from the scene to the eye, in the axes of the scene. Returns false if it
   is not a direction. */
bool ffd_camera_from(const double direction[3], ffd_up up, camera *result);
/* Makes the camera that looks from the right, above and in front. */
camera ffd_camera_iso(ffd_up up);

/* Extends bounds along right, up and back by points in world space; points that are not finite are
   ignored. */
void ffd_camera_widen(const camera *from, const double *points, size_t count, ffd_bounds *seen);

/* Returns the projection that fits bounds along right, up and back into a panel of this size with its middle
   at (x, y). */
projection ffd_camera_fit(const camera *from, const ffd_bounds *seen, double x, double y, double width,
                          double height);

/* Projects a point to pixels. The result may be not finite. */
static inline void projection_apply(const projection *by, const double point[3], double seen[3])
{
    const double *const r = by->camera.right, *const u = by->camera.up, *const b = by->camera.back;
    const double x = point[0], y = point[1], z = point[2], s = by->scale;
    seen[0] = by->offset[0] + s * (r[0] * x + r[1] * y + r[2] * z);
    seen[1] = by->offset[1] - s * (u[0] * x + u[1] * y + u[2] * z);
    seen[2] = by->offset[2] - s * (b[0] * x + b[1] * y + b[2] * z);
}

#endif
