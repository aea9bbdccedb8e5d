/* box_tree.h - a tree over axis-aligned boxes that answers: which of them hold this point? */
#ifndef FFD_EMBED_FRAME_BOX_TREE_H
#define FFD_EMBED_FRAME_BOX_TREE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct bounds {
    double lo[3], hi[3];
} bounds;

typedef struct box_tree {
    struct box_tree_node *nodes; /* node 0 is the root */
    uint32_t *items;             /* the boxes' numbers, leaf by leaf */
    size_t node_count;
} box_tree;

/* Builds the tree over count boxes (fewer than 2^31). Returns false if memory runs out. */
bool ffd_box_tree_build(const bounds *boxes, size_t count, box_tree *tree);
/* Frees the tree; it is empty then. */
void ffd_box_tree_free(box_tree *tree);

/* A callback: returns false to stop the traversal. */
typedef bool (*box_tree_visitor)(void *context, uint32_t item);

/* Calls visit for every box whose node's box, grown by slack in each coordinate, holds p; the caller tests
   the box itself. The order depends on the boxes only. Stops and returns false when visit does. */
bool ffd_box_tree_visit(const box_tree *tree, const double p[3], const double slack[3],
                        box_tree_visitor visit, void *context);

/* The same for every box that meets another one, `query`: one traversal for points that are neighbours.
   What it visits for a point alone, it visits for the box too, if slack is no less. */
bool ffd_box_tree_visit_box(const box_tree *tree, const bounds *query, const double slack[3],
                            box_tree_visitor visit, void *context);

/* Calls visit for every box whose node's box is no farther than *reach from p (Euclidean), nearer nodes
 *first. reach is read again all the time: visit lowers it. Stops and returns false when visit does. */
bool ffd_box_tree_visit_near(const box_tree *tree, const double p[3], const double *reach,
                             box_tree_visitor visit, void *context);

static inline bool bounds_hold(const bounds *box, const double p[3], const double slack[3])
{
    return p[0] >= box->lo[0] - slack[0] && p[0] <= box->hi[0] + slack[0] && p[1] >= box->lo[1] - slack[1] &&
           p[1] <= box->hi[1] + slack[1] && p[2] >= box->lo[2] - slack[2] && p[2] <= box->hi[2] + slack[2];
}

static inline void bounds_add(bounds *box, const double p[3])
{
    for (int a = 0; a < 3; a++) {
        if (p[a] < box->lo[a])
            box->lo[a] = p[a];
        if (p[a] > box->hi[a])
            box->hi[a] = p[a];
    }
}

#endif
