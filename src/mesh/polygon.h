/* polygon.h - the direction, size and angles of a polygon in space. */
#ifndef FFD_MESH_POLYGON_H
#define FFD_MESH_POLYGON_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* A polygon's normal by Newell's sum, of no particular length: differences to the first corner are divided by
   the largest of them, *extent (NULL: not wanted), so that nothing overflows: the area is |normal| extent^2 /
   2. corners: count (at least 1) numbers of points, 3 doubles each. False where the polygon has no area
   beyond what the coordinates' rounding can make, or a corner is not finite. */
bool ffd_polygon_normal(const double *xyz, const uint32_t *corners, size_t count, double normal[3],
                        double *extent);

/* The interior angles of a polygon with the normal given, radians, 0 to 2 pi, into angles[count].
   Neighbouring corners at one position count as one corner, whose angle they share equally. scratch:
   memory for count numbers. */
void ffd_polygon_angles(const double *xyz, const uint32_t *corners, size_t count, const double normal[3],
                        size_t *scratch, double *angles);

#ifdef __cplusplus
}
#endif

#endif
