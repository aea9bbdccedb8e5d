/* packet.h - points that walk through the trees of bricks and leaves together: neighbours in a mesh mostly
   lie in the same leaves. */
#ifndef FFD_EMBED_CELLS_PACKET_H
#define FFD_EMBED_CELLS_PACKET_H

#include "embed/cells/point_search.h"

#define PACKET_SIZE 8
/* Most leaves of a point; a point with more is searched for alone. */
#define MOST_LEAVES 4

typedef struct packet_point {
    point_search search; /* placed; nothing is found */
    uint32_t number;     /* the caller's */
    uint32_t bricks;     /* looked into */
    uint32_t count;
    const cell_leaf *leaves[MOST_LEAVES]; /* that may hold it, in the order of ffd_cells_find */
    bool alone;                           /* it needs a search of its own */
} packet_point;

typedef struct point_packet {
    const ffd_locator *locator;
    double side; /* of a box that all must lie in, in the search's units */
    packet_point points[PACKET_SIZE];
    int count; /* the caller empties it */
    bounds hull;
    double slack[3]; /* the largest */
    /* While a brick is looked into: */
    const cell_brick *brick;
    bool enter[PACKET_SIZE];
} point_packet;

/* An empty packet for points in this locator's lattice. */
void ffd_packet_begin(point_packet *packet, const ffd_locator *locator);
/* Adds a point; one that is too large for the search's doubles is left out. Returns false if the packet is
   full, or the point is too far from the others. */
bool ffd_packet_add(point_packet *packet, const double p[3], uint32_t number);
/* Finds each point's leaves. */
void ffd_packet_find_leaves(point_packet *packet);

#endif
