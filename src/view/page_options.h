/* page_options.h - how a page opens, and how much it shows. */
#ifndef FFD_VIEW_PAGE_OPTIONS_H
#define FFD_VIEW_PAGE_OPTIONS_H

#include "mesh/memory_budget.h"
#include "mesh/mesh_log.h"
#include <ffd/job.h>
#include <stdbool.h>

/* Limits of a page without `full`: vertices, and control points of all lattices. */
#define VIEW_PAGE_VERTICES 200000
#define VIEW_PAGE_CONTROLS 100000

typedef struct view_page_options {
    bool full;            /* show all vertices and control points */
    ffd_view_color color; /* the colouring with which a page opens */
    double camera[3]; /* direction from the mesh to the camera; zeros: from the right, above and in front */
    ffd_up up;        /* the axis that points upwards */
    const memory_budget *budget; /* limits the memory for decoding textures; NULL: nothing does */
    const mesh_log *log;         /* gets a line for each reduction of the mesh; may be NULL */
} view_page_options;

#endif
