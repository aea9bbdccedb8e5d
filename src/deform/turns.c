#include "deform/turns.h"
#include "base/vector/vec.h"
#include "deform/collapse.h"
#include <math.h>
#include <string.h>

/* A matrix whose entries are known up to a radius. */
typedef struct matrix_range {
    double centre[9], radius[9];
} matrix_range;

/* What the determinant must exceed, relative to that of the centre and to the lengths of its rows, so that
   rounding does not matter. */
#define CERTAIN 0.01
#define ROUNDING 1e-9

/* Returns the sign of the determinant if it is the same for all matrices of a range, else 0. The determinant
   is expanded about the centre: det (M + E) = det M + sum cof(M)_ij E_ij + sum M_ij cof(E)_ij + det E. */
static int sign_of(const matrix_range *range)
{
    const double change = ffd_determinant_change(range->centre, range->radius);
    const double *const m = range->centre, det = mat_determinant(m), size = fabs(det);
    if (!(size - change > CERTAIN * size) ||
        !(size * size > ROUNDING * ROUNDING * vec_dot(m, m) * vec_dot(m + 3, m + 3) * vec_dot(m + 6, m + 6)))
        return 0;
    return det > 0 ? 1 : -1;
}

static size_t net_points(const size_t order[3])
{
    return order[0] * order[1] * order[2];
}

static void cell_order(const turn_cell *cell, size_t order[3])
{
    for (int a = 0; a < 3; a++)
        order[a] = (size_t)cell->lattice->knots[a].degree + 1;
}

/* Returns the factors that take the binomial coefficients out of the points of a kernel_field, and leave the
   Bezier points. */
static const double *bezier_factors(const size_t order[3], turn_scratch *scratch)
{
    double factor[3][MAX_ORDER];
    double *to = scratch->factors;
    if (memcmp(scratch->order, order, sizeof scratch->order) == 0)
        return scratch->factors;
    for (int a = 0; a < 3; a++) {
        double binomial = 1;
        for (size_t i = 0; i < order[a]; i++) {
            factor[a][i] = 1 / binomial;
            binomial = binomial * (double)(order[a] - 1 - i) / (double)(i + 1);
        }
    }
    for (size_t k = 0; k < order[2]; k++)
        for (size_t j = 0; j < order[1]; j++)
            for (size_t i = 0; i < order[0]; i++)
                *to++ = factor[2][k] * factor[1][j] * factor[0][i];
    memcpy(scratch->order, order, sizeof scratch->order);
    return scratch->factors;
}

/* Converts the points of a kernel_field to Bezier points; may be in place. */
static void find_bezier(const size_t order[3], const double *field, turn_scratch *scratch, double *points)
{
    const double *const factors = bezier_factors(order, scratch);
    for (size_t n = 0; n < net_points(order); n++)
        for (size_t c = 0; c < 3; c++)
            points[3 * n + c] = factors[n] * field[3 * n + c];
    points[3 * net_points(order)] = 0;
}

/* Computes the steps from each point of a net to the next one along direction a, and makes it shorter by
   one. */
static void take_steps(const double *points, int a, size_t order[3], double *steps)
{
    const size_t stride = a == 0 ? 3 : a == 1 ? 3 * order[0] : 3 * order[0] * order[1];
    const size_t whole = stride * order[a], run = whole - stride, count = 3 * net_points(order);
    for (size_t block = 0; block < count; block += whole, steps += run) {
        const double *restrict const from = points + block, *restrict const next = from + stride;
        for (size_t n = 0; n < run; n++)
            steps[n] = next[n] - from[n];
    }
    order[a]--;
}

/* Returns degree / width of a direction. */
static double slope_factor(const turn_cell *cell, int a)
{
    const knot_vector *const knots = &cell->lattice->knots[a];
    const double *const t = knots->t + knots->spans[cell->index[a]];
    return knots->degree / (t[1] - t[0]);
}

/* Prepares the net of a field in the cell, without its points. */
static void begin_net(const turn_cell *cell, control_net *net)
{
    cell_order(cell, net->order);
    memset(net->shift, 0, sizeof net->shift);
    for (int a = 0; a < 3; a++)
        for (size_t i = 0; i + 1 < net->order[a]; i++)
            net->scale[a][i] = slope_factor(cell, a);
}

/* Sets the rounding of the derivatives by direction a. */
static void set_rounding(const ffd_lattice *lattice, int a, double scale, double rounding[9])
{
    for (int r = 0; r < 3; r++)
        rounding[3 * r + a] = ffd_slope_rounding(lattice, r, scale);
}

/* rounding: of each derivative. Without it a volume that collapses could have derivatives
   that are nothing but rounding, all with the same sign. */
static void set_range(const slope_range ranges[3], const double rounding[9], matrix_range *matrix)
{
    for (int a = 0; a < 3; a++)
        for (int r = 0; r < 3; r++) {
            matrix->centre[3 * r + a] = (ranges[a].low[r] + ranges[a].high[r]) / 2;
            matrix->radius[3 * r + a] = (ranges[a].high[r] - ranges[a].low[r]) / 2 + rounding[3 * r + a];
        }
}

/* Finds a coordinate that has the same sign in all derivatives by a direction, the one with the greatest
   least size. Returns that size; 0 if there is none, or if it may be their rounding, or that of what is
   `size` long. */
static double find_axis(const slope_range *range, int a, double size, const double rounding[9], int *axis)
{
    double greatest = 0;
    for (int c = 0; c < 3; c++) {
        const double low = range->low[c], high = range->high[c];
        const double least = low > 0 ? low : high < 0 ? -high : 0;
        size = larger_of(size, larger_of(fabs(low), fabs(high)));
        if (least > greatest) {
            greatest = least;
            *axis = c;
        }
    }
    return greatest > ROUNDING * size && greatest > 2 * rounding[3 * *axis + a] ? greatest : 0;
}

/* Fills the rounding of derivatives by direction a that are divided by one of their coordinates, which is at
   least twice its own rounding. ratios: the range of what that leaves. least: that coordinate's least size.
 */
static void divide_rounding(const slope_range *ratios, int a, const double rounding[9], int axis,
                            double least, double divided[9])
{
    for (int r = 0; r < 3; r++) {
        const double largest = larger_of(fabs(ratios->low[r]), fabs(ratios->high[r]));
        divided[3 * r + a] = 2 * (rounding[3 * r + a] + largest * rounding[3 * axis + a]) / least;
    }
}

/* Returns the sign of the determinant of the derivatives of a net if it is known to be the same everywhere,
   else 0. The derivatives by a direction are sums of those of the net, with factors >= 0, and the determinant
   is linear in them: if their range is too large, that of their directions may do. matrix: what the
   derivatives are changes of, or 0; receives their range. rounding: of each derivative. */
static int sign_of_net(slope_kernel *find_slopes, const control_net *net, const double rounding[9],
                       matrix_range *matrix)
{
    const matrix_range from = *matrix;
    slope_range ranges[3];
    double least[3], of_cones[9];
    int axes[3] = {0};
    find_slopes(net, 0, NULL, ranges);
    set_range(ranges, rounding, matrix);
    const int sign = sign_of(matrix);
    if (sign != 0)
        return sign;
    for (int a = 0; a < 3; a++) {
        const double before[3] = {from.centre[a], from.centre[3 + a], from.centre[6 + a]};
        least[a] = find_axis(&ranges[a], a, vec_greatest(before), rounding, &axes[a]);
        if (!(least[a] > 0))
            return 0;
    }
    matrix_range cones;
    find_slopes(net, 0, axes, ranges);
    for (int a = 0; a < 3; a++)
        divide_rounding(&ranges[a], a, rounding, axes[a], least[a], of_cones);
    set_range(ranges, of_cones, &cones);
    return sign_of(&cones);
}

/* The greatest second derivatives of a field in a cell: entry 3 r + c of the Jacobian changes by at most
   by[b][3 r + c] for each unit of direction b. */
typedef struct field_bends {
    double by[3][9];
} field_bends;

static void set_bend(const turn_cell *cell, int a, int b, const slope_range *slopes, field_bends *bends)
{
    const int degree = cell->lattice->knots[b].degree;
    const double factor = slope_factor(cell, a) * (a == b ? (degree - 1) / (double)degree : 1);
    for (int r = 0; r < 3; r++)
        bends->by[b][3 * r + a] = bends->by[a][3 * r + b] =
            factor * larger_of(fabs(slopes->low[r]), fabs(slopes->high[r]));
}

static void find_bends(const turn_cell *cell, const double *field, turn_scratch *scratch, field_bends *bends)
{
    control_net net;
    begin_net(cell, &net);
    find_bezier(net.order, field, scratch, scratch->points);
    memset(bends, 0, sizeof *bends);
    net.points = scratch->steps;
    for (int a = 0; a < 3; a++) {
        slope_range slopes[3];
        cell_order(cell, net.order);
        take_steps(scratch->points, a, net.order, scratch->steps);
        cell->kernels->find_slopes(&net, a, NULL, slopes);
        for (int b = a; b < 3; b++)
            if (net.order[b] > 1)
                set_bend(cell, a, b, &slopes[b], bends);
    }
}

/* Adds what the derivatives of a field change by in a box. half: its half sides. */
static void add_bends(const field_bends *bends, const double half[3], matrix_range *sum)
{
    for (int n = 0; n < 9; n++)
        sum->radius[n] += bends->by[0][n] * half[0] + bends->by[1][n] * half[1] + bends->by[2][n] * half[2];
}

/* Fills the constant derivatives of a box's rest positions. Returns false if those are not constant. */
static bool constant_rest(const ffd_lattice *lattice, matrix_range *rest)
{
    memset(rest, 0, sizeof *rest);
    return lattice->has_uvw_by_p && mat_invert(lattice->uvw_by_p, rest->centre);
}

/* Returns whether det F > 0 is known where a net acts. difference: its displacements; rest: its rest
   positions, to which these are added, if their derivatives are not constant. */
static bool turns_nowhere(const ffd_lattice *lattice, slope_kernel *find_slopes, control_net *net,
                          const double *difference, double *rest)
{
    matrix_range slopes;
    double rounding[9];
    for (int a = 0; a < 3; a++) {
        double scale = 0;
        for (size_t i = 0; i + 1 < net->order[a]; i++)
            scale = larger_of(scale, net->scale[a][i]);
        set_rounding(lattice, a, scale, rounding);
    }
    if (constant_rest(lattice, &slopes)) {
        const double before = mat_determinant(slopes.centre);
        for (int n = 0; n < 9; n++)
            net->shift[n % 3][n / 3] = slopes.centre[n];
        net->points = difference;
        return before * sign_of_net(find_slopes, net, rounding, &slopes) > 0;
    }
    net->points = rest;
    const int before = sign_of_net(find_slopes, net, rounding, &slopes);
    if (before == 0)
        return false;
    for (size_t n = 0; n < 3 * net_points(net->order); n++)
        rest[n] += difference[n];
    return before * sign_of_net(find_slopes, net, rounding, &slopes) > 0;
}

bool ffd_turns_nowhere(const turn_cell *cell, const double *difference, turn_scratch *scratch)
{
    const ffd_lattice *const lattice = cell->lattice;
    double *const rest = scratch->field;
    control_net net;
    begin_net(cell, &net);
    find_bezier(net.order, difference, scratch, scratch->points);
    if (!lattice->has_uvw_by_p) {
        ffd_displacement_cell_field(lattice, cell->kernels->extract, cell->index, lattice->rest, false, rest);
        find_bezier(net.order, rest, scratch, rest);
    }
    return turns_nowhere(lattice, cell->kernels->find_slopes, &net, scratch->points, rest);
}

/* Sets the net's points and scale along direction a of a block of cells (NURBS Book 3.3), and the index of
   its first control point. Returns false if there are too many. */
static bool set_block_direction(const knot_vector *knots, size_t block, size_t *first, control_net *net,
                                int a)
{
    const size_t degree = (size_t)knots->degree, begin = BLOCK_SIDE * block;
    const size_t end = begin + BLOCK_SIDE < knots->span_count ? begin + BLOCK_SIDE : knots->span_count;
    *first = (size_t)knots->spans[begin] - degree;
    net->order[a] = (size_t)knots->spans[end - 1] + 1 - *first;
    if (net->order[a] > MAX_ORDER)
        return false;
    for (size_t i = 0; i + 1 < net->order[a]; i++) {
        const double *const t = knots->t + *first + i + 1;
        net->scale[a][i] = knots->degree / (t[degree] - t[0]);
    }
    return true;
}

bool ffd_turns_nowhere_in_block(const ffd_lattice *lattice, slope_kernel *find_slopes, const size_t block[3],
                                turn_scratch *scratch)
{
    control_net net = {.points = NULL};
    size_t first[3];
    for (int a = 0; a < 3; a++)
        if (!set_block_direction(&lattice->knots[a], block[a], &first[a], &net, a))
            return false;
    if (!lattice->has_uvw_by_p)
        ffd_lattice_block_points(lattice, lattice->rest, first, net.order, scratch->field);
    ffd_lattice_block_points(lattice, lattice->difference, first, net.order, scratch->points);
    scratch->field[3 * net_points(net.order)] = scratch->points[3 * net_points(net.order)] = 0;
    return turns_nowhere(lattice, find_slopes, &net, scratch->points, scratch->field);
}

/* Boxes that are looked at together. */
#define BOXES ((size_t)32)

typedef struct turn_boxes {
    double centre[3 * BOXES], half[3 * BOXES];
    turn_run *run[BOXES];
    size_t count;
} turn_boxes;

static void add_box(const double *uvw, turn_run *run, turn_boxes *boxes)
{
    double *const centre = boxes->centre + 3 * boxes->count, *const half = boxes->half + 3 * boxes->count;
    for (size_t a = 0; a < 3; a++) {
        double low = uvw[3 * (size_t)run->first + a], high = low;
        for (size_t k = run->first; k < run->end; k++) {
            const double u = uvw[3 * k + a];
            low = u < low ? u : low;
            high = u > high ? u : high;
        }
        centre[a] = (low + high) / 2;
        half[a] = (high - low) / 2;
    }
    boxes->run[boxes->count++] = run;
}

/* Finds the derivatives by u,v,w at the centres of boxes: of the displacement, and of the rest positions if
   the fields have them. */
static void find_centres(const turn_cell *cell, const kernel_cell *fields, const turn_boxes *boxes,
                         double *by_uvw, double *rest_by_uvw)
{
    kernel_cell without_inverse = *fields;
    double delta[3 * BOXES];
    uint32_t which[BOXES];
    for (size_t i = 0; i < boxes->count; i++)
        which[i] = (uint32_t)i;
    without_inverse.inverse = NULL;
    const kernel_points points = {.uvw = boxes->centre,
                                  .which = which,
                                  .count = boxes->count,
                                  .delta = delta,
                                  .gradient = by_uvw,
                                  .jacobian = fields->rest.points ? rest_by_uvw : NULL};
    cell->kernels->displace(&without_inverse, &points);
}

/* What is known of a cell for its boxes. */
typedef struct turn_search {
    const turn_cell *cell;
    const kernel_cell *fields;
    const double *uvw;            /* of its points */
    field_bends difference, rest; /* rest: only if the fields have it */
} turn_search;

static void judge_boxes(const turn_search *search, const turn_boxes *boxes)
{
    double by_uvw[9 * BOXES], rest_by_uvw[9 * BOXES];
    matrix_range constant;
    const bool is_constant = constant_rest(search->cell->lattice, &constant);
    const double sign = is_constant ? mat_determinant(constant.centre) : 0;
    double rounding[9];
    for (int a = 0; a < 3; a++)
        set_rounding(search->cell->lattice, a, slope_factor(search->cell, a), rounding);
    find_centres(search->cell, search->fields, boxes, by_uvw, rest_by_uvw);
    for (size_t i = 0; i < boxes->count; i++) {
        matrix_range slopes = constant;
        if (!is_constant) {
            memcpy(slopes.centre, rest_by_uvw + 9 * i, sizeof slopes.centre);
            add_bends(&search->rest, boxes->half + 3 * i, &slopes);
        }
        const double before = is_constant ? sign : sign_of(&slopes);
        for (size_t n = 0; n < 9; n++)
            slopes.centre[n] += by_uvw[9 * i + n];
        add_bends(&search->difference, boxes->half + 3 * i, &slopes);
        for (int n = 0; n < 9; n++)
            slopes.radius[n] += rounding[n];
        boxes->run[i]->may_turn = !(before * sign_of(&slopes) > 0);
    }
}

/* Judges the runs that may turn, and have at least so many points. */
static void judge_runs(const turn_search *search, size_t least, turn_run *runs, size_t count)
{
    turn_boxes boxes = {.count = 0};
    for (size_t i = 0; i < count; i++) {
        if (runs[i].may_turn && runs[i].end - runs[i].first >= least)
            add_box(search->uvw, &runs[i], &boxes);
        if (boxes.count == BOXES || (boxes.count > 0 && i + 1 == count)) {
            judge_boxes(search, &boxes);
            boxes.count = 0;
        }
    }
}

/* The points of a run at first; if its box is too large, of the pieces into which it is cut. In fewer than
   FEWEST, derivatives cost no more than the box. */
#define MOST ((size_t)16)
#define PIECE ((size_t)4)
#define FEWEST ((size_t)3)

/* Makes runs of points with consecutive numbers from `first` on. Returns how many; stops at BOXES. */
static size_t make_runs(const uint32_t *which, size_t first, size_t count, turn_run *runs)
{
    size_t made = 0, end = first;
    for (; end < count && made < BOXES; first = end) {
        for (end = first + 1; end < count && end - first < MOST && which[end] == which[end - 1] + 1;)
            end++;
        runs[made++] = (turn_run){(uint32_t)first, (uint32_t)end, true};
    }
    return made;
}

/* Appends the runs, of which those that may turn are cut. Returns how many that makes. */
static size_t cut_runs(const turn_run *runs, size_t count, turn_run *cut)
{
    size_t made = 0;
    for (size_t i = 0; i < count; i++) {
        const size_t size = runs[i].may_turn ? PIECE : MOST;
        for (size_t first = runs[i].first; first < runs[i].end; first += size) {
            const size_t end = first + size < runs[i].end ? first + size : runs[i].end;
            cut[made++] = (turn_run){(uint32_t)first, (uint32_t)end, runs[i].may_turn};
        }
    }
    return made;
}

size_t ffd_turns_find(const turn_cell *cell, const kernel_cell *fields, const uint32_t *which,
                      const double *uvw, size_t count, turn_run *runs, turn_scratch *scratch)
{
    turn_search search = {.cell = cell, .fields = fields, .uvw = uvw};
    size_t made = 0;
    if (count >= FEWEST)
        find_bends(cell, fields->difference.points, scratch, &search.difference);
    if (count >= FEWEST && fields->rest.points)
        find_bends(cell, fields->rest.points, scratch, &search.rest);
    for (size_t first = 0; first < count;) {
        turn_run whole[BOXES];
        const size_t wholes = make_runs(which, first, count, whole);
        judge_runs(&search, FEWEST, whole, wholes);
        first = whole[wholes - 1].end;
        const size_t cut = cut_runs(whole, wholes, runs + made);
        judge_runs(&search, FEWEST, runs + made, cut);
        made += cut;
    }
    return made;
}
