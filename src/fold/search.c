#include "fold/search.h"
#include "fold/bernstein.h"

#define UNIT (0.5 * DBL_EPSILON)

/* The least side of a box. Smaller ones near 1 have ends that are not doubles. */
#define LEAST_SIDE 0x1p-53

static void local_of(const box *part, const double t[3], double local[3])
{
    for (int a = 0; a < 3; a++)
        local[a] = part->lo[a] + t[a] * (part->hi[a] - part->lo[a]);
}

/* Tests the corners, whose coefficients are values. Returns whether one of them is so near to 0 that its sign
   is unknown; search->result records a negative one. */
static bool test_corners(cell_search *search, const box *part, const box_view *view)
{
    const int *order = search->order;
    bool doubtful = false;
    for (int corner = 0; corner < 8; corner++) {
        double t[3], local[3];
        size_t at = 0, stride = 1;
        for (int a = 0; a < 3; a++) {
            t[a] = corner >> a & 1;
            at += stride * (corner >> a & 1 ? (size_t)order[a] - 1 : 0);
            stride *= (size_t)order[a];
        }
        const double value = view->corner_is_zero[corner] ? 0 : part->coefficients[at];
        const double relative = ffd_search_relative(search, value, ffd_box_weight(search, part, t));
        ffd_search_see(search, relative);
        if (view->corner_is_zero[corner])
            continue;
        doubtful |= fabs(value) <= part->rounding;
        if (value < -part->rounding && search->result.verdict != FFD_FOLDS_SOME) {
            local_of(part, t, local);
            ffd_search_set_folded(search, local, relative);
        }
    }
    return doubtful;
}

/* Tests the value at the parameter where the least coefficient has its greatest influence. */
static void test_least(cell_search *search, const box *part, const box_view *view)
{
    double t[3], local[3];
    int orders = 0;
    for (int a = 0; a < 3; a++) {
        t[a] = (double)view->at[a] / (search->order[a] - 1);
        orders += search->order[a];
    }
    const double value = ffd_bernstein_value(part->coefficients, search->order, t);
    const double relative = ffd_search_relative(search, value, ffd_box_weight(search, part, t));
    const double greatest =
        search->rational ? ffd_bernstein_greatest_size(part->coefficients, ffd_bernstein_count(search->order))
                         : search->greatest;
    ffd_search_see(search, relative);
    if (value < -part->rounding - 8 * orders * UNIT * greatest && search->result.verdict != FFD_FOLDS_SOME) {
        local_of(part, t, local);
        ffd_search_set_folded(search, local, relative);
    }
}

/* Returns whether all coefficients are 0 within rounding: smaller boxes, if the weights do not differ, cannot
   decide the sign. */
static bool is_lost(const cell_search *search, const box *part)
{
    return ffd_bernstein_greatest_size(part->coefficients, ffd_bernstein_count(search->order)) <=
           part->rounding;
}

/* Nothing is proven negative, and smaller boxes cannot prove more. A whole cell of this kind is flat to
   rounding, unless its computed determinant has the right sign everywhere. */
static void give_up(cell_search *search, const box *part, int depth)
{
    static const double centre[3] = {0.5, 0.5, 0.5};
    if (depth == 0 && !search->rational && is_lost(search, part) && !(ffd_box_least(search, part) > 0))
        ffd_search_set_folded(search, centre, 0);
    else
        search->result.verdict = FFD_FOLDS_UNKNOWN;
}

/* For the verdict: returns whether the box is decided. */
static bool is_decided(cell_search *search, const box *part, const box_view *view, int depth)
{
    if (view->is_positive)
        return true;
    if (is_lost(search, part)) {
        if (depth == 0 && search->rational)
            ffd_search_flat(search);
        if (search->result.verdict != FFD_FOLDS_SOME && part->is_even)
            give_up(search, part, depth);
        return search->result.verdict == FFD_FOLDS_SOME || part->is_even;
    }
    const bool doubtful = test_corners(search, part, view);
    if (search->result.verdict == FFD_FOLDS_SOME)
        return true;
    if (doubtful && part->is_even && view->least >= -part->rounding) {
        give_up(search, part, depth);
        return true;
    }
    test_least(search, part, view);
    return search->result.verdict == FFD_FOLDS_SOME;
}

/* For the refinement of min_det: returns whether the bound of the box is good enough. */
static bool is_near(cell_search *search, const box *part, const box_view *view)
{
    test_corners(search, part, view);
    const double rounding = ffd_search_relative(search, 4 * part->rounding, view->least_weight);
    const double lower = ffd_box_lower(search, part, view), seen = search->result.least_seen;
    if (lower >= ffd_fold_target(seen) || (part->is_even && lower >= seen - rounding))
        return true;
    test_least(search, part, view);
    return lower >= ffd_fold_target(search->result.least_seen);
}

static bool must_stop(const cell_search *search)
{
    return !search->refining && search->result.verdict == FFD_FOLDS_SOME;
}

/* Returns the direction in which to halve a box, or -1 if it cannot be halved: because it has the greatest
   depth, the budget is used up, or its ends would no longer be exact. */
static int direction_of(const cell_search *search, const box *part, int depth)
{
    if (depth == search->scratch->depth || search->boxes <= 0)
        return -1;
    const int a = ffd_bernstein_direction(part->coefficients, search->order);
    return part->hi[a] - part->lo[a] > LEAST_SIDE ? a : -1;
}

void ffd_search_box(cell_search *search, box *part, int depth)
{
    box_view view;
    search->boxes--;
    ffd_box_view(search, part, &view);
    if (depth == 0)
        search->whole_lower = ffd_box_lower(search, part, &view);
    const bool done =
        search->refining ? is_near(search, part, &view) : is_decided(search, part, &view, depth);
    const int a = done ? -1 : direction_of(search, part, depth);
    if (a < 0) {
        if (!done && !search->refining)
            search->result.verdict = FFD_FOLDS_UNKNOWN;
        ffd_search_lower_to(search, ffd_box_lower(search, part, &view));
        return;
    }
    box lower;
    ffd_box_halve(search, part, a, depth, &lower);
    /* The half with the least coefficient first, because it may decide the cell. The other half keeps its
       slot: subdivision writes to deeper ones. */
    const bool lower_first = ffd_box_least(search, &lower) <= ffd_box_least(search, part);
    ffd_search_box(search, lower_first ? &lower : part, depth + 1);
    if (!must_stop(search))
        ffd_search_box(search, lower_first ? part : &lower, depth + 1);
}
