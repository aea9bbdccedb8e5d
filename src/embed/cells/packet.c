#include "embed/cells/packet.h"
#include "base/vector/root.h"
#include <math.h>
#include <string.h>

/* The side of a packet relative to the mean side of a cell: points of a packet have nearly the same
   leaves. */
#define CELLS_A_PACKET (1.0 / 8)

void ffd_packet_begin(point_packet *packet, const ffd_locator *locator)
{
    const size_t *const cells = locator->cells->cells;
    packet->locator = locator;
    packet->side = CELLS_A_PACKET / ffd_root((double)cells[0] * (double)cells[1] * (double)cells[2], 3);
    packet->count = 0;
}

static bool is_near(const point_packet *packet, const double x[3])
{
    for (int a = 0; a < 3; a++)
        if (x[a] - packet->hull.lo[a] > packet->side || packet->hull.hi[a] - x[a] > packet->side)
            return false;
    return true;
}

static void widen(point_packet *packet, const point_search *added)
{
    if (packet->count == 0) {
        memcpy(packet->hull.lo, added->x, sizeof added->x);
        memcpy(packet->hull.hi, added->x, sizeof added->x);
        memcpy(packet->slack, added->slack, sizeof added->slack);
    }
    bounds_add(&packet->hull, added->x);
    for (int a = 0; a < 3; a++)
        packet->slack[a] = added->slack[a] > packet->slack[a] ? added->slack[a] : packet->slack[a];
}

bool ffd_packet_add(point_packet *packet, const double p[3], uint32_t index)
{
    if (packet->count == PACKET_SIZE)
        return false;
    packet_point *const point = &packet->points[packet->count];
    ffd_search_begin(&point->search, packet->locator);
    if (!ffd_search_set_point(&point->search, p))
        return true;
    if (packet->count > 0 && !is_near(packet, point->search.x))
        return false;
    point->index = index;
    point->bricks = point->count = 0;
    point->alone = false;
    widen(packet, &point->search);
    packet->count++;
    return true;
}

static void note_leaf(packet_point *point, const cell_leaf *leaf)
{
    if (!bounds_hold(&leaf->hull, point->search.x, point->search.slack) ||
        (!leaf->hard && !ffd_search_image_holds(&point->search, leaf)))
        return;
    if (leaf->hard || point->count == MOST_LEAVES)
        point->alone = true;
    else
        point->leaves[point->count++] = leaf;
}

static bool visit_leaf(void *context, uint32_t index)
{
    point_packet *packet = context;
    for (int i = 0; i < packet->count; i++)
        if (packet->enter[i] && !packet->points[i].alone)
            note_leaf(&packet->points[i], &packet->brick->leaves[index]);
    return true;
}

static bool visit_brick(void *context, uint32_t index)
{
    point_packet *packet = context;
    const cell_search *cells = packet->locator->cells;
    bool any = false;
    /* Only stored bricks are used here: another one may not live beyond this point's search. */
    packet->brick = atomic_load_explicit(&cells->made[index], memory_order_acquire);
    for (int i = 0; i < packet->count; i++) {
        packet_point *point = &packet->points[i];
        packet->enter[i] = bounds_hold(&cells->brick_hulls[index], point->search.x, point->search.slack);
        if (packet->enter[i])
            point->alone = point->alone || !packet->brick || point->bricks++ >= SEARCH_BRICKS;
        any = any || packet->enter[i];
    }
    return !any || !packet->brick ||
           ffd_box_tree_visit_box(&packet->brick->tree, &packet->hull, packet->slack, visit_leaf, packet);
}

void ffd_packet_find_leaves(point_packet *packet)
{
    if (packet->count > 0)
        ffd_box_tree_visit_box(&packet->locator->cells->brick_tree, &packet->hull, packet->slack, visit_brick,
                               packet);
}
