#include "cells/reference.h"
#include "base/memory/memory.h"
#include <string.h>

/* At most three in each direction of a hexahedron, beside its points. */
#define PLACES (CELL_MOST_POINTS + 27)

typedef struct place_list {
    double at[PLACES][3];
    size_t count;
} place_list;

/* Roots of the Legendre polynomials of degree 2 and 3, moved to [0, 1]. */
static const double gauss2[] = {0.21132486540518711775, 0.78867513459481288225};
static const double gauss3[] = {0.11270166537925831148, 0.5, 0.88729833462074168852};

static void add_place(place_list *list, double r, double s, double t)
{
    const double at[3] = {r, s, t};
    memcpy(list->at[list->count++], at, sizeof at);
}

/* The points of a rule for cubes, also for pyramids by the square of their base and their height. */
static void add_cube(place_list *list, const double *roots, size_t count)
{
    for (size_t k = 0; k < count; k++)
        for (size_t j = 0; j < count; j++)
            for (size_t i = 0; i < count; i++)
                add_place(list, roots[i], roots[j], roots[k]);
}

/* The rule of degree 2 with four points (Hammer and Stroud, 1956). */
static void add_tetra(place_list *list)
{
    const double far = 0.58541019662496845446, near = 0.13819660112501051518;
    add_place(list, near, near, near);
    add_place(list, far, near, near);
    add_place(list, near, far, near);
    add_place(list, near, near, far);
}

/* The rule of degree 2 with three points in a triangle, at each root. */
static void add_wedge(place_list *list, const double *roots, size_t count)
{
    const double near = 1.0 / 6, far = 2.0 / 3;
    for (size_t k = 0; k < count; k++) {
        add_place(list, near, near, roots[k]);
        add_place(list, far, near, roots[k]);
        add_place(list, near, far, roots[k]);
    }
}

/* The corners and middles of a quadratic cell. The apex of a pyramid is seen along its edges: each of them
   has a Jacobian of its own there. */
static void add_points(const cell_type *type, place_list *list)
{
    for (size_t p = 0; p < type->points; p++)
        if (type->family == FAMILY_PYRAMID && type->places[p][2] == 2)
            for (int corner = 0; corner < 4; corner++)
                add_place(list, corner & 1, corner >> 1, 1);
        else
            add_place(list, type->places[p][0] * 0.5, type->places[p][1] * 0.5, type->places[p][2] * 0.5);
}

static bool is_quadratic(const cell_type *type)
{
    return type->points > ffd_cell_type_corners(type);
}

static void list_places(const cell_type *type, place_list *list)
{
    const bool quadratic = is_quadratic(type);
    const double *const roots = quadratic ? gauss3 : gauss2;
    const size_t count = quadratic ? 3 : 2;
    list->count = 0;
    if (quadratic)
        add_points(type, list);
    if (type->family == FAMILY_TETRA)
        add_tetra(list);
    else if (type->family == FAMILY_WEDGE)
        add_wedge(list, roots, count);
    else
        add_cube(list, roots, count);
}

/* Whether the shape functions of a kind have the term r^i s^j t^k. Of a pyramid it is r^i s^j z^m t^k, with r
   and s from the axis, z = 1 - t and m the greater of i and j (Bergot, Cohen, Durufle, Higher-order Finite
   Elements for Hybrid Meshes Using New Nodal Pyramidal Elements, 2010). */
static bool has_term(const cell_type *type, int i, int j, int k)
{
    const int order = is_quadratic(type) ? 2 : 1, flat = i > j ? i : j, squares = (i == 2) + (j == 2);
    if (flat > order || k > order)
        return false;
    switch (type->points) {
    case 10: /* tetra */
        return i + j + k <= 2;
    case 12: /* wedges */
        return i + j <= 2 && k <= 1;
    case 15:
        return i + j <= 2 && (k <= 1 || i + j <= 1);
    case 18:
        return i + j <= 2;
    case 6:
        return i + j <= 1;
    case 20: /* hexahedra */
        return squares + (k == 2) <= 1;
    case 24:
        return squares <= 1;
    case 13: /* pyramids */
        return flat + k <= order && squares <= 1;
    case 5:
    case 14:
        return flat + k <= order;
    default:
        return true; /* all of a hexahedron with 27 points */
    }
}

static double power(double x, int exponent)
{
    double value = 1;
    for (int i = 0; i < exponent; i++)
        value *= x;
    return value;
}

/* d x^e / dx */
static double slope(double x, int exponent)
{
    return exponent ? exponent * power(x, exponent - 1) : 0;
}

/* The value of a term, and its derivatives. Those of a pyramid by r and s are divided by z: its place is
   (r z, s z, t), and the terms of the derivative by t that are left out are multiples of the other two, which
   change no determinant. */
static void evaluate(bool is_pyramid, const int e[3], const double at[3], double *value, double slopes[3])
{
    const double middle = is_pyramid ? 0.5 : 0, r = at[0] - middle, s = at[1] - middle, t = at[2];
    const double z = is_pyramid ? 1 - t : 1;
    const int m = !is_pyramid ? 0 : e[0] > e[1] ? e[0] : e[1];
    const double flat = power(r, e[0]) * power(s, e[1]), along = power(t, e[2]);
    *value = flat * power(z, m) * along;
    slopes[0] = slope(r, e[0]) * power(s, e[1]) * (m > 0 ? power(z, m - is_pyramid) : 1) * along;
    slopes[1] = power(r, e[0]) * slope(s, e[1]) * (m > 0 ? power(z, m - is_pyramid) : 1) * along;
    slopes[2] = flat * (power(z, m) * slope(t, e[2]) - (is_pyramid ? slope(z, m) : 0) * along);
}

/* Rows of a system of equations, with the right sides behind. */
typedef struct equations {
    size_t count, width;
    double *rows;
} equations;

/* Gauss-Jordan elimination with the largest pivot of each column. The places make it well conditioned. */
static void solve(const equations *system)
{
    const size_t n = system->count, width = system->width;
    for (size_t c = 0; c < n; c++) {
        size_t pivot = c;
        for (size_t r = c + 1; r < n; r++)
            if (fabs(system->rows[r * width + c]) > fabs(system->rows[pivot * width + c]))
                pivot = r;
        double *const own = system->rows + c * width, *const other = system->rows + pivot * width;
        for (size_t k = 0; k < width && pivot != c; k++) {
            const double kept = own[k];
            own[k] = other[k];
            other[k] = kept;
        }
        const double by = own[c];
        for (size_t k = c; k < width; k++)
            own[k] /= by;
        for (size_t r = 0; r < n; r++) {
            double *const row = system->rows + r * width;
            const double factor = row[c];
            for (size_t k = c; k < width && r != c; k++)
                row[k] -= factor * own[k];
        }
    }
}

/* Fills the equations: for each term its values at the points, and its derivatives at the places. */
static void fill(const cell_type *type, const place_list *list, const equations *system)
{
    const bool is_pyramid = type->family == FAMILY_PYRAMID;
    size_t term = 0;
    for (int index = 0; index < 27; index++) {
        const int e[3] = {index % 3, index / 3 % 3, index / 9};
        double value, slopes[3];
        if (!has_term(type, e[0], e[1], e[2]))
            continue;
        double *const row = system->rows + term++ * system->width;
        for (size_t p = 0; p < type->points; p++) {
            const double at[3] = {type->places[p][0] * 0.5, type->places[p][1] * 0.5,
                                  type->places[p][2] * 0.5};
            evaluate(is_pyramid, e, at, &row[p], slopes);
        }
        for (size_t s = 0; s < list->count; s++)
            evaluate(is_pyramid, e, list->at[s], &value, row + type->points + 3 * s);
    }
}

ffd_status ffd_cell_rules_add(cell_rules *rules, const cell_type *type, ffd_error *error)
{
    const size_t index = ffd_cell_type_index(type), n = type->points;
    place_list list;
    if (!type->places || rules->of[index])
        return FFD_OK;
    list_places(type, &list);
    const size_t numbers = 3 * list.count * n;
    equations system = {n, n + 3 * list.count, ffd_alloc(n * (n + 3 * list.count), sizeof(double))};
    cell_rule *const rule = ffd_alloc(sizeof(cell_rule) + numbers * sizeof(double), 1);
    if (!system.rows || !rule) {
        ffd_free(system.rows);
        ffd_free(rule);
        return ffd_fail_memory(error);
    }
    fill(type, &list, &system);
    solve(&system);
    rule->points = n;
    rule->places = list.count;
    for (size_t s = 0; s < 3 * list.count; s++)
        for (size_t p = 0; p < n; p++)
            rule->weights[s * n + p] = system.rows[p * system.width + n + s];
    ffd_free(system.rows);
    rules->of[index] = rule;
    return FFD_OK;
}

void ffd_cell_rules_free(cell_rules *rules)
{
    for (size_t t = 0; t < CELL_TYPES; t++)
        ffd_free(rules->of[t]);
    memset(rules, 0, sizeof *rules);
}

/* The error of a determinant, relative to the product of the sums of the sizes that its columns are made of:
   that of the weights, some 1e-14, and of 27 products and three factors. */
#define RELATIVE_ERROR 1e-12
/* Products that underflow. */
#define ABSOLUTE_ERROR 1e-290

/* Whether all edges lie in a plane across an axis: all determinants are 0 then. */
static bool is_flat(const double *edges, size_t count)
{
    for (int a = 0; a < 3; a++) {
        size_t p = 0;
        while (p < count && edges[3 * p + (size_t)a] == 0)
            p++;
        if (p == count)
            return true;
    }
    return false;
}

void ffd_cell_rule_signs(const cell_rule *rule, const double (*points)[3], jacobian_signs *signs)
{
    double edges[CELL_MOST_POINTS][3], sizes[CELL_MOST_POINTS];
    const size_t n = rule->points;
    for (size_t p = 0; p < n; p++) {
        for (int a = 0; a < 3; a++)
            edges[p][a] = points[p][a] - points[0][a];
        sizes[p] = larger_of(larger_of(fabs(edges[p][0]), fabs(edges[p][1])), fabs(edges[p][2]));
    }
    const bool flat = is_flat(edges[0], n);
    for (size_t s = 0; s < rule->places; s++) {
        double column[3][3] = {{0}}, size = 1;
        for (size_t d = 0; d < 3; d++) {
            const double *const weights = rule->weights + (3 * s + d) * n;
            double sum = 0;
            for (size_t p = 1; p < n; p++) {
                for (int a = 0; a < 3; a++)
                    column[d][a] += weights[p] * edges[p][a];
                sum += fabs(weights[p]) * sizes[p];
            }
            size *= sum;
        }
        const double x = column[1][1] * column[2][2] - column[1][2] * column[2][1];
        const double y = column[1][2] * column[2][0] - column[1][0] * column[2][2];
        const double z = column[1][0] * column[2][1] - column[1][1] * column[2][0];
        const double value = column[0][0] * x + column[0][1] * y + column[0][2] * z;
        add_sign(signs, flat ? 0 : value, flat ? 0 : RELATIVE_ERROR * size + ABSOLUTE_ERROR);
    }
}
