/* bezier_box.h - a lattice's volume over one span cell, or a part of it, in Bezier form, and its hulls.

   The equation is F(t) = A(t) - p W(t) = 0 with A = sum h P B, W = sum h B (h = 1 and W = 1 without weights):
   its roots are those of C(t) = p, and F is a polynomial also for a rational volume. */
#ifndef FFD_EMBED_FRAME_BEZIER_BOX_H
#define FFD_EMBED_FRAME_BEZIER_BOX_H

#include "embed/frame/box_tree.h"
#include "spline/knots.h"

#define BEZIER_COMPONENTS 4 /* h P (3) and h */

typedef struct bezier_box {
    int order[3];
    bool rational;
    double lo[3], hi[3];  /* the part of the cell, whose own is [0,1]; multiples of powers of 1/2, exact */
    double *coefficients; /* ffd_bezier_size values: BEZIER_COMPONENTS a point, u fastest */
} bezier_box;

/* Control points of a box of this order. */
size_t ffd_bezier_count(const int order[3]);
/* Doubles that its coefficients take. */
size_t ffd_bezier_size(const int order[3]);

/* From a point to its neighbour along a. */
static inline size_t ffd_bezier_stride(const int order[3], int a)
{
    return a == 0 ? 1 : a == 1 ? (size_t)order[0] : (size_t)order[0] * (size_t)order[1];
}

/* From the control points h P, h of a span's basis functions (box->coefficients, u fastest) to the Bezier
   form of that cell, in place; matrix[a] is the span's ffd_bezier_extraction. order and rational must be set;
   lo and hi become those of the whole cell. */
void ffd_bezier_extract(bezier_box *box, const double *const matrix[3]);

/* De Casteljau's scheme at 1/2 (NURBS Book 1.4) for lines of `order` points side by side, `inner` consecutive
   numbers of all lines, then those of the next points. The upper halves arise in place of the lines (high):
   after step k the points from the first on hold level k, and the first of them is point k of the lower
   halves (low). */
void ffd_bezier_halve_lines(size_t order, size_t inner, double *low, double *high);

/* The halves of box across direction a; lower and upper have their own coefficients (upper may share box's).
 */
void ffd_bezier_halve(const bezier_box *box, int a, bezier_box *lower, bezier_box *upper);

/* Bounds of C over the box: those of the control points A_i / W_i. */
bounds ffd_bezier_hull(const bezier_box *box);
/* Bounds of the weights. */
void ffd_bezier_weights(const bezier_box *box, double *least, double *greatest);

/* The direction in which the box is widest in space. */
int ffd_bezier_widest(const bezier_box *box);

/* Bounds of F over the box for one p. */
bounds ffd_bezier_equation_hull(const bezier_box *box, const double p[3]);
/* Bounds of Y F over the box for one p. */
bounds ffd_bezier_image(const bezier_box *box, const double inverse[9], const double p[3]);

#endif
