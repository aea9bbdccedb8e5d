#include "cells/cell_measure.h"
#include "base/vector/vec.h"
#include "cells/corners.h"
#include "cells/hexahedron.h"
#include "cells/polyhedron.h"
#include <math.h>
#include <string.h>

/* Between these coordinates no product of six lengths overflows, nor are their bits lost. */
#define LEAST_COORDINATE 0x1p-100
#define LARGEST_COORDINATE 0x1p100

/* Nothing is known. */
static const cell_measure nothing = {JACOBIAN_UNKNOWN, NAN, NAN};

/* Returns the power of two by which points are multiplied, as an exponent. */
static int scale_of(double largest)
{
    int exponent;
    if (largest == 0 || (largest >= LEAST_COORDINATE && largest <= LARGEST_COORDINATE))
        return 0;
    frexp(largest, &exponent);
    return exponent < -1000 ? 1000 : -exponent; /* whose power is finite */
}

/* Returns the largest size of a coordinate; NaN or infinite if one is not finite. */
static double largest_of(const double *numbers, size_t count)
{
    double largest = 0;
    for (size_t i = 0; i < count; i++) {
        const double size = fabs(numbers[i]);
        largest = size <= largest ? largest : size;
        if (!isfinite(largest))
            break;
    }
    return largest;
}

/* Multiplies the points, unless that loses bits: some are so much smaller than others. */
static int scale_points(double (*points)[3], size_t count)
{
    double scaled[CELL_MOST_POINTS][3];
    const int exponent = scale_of(largest_of(points[0], 3 * count));
    if (exponent == 0)
        return 0;
    for (size_t p = 0; p < count; p++)
        for (int a = 0; a < 3; a++) {
            const double x = points[p][a];
            scaled[p][a] = ldexp(x, exponent);
            if (ldexp(scaled[p][a], -exponent) < x || ldexp(scaled[p][a], -exponent) > x)
                return 0;
        }
    memcpy(points, scaled, count * sizeof *points);
    return exponent;
}

static cell_measure measure_linear(const cell_rules *rules, const cell_type *type, const double (*points)[3])
{
    jacobian_signs signs = no_signs();
    double least;
    if (type->family == FAMILY_HEXAHEDRON) {
        const jacobian_state state = ffd_hexahedron_state(points, &least);
        return (cell_measure){state, least, NAN};
    }
    ffd_corner_signs(type->family, points, &signs);
    if (type->family != FAMILY_TETRA)
        ffd_cell_rule_signs(rules->of[ffd_cell_type_index(type)], points, &signs);
    return (cell_measure){state_of(&signs), signs.least, NAN};
}

static cell_measure measure_points(const cell_rules *rules, const cell_type *type, const uint32_t *words,
                                   const double *points)
{
    const size_t corners = ffd_cell_type_corners(type);
    double own[CELL_MOST_POINTS][3];
    cell_measure measure;
    for (size_t p = 0; p < type->points; p++)
        memcpy(own[p], points + 3 * (size_t)words[type->order ? type->order[p] : p], sizeof own[p]);
    if (!isfinite(largest_of(own[0], 3 * (size_t)type->points)))
        return nothing;
    const int exponent = scale_points(own, type->points);
    const double(*const ready)[3] = (const double(*)[3])own;
    if (type->points > corners) {
        jacobian_signs signs = no_signs();
        ffd_cell_rule_signs(rules->of[ffd_cell_type_index(type)], ready, &signs);
        measure = (cell_measure){quadratic_state_of(&signs), signs.least, NAN};
    } else
        measure = measure_linear(rules, type, ready);
    measure.scaled = ffd_corners_scaled(type->family, ready);
    measure.jacobian = ldexp(measure.jacobian, -3 * exponent);
    return measure;
}

/* Returns the largest coordinate of the vertices of all faces. */
static double largest_of_faces(const uint32_t *words, const double *points)
{
    const uint32_t *at = words + 1;
    double largest = 0;
    for (uint32_t f = 0; f < words[0] && isfinite(largest); f++, at += 1 + (size_t)*at)
        for (uint32_t i = 1; i <= *at && isfinite(largest); i++) {
            const double size = largest_of(points + 3 * (size_t)at[i], 3);
            largest = size <= largest ? largest : size;
        }
    return largest;
}

static cell_measure measure_faces(const uint32_t *words, const double *points, const double *rest)
{
    jacobian_signs signs = no_signs();
    const double largest = largest_of_faces(words, points);
    const bool is_oriented = ffd_polyhedron_is_oriented(words);
    const double *const outwards = is_oriented ? NULL : rest;
    if (!isfinite(largest) || (outwards && !isfinite(largest_of_faces(words, outwards))))
        return nothing;
    const int exponent = scale_of(largest);
    ffd_polyhedron_signs(words, points, ldexp(1, exponent), outwards, &signs);
    return (cell_measure){is_oriented || rest ? state_of(&signs) : JACOBIAN_UNKNOWN,
                          isfinite(signs.least) ? ldexp(signs.least, -3 * exponent) : NAN, NAN};
}

cell_measure ffd_cell_measure(const cell_rules *rules, const cell_view *cell, const double *points,
                              const double *rest)
{
    const cell_type *const type = ffd_cell_type(cell->number, cell->count);
    uint32_t prism[PRISM_WORDS];
    if (!type)
        return nothing;
    if (type->family == FAMILY_POLYHEDRON)
        return measure_faces(cell->words, points, rest);
    if (type->family != FAMILY_PRISM)
        return measure_points(rules, type, cell->words, points);
    ffd_prism_words(cell->words, type->points / 2, prism);
    return measure_faces(prism, points, rest);
}
