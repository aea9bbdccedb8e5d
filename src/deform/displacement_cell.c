#include "deform/displacement_cell.h"
#include "base/vector/vec.h"
#include <math.h>
#include <string.h>

bool ffd_displacement_reaches(const ffd_lattice *lattice, const int span[3])
{
    size_t first[3];
    for (int a = 0; a < 3; a++)
        first[a] = (size_t)(span[a] - lattice->knots[a].degree);
    for (int k = 0; k <= lattice->knots[2].degree; k++) {
        const size_t plane = lattice->size[1] * ffd_knots_point(&lattice->knots[2], first[2] + (size_t)k);
        for (int j = 0; j <= lattice->knots[1].degree; j++) {
            const size_t row =
                lattice->size[0] * (plane + ffd_knots_point(&lattice->knots[1], first[1] + (size_t)j));
            for (int i = 0; i <= lattice->knots[0].degree; i++)
                if (lattice->moved[row + ffd_knots_point(&lattice->knots[0], first[0] + (size_t)i)])
                    return true;
        }
    }
    return false;
}

/* The position of a parameter in a span: on its first knot, between the knots, or on the last knot, which is
   then the end of the domain. */
typedef enum span_place { ON_FIRST_KNOT, BETWEEN_KNOTS, ON_LAST_KNOT, SPAN_PLACES } span_place;

/* Returns the functions that are not 0 at a place. At a knot of multiplicity m there are m fewer than between
   knots; at the end of a clamped direction there is one. */
static function_range acting_at(const knot_vector *knots, int span, span_place place)
{
    const int degree = knots->degree;
    const double *const t = knots->t + span;
    int absent = 0;
    if (place == ON_FIRST_KNOT)
        while (absent < degree && t[-absent] == t[0])
            absent++;
    else if (place == ON_LAST_KNOT)
        while (absent < degree && t[1 + absent] == t[1])
            absent++;
    return (function_range){place == ON_LAST_KNOT ? absent : 0, degree + 1 - absent};
}

static span_place place_of(const knot_vector *knots, int span, double u)
{
    const double *const t = knots->t + span;
    return u <= t[0] ? ON_FIRST_KNOT : u < t[1] ? BETWEEN_KNOTS : ON_LAST_KNOT;
}

function_range ffd_displacement_acting(const knot_vector *knots, int span, double u)
{
    return acting_at(knots, span, place_of(knots, span, u));
}

/* Returns the index of the control point of function i of a span. */
static size_t index_of(const knot_vector *knots, int span, int i)
{
    return ffd_knots_point(knots, (size_t)(span - knots->degree + i));
}

/* Returns the index of the first control point of a block of a cell. */
static size_t first_of(const ffd_lattice *lattice, const int span[3], const function_range block[3])
{
    size_t index[3];
    for (int a = 0; a < 3; a++)
        index[a] = index_of(&lattice->knots[a], span[a], block[a].first);
    return index[0] + lattice->size[0] * (index[1] + lattice->size[1] * index[2]);
}

/* Returns whether all control points of a block have the same displacement. */
static bool moves_alike(const ffd_lattice *lattice, const int span[3], const function_range block[3])
{
    for (int k = 0; k < block[2].count; k++) {
        const size_t plane = lattice->size[1] * index_of(&lattice->knots[2], span[2], block[2].first + k);
        for (int j = 0; j < block[1].count; j++) {
            const size_t row =
                lattice->size[0] * (plane + index_of(&lattice->knots[1], span[1], block[1].first + j));
            for (int i = 0; i < block[0].count; i++) {
                const size_t point = row + index_of(&lattice->knots[0], span[0], block[0].first + i);
                const unsigned char wanted =
                    (unsigned char)((i + 1 < block[0].count ? POINT_LIKE_NEXT_U : 0) |
                                    (i == 0 && j + 1 < block[1].count ? POINT_LIKE_NEXT_V : 0) |
                                    (i + j == 0 && k + 1 < block[2].count ? POINT_LIKE_NEXT_W : 0));
                if ((lattice->moved[point] & wanted) != wanted)
                    return false;
            }
        }
    }
    return true;
}

/* Returns the common displacement of the control points of a block, or NULL, as ffd_displacement_shared. */
static const double *shared_in(const ffd_lattice *lattice, const int span[3], const function_range block[3])
{
    const size_t first = first_of(lattice, span, block);
    const bool weight_moved =
        lattice->weights_moved && lattice->rest_weights[first] != lattice->deformed_weights[first];
    return lattice->moved[first] && !weight_moved && moves_alike(lattice, span, block)
               ? lattice->difference + 3 * first
               : NULL;
}

const double *ffd_displacement_shared(const ffd_lattice *lattice, const int span[3], const double *uvw)
{
    function_range block[3];
    for (int a = 0; a < 3; a++) {
        const span_place place = uvw ? place_of(&lattice->knots[a], span[a], uvw[a]) : BETWEEN_KNOTS;
        block[a] = acting_at(&lattice->knots[a], span[a], place);
    }
    if (uvw)
        return shared_in(lattice, span, block);
    const size_t first = first_of(lattice, span, block);
    return lattice->moved[first] & POINT_BEGINS_CELL ? lattice->difference + 3 * first : NULL;
}

/* Returns the bit of cell_motion.knots for the last direction in which a place is on a knot; 0 if there is
   none. */
static uint8_t knot_bit(const span_place place[3])
{
    for (int a = 3; a-- > 0;)
        if (place[a] != BETWEEN_KNOTS)
            return (uint8_t)(1 << (2 * a + (place[a] == ON_LAST_KNOT)));
    return 0;
}

/* The functions that are not 0 at each place of a cell. */
typedef struct cell_blocks {
    function_range block[3][SPAN_PLACES];
    span_place last[3];
} cell_blocks;

/* Returns whether the control points at a place on a knot have a common displacement. A single control point
   need not be checked, because the sum is exact then. */
static bool shares_at(const ffd_lattice *lattice, const int span[3], const cell_blocks *blocks,
                      const span_place place[3])
{
    const function_range block[3] = {blocks->block[0][place[0]], blocks->block[1][place[1]],
                                     blocks->block[2][place[2]]};
    return block[0].count * block[1].count * block[2].count > 1 && shared_in(lattice, span, block);
}

/* Returns the bits of cell_motion.knots: the knots with a place that has a common displacement. */
static uint8_t find_knots(const ffd_lattice *lattice, const int span[3], const cell_blocks *blocks)
{
    uint8_t knots = 0;
    for (int w = 0; w <= (int)blocks->last[2]; w++)
        for (int v = 0; v <= (int)blocks->last[1]; v++)
            for (int u = 0; u <= (int)blocks->last[0]; u++) {
                const span_place place[3] = {(span_place)u, (span_place)v, (span_place)w};
                const uint8_t bit = knot_bit(place);
                if (bit && !(knots & bit) && shares_at(lattice, span, blocks, place))
                    knots |= bit;
            }
    return knots;
}

/* The same with an early exit: except at the end of the domain, all places that can have a common
   displacement include the first control point of the cell. */
static uint8_t knots_that_share(const ffd_lattice *lattice, const int span[3])
{
    cell_blocks blocks;
    function_range all[3];
    bool at_end = false;
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const bool is_last = span[a] == knots->spans[knots->span_count - 1];
        blocks.last[a] = is_last ? ON_LAST_KNOT : BETWEEN_KNOTS;
        at_end = at_end || is_last;
        all[a] = (function_range){0, knots->degree + 1};
    }
    if (!at_end && !(lattice->moved[first_of(lattice, span, all)] & POINT_LIKE_NEXT))
        return 0;
    for (int a = 0; a < 3; a++)
        for (int place = 0; place <= (int)blocks.last[a]; place++)
            blocks.block[a][place] = acting_at(&lattice->knots[a], span[a], (span_place)place);
    return find_knots(lattice, span, &blocks);
}

static cell_motion motion_of(const ffd_lattice *lattice, const int span[3])
{
    if (!ffd_displacement_reaches(lattice, span))
        return (cell_motion){.kind = CELL_STILL};
    if (!lattice->moves_alike)
        return (cell_motion){.kind = CELL_BENT};
    if (ffd_displacement_shared(lattice, span, NULL))
        return (cell_motion){.kind = CELL_SHIFTED};
    return (cell_motion){.kind = CELL_BENT, .knots = knots_that_share(lattice, span)};
}

void ffd_displacement_spans(const ffd_lattice *lattice, const size_t index[3], int span[3])
{
    for (int a = 0; a < 3; a++)
        span[a] = lattice->knots[a].spans[index[a]];
}

void ffd_displacement_wrap(const ffd_lattice *lattice, const double uvw[3], double inside[3])
{
    for (int a = 0; a < 3; a++)
        inside[a] = ffd_knots_wrap(&lattice->knots[a], uvw[a]);
}

void ffd_displacement_to_space(const double jacobian[9], double gradient[9])
{
    double inverse[9], by_uvw[9];
    memcpy(by_uvw, gradient, sizeof by_uvw);
    if (mat_invert(jacobian, inverse))
        mat_multiply(by_uvw, inverse, gradient);
    else
        memset(gradient, 0, 9 * sizeof *gradient);
}

static bool needs_rest(const ffd_lattice *lattice, cell_use use)
{
    return use == CELL_GRADIENTS && !lattice->has_uvw_by_p;
}

/* Return the number of doubles for the points and for the slopes of a field in a cell. */
static size_t point_width(const ffd_lattice *lattice)
{
    size_t count = 3;
    for (int a = 0; a < 3; a++)
        count *= (size_t)lattice->knots[a].degree + 1;
    return count;
}

static size_t slope_width(const ffd_lattice *lattice)
{
    const size_t degree = (size_t)lattice->knots[0].degree;
    return point_width(lattice) / (degree + 1) * degree;
}

static size_t field_width(const ffd_lattice *lattice, cell_use use)
{
    return point_width(lattice) + (use == CELL_VALUES ? 0 : slope_width(lattice));
}

void ffd_displacement_cell_field(const ffd_lattice *lattice, extraction_kernel *extract,
                                 const size_t index[3], const double *field, bool with_slopes,
                                 double *numbers)
{
    const size_t count = point_width(lattice);
    int degree[3], span[3];
    const double *extraction[3];
    ffd_displacement_spans(lattice, index, span);
    ffd_lattice_cell_points(lattice, field, span, numbers);
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const size_t order = (size_t)knots->degree + 1;
        degree[a] = knots->degree;
        extraction[a] = knots->extractions + index[a] * order * order;
    }
    numbers[count] = 0;
    extract(degree, extraction, numbers, with_slopes ? numbers + count : NULL);
}

size_t ffd_displacement_cell_width(const ffd_lattice *lattice, cell_use use)
{
    return (needs_rest(lattice, use) ? 2 : 1) * field_width(lattice, use);
}

cell_motion ffd_displacement_cell_points(const ffd_lattice *lattice, extraction_kernel *extract,
                                         const size_t index[3], cell_use use, double *numbers)
{
    int span[3];
    ffd_displacement_spans(lattice, index, span);
    const cell_motion motion = motion_of(lattice, span);
    if (motion.kind != CELL_BENT)
        return motion;
    const bool with_slopes = use != CELL_VALUES;
    ffd_displacement_cell_field(lattice, extract, index, lattice->difference, with_slopes, numbers);
    if (needs_rest(lattice, use))
        ffd_displacement_cell_field(lattice, extract, index, lattice->rest, with_slopes,
                                    numbers + field_width(lattice, use));
    return motion;
}

void ffd_displacement_cell_begin(const ffd_lattice *lattice, const size_t index[3], cell_use use,
                                 const double *numbers, kernel_cell *cell)
{
    for (int a = 0; a < 3; a++) {
        const knot_vector *const knots = &lattice->knots[a];
        const int span = knots->spans[index[a]];
        cell->degree[a] = knots->degree;
        cell->first[a] = knots->t[span];
        cell->width[a] = knots->t[span + 1] - knots->t[span];
    }
    const size_t points = point_width(lattice);
    const double *const rest = numbers + field_width(lattice, use);
    cell->difference = (kernel_field){numbers, numbers + points};
    cell->rest = needs_rest(lattice, use) ? (kernel_field){rest, rest + points} : (kernel_field){NULL, NULL};
    cell->inverse = lattice->has_uvw_by_p ? lattice->uvw_by_p : NULL;
}
