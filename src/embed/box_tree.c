#include "embed/box_tree.h"
#include "base/memory.h"
#include <stdlib.h>
#include <string.h>

#define ITEMS_A_NODE 2
/* Every split halves the items, so 2^31 of them need no more levels than this. */
#define DEPTH 40

typedef struct box_tree_node {
    bounds box;
    uint32_t first; /* leaf: its place in items; inner node: its first child, the second follows */
    uint32_t count; /* 0: inner node */
} box_tree_node;

typedef struct sort_key {
    double centre;
    uint32_t item;
} sort_key;

static int compare_keys(const void *left, const void *right)
{
    const sort_key *a = left, *b = right;
    if (a->centre != b->centre)
        return a->centre < b->centre ? -1 : 1;
    return a->item < b->item ? -1 : a->item > b->item;
}

static bounds enclose(const bounds *boxes, const uint32_t *items, size_t count)
{
    bounds all = boxes[items[0]];
    for (size_t i = 1; i < count; i++) {
        bounds_add(&all, boxes[items[i]].lo);
        bounds_add(&all, boxes[items[i]].hi);
    }
    return all;
}

/* The direction in which the boxes' centres spread most. */
static int widest_direction(const bounds *boxes, const uint32_t *items, size_t count)
{
    bounds centres = {{1, 1, 1}, {-1, -1, -1}};
    for (size_t i = 0; i < count; i++) {
        const bounds *box = &boxes[items[i]];
        double centre[3];
        for (int a = 0; a < 3; a++)
            centre[a] = 0.5 * box->lo[a] + 0.5 * box->hi[a];
        if (i == 0)
            centres = (bounds){{centre[0], centre[1], centre[2]}, {centre[0], centre[1], centre[2]}};
        bounds_add(&centres, centre);
    }
    int widest = 0;
    for (int a = 1; a < 3; a++)
        if (centres.hi[a] - centres.lo[a] > centres.hi[widest] - centres.lo[widest])
            widest = a;
    return widest;
}

static void split(box_tree *tree, uint32_t node_number, const bounds *boxes, size_t first, size_t count,
                  sort_key *keys)
{
    box_tree_node *node = &tree->nodes[node_number];
    node->box = enclose(boxes, tree->items + first, count);
    if (count <= ITEMS_A_NODE) {
        node->first = (uint32_t)first;
        node->count = (uint32_t)count;
        return;
    }
    const int a = widest_direction(boxes, tree->items + first, count);
    for (size_t i = 0; i < count; i++) {
        const uint32_t item = tree->items[first + i];
        keys[i] = (sort_key){0.5 * boxes[item].lo[a] + 0.5 * boxes[item].hi[a], item};
    }
    qsort(keys, count, sizeof *keys, compare_keys);
    for (size_t i = 0; i < count; i++)
        tree->items[first + i] = keys[i].item;

    const uint32_t child = (uint32_t)tree->node_count;
    tree->node_count += 2;
    node->first = child;
    node->count = 0;
    const size_t half = count / 2;
    split(tree, child, boxes, first, half, keys);
    split(tree, child + 1, boxes, first + half, count - half, keys);
}

bool ffd_box_tree_build(const bounds *boxes, size_t count, box_tree *tree)
{
    memset(tree, 0, sizeof *tree);
    if (count == 0)
        return true;
    sort_key *keys = ffd_alloc(count, sizeof *keys);
    tree->items = ffd_alloc(count, sizeof *tree->items);
    tree->nodes = ffd_alloc(2 * count, sizeof *tree->nodes);
    if (keys && tree->items && tree->nodes) {
        for (size_t i = 0; i < count; i++)
            tree->items[i] = (uint32_t)i;
        tree->node_count = 1;
        split(tree, 0, boxes, 0, count, keys);
    } else {
        ffd_box_tree_free(tree);
    }
    ffd_free(keys);
    return tree->nodes != NULL;
}

void ffd_box_tree_free(box_tree *tree)
{
    ffd_free(tree->nodes);
    ffd_free(tree->items);
    memset(tree, 0, sizeof *tree);
}

bool ffd_box_tree_visit(const box_tree *tree, const double p[3], const double slack[3],
                        box_tree_visitor visit, void *context)
{
    const bounds place = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
    return ffd_box_tree_visit_box(tree, &place, slack, visit, context);
}

bool ffd_box_tree_visit_box(const box_tree *tree, const bounds *places, const double slack[3],
                            box_tree_visitor visit, void *context)
{
    uint32_t stack[2 * DEPTH];
    int height = 0;
    if (tree->node_count > 0)
        stack[height++] = 0;
    while (height > 0) {
        const box_tree_node *node = &tree->nodes[stack[--height]];
        if (!bounds_meet(&node->box, places, slack))
            continue;
        if (node->count == 0) {
            stack[height++] = node->first + 1;
            stack[height++] = node->first;
            continue;
        }
        for (uint32_t i = 0; i < node->count; i++)
            if (!visit(context, tree->items[node->first + i]))
                return false;
    }
    return true;
}
