/* layout.h - where in a picture its panels, captions and colour scale are, and drawing all but the panels. */
#ifndef FFD_PICTURE_LAYOUT_H
#define FFD_PICTURE_LAYOUT_H

#include "picture/linear.h"
#include "picture/picture_scene.h"
#include "picture/strokes.h"

typedef struct layout {
    const picture *of;
    double dot;  /* of letters, in pixels */
    double line; /* width of a cage's lines */
    size_t rows, columns;
    double row_height;
    double top, bottom; /* of the part of each panel of the first row that meshes are drawn in */
    double margin;      /* beside it */
} layout;

/* Finds the places. */
layout ffd_layout_make(const picture *of);
/* The first pixel of a column of panels; of their number: the end of the last. */
int32_t ffd_layout_column(const layout *by, size_t column);
/* The same of a row of them. */
int32_t ffd_layout_row(const layout *by, size_t row);
/* The background of a row. */
uint64_t ffd_layout_background(const layout *by, const linear_tables *tables, int32_t row);
/* Draws captions, lines between panels and the scale, as far as they are in the target's rows. */
void ffd_layout_draw(const layout *by, const linear_tables *tables, const stroke_target *into);

#endif
