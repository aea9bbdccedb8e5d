/* polygon_cut.h - cuts polygons into triangles, also concave ones and those that are not quite planar. */
#ifndef FFD_MESH_POLYGON_CUT_H
#define FFD_MESH_POLYGON_CUT_H

#include "base/fail.h"
#include "mesh/mesh_log.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct cut_corner {
    uint32_t previous, next;
    uint32_t place; /* in the order */
    bool is_reflex;
} cut_corner;

/* A box round corners that are near each other, and how many of them are reflex. */
typedef struct cut_node {
    double low[2], high[2];
    uint32_t reflex_count;
} cut_node;

/* Scratch memory that grows with the largest polygon. Zeroed: none yet. */
typedef struct polygon_cutter {
    double *plane; /* 2 a corner: the polygon seen against its normal */
    cut_corner *corners;
    uint32_t *order; /* the corners as the leaves of the tree have them */
    cut_node *nodes; /* a binary tree of 2 leaves, from 1 */
    size_t leaves;
    bool has_boxes;   /* else all reflex corners are looked at */
    uint64_t hurried; /* polygons so far whose ears took too long to find: their triangles may overlap */
    size_t plane_capacity, corners_capacity, order_capacity, nodes_capacity;
} polygon_cutter;

/* Cuts the polygon with the corners points (3 * count doubles, count at least 3) into count - 2 triangles,
   whose corners are numbers of the polygon's and go round as it does. A convex polygon becomes a fan from its
   first corner; others lose an ear at a time (Meisters, Polygons have ears, 1975). Of polygons that cross
   themselves only the number of triangles is certain, and likewise of those that have so many corners that
   their ears would take too long to find: cutter->hurried counts these. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_polygon_cut(polygon_cutter *cutter, const double *points, size_t count, uint32_t *triangles,
                           ffd_error *error);
/* Warns of that many hurried polygons; says nothing of none. */
void ffd_polygon_cut_warn(uint64_t hurried, const mesh_log *log);
/* Frees the scratch memory. */
void ffd_polygon_cutter_free(polygon_cutter *cutter);

#endif
