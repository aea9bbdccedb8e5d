/* panel.h - prepares the meshes and cages of a panel, and draws them band by band. */
#ifndef FFD_PICTURE_PANEL_H
#define FFD_PICTURE_PANEL_H

#include "picture/bands.h"
#include "picture/layout.h"
#include "picture/points.h"
#include "picture/raster.h"

typedef struct panel_mesh {
    surface surface;
    bands triangles;
} panel_mesh;

typedef struct panel_points {
    placed_points placed;
    bands list;
} panel_points;

typedef struct panel_cage {
    const picture_cage *cage;
    int32_t stripe; /* period of stripes */
    double half_width, radius;
    double *points; /* in pixels */
    bands segments, discs;
} panel_cage;

typedef struct panel {
    const picture_panel *of;
    const layout *layout;
    int32_t left, right, top, bottom; /* columns and rows */
    panel_mesh *meshes;
    panel_points *points;
    panel_cage *cages;
} panel;

/* Prepares panel `number` of a picture. Errors: FFD_E_MEMORY, FFD_E_LIMIT; there is nothing to free then. */
ffd_status ffd_panel_make(const layout *by, size_t index, const ffd_bounds *seen, const band_means *means,
                          panel *result, ffd_error *error);
/* Frees the panel and empties it. */
void ffd_panel_free(panel *of);
/* Draws the surfaces and points in a band of rows into the samples of the panel's columns: first all that is
   opaque, then the layers of what is see-through. */
void ffd_panel_draw_meshes(const panel *of, const linear_tables *tables, size_t band, samples *into);
/* Draws the cages in a band of rows. */
void ffd_panel_draw_cages(const panel *of, const linear_tables *tables, size_t band,
                          const stroke_target *into);

#endif
