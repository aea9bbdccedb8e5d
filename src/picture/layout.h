/* layout.h - the positions of panels, captions, the colour scale and the legend of marks in a picture; draws
   everything except the panels' content. */
#ifndef FFD_PICTURE_LAYOUT_H
#define FFD_PICTURE_LAYOUT_H

#include "picture/linear.h"
#include "picture/picture_scene.h"
#include "picture/strokes.h"

typedef struct layout {
    const picture *of;
    double dot;     /* size of a dot of letters, in pixels */
    double line;    /* width of the lines of a cage, in pixels */
    int32_t stripe; /* pixels of a stripe and the one beside it */
    size_t rows, columns;
    double row_height;
    double top, bottom; /* rows of the part of each panel of the first row in which meshes are drawn */
    double margin;      /* margin left and right of it */
} layout;

/* Computes the layout. */
layout ffd_layout_make(const picture *of);
/* Returns the first pixel of a column of panels; for column = number of columns: the end of the last. */
int32_t ffd_layout_column(const layout *by, size_t column);
/* The same for a row of panels. */
int32_t ffd_layout_row(const layout *by, size_t row);
/* Returns the background colour of a row of pixels. */
uint64_t ffd_layout_background(const layout *by, const linear_tables *tables, int32_t row);
/* Draws captions, lines between panels and the scale, clipped to the rows of the target. */
void ffd_layout_draw(const layout *by, const linear_tables *tables, const stroke_target *into);

#endif
