/* border.c - excuses zeros of the determinant that the rest volume has too. */
#include "fold/bernstein.h"
#include "fold/search.h"
#include "fold/zeros.h"
#include <string.h>

#define UNIT (0.5 * DBL_EPSILON)

/* Why zeros of the rest volume on the border of the domain can be excused:

   On a face, edge or vertex of a box the polynomial depends only on the coefficients of that face, and inside
   the face each of their Bernstein polynomials is positive. So if some coefficients are 0 and all others
   positive, det J > 0 on every (relatively open) face that has a positive coefficient. If every face that is
   not on the border of the domain has one, det J > 0 everywhere except on that border. The number of layers
   of zero coefficients does not matter: there are two where a whole face has collapsed to a point.

   Coefficients count as 0 in one of two cases:
   - exactly: control points are equal along rows (zeros.h) in both volumes. The argument above is then a
     proof.
   - to rounding: the rest volume has no such rows, but has coefficients that are 0 within rounding. Its axis
     is then not a row of equal control points (unclamped knots, weights that differ round the axis, rounded
     points). Excused are coefficients of the first two layers that are 0 in both volumes within rounding,
     including that of the control points: nothing more precise can be said about such a border, even at rest.
     They may be below 0 by 2 rounding bounds. The others must exceed MARGIN bounds, so that det J > 0
     wherever these have 2 / MARGIN of the sum of the Bernstein polynomials: everywhere except in a film on
     that border, which is thinner the greater they are (usually about 1e-12 of the box).

   A coefficient that is exactly 0 at rest but not in the deformed volume is not excused: the axis is torn
   open. */
#define MARGIN 1024

/* Returns whether the index of a coefficient is in the first two layers at an end of the domain. */
static bool is_at_border(const bool touches[3][2], const int order[3], const int at[3])
{
    for (int a = 0; a < 3; a++)
        if ((touches[a][0] && at[a] <= 1) || (touches[a][1] && at[a] >= order[a] - 2))
            return true;
    return false;
}

/* With weights: returns whether the control points alone make the determinant of the rest volume 0 within
   rounding in the first two layers at an end of the domain. Else it has no zeros there with weights either,
   and nothing is excused. */
static bool may_have_zeros(cell_search *search)
{
    fold_scratch *scratch = search->scratch;
    determinant_bounds bounds;
    cell_form form;
    const double *c = scratch->rest;
    int order[3], at[3];
    ffd_cell_form_make(search->plan, FFD_VOLUME_REST, search->index, false, scratch->rest_rows,
                       scratch->working, &form);
    ffd_determinant_bounds(&form, &bounds);
    ffd_determinant_order(search->plan->order, false, order);
    ffd_determinant_coefficients(&form, 1, scratch->working, scratch->rest);
    search->boxes -= DETERMINANT_COST / 2;
    for (at[2] = 0; at[2] < order[2]; at[2]++)
        for (at[1] = 0; at[1] < order[1]; at[1]++)
            for (at[0] = 0; at[0] < order[0]; at[0]++, c++)
                if (fabs(*c) <= bounds.coarse && is_at_border((const bool(*)[2])search->on_border, order, at))
                    return true;
    return false;
}

static void make_rest(cell_search *search)
{
    fold_scratch *scratch = search->scratch;
    determinant_bounds bounds;
    cell_form *form = &search->rest_form;
    ffd_cell_form_make(search->plan, FFD_VOLUME_REST, search->index, search->rational, scratch->rest_rows,
                       scratch->working, form);
    ffd_determinant_bounds(form, &bounds);
    ffd_determinant_coefficients(form, search->plan->volume.sign, scratch->working, scratch->rest);
    search->rest_greatest = ffd_bernstein_greatest_size(scratch->rest, ffd_bernstein_count(search->order));
    search->rest_rounding = bounds.coarse;
    search->has_exact_zeros =
        ffd_zeros_find(search->plan, search->index, search->rational, scratch->working, scratch->other);
    search->rest = REST_MADE;
    search->boxes -= 2 * DETERMINANT_COST;
}

static void restrict_to(cell_search *search, const box *part, const double *whole, double *result)
{
    memcpy(result, whole, ffd_bernstein_count(search->order) * sizeof(double));
    ffd_bernstein_restrict(result, search->order, part->lo, part->hi, search->scratch->working);
    search->boxes--;
}

static void restrict_rest(cell_search *search, const box *part)
{
    fold_scratch *scratch = search->scratch;
    restrict_to(search, part, scratch->rest, scratch->rest_part);
    for (int volume = 0; volume < 2 && search->has_exact_zeros; volume++)
        restrict_to(search, part, scratch->other[volume], scratch->other_part[volume]);
}

static int corner_of(const int order[3], const int at[3])
{
    int corner = 0;
    for (int a = 0; a < 3; a++) {
        if (at[a] == order[a] - 1)
            corner |= 1 << a;
        else if (at[a] != 0)
            return -1;
    }
    return corner;
}

/* The faces, edges, vertices and the interior of a box, numbered by a base-3 digit for each direction: 0 and
   2 for its ends, 1 for between. */
#define FACES 27

/* Marks the faces on which the Bernstein polynomial of this index is positive. */
static void cover(const int order[3], const int at[3], bool covered[FACES])
{
    for (int face = 0; face < FACES; face++) {
        const int digit[3] = {face % 3, face / 3 % 3, face / 9};
        bool has = true;
        for (int a = 0; a < 3; a++)
            has &= digit[a] == 1 || (digit[a] == 0 ? at[a] == 0 : at[a] == order[a] - 1);
        covered[face] |= has;
    }
}

/* Returns whether every face that is not on the border of the domain is covered. */
static bool is_covered(const bool touches[3][2], const bool covered[FACES])
{
    for (int face = 0; face < FACES; face++) {
        const int digit[3] = {face % 3, face / 3 % 3, face / 9};
        bool excused = false;
        for (int a = 0; a < 3; a++)
            excused |= (digit[a] == 0 && touches[a][0]) || (digit[a] == 2 && touches[a][1]);
        if (!excused && !covered[face])
            return false;
    }
    return true;
}

/* The greatest magnitudes that count as 0, for coefficients of the deformed and of the rest volume. */
typedef struct zero_bounds {
    double deformed, rest;
    bool apply; /* false if they are those of a heavy corner of the box */
} zero_bounds;

/* With weights: the bound from the products in the box of one volume, if control points are known only to 2
   eps of their magnitude; at most that of the whole cell. */
static double bound_in_part(cell_search *search, const box *part, const cell_form *form, double cell,
                            bool *is_even)
{
    size_bounds sizes;
    ffd_sizes_bound_part(form, part->lo, part->hi, search->scratch->part_sizes, &sizes);
    *is_even = *is_even && sizes.is_even;
    search->boxes--;
    const double known = ffd_sizes_products(&sizes, true);
    const double bound = 1.01 * (known - ffd_sizes_products(&sizes, false)) +
                         (search->relative + 1.01 * UNIT * part->halvings) * known + LEAST_ROUNDING;
    return bound < cell ? bound : cell;
}

static zero_bounds bounds_of(cell_search *search, const box *part)
{
    zero_bounds bounds = {
        search->bounds.coarse + (part->cell_rounding - search->bounds.rounding),
        search->rest_rounding + CELL_DEPTH * BERNSTEIN_MAX_ORDER * UNIT * search->rest_greatest, true};
    if (search->rational) {
        bounds.deformed = bound_in_part(search, part, &search->form, bounds.deformed, &bounds.apply);
        bounds.rest = bound_in_part(search, part, &search->rest_form, bounds.rest, &bounds.apply);
    }
    return bounds;
}

typedef enum coefficient_zero { ZERO_NOT, ZERO_EXACT, ZERO_ROUNDED } coefficient_zero;

/* Returns how the coefficient i, with the index `at`, is excused. */
static coefficient_zero zero_of(const cell_search *search, const box *part, const bool touches[3][2],
                                const zero_bounds *bounds, const int at[3], size_t i)
{
    const fold_scratch *scratch = search->scratch;
    if (search->has_exact_zeros && scratch->other_part[FFD_VOLUME_REST][i] == 0)
        return scratch->other_part[FFD_VOLUME_DEFORMED][i] == 0 ? ZERO_EXACT : ZERO_NOT;
    return bounds->apply && fabs(part->coefficients[i]) <= bounds->deformed &&
                   fabs(scratch->rest_part[i]) <= bounds->rest && is_at_border(touches, search->order, at)
               ? ZERO_ROUNDED
               : ZERO_NOT;
}

void ffd_border_view(cell_search *search, const box *part, const bool touches[3][2], box_view *view)
{
    if (search->rest == REST_NOT_MADE) {
        if (search->rational && !may_have_zeros(search))
            search->rest = REST_WITHOUT_ZEROS;
        else
            make_rest(search);
    }
    if (search->rest == REST_WITHOUT_ZEROS)
        return;
    restrict_rest(search, part);
    const int *order = search->order;
    const zero_bounds bounds = bounds_of(search, part);
    const double *c = part->coefficients;
    double demanded = part->rounding;
    size_t i = 0;
    bool covered[FACES] = {false};
    int at[3];
    view->least = DBL_MAX;
    for (at[2] = 0; at[2] < order[2]; at[2]++)
        for (at[1] = 0; at[1] < order[1]; at[1]++)
            for (at[0] = 0; at[0] < order[0]; at[0]++, c++, i++) {
                const coefficient_zero zero = zero_of(search, part, touches, &bounds, at, i);
                if (zero != ZERO_NOT) {
                    const int corner = corner_of(order, at);
                    view->has_zeros = true;
                    if (corner >= 0)
                        view->corner_is_zero[corner] = true;
                    if (zero == ZERO_ROUNDED)
                        demanded = MARGIN * bounds.deformed;
                    continue;
                }
                cover(order, at, covered);
                if (*c < view->least) {
                    view->least = *c;
                    memcpy(view->at, at, sizeof at);
                }
            }
    /* Without zeros, or with a coefficient that is not positive, this equals the previous result. */
    view->is_positive = view->least > demanded && is_covered(touches, covered);
}
