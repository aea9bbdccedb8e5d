/* shade.h - the colour of a place on a triangle. */
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
    int side;          /* 0: its front is seen */
    double texel_size; /* how many texels of its texture a pixel spans */
} shade;

/* The material of a triangle: never NULL. */
const picture_material *ffd_shade_material(const picture_mesh *mesh, size_t triangle);
/* Finds the material of a triangle, whose number and side are given, and how large its texels are. */
void ffd_shade_begin(shade *of);
/* The colour where the corners have these weights, whose sum is 1, as linear_pack. Returns false where the
   material is cut away. */
bool ffd_shade_color(const shade *of, const double weights[3], uint64_t *color);

/* The same in the middle of the triangle. */
bool ffd_shade_middle(const shade *of, uint64_t *color);

#endif
