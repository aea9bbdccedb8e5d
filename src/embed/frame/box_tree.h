/* box_tree.h - a tree over axis-aligned boxes, to find those that contain a point (a bounding volume
   hierarchy). */
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
    uint32_t *items;             /* indices of the boxes, leaf by leaf */
    size_t node_count;
} box_tree;

/* Builds a tree over count boxes (fewer than 2^31). Returns false if memory runs out. */
bool ffd_box_tree_build(const bounds *boxes, size_t count, box_tree *tree);
/* Frees the tree and empties it. */
void ffd_box_tree_free(box_tree *tree);

/* A callback for a box; returns false to stop the traversal. */
typedef bool (*box_tree_visitor)(void *context, uint32_t item);

/* Calls visit for every box whose leaf's box, grown by slack in each coordinate, contains p; the caller tests
   the box itself. The order depends only on the boxes. Stops and returns false if visit does. */
bool ffd_box_tree_visit(const box_tree *tree, const double p[3], const double slack[3],
                        box_tree_visitor visit, void *context);

/* The same for every box that meets the box `query`: one traversal for neighbouring points. With a slack that
   is not less, it visits everything that it would visit for a point in the box. */
bool ffd_box_tree_visit_box(const box_tree *tree, const bounds *query, const double slack[3],
                            box_tree_visitor visit, void *context);

/* Calls visit for every box whose leaf's box is at most *reach from p (Euclidean distance), nearer nodes
   first. visit may lower *reach during the traversal. Stops and returns false if visit does. */
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
