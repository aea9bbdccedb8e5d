#include "embed/frame/box_tree.h"
#include "base/arithmetic.h"
#include "base/memory/memory.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define ITEMS_A_LEAF 2
/* Each node has four children, two levels of halving, whose boxes are tested together. */
#define CHILDREN 4
/* Every node divides the items by four, so 2^31 of them need fewer levels than this. */
#define DEPTH 20

typedef struct box_tree_child {
    uint32_t first; /* leaf: index of its first item; else index of its node */
    uint32_t count; /* number of items of a leaf; 0: a node */
} box_tree_child;

typedef struct box_tree_node {
    double lo[3][CHILDREN], hi[3][CHILDREN]; /* NaN if there is no child, so that no test succeeds */
    box_tree_child children[CHILDREN];
} box_tree_node;

typedef struct sort_key {
    double centre;
    uint32_t item;
} sort_key;

typedef struct tree_builder {
    const bounds *boxes;
    box_tree *tree;
    sort_key *keys;
} tree_builder;

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

/* Returns the direction in which the centres of the boxes have the greatest extent. */
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

/* Sorts the items by the centres of their boxes in that direction. */
static void sort_items(const tree_builder *builder, size_t first, size_t count)
{
    const bounds *const boxes = builder->boxes;
    uint32_t *const items = builder->tree->items + first;
    const int a = widest_direction(boxes, items, count);
    for (size_t i = 0; i < count; i++)
        builder->keys[i] = (sort_key){0.5 * boxes[items[i]].lo[a] + 0.5 * boxes[items[i]].hi[a], items[i]};
    qsort(builder->keys, count, sizeof *builder->keys, compare_keys);
    for (size_t i = 0; i < count; i++)
        items[i] = builder->keys[i].item;
}

static uint32_t add_node(const tree_builder *builder, size_t first, size_t count);

static void set_child(const tree_builder *builder, uint32_t parent, int slot, size_t first, size_t count)
{
    box_tree_node *const node = &builder->tree->nodes[parent];
    const bounds box = enclose(builder->boxes, builder->tree->items + first, count);
    for (int a = 0; a < 3; a++) {
        node->lo[a][slot] = box.lo[a];
        node->hi[a][slot] = box.hi[a];
    }
    node->children[slot] = count <= ITEMS_A_LEAF ? (box_tree_child){(uint32_t)first, (uint32_t)count}
                                                 : (box_tree_child){add_node(builder, first, count), 0};
}

/* Adds a node. Returns its index. */
static uint32_t add_node(const tree_builder *builder, size_t first, size_t count)
{
    const uint32_t index = (uint32_t)builder->tree->node_count++;
    const size_t ends[] = {first, first + count / 2, first + count};
    box_tree_node *const node = &builder->tree->nodes[index];
    for (int a = 0; a < 3; a++)
        for (int i = 0; i < CHILDREN; i++)
            node->lo[a][i] = node->hi[a][i] = NAN;
    int slot = 0;
    if (count > ITEMS_A_LEAF)
        sort_items(builder, first, count);
    for (int h = 0; h < 2; h++) {
        const size_t half = ends[h + 1] - ends[h], quarter = half > ITEMS_A_LEAF ? half / 2 : half;
        if (half > ITEMS_A_LEAF)
            sort_items(builder, ends[h], half);
        if (quarter > 0)
            set_child(builder, index, slot++, ends[h], quarter);
        if (quarter < half)
            set_child(builder, index, slot++, ends[h] + quarter, half - quarter);
    }
    return index;
}

bool ffd_box_tree_build(const bounds *boxes, size_t count, box_tree *tree)
{
    memset(tree, 0, sizeof *tree);
    if (count == 0)
        return true;
    tree_builder builder = {.boxes = boxes, .tree = tree};
    builder.keys = ffd_alloc(count, sizeof *builder.keys);
    tree->items = ffd_alloc(count, sizeof *tree->items);
    /* For at least three items there are at most (count - 1) / 2 nodes, by induction: one for three items;
       and each of up to four children that are nodes leaves half a node for their parent. */
    tree->nodes = ffd_alloc(count / 2 + 1, sizeof *tree->nodes);
    if (builder.keys && tree->items && tree->nodes) {
        for (size_t i = 0; i < count; i++)
            tree->items[i] = (uint32_t)i;
        add_node(&builder, 0, count);
    } else {
        ffd_box_tree_free(tree);
    }
    ffd_free(builder.keys);
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
    const bounds query = {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
    return ffd_box_tree_visit_box(tree, &query, slack, visit, context);
}

/* Two boxes are tested at once with SIMD; without SIMD the compiler splits the vectors. */
typedef double pair __attribute__((vector_size(16)));
typedef int64_t pair_mask __attribute__((vector_size(16)));

static pair load_pair(const double *numbers)
{
    pair loaded;
    memcpy(&loaded, numbers, sizeof loaded);
    return loaded;
}

/* Returns a bit mask of the children whose boxes, grown by slack, meet query. */
static unsigned meet_children(const box_tree_node *node, const bounds *query, const double slack[3])
{
    unsigned met = 0;
    for (int i = 0; i < CHILDREN; i += 2) {
        pair_mask meets = {-1, -1};
        for (int a = 0; a < 3; a++)
            meets &= (query->hi[a] >= load_pair(node->lo[a] + i) - slack[a]) &
                     (query->lo[a] <= load_pair(node->hi[a] + i) + slack[a]);
        met |= ((unsigned)meets[0] & 1) << i | ((unsigned)meets[1] & 2) << i;
    }
    return met;
}

bool ffd_box_tree_visit_box(const box_tree *tree, const bounds *query, const double slack[3],
                            box_tree_visitor visit, void *context)
{
    box_tree_child stack[CHILDREN * DEPTH];
    int height = 0;
    if (tree->node_count > 0)
        stack[height++] = (box_tree_child){0, 0};
    while (height > 0) {
        const box_tree_child at = stack[--height];
        for (uint32_t i = 0; i < at.count; i++)
            if (!visit(context, tree->items[at.first + i]))
                return false;
        if (at.count > 0)
            continue;
        const box_tree_node *const node = &tree->nodes[at.first];
        const unsigned met = meet_children(node, query, slack);
        for (int i = CHILDREN - 1; i >= 0; i--)
            if (met >> i & 1)
                stack[height++] = node->children[i];
    }
    return true;
}

/* A child in the traversal by distance. */
typedef struct near_child {
    box_tree_child child;
    double square; /* squared distance of its box */
} near_child;

static double square_distance(const box_tree_node *node, int i, const double p[3])
{
    double square = 0;
    for (int a = 0; a < 3; a++) {
        const double beyond = maximum_number(maximum_number(node->lo[a][i] - p[a], p[a] - node->hi[a][i]), 0);
        square += beyond * beyond;
    }
    return square;
}

/* Pushes the children of a node on the stack, the nearest last. Returns their number. */
static int push_children(const box_tree_node *node, const double p[3], near_child *stack)
{
    int count = 0;
    for (int i = 0; i < CHILDREN; i++) {
        if (isnan(node->lo[0][i]))
            continue;
        const near_child child = {node->children[i], square_distance(node, i, p)};
        int at = count++;
        for (; at > 0 && stack[at - 1].square < child.square; at--)
            stack[at] = stack[at - 1];
        stack[at] = child;
    }
    return count;
}

bool ffd_box_tree_visit_near(const box_tree *tree, const double p[3], const double *reach,
                             box_tree_visitor visit, void *context)
{
    near_child stack[CHILDREN * DEPTH];
    int height = 0;
    if (tree->node_count > 0)
        stack[height++] = (near_child){.square = 0};
    while (height > 0) {
        const near_child at = stack[--height];
        if (at.square > *reach * *reach)
            continue;
        for (uint32_t i = 0; i < at.child.count; i++)
            if (!visit(context, tree->items[at.child.first + i]))
                return false;
        if (at.child.count == 0)
            height += push_children(&tree->nodes[at.child.first], p, stack + height);
    }
    return true;
}
