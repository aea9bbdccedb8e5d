/* border.c - zeros of the determinant that the rest volume has too. */
#include "fold/bernstein.h"
#include "fold/search.h"
#include "fold/zeros.h"
#include <string.h>

#define UNIT (0.5 * DBL_EPSILON)

/* Zeros that the rest volume has on the border of the domain.

   On a face, edge or vertex of a box the polynomial depends on the coefficients of that face only, and inside
   of the face each of their Bernstein polynomials is positive. So if some coefficients are 0 and all others
   positive, det J > 0 on every (relatively open) face that has one of the others; and if each face off the
   domain's border has one, det J > 0 everywhere but on that border. It does not matter how near to the border
   the zero coefficients lie: two layers of them at a point to which a whole face has shrunk.

   Which coefficients are 0 is known in one of two ways.
   - exactly: control points are equal along lines (zeros.h), in both volumes. The above is the proof.
   - to rounding: where the rest volume has no such lines, but coefficients within its rounding of 0, those of
     volumes whose axis is not a line of equal control points (unclamped knots, weights that differ round the
     axis, points that were rounded). Excused are then coefficients of the first two layers that are 0 within
     rounding, that of the control points themselves included, in both volumes: nothing finer can be said of
     such a border, also not at rest. They may be less than 0 by 2 such bounds; the others are demanded to be
     MARGIN times greater, so that det J > 0 wherever these have 2 / MARGIN of the Bernstein polynomials' sum:
     everywhere but in a film on that border, the thinner the greater they are (usually some 1e-12 of the
   box).

   A coefficient that is exactly 0 at rest and no longer so is not excused: the axis has been torn open. */
#define MARGIN 1024

static void make_rest(cell_search *search)
{
    fold_scratch *scratch = search->scratch;
    cell_form form;
    determinant_bounds bounds;
    ffd_cell_form_make(search->plan, FFD_VOLUME_REST, search->index, search->rational, scratch->rest_rows,
                       scratch->working, &form);
    ffd_determinant_bounds(&form, &bounds);
    ffd_determinant_coefficients(&form, search->plan->volume.sign, scratch->working, scratch->rest);
    search->rest_greatest = ffd_bernstein_greatest_size(scratch->rest, ffd_bernstein_count(search->order));
    search->rest_rounding = bounds.coarse;
    search->has_exact_zeros =
        ffd_zeros_find(search->plan, search->index, search->rational, scratch->working, scratch->other);
    search->has_rest = true;
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
    if (!search->has_rest)
        make_rest(search);
    restrict_to(search, part, scratch->rest, scratch->rest_part);
    for (int volume = 0; volume < 2 && search->has_exact_zeros; volume++)
        restrict_to(search, part, scratch->other[volume], scratch->other_part[volume]);
}

/* Whether a coefficient's index is one of the first two from an end of the domain. */
static bool is_at_border(const bool touches[3][2], const int order[3], const int at[3])
{
    for (int a = 0; a < 3; a++)
        if ((touches[a][0] && at[a] <= 1) || (touches[a][1] && at[a] >= order[a] - 2))
            return true;
    return false;
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

/* Faces of a box by a digit a direction: 0 and 2 its ends, 1 between them. */
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

/* Whether each face off the domain's border is covered. */
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

/* Greatest sizes that pass for 0, of the deformed and of the rest volume's coefficients. */
typedef struct zero_bounds {
    double deformed, rest;
} zero_bounds;

static zero_bounds bounds_of(const cell_search *search, const box *part)
{
    return (zero_bounds){search->bounds.coarse + (part->rounding - search->bounds.rounding),
                         search->rest_rounding +
                             CELL_DEPTH * BERNSTEIN_MAX_ORDER * UNIT * search->rest_greatest};
}

typedef enum coefficient_zero { ZERO_NOT, ZERO_EXACT, ZERO_ROUNDED } coefficient_zero;

/* How coefficient i, whose index is at, is excused. */
static coefficient_zero zero_of(const cell_search *search, const box *part, const bool touches[3][2],
                                const zero_bounds *bounds, const int at[3], size_t i)
{
    const fold_scratch *scratch = search->scratch;
    if (search->has_exact_zeros && scratch->other_part[FFD_VOLUME_REST][i] == 0)
        return scratch->other_part[FFD_VOLUME_DEFORMED][i] == 0 ? ZERO_EXACT : ZERO_NOT;
    return fabs(part->coefficients[i]) <= bounds->deformed && fabs(scratch->rest_part[i]) <= bounds->rest &&
                   is_at_border(touches, search->order, at)
               ? ZERO_ROUNDED
               : ZERO_NOT;
}

void ffd_border_view(cell_search *search, const box *part, const bool touches[3][2], box_view *view)
{
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
    /* Without zeros, or with a coefficient that is not positive, this is what was found before. */
    view->is_positive = view->least > demanded && is_covered(touches, covered);
}
