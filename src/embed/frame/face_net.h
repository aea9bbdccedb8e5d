/* face_net.h - the control nets of the faces of the domain at rest, scaled, for integrals over them. */
#ifndef FFD_EMBED_FRAME_FACE_NET_H
#define FFD_EMBED_FRAME_FACE_NET_H

#include "embed/frame/bezier_box.h"
#include "lattice/lattice.h"

/* The origin that is subtracted from control points, and the powers of two by which x, y, z and the weights
   are divided, so that their sizes are at most 1. */
typedef struct face_scale {
    double origin[3];
    int exponent[BEZIER_COMPONENTS];
} face_scale;

/* A face of the domain, across direction a; b and c are the next directions, cyclically. */
typedef struct face_net {
    const ffd_lattice *lattice;
    int a, b, c;
    size_t count_b, count_c;          /* numbers of basis functions */
    double *points;                   /* h P, h of the face's control points, b fastest */
    double extent[BEZIER_COMPONENTS]; /* max |component| */
} face_net;

/* Finds the scale of a lattice. */
void ffd_face_scale_find(const ffd_lattice *lattice, face_scale *scale);

/* Allocates the points of the faces across direction a, which is not closed. Free with ffd_face_net_free.
   Errors: FFD_E_MEMORY. */
ffd_status ffd_face_net_create(const ffd_lattice *lattice, int a, face_net *net, ffd_error *error);
/* Frees the points. */
void ffd_face_net_free(face_net *net);

/* Fills the points of the first (end 0) or the last face. */
void ffd_face_net_fill(face_net *net, const face_scale *scale, int end);

/* Makes the Bezier form of a cell of the face. The box's directions u, v are b, c; its coefficients have room
   for order_b * order_c points. extraction: of all spans of each direction (ffd_bezier_extractions). */
void ffd_face_net_cell(const face_net *net, double *const extraction[3], size_t cell_b, size_t cell_c,
                       bezier_box *box);

#endif
