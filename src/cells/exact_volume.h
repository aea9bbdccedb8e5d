/* exact_volume.h - the volume of a tetrahedron with the exact sign. */
#ifndef FFD_CELLS_EXACT_VOLUME_H
#define FFD_CELLS_EXACT_VOLUME_H

/* Returns (b - a) . ((c - a) x (d - a)), six times the volume of a tetrahedron. The sign is that of the exact
   value for these doubles, which are finite: 0 only if the four points lie in a plane. A value out of the
   range of doubles is infinite, or the least double of its sign. */
double ffd_exact_volume(const double a[3], const double b[3], const double c[3], const double d[3]);

#endif
