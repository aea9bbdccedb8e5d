/* grid_order.c - the directions of a grid of points whose file does not tell them. */
#include "base/memory/memory.h"
#include "base/text/words.h"
#include "base/vector/vec.h"
#include "lattice/formats/format_spec.h"
#include <math.h>
#include <stdio.h>
#include <string.h>

/* A grid of points along three directions. */
typedef struct point_grid {
    const double *points;
    size_t size[3], stride[3]; /* stride: in points, from one to the next along a direction */
} point_grid;

/* A direction of a grid, as it is or backwards. */
typedef struct grid_way {
    int direction;
    bool backwards;
} grid_way;

static const double *point_at(const point_grid *grid, size_t i, size_t j, size_t k)
{
    return grid->points + 3 * (i * grid->stride[0] + j * grid->stride[1] + k * grid->stride[2]);
}

/* The sum of the squared distances of neighbours. */
static double find_roughness(const point_grid *grid)
{
    double sum = 0;
    for (size_t k = 0; k < grid->size[2]; k++)
        for (size_t j = 0; j < grid->size[1]; j++)
            for (size_t i = 0; i < grid->size[0]; i++) {
                const size_t at[3] = {i, j, k};
                const double *const point = point_at(grid, i, j, k);
                for (int d = 0; d < 3; d++)
                    for (int c = 0; c < 3 && at[d] + 1 < grid->size[d]; c++) {
                        const double step = point[3 * grid->stride[d] + (size_t)c] - point[c];
                        sum += step * step;
                    }
            }
    return sum;
}

/* Finds which of the counts is that of the direction whose neighbours stand next to each other in the file,
   and which is next: where neighbours are nearest. */
static point_grid nest(const double *points, const size_t counts[3])
{
    static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    point_grid best = {0};
    double least = HUGE_VAL;
    for (int o = 0; o < 6; o++) {
        const size_t a = counts[orders[o][0]], b = counts[orders[o][1]], c = counts[orders[o][2]];
        const point_grid grid = {points, {a, b, c}, {1, a, a * b}};
        const double roughness = find_roughness(&grid);
        if (o == 0 || roughness < least) {
            best = grid;
            least = roughness;
        }
    }
    return best;
}

/* The determinant of the Jacobian of a cell, whose 8 points are joined linearly, at its middle. */
static double find_determinant(const point_grid *grid, size_t i, size_t j, size_t k)
{
    double columns[9] = {0};
    for (int corner = 0; corner < 8; corner++) {
        const size_t at[3] = {i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2 & 1)};
        const double *const point = point_at(grid, at[0], at[1], at[2]);
        for (int d = 0; d < 3; d++)
            for (int c = 0; c < 3; c++)
                columns[3 * d + c] += (corner >> d & 1 ? 0.25 : -0.25) * point[c];
    }
    return mat_determinant(columns); /* that of its transpose */
}

/* Returns the sign that all cells have, or 0. */
static int find_sign(const point_grid *grid)
{
    int sign = 0;
    for (size_t k = 0; k + 1 < grid->size[2]; k++)
        for (size_t j = 0; j + 1 < grid->size[1]; j++)
            for (size_t i = 0; i + 1 < grid->size[0]; i++) {
                const double determinant = find_determinant(grid, i, j, k);
                const int own = (determinant > 0) - (determinant < 0);
                if (own == 0 || (sign && own != sign))
                    return 0;
                sign = own;
            }
    return sign;
}

/* The mean of a direction's edges. */
static void find_mean(const point_grid *grid, int d, double mean[3])
{
    const int e = (d + 1) % 3, f = (d + 2) % 3;
    const size_t last = (grid->size[d] - 1) * grid->stride[d];
    memset(mean, 0, 3 * sizeof *mean);
    for (size_t j = 0; j < grid->size[e]; j++)
        for (size_t k = 0; k < grid->size[f]; k++) {
            const double *const first = grid->points + 3 * (j * grid->stride[e] + k * grid->stride[f]);
            for (size_t c = 0; c < 3; c++)
                mean[c] += first[3 * last + c] - first[c];
        }
}

/* Chooses, among the directions that are not taken, the one that leads most along an axis. */
static grid_way choose_way(double means[3][3], unsigned taken, int axis)
{
    grid_way best = {-1, false};
    double most = 0;
    for (int d = 0; d < 3; d++)
        for (int backwards = 0; backwards < 2; backwards++) {
            const double length = vec_length(means[d]);
            const double along = length > 0 ? (backwards ? -1 : 1) * means[d][axis] / length : 0;
            if (taken >> d & 1 || (best.direction >= 0 && !(along > most)))
                continue;
            best = (grid_way){d, backwards};
            most = along;
        }
    return best;
}

/* Chooses u nearest to +x, of the others v nearest to +y, and w so that the volume is not turned over. */
static void choose_ways(const point_grid *grid, int sign, grid_way ways[3])
{
    double means[3][3];
    for (int d = 0; d < 3; d++)
        find_mean(grid, d, means[d]);
    ways[0] = choose_way(means, 0, 0);
    ways[1] = choose_way(means, 1u << ways[0].direction, 1);
    ways[2].direction = 3 - ways[0].direction - ways[1].direction;
    const bool is_odd = ways[1].direction != (ways[0].direction + 1) % 3;
    ways[2].backwards = ((sign < 0) != is_odd) != (ways[0].backwards != ways[1].backwards);
}

/* Copies the points in the order of these ways, u fastest. */
static void copy_points(const point_grid *grid, const grid_way ways[3], double *to)
{
    size_t at[3], index[3];
    for (at[2] = 0; at[2] < grid->size[ways[2].direction]; at[2]++)
        for (at[1] = 0; at[1] < grid->size[ways[1].direction]; at[1]++)
            for (at[0] = 0; at[0] < grid->size[ways[0].direction]; at[0]++) {
                for (int a = 0; a < 3; a++) {
                    const int d = ways[a].direction;
                    index[d] = ways[a].backwards ? grid->size[d] - 1 - at[a] : at[a];
                }
                memcpy(to, point_at(grid, index[0], index[1], index[2]), 3 * sizeof *to);
                to += 3;
            }
}

ffd_status ffd_points_order(double **points, size_t states, size_t size[3], bool nests, const char *name,
                            const format_wish *wish, ffd_error *error)
{
    const point_grid as_is = {*points, {size[0], size[1], size[2]}, {1, size[0], size[0] * size[1]}};
    const size_t count = size[0] * size[1] * size[2];
    point_grid grid = nests ? nest(*points, size) : as_is;
    const int sign = find_sign(&grid);
    grid_way ways[3];
    if (sign == 0)
        return ffd_fail_file(error, FFD_E_INVALID, name,
                             "is not a grid of %zu x %zu x %zu points in any order: some of its cells are "
                             "turned over, or flat",
                             size[0], size[1], size[2]);
    choose_ways(&grid, sign, ways);
    double *const copy = ffd_alloc(states * count, 3 * sizeof *copy);
    if (!copy)
        return ffd_fail_memory(error);
    for (size_t s = 0; s < states; s++) {
        grid.points = *points + 3 * count * s;
        copy_points(&grid, ways, copy + 3 * count * s);
    }
    for (int a = 0; a < 3; a++)
        size[a] = grid.size[ways[a].direction];
    ffd_free(*points);
    *points = copy;
    if (wish->notes)
        wish->notes->found_order = true;
    return FFD_OK;
}
