/* boundary_search.c - branch and bound for the nearest point of the border. Boxes of the tree, patches and
   halves of patches are examined in the order of their distance from x. So the order does not depend on the
   reach, which only ends the search earlier.

   Distances are compared by their excess |C - x| - |x| = (C.C - 2 C.x) / (|C - x| + |x|), which does not lose
   digits if x is far away. */
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "embed/boundary/boundary_faces.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* In the search's units, in which the lattice has a size of about 1. */
#define TIE (256 * DBL_EPSILON) /* excesses that differ by less are equal to rounding */
#define GAP 1e-12               /* a patch is dropped if it cannot improve the excess by more */
#define ROUNDINGS (16 * DBL_EPSILON)
/* The most patches and parts of patches that a search examines. */
#define BUDGET 4096
/* Parts of a patch that are this short, relative to a cell, are not halved. */
#define LEAST_PART 0x1p-44
#define MOST_TIES 16

/* An entry of the queue: a node of the tree, or a part of a patch. */
typedef struct waiting {
    double key;     /* a lower bound of the excess */
    uint32_t order; /* order of insertion, to break ties */
    uint32_t node;
    const face_patch *part; /* may be NULL */
} waiting;

typedef struct candidate {
    boundary_location location;
    double uvw[3];
    double excess;
} candidate;

typedef struct border_search {
    const boundary *border;
    const double *x;
    double length;    /* |x| */
    double inward[3]; /* -x / |x|, or 0 */
    double reach;     /* the reach as an excess */
    double least;     /* least excess found so far */
    candidate ties[MOST_TIES];
    int tie_count;
    waiting *heap;
    size_t heap_count, heap_capacity;
    uint32_t arrivals;
    int budget;
    bool cut_short;      /* the budget ran out */
    face_patch *parts;   /* list of patches that this search has made */
    face_patch *scratch; /* large enough for any patch; allocated when first needed */
    ffd_error *error;
} border_search;

/* Returns the excess beyond which no box can contain the result or a tie with it. */
static double threshold(const border_search *search)
{
    return (search->least < search->reach ? search->least : search->reach) + TIE;
}

/* Lower bounds */

/* Returns a lower bound of the excess from lower bounds of |C - x| and of C . inward. */
static double excess_bound(const border_search *search, double distance, double inward)
{
    const double near = distance - search->length - ROUNDINGS * (1 + search->length);
    const double far = inward - ROUNDINGS;
    return near > far ? near : far;
}

static double box_bound(const border_search *search, const bounds *box)
{
    double square = 0, inward = 0;
    for (int c = 0; c < 3; c++) {
        const double below = box->lo[c] - search->x[c], above = search->x[c] - box->hi[c];
        const double off = below > 0 ? below : above > 0 ? above : 0;
        square += off * off;
        inward += search->inward[c] * (search->inward[c] > 0 ? box->lo[c] : box->hi[c]);
    }
    return excess_bound(search, sqrt(square), inward);
}

static double patch_bound(const border_search *search, const face_patch *patch, const bounds *residual)
{
    double square = 0, inward = vec_dot(search->inward, patch->centre);
    for (int k = 0; k < 3; k++) {
        const double off = residual->lo[k] > 0 ? residual->lo[k] : residual->hi[k] < 0 ? residual->hi[k] : 0;
        square += off * off;
        inward -= fabs(vec_dot(search->inward, patch->axis + 3 * k)) * patch->half[k];
    }
    return excess_bound(search, sqrt(square), inward);
}

/* The queue */

static bool comes_first(const waiting *a, const waiting *b)
{
    return a->key < b->key || (a->key == b->key && a->order < b->order);
}

static ffd_status push(border_search *search, double key, uint32_t node, const face_patch *part)
{
    if (!ffd_grow((void **)&search->heap, &search->heap_capacity, search->heap_count + 1,
                  sizeof *search->heap))
        return ffd_fail_memory(search->error);
    const waiting added = {key, search->arrivals++, node, part};
    size_t at = search->heap_count++;
    for (; at > 0; at = (at - 1) / 2) {
        const waiting *parent = &search->heap[(at - 1) / 2];
        if (!comes_first(&added, parent))
            break;
        search->heap[at] = *parent;
    }
    search->heap[at] = added;
    return FFD_OK;
}

static waiting pop(border_search *search)
{
    const waiting first = search->heap[0], moved = search->heap[--search->heap_count];
    const size_t count = search->heap_count;
    size_t at = 0;
    for (size_t child = 1; child < count; child = 2 * at + 1) {
        if (child + 1 < count && comes_first(&search->heap[child + 1], &search->heap[child]))
            child++;
        if (!comes_first(&search->heap[child], &moved))
            break;
        search->heap[at] = search->heap[child];
        at = child;
    }
    search->heap[at] = moved;
    return first;
}

/* Candidates */

static double excess_of(const border_search *search, const patch_sample *sample)
{
    const double *point = sample->point;
    const double sum = vec_length(sample->residual) + search->length;
    return sum > 0 ? (vec_dot(point, point) - 2 * vec_dot(point, search->x)) / sum : 0;
}

/* Returns the slot for a new candidate: that of a candidate at the same point, a free one, or that of a
   candidate that is farther away or comes last by u,v,w. */
static candidate *seat(border_search *search, const candidate *found)
{
    candidate *last = NULL;
    for (int i = 0; i < search->tie_count; i++) {
        candidate *tie = &search->ties[i];
        if (!ffd_boundary_before(search->border, tie->uvw, found->uvw) &&
            !ffd_boundary_before(search->border, found->uvw, tie->uvw))
            return found->excess < tie->excess ? tie : NULL;
        if (tie->excess > search->least + TIE)
            last = tie;
        else if (!last || (last->excess <= search->least + TIE &&
                           ffd_boundary_before(search->border, last->uvw, tie->uvw)))
            last = tie;
    }
    if (search->tie_count < MOST_TIES)
        return &search->ties[search->tie_count++];
    if (last->excess > search->least + TIE || ffd_boundary_before(search->border, found->uvw, last->uvw))
        return last;
    return NULL;
}

static void add_candidate(border_search *search, const face_patch *patch, const double t[2],
                          const patch_sample *sample)
{
    candidate found = {.location = {.face = patch->face}, .excess = excess_of(search, sample)};
    if (!(found.excess <= search->least + TIE))
        return;
    for (int f = 0; f < 2; f++) {
        found.location.cell[f] = patch->cell[f];
        found.location.t[f] = t[f] == 0   ? patch->lo[f]
                              : t[f] == 1 ? patch->hi[f]
                                          : patch->lo[f] + t[f] * (patch->hi[f] - patch->lo[f]);
    }
    if (found.excess < search->least)
        search->least = found.excess;
    ffd_boundary_uvw(search->border, &found.location, found.uvw);
    candidate *at = seat(search, &found);
    if (at)
        *at = found;
}

static const candidate *choose(const border_search *search)
{
    const candidate *best = NULL;
    for (int i = 0; i < search->tie_count; i++) {
        const candidate *tie = &search->ties[i];
        if (tie->excess <= search->least + TIE &&
            (!best || ffd_boundary_before(search->border, tie->uvw, best->uvw)))
            best = tie;
    }
    return best;
}

/* Patches */

/* If the patch collapses a line to one point, moves t to the least parameter on that line. */
static void go_to_least(const border_search *search, const face_patch *patch, double t[2],
                        patch_sample *sample)
{
    for (int f = 0; f < 2; f++) {
        if (t[f] == 0 || vec_length(sample->first[f]) > ROUNDINGS)
            continue;
        double least[2] = {t[0], t[1]}, step[3];
        patch_sample there;
        least[f] = 0;
        ffd_patch_evaluate(patch, search->x, least, &there);
        for (int c = 0; c < 3; c++)
            step[c] = there.point[c] - sample->point[c];
        if (vec_length(step) <= ROUNDINGS) {
            t[f] = 0;
            *sample = there;
        }
    }
}

/* Finds a candidate by descent from (s, t). Returns a lower bound for the whole patch: the control points are
   on the far side of the plane perpendicular to the direction of x through the control point that is nearest
   in that direction. */
static double try_from(border_search *search, const face_patch *patch, double s, double t)
{
    double at[2] = {s, t}, inward[3];
    patch_sample sample;
    ffd_patch_project(patch, search->x, at, &sample);
    go_to_least(search, patch, at, &sample);
    add_candidate(search, patch, at, &sample);
    const double distance = vec_length(sample.residual), excess = excess_of(search, &sample);
    if (!(distance > GAP))
        return excess;
    for (int c = 0; c < 3; c++)
        inward[c] = sample.residual[c] / distance;
    double least = 0;
    const int count = patch->order[0] * patch->order[1];
    for (int i = 0; i < count; i++) {
        const double *a = patch->points + PATCH_COMPONENTS * i;
        double step[3];
        for (int c = 0; c < 3; c++)
            step[c] = (patch->rational ? a[c] / a[3] : a[c]) - sample.point[c];
        const double off = vec_dot(inward, step);
        least = off < least ? off : least;
    }
    return excess + least;
}

static ffd_status halve(border_search *search, const face_patch *patch, double key)
{
    face_patch *half[2];
    for (int i = 0; i < 2; i++) {
        half[i] = ffd_patch_create(patch->order, patch->rational);
        if (!half[i])
            return ffd_fail_memory(search->error);
        half[i]->next = search->parts;
        search->parts = half[i];
    }
    ffd_patch_halve(patch, ffd_patch_direction(patch), half[0], half[1]);
    for (int i = 0; i < 2; i++) {
        const bounds residual = ffd_patch_residual(half[i], search->x);
        const double bound = maximum_number(key, patch_bound(search, half[i], &residual));
        if (bound <= threshold(search))
            TRY(push(search, bound, 0, half[i]));
    }
    return FFD_OK;
}

/* Searches the nearest point of a patch. If the distance may have several minima, queues its halves. */
static ffd_status search_patch(border_search *search, const face_patch *patch, double key)
{
    search->budget--;
    const double bound = maximum_number(key, try_from(search, patch, 0.5, 0.5));
    if (bound >= search->least - GAP)
        return FFD_OK;
    const bounds residual = ffd_patch_residual(patch, search->x);
    if (ffd_patch_has_one_minimum(patch, &residual))
        return FFD_OK;
    try_from(search, patch, 0, 0); /* the first of a line of equally near points */
    if (bound >= search->least - GAP)
        return FFD_OK;
    if (patch->hi[0] - patch->lo[0] <= LEAST_PART || patch->hi[1] - patch->lo[1] <= LEAST_PART)
        return FFD_OK;
    return halve(search, patch, bound);
}

/* The tree */

static ffd_status make_scratch(border_search *search)
{
    const int order[2] = {MAX_ORDER, MAX_ORDER};
    if (!search->scratch)
        search->scratch = ffd_patch_create(order, true);
    return search->scratch ? FFD_OK : ffd_fail_memory(search->error);
}

/* Makes the patches of a leaf whose patches are not stored, in scratch memory; halves have their own memory.
   Which patches are made must not depend on the reach, because that would change the search. */
static ffd_status search_cells(border_search *search, const boundary_node *leaf)
{
    TRY(make_scratch(search));
    for (size_t j = 0; j < leaf->cells[1]; j++)
        for (size_t i = 0; i < leaf->cells[0]; i++) {
            if (search->budget <= 0) {
                search->cut_short = true;
                return FFD_OK;
            }
            const size_t cell[2] = {leaf->cell[0] + i, leaf->cell[1] + j};
            ffd_boundary_patch(search->border, leaf->face, cell, search->scratch);
            ffd_patch_measure(search->scratch);
            const bounds residual = ffd_patch_residual(search->scratch, search->x);
            const double bound = patch_bound(search, search->scratch, &residual);
            if (bound <= search->least + TIE)
                TRY(search_patch(search, search->scratch, bound));
        }
    return FFD_OK;
}

static ffd_status push_node(border_search *search, uint32_t index)
{
    const boundary_node *node = &search->border->nodes[index];
    double bound = box_bound(search, &node->box);
    if (bound <= threshold(search) && node->patch) {
        const bounds residual = ffd_patch_residual(node->patch, search->x);
        bound = maximum_number(bound, patch_bound(search, node->patch, &residual));
    }
    return bound <= threshold(search) ? push(search, bound, index, NULL) : FFD_OK;
}

static ffd_status expand(border_search *search, const waiting *next)
{
    if (next->part)
        return search_patch(search, next->part, next->key);
    const boundary_node *node = &search->border->nodes[next->node];
    if (node->patch)
        return search_patch(search, node->patch, next->key);
    if (!node->child)
        return search_cells(search, node);
    TRY(push_node(search, node->child));
    return push_node(search, node->child + 1);
}

static ffd_status search_border(border_search *search)
{
    for (int i = 0; i < search->border->face_count; i++)
        TRY(push_node(search, search->border->faces[i].root));
    while (search->heap_count > 0 && search->budget > 0) {
        const waiting next = pop(search);
        if (next.key > threshold(search))
            break;
        TRY(expand(search, &next));
    }
    /* The remaining queue may contain a nearer point. */
    if (search->budget <= 0 && search->heap_count > 0)
        search->cut_short |=
            search->heap[0].key < search->least - GAP && search->heap[0].key <= threshold(search);
    return FFD_OK;
}

ffd_status ffd_boundary_search(const boundary *border, const boundary_query *query, double reach, bool *found,
                               boundary_foot *foot, ffd_error *error)
{
    border_search search = {.border = border,
                            .x = query->x,
                            .length = query->length,
                            .reach = reach - query->length + ROUNDINGS * (1 + query->length),
                            .least = HUGE_VAL,
                            .budget = BUDGET,
                            .error = error};
    for (int c = 0; c < 3; c++)
        search.inward[c] = query->length > 0 ? -query->x[c] / query->length : 0;
    *found = false;
    ffd_status status;
    TRY_END(search_border(&search));
    const candidate *const best = choose(&search);
    if (best) {
        TRY_END(make_scratch(&search));
        ffd_boundary_settle(border, query->x, &best->location, search.scratch, foot);
        *found = true;
    }
end:
    foot->cut_short = search.cut_short;
    ffd_boundary_free_patches(search.parts);
    ffd_free(search.scratch);
    ffd_free(search.heap);
    return status;
}
