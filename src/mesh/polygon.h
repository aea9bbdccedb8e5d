/* polygon.h - the normal, area and angles of a polygon in space. */
#ifndef FFD_MESH_POLYGON_H
#define FFD_MESH_POLYGON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Computes the normal of a polygon with Newell's method. It is not a unit vector: differences to the first
   corner are divided by the largest of them, *extent (may be NULL), so that nothing overflows; the area is
   |normal| extent^2 / 2. corners: count (>= 1) indices of points in xyz, 3 doubles each. Returns false if the
   area is 0 to rounding, or a corner is not finite. */
bool ffd_polygon_normal(const double *xyz, const uint32_t *corners, size_t count, double normal[3],
                        double *extent);

/* Computes the interior angles of a polygon with a given normal, in radians, 0 to 2 pi, into angles[count].
   Consecutive corners at the same position count as one corner, whose angle is divided equally among them.
   scratch: count elements. */
void ffd_polygon_angles(const double *xyz, const uint32_t *corners, size_t count, const double normal[3],
                        size_t *scratch, double *angles);

#ifdef __cplusplus
}
#endif

#endif
