/* packet.h - packets of points that traverse the trees of bricks and leaves together: neighbours in a mesh
   are mostly in the same leaves. */
#ifndef FFD_EMBED_CELLS_PACKET_H
#define FFD_EMBED_CELLS_PACKET_H

#include "embed/cells/point_search.h"

#define PACKET_SIZE 8
/* The most leaves of a point; a point with more is searched alone. */
#define MOST_LEAVES 4

typedef struct packet_point {
    point_search search; /* with its point set, without results */
    uint32_t index;      /* of the caller */
    uint32_t bricks;     /* number of visited bricks */
    uint32_t count;
    const cell_leaf *leaves[MOST_LEAVES]; /* leaves that may contain the point, in the order of
                                             ffd_cells_find */
    bool alone;                           /* it must be searched alone */
} packet_point;

typedef struct point_packet {
    const ffd_locator *locator;
    double side; /* side of a box that all points must be in, in the search's units */
    packet_point points[PACKET_SIZE];
    int count; /* the caller resets it */
    bounds hull;
    double slack[3]; /* greatest slack of the points */
    /* The state while a brick is visited: */
    const cell_brick *brick;
    bool enter[PACKET_SIZE];
} point_packet;

/* Begins an empty packet for a locator. */
void ffd_packet_begin(point_packet *packet, const ffd_locator *locator);
/* Adds a point, unless it is too far away for the search's units. Returns false if the packet is full, or the
   point is too far from the others. */
bool ffd_packet_add(point_packet *packet, const double p[3], uint32_t index);
/* Finds the leaves of each point. */
void ffd_packet_find_leaves(point_packet *packet);

#endif
