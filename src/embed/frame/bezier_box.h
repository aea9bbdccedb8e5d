/* bezier_box.h - the volume of a lattice over a span cell, or a part of it, in Bezier form, with its hulls.

   The equation is F(t) = A(t) - p W(t) = 0 with A = sum h P B, W = sum h B (without weights h = 1 and W = 1).
   Its roots are those of C(t) = p, but F is a polynomial for a rational volume too. */
#ifndef FFD_EMBED_FRAME_BEZIER_BOX_H
#define FFD_EMBED_FRAME_BEZIER_BOX_H

#include "embed/frame/box_tree.h"
#include "spline/knots.h"

#define BEZIER_COMPONENTS 4 /* h P (3) and h */

typedef struct bezier_box {
    int order[3];
    bool rational;
    double lo[3], hi[3];  /* the part of the cell, which is [0,1]^3; multiples of powers of 1/2, exact */
    double *coefficients; /* ffd_bezier_size values: BEZIER_COMPONENTS for each point, u fastest */
} bezier_box;

/* Returns the number of control points of a box of this order. */
size_t ffd_bezier_count(const int order[3]);
/* Returns the number of doubles of its coefficients. */
size_t ffd_bezier_size(const int order[3]);

/* Returns the stride from a point to the next in direction a, in points. */
static inline size_t ffd_bezier_stride(const int order[3], int a)
{
    return a == 0 ? 1 : a == 1 ? (size_t)order[0] : (size_t)order[0] * (size_t)order[1];
}

/* Converts the control points h P, h of a cell (box->coefficients, u fastest) to its Bezier form, in place.
   matrix[a]: the extraction matrix of the span (ffd_bezier_extraction). order and rational must be set; lo
   and hi are set to the whole cell. */
void ffd_bezier_extract(bezier_box *box, const double *const matrix[3]);

/* De Casteljau's algorithm at 1/2 (NURBS Book 1.4) for several rows of `order` points at once: point i of all
   rows together is `inner` consecutive numbers. The upper halves replace the rows (high): after step k the
   points hold level k, and the first of them is point k of the lower halves (low). */
void ffd_bezier_halve_lines(size_t order, size_t inner, double *low, double *high);

/* Splits a box in direction a. lower and upper have their own coefficients; upper may use those of box. */
void ffd_bezier_halve(const bezier_box *box, int a, bezier_box *lower, bezier_box *upper);

/* Returns bounds of C over the box: those of the control points A_i / W_i. */
bounds ffd_bezier_hull(const bezier_box *box);
/* Finds the least and the greatest weight. */
void ffd_bezier_weights(const bezier_box *box, double *least, double *greatest);

/* Returns the direction in which the box has the greatest extent in space. */
int ffd_bezier_widest(const bezier_box *box);

/* Returns bounds of F over the box for one p. */
bounds ffd_bezier_equation_hull(const bezier_box *box, const double p[3]);
/* Returns bounds of Y F over the box for one p. */
bounds ffd_bezier_image(const bezier_box *box, const double inverse[9], const double p[3]);

#endif
