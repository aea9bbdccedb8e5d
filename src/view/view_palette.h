/* view_palette.h - how a picture is coloured: a colour for each vertex, and the scale that explains them.
   Uses + - * / and square roots only, so that the bits are the same on every machine. */
#ifndef FFD_VIEW_VIEW_PALETTE_H
#define FFD_VIEW_VIEW_PALETTE_H

#include "picture/picture.h"
#include "view/page_options.h"
#include "view/view_frame.h"
#include "view/view_scene.h"

#define PALETTE_COLORS 256
#define PALETTE_LABELS 5
/* The most marks in a legend. */
#define PALETTE_MARKS 3

typedef struct view_palette {
    ffd_view_color color; /* the colouring asked for, or what replaces it where the scene lacks the data */
    double most; /* end of the scale: the largest displacement; or the largest of det F and 1 / det F, where
                    det F > 0 */
    uint8_t ramp[PALETTE_COLORS][3];
    char texts[PALETTE_LABELS][32];
    const char *labels[PALETTE_LABELS];
    picture_scale scale; /* refers to the members above, so a palette must not be copied */
    bool has_scale;
} view_palette;

/* Colours of marks, sRGB: of flipped faces, folded volume and torn edges. Each is drawn in stripes of two, so
   that the colour-blind too tell it from all colours of the scales. */
extern const uint8_t ffd_view_flipped[2][3], ffd_view_folded[2][3], ffd_view_torn[2][3];

/* Fills the marks of a scene for the legend: those that are in it, coloured like this. Returns their
   number. */
size_t ffd_view_marks(const view_scene *scene, ffd_view_color color, picture_mark marks[PALETTE_MARKS]);

/* Returns the largest of det F and 1 / det F in a scene, where det F > 0; 0: det F is not known. */
double ffd_view_most_det(const view_scene *scene);
/* Makes the palette of a scene, with the scale of a frame. Without the statuses or det F that were asked for,
   it shows displacements; where nothing moves in the frame, the mesh's own colours. */
void ffd_view_palette_make(const view_scene *scene, const view_frame *frame, ffd_view_color color,
                           view_palette *palette);

/* Fills the colour of each vertex (red, green, blue, alpha) at a share of the way from before (0) to after
   (1). The alpha of a colour of the palette is 255, or 0 where the colour is a mark: folded volume. */
void ffd_view_palette_fill(const view_palette *palette, const view_scene *scene, double share,
                           uint8_t *colors);

#endif
