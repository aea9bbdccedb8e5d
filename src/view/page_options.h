/* page_options.h - how a page opens, and how much it shows. */
#ifndef FFD_VIEW_PAGE_OPTIONS_H
#define FFD_VIEW_PAGE_OPTIONS_H

#include "mesh/mesh_log.h"
#include <stdbool.h>

/* What a page is coloured by when it opens. In the order of ffd_view_color. */
typedef enum view_page_color {
    VIEW_BY_DISPLACEMENT,
    VIEW_BY_STATUS,
    VIEW_BY_DET,
    VIEW_BY_MATERIAL
} view_page_color;

/* Vertices and control points of a page that is not full. */
#define VIEW_PAGE_VERTICES 200000
#define VIEW_PAGE_CONTROLS 100000

typedef struct view_page_options {
    bool full; /* all vertices, whatever their number */
    view_page_color color;
    double camera[3];    /* where it is, seen from the mesh; zeros: from the right, above and in front */
    const mesh_log *log; /* gets a line where the page shows less than the mesh; may be NULL */
} view_page_options;

#endif
