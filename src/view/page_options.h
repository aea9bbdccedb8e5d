/* page_options.h - how a page opens, and how much it shows. */
#ifndef FFD_VIEW_PAGE_OPTIONS_H
#define FFD_VIEW_PAGE_OPTIONS_H

#include "mesh/mesh_log.h"
#include <stdbool.h>

/* The colouring with which a page opens. In the order of ffd_view_color. */
typedef enum view_page_color {
    VIEW_BY_DISPLACEMENT,
    VIEW_BY_STATUS,
    VIEW_BY_DET,
    VIEW_BY_MATERIAL
} view_page_color;

/* Limits of a page without `full`: vertices, and control points of all lattices. */
#define VIEW_PAGE_VERTICES 200000
#define VIEW_PAGE_CONTROLS 100000

typedef struct view_page_options {
    bool full; /* show all vertices and control points */
    view_page_color color;
    double camera[3]; /* direction from the mesh to the camera; zeros: from the right, above and in front */
    const mesh_log *log; /* gets a line for each reduction of the mesh; may be NULL */
} view_page_options;

#endif
