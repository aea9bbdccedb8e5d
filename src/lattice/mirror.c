#include "lattice/mirror.h"
#include "base/memory/memory.h"
#include "base/text/number.h"
#include "base/vector/vec.h"
#include <float.h>
#include <stdio.h>

/* Positions whose distance is at most this fraction of the diagonal are equal. The rounding of coordinates
   far from the origin is added. */
#define SAME_PLACE 1e-9

/* A range of at most this many points is searched linearly. */
#define LEAF 8

/* A value of `split` that is not a coordinate: all points of the range are at the same position. */
#define ONE_PLACE 3

static void find_bounds(const double *points, const uint32_t *order, size_t count, double min[3],
                        double max[3])
{
    for (int c = 0; c < 3; c++) {
        min[c] = INFINITY;
        max[c] = -INFINITY;
    }
    for (size_t i = 0; i < count; i++) {
        const double *const p = points + 3 * (order ? order[i] : i);
        for (int c = 0; c < 3; c++) {
            min[c] = lesser_of(min[c], p[c]);
            max[c] = larger_of(max[c], p[c]);
        }
    }
}

/* Returns the plane without its place. */
static mirror_plane make_plane(const ffd_lattice *lattice, const double normal[3], double min[3],
                               double max[3])
{
    mirror_plane plane = {.axis = -1};
    double side[3], size = 0;
    find_bounds(lattice->rest, NULL, lattice->count, min, max);
    for (int c = 0; c < 3; c++) {
        side[c] = max[c] - min[c];
        size = larger_of(size, larger_of(fabs(min[c]), fabs(max[c])));
    }
    const double tolerance = SAME_PLACE * vec_length(side) + 16 * DBL_EPSILON * size;
    plane.tolerance = larger_of(tolerance, DBL_MIN);
    for (int c = 0; c < 3; c++) {
        plane.normal[c] = normal[c];
        if (fabs(normal[c]) == 1 && normal[(c + 1) % 3] == 0 && normal[(c + 2) % 3] == 0)
            plane.axis = c;
    }
    return plane;
}

mirror_plane ffd_mirror_middle(const ffd_lattice *lattice, int axis)
{
    const double normal[3] = {axis == 0, axis == 1, axis == 2};
    double min[3], max[3];
    mirror_plane plane = make_plane(lattice, normal, min, max);
    plane.twice = min[axis] + max[axis];
    plane.offset = 0.5 * plane.twice;
    return plane;
}

mirror_plane ffd_mirror_plane(const ffd_lattice *lattice, const double normal[3], double offset)
{
    double min[3], max[3];
    mirror_plane plane = make_plane(lattice, normal, min, max);
    plane.offset = offset;
    if (plane.axis >= 0)
        plane.twice = 2 * offset * normal[plane.axis];
    return plane;
}

void ffd_mirror_vector(const mirror_plane *plane, const double v[3], double image[3])
{
    /* v may be image: the product is taken first. */
    const double by = plane->axis < 0 ? 2 * vec_dot(plane->normal, v) : 0;
    for (int c = 0; c < 3; c++)
        image[c] = plane->axis < 0 ? v[c] - by * plane->normal[c] : c == plane->axis ? -v[c] : v[c];
}

void ffd_mirror_point(const mirror_plane *plane, const double p[3], double image[3])
{
    const double by = plane->axis < 0 ? 2 * (vec_dot(plane->normal, p) - plane->offset) : 0;
    for (int c = 0; c < 3; c++)
        image[c] = plane->axis < 0    ? p[c] - by * plane->normal[c]
                   : c == plane->axis ? plane->twice - p[c]
                                      : p[c];
}

void ffd_mirror_back(const mirror_plane *plane, const double p[3], const double from[3], const double to[3],
                     double moved[3])
{
    const bool is_still = to[0] == from[0] && to[1] == from[1] && to[2] == from[2];
    const bool is_across = plane->axis >= 0 && to[plane->axis] != from[plane->axis];
    ffd_mirror_point(plane, to, moved);
    for (int c = 0; c < 3; c++)
        if (is_still || (c == plane->axis && !is_across))
            moved[c] = p[c];
}

mirror_text ffd_mirror_describe(const mirror_plane *plane)
{
    mirror_text described = {""};
    size_t length = 0;
    if (plane->axis >= 0) {
        snprintf(described.text, sizeof described.text, "%c = %s", "xyz"[plane->axis],
                 ffd_number_text(0.5 * plane->twice).text);
        return described;
    }
    for (int c = 0; c < 3; c++)
        if (plane->normal[c] != 0)
            length += (size_t)snprintf(described.text + length, sizeof described.text - length, "%s%.6g %c",
                                       length == 0            ? ""
                                       : plane->normal[c] < 0 ? " - "
                                                              : " + ",
                                       length == 0 ? plane->normal[c] : fabs(plane->normal[c]), "xyz"[c]);
    snprintf(described.text + length, sizeof described.text - length, " = %.6g", plane->offset);
    return described;
}

static void swap(uint32_t *a, uint32_t *b)
{
    const uint32_t kept = *a;
    *a = *b;
    *b = kept;
}

/* Hoare's selection: afterwards no point before the middle is greater along c than the middle one, and none
   after it is less. Pivots are pseudo-random, so that no order of points in a file makes it slow. */
static void put_middle(mirror_tree *tree, size_t begin, size_t end, size_t middle, int c)
{
    uint32_t *const order = tree->order;
    uint64_t draw = end;
    while (end - begin > 1) {
        draw = draw * 6364136223846793005u + 1442695040888963407u;
        const double pivot = tree->points[3 * order[begin + (draw >> 33) % (end - begin)] + (size_t)c];
        size_t low = begin, high = end;
        while (low < high) {
            while (tree->points[3 * order[low] + (size_t)c] < pivot)
                low++;
            while (tree->points[3 * order[high - 1] + (size_t)c] > pivot)
                high--;
            if (low < high)
                swap(&order[low++], &order[--high]);
        }
        if (middle < high)
            end = high;
        else if (middle >= low)
            begin = low;
        else
            return;
    }
}

static void split_range(mirror_tree *tree, size_t begin, size_t end)
{
    double min[3], max[3];
    const size_t middle = begin + (end - begin) / 2;
    int widest = 0;
    if (end - begin <= LEAF)
        return;
    find_bounds(tree->points, tree->order + begin, end - begin, min, max);
    for (int c = 1; c < 3; c++)
        if (max[c] - min[c] > max[widest] - min[widest])
            widest = c;
    if (!(max[widest] > min[widest])) {
        tree->split[middle] = ONE_PLACE;
        return;
    }
    tree->split[middle] = (unsigned char)widest;
    put_middle(tree, begin, end, middle, widest);
    split_range(tree, begin, middle);
    split_range(tree, middle + 1, end);
}

/* Builds the tree of all points, or of the selected ones. */
static ffd_status make_tree(const ffd_lattice *lattice, const unsigned char *selected, mirror_tree *tree,
                            ffd_error *error)
{
    *tree = (mirror_tree){.points = lattice->rest,
                          .order = ffd_alloc(lattice->count, sizeof *tree->order),
                          .split = ffd_alloc(lattice->count, sizeof *tree->split)};
    if (!tree->order || !tree->split) {
        ffd_mirror_tree_free(tree);
        return ffd_fail_memory(error);
    }
    for (size_t i = 0; i < lattice->count; i++)
        if (!selected || selected[i])
            tree->order[tree->count++] = (uint32_t)i;
    split_range(tree, 0, tree->count);
    return FFD_OK;
}

/* A lookup of a point within the tolerance of a position. Lengths are in units of the tolerance, so that
   squares neither overflow nor underflow. */
typedef struct find_slot {
    const mirror_tree *tree;
    const double *place;
    double tolerance;
    double offset[3]; /* lower bound of the distance to the current range in each coordinate */
} find_slot;

static bool is_near(const double offset[3])
{
    return vec_dot(offset, offset) <= 1;
}

static bool is_at(const find_slot *search, size_t place_in_order)
{
    const double *const p = search->tree->points + 3 * (size_t)search->tree->order[place_in_order];
    double offset[3];
    for (int c = 0; c < 3; c++)
        offset[c] = (p[c] - search->place[c]) / search->tolerance;
    return is_near(offset);
}

static bool find_in(find_slot *search, size_t begin, size_t end)
{
    const size_t middle = begin + (end - begin) / 2;
    if (end - begin <= LEAF) {
        for (size_t i = begin; i < end; i++)
            if (is_at(search, i))
                return true;
        return false;
    }
    const int c = search->tree->split[middle];
    if (c == ONE_PLACE)
        return is_at(search, begin);
    const double *const p = search->tree->points + 3 * (size_t)search->tree->order[middle];
    const double from_split = (search->place[c] - p[c]) / search->tolerance, kept = search->offset[c];
    const bool before = from_split < 0;
    if (is_at(search, middle) || (before ? find_in(search, begin, middle) : find_in(search, middle + 1, end)))
        return true;
    search->offset[c] = larger_of(kept, fabs(from_split));
    const bool found = is_near(search->offset) &&
                       (before ? find_in(search, middle + 1, end) : find_in(search, begin, middle));
    search->offset[c] = kept;
    return found;
}

static bool has_image(const mirror_tree *tree, const mirror_plane *plane, size_t point)
{
    double image[3];
    ffd_mirror_point(plane, tree->points + 3 * point, image);
    find_slot search = {.tree = tree, .place = image, .tolerance = plane->tolerance};
    return find_in(&search, 0, tree->count);
}

ffd_status ffd_mirror_select(const ffd_lattice *lattice, const mirror_plane *plane, mirror_tree *all,
                             unsigned char *selected, size_t *missing, ffd_error *error)
{
    mirror_tree chosen;
    TRY(all->order ? FFD_OK : make_tree(lattice, NULL, all, error));
    TRY(make_tree(lattice, selected, &chosen, error));
    *missing = lattice->count;
    for (size_t i = 0; i < lattice->count && *missing == lattice->count; i++)
        if (selected[i] && !has_image(all, plane, i))
            *missing = i;
    for (size_t i = 0; i < lattice->count && *missing == lattice->count; i++)
        selected[i] = has_image(&chosen, plane, i);
    ffd_mirror_tree_free(&chosen);
    return FFD_OK;
}

void ffd_mirror_tree_free(mirror_tree *tree)
{
    ffd_free(tree->order);
    ffd_free(tree->split);
    *tree = (mirror_tree){0};
}
