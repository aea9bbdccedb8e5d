/* view_dots.h - the points of a scene in a picture, Gaussian splats too, and the colours of points and lines.
 */
#ifndef FFD_VIEW_VIEW_DOTS_H
#define FFD_VIEW_VIEW_DOTS_H

#include "picture/picture.h"
#include "view/view_scene.h"

/* The colour of lines and points that have none, sRGB. */
extern const uint8_t ffd_view_line_color[3];

/* The points of a panel. All zeros: none. */
typedef struct view_dots {
    picture_points points; /* count 0: none */
    uint32_t *all;         /* the numbers of all vertices, where the mesh has nothing but these */
    float *covariances;
    uint8_t *own; /* colours of vertices by materials, or of splats by the palette; NULL: those lent */
} view_dots;

/* Whether the scene has points or lines; a mesh that has vertices and nothing else is points. */
bool ffd_view_has_dots(const view_scene *scene);
/* Fills the points of a panel at a share of the way from before (0) to after (1). positions: of the vertices,
   lent; colors: of the palette, or the mesh's own if is_plain, lent; NULL: none. height: of the picture in
   pixels. The colours of lines are then dots->points.colors too. Errors: FFD_E_MEMORY; call
   ffd_view_dots_free in every case. */
ffd_status ffd_view_dots_make(const view_scene *scene, double share, const double *positions,
                              const uint8_t *colors, bool is_plain, uint32_t height, view_dots *dots,
                              ffd_error *error);
/* Frees the arrays; leaves all zeros. */
void ffd_view_dots_free(view_dots *dots);

/* Clears the marks of vertices that are splats and nearly clear: they may be far from all that is seen. */
void ffd_view_drop_faint(const view_scene *scene, uint8_t *marks);

#endif
