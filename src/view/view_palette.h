/* view_palette.h - what a picture is coloured by: a colour for each vertex, and the scale that explains it.
   By
   + - * / and square roots only, so that the same bits come out on every machine. */
#ifndef FFD_VIEW_VIEW_PALETTE_H
#define FFD_VIEW_VIEW_PALETTE_H

#include "picture/picture.h"
#include "view/page_options.h"
#include "view/view_scene.h"

#define PALETTE_COLORS 256
#define PALETTE_LABELS 5

typedef struct view_palette {
    view_page_color color; /* what the scene has of what was asked for */
    double most; /* the largest displacement; or the largest det F, or 1 / det F, of those above 0 */
    uint8_t ramp[PALETTE_COLORS][3];
    char texts[PALETTE_LABELS][32];
    const char *labels[PALETTE_LABELS];
    picture_scale scale; /* of the above, so that a palette must stay where it was made */
    bool has_scale;
} view_palette;

/* Of flipped faces and folded volume, and of torn edges; sRGB. */
extern const uint8_t ffd_view_folded[3], ffd_view_torn[3];

/* Makes the palette of a scene. Without statuses and det F, displacements are what is left; where nothing
   moves, the mesh is drawn plainly. */
void ffd_view_palette_make(const view_scene *scene, view_page_color color, view_palette *palette);

/* Fills the colour of each vertex, red, green, blue, alpha, when it has gone this share of its way. */
void ffd_view_palette_fill(const view_palette *palette, const view_scene *scene, double share,
                           uint8_t *colors);

#endif
