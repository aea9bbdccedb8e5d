/* shade.h - the colour at a position on a triangle. */
#ifndef FFD_PICTURE_SHADE_H
#define FFD_PICTURE_SHADE_H

#include "picture/linear.h"
#include "picture/surface.h"

/* A triangle that is drawn. */
typedef struct shade {
    const surface *surface;
    const linear_tables *tables;
    size_t triangle;
    const picture_material *material;
    int side;         /* 0: seen from the front */
    int64_t px, py;   /* the pixel, for stripes */
    double texels[3]; /* of the texture, that of the opacity and that of the emission for a pixel */
} shade;

/* Returns the material of a triangle; never NULL. */
const picture_material *ffd_shade_material(const picture_mesh *mesh, size_t triangle);
/* Sets the material and the texel sizes of a triangle, whose index and side are set. */
void ffd_shade_begin(shade *of);
/* Computes the colour, as linear_pack, at barycentric weights whose sum is 1; of a see-through material with
   alpha in the highest 16 bits. Returns false at a hole (alpha test). */
bool ffd_shade_color(const shade *of, const double weights[3], uint64_t *color);

/* The same in the middle of the triangle. */
bool ffd_shade_middle(const shade *of, uint64_t *color);

#endif
