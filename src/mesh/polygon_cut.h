/* polygon_cut.h - triangulates polygons, also concave ones and those that are not quite planar. */
#ifndef FFD_MESH_POLYGON_CUT_H
#define FFD_MESH_POLYGON_CUT_H

#include "base/fail.h"
#include "mesh/mesh_log.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct cut_corner {
    uint32_t previous, next;
    uint32_t place; /* index in the order */
    bool is_reflex;
} cut_corner;

/* A node: the bounding box of neighbouring corners, and the number of reflex ones. */
typedef struct cut_node {
    double low[2], high[2];
    uint32_t reflex_count;
} cut_node;

/* Scratch memory, which grows with the largest polygon. All zeros: empty. */
typedef struct polygon_cutter {
    double *plane; /* 2 for each corner: the projected polygon */
    cut_corner *corners;
    uint32_t *order; /* the corners in the order of the leaves */
    cut_node *nodes; /* a binary tree of 2 * leaves nodes; the root is node 1 */
    size_t leaves;
    bool has_boxes;   /* false: test all reflex corners */
    uint64_t hurried; /* number of polygons for which the budget ran out; their triangles may overlap */
    size_t plane_capacity, corners_capacity, order_capacity, nodes_capacity;
} polygon_cutter;

/* Triangulates a polygon with the corners points (3 * count doubles, count >= 3) into count - 2 triangles,
   whose corners are indices of the polygon's corners in its orientation. A convex polygon becomes a fan from
   its first corner; others are processed by ear clipping (Meisters, Polygons have ears, 1975). For a polygon
   that intersects itself, only the number of triangles is guaranteed; the same holds if finding ears takes
   too long because of many corners, which cutter->hurried counts. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_polygon_cut(polygon_cutter *cutter, const double *points, size_t count, uint32_t *triangles,
                           ffd_error *error);
/* Logs a warning about hurried polygons, if there are any. */
void ffd_polygon_cut_warn(uint64_t hurried, const mesh_log *log);
/* Frees the scratch memory. */
void ffd_polygon_cutter_free(polygon_cutter *cutter);

#endif
