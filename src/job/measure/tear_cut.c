#include "job/measure/tear_cut.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "embed/frame/frame.h"
#include "job/pass/pass.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Differences below this part of the edge's length are left alone. */
#define NEGLIGIBLE (TORN / 4)
/* What is cut first is cut here, not at the middle: meshes and lattices often have their corners at simple
   fractions, and at the very place where two lattices meet both may act. */
#define FIRST_CUT 0.4870129870129
/* A part is narrow enough to be measured, relative to the edge; about 20 halvings. */
#define NARROW 1.05e-6
/* Where the slopes differ so much that the step is not known to this part of it, */
#define EXACT 1e-9
/* cutting goes on to this width. */
#define NARROWEST 1e-12
/* A place farther from a border than this many eps of the coordinates is on one side of it, whatever the
   rounding. */
#define MARGIN 256
/* An edge is cut into so many pieces first where it is in the bounds of a volume that is not a box. */
#define PIECES 4
/* The most parts of an edge that wait while another one is cut; of more those with the smallest defects are
   left out. */
#define PARTS 16
/* A cut before a border leaves this part of the way to it, or as many times less as that way is short; */
#define ASIDE (1.0 / 64)
/* from here a cut goes behind it. */
#define NEAR (NARROW / 8)
/* After so many cuts in a row that left most of a part it is halved. */
#define SLOW 4
/* A part whose defect is at most this part of the step that was found is left: it hardly has a larger one. */
#define PROMISING 0.5

/* A place of an edge. */
typedef struct cut_place {
    double t;                  /* 0 at the first end, 1 at the second */
    double delta[3], slope[3]; /* the displacement, and its derivative by t */
    double exits[2];           /* as of field_place, */
    size_t holder;             /* likewise */
} cut_place;

/* A part of an edge along which the displacement may jump. */
typedef struct cut_part {
    cut_place low, high;
    double defect;   /* how much the displacement differs from what the slopes say */
    bool is_half;    /* of another part */
    int slow;        /* so many cuts in a row have left more than half of one */
    bool is_judged;  /* measured since it was made */
    tear_step known; /* the jump along it, as far as it was measured; 0: it was not */
} cut_part;

typedef struct cut_edge {
    uint32_t ends[2]; /* the first has the lesser position: equal edges have equal steps; or twice the end
                         that moves, if that goes on */
    bool moves_last;  /* what goes on is that of the place t = 1, not of t = 0 */
    double start[3], along[3], length;
    double margin;     /* of t: farther from a border than the rounding of places on it */
    cut_part part;     /* what is being cut, */
    bool is_cut;       /* if something is */
    cut_part *waiting; /* the first part that waits; CUT_RUN behind it the next one: most edges have few */
    size_t count;      /* of these, at most PARTS */
    tear_step step;
} cut_edge;

/* Where an edge that links have bent meets a border is found in so many turns, */
#define BEND_TURNS 2
/* and is known to this part of the edge if that is short beside the links' cells. */
#define BEND_MARGIN (NARROW / 64)

/* The most places that an edge is cut at first: its ends, and where it meets borders of lattices. */
#define FIRST_PLACES 64

/* Places of an edge, ascending. */
typedef struct place_list {
    double t[FIRST_PLACES];
    size_t count;
} place_list;

/* An edge on its way through links one after the other. */
typedef struct edge_way {
    double x[2][3], last[2][3]; /* its ends: as links that move both have moved them; as all have */
    double slope[2][3];         /* the derivatives of these by t, if it bends */
    bool follows;               /* the last link moves both */
    bool bends;                 /* some link has moved both ends, and none has moved one alone */
    bool parts;                 /* some link has moved one end alone */
} edge_way;

struct tear_cuts {
    field_scratch *field;
    cut_edge edges[CUT_RUN];
    cut_part waiting[PARTS][CUT_RUN];
    place_list lists[CUT_RUN];
    edge_way ways[CUT_RUN];
    cut_place low[CUT_RUN], high[CUT_RUN]; /* their ends */
    field_place places[FIELD_RUN];
};

_Static_assert(CUT_RUN <= FIELD_PAIRS, "more edges at once than pairs");
_Static_assert(sizeof(struct tear_cuts) + sizeof(field_scratch) - sizeof(kept_cells) < THREAD_BYTES,
               "a thread takes more than is counted");

/* What all steps of a run share. */
typedef struct cut_work {
    const tear_field *field;
    tear_cuts *cuts;
    double size; /* of the lattices' coordinates */
    ffd_error *error;
} cut_work;

/* Clips the segment start + t along, t in 0 .. 1, to the box from lo to hi. Returns whether it meets it. */
static bool clip(const double lo[3], const double hi[3], const double start[3], const double along[3],
                 double *from, double *to)
{
    *from = 0;
    *to = 1;
    for (int a = 0; a < 3; a++) {
        const double enters = (lo[a] - start[a]) / along[a], leaves = (hi[a] - start[a]) / along[a];
        if (along[a] == 0 && !(start[a] >= lo[a] && start[a] <= hi[a]))
            return false;
        if (along[a] == 0)
            continue;
        *from = larger_of(*from, lesser_of(enters, leaves));
        *to = lesser_of(*to, larger_of(enters, leaves));
    }
    return *from <= *to;
}

bool ffd_link_clip(const chain_link *link, const double start[3], const double along[3], double *from,
                   double *to)
{
    static const double zero[3] = {0, 0, 0}, one[3] = {1, 1, 1};
    const ffd_locator *const locator = link->locator;
    double p[3], d[3];
    if (locator->method != METHOD_AFFINE)
        return clip(locator->hull.lo, locator->hull.hi, start, along, from, to);
    for (int a = 0; a < 3; a++)
        p[a] = start[a] - locator->origin[a];
    mat_apply(locator->affine.inverse, p, p);
    mat_apply(locator->affine.inverse, along, d);
    return clip(zero, one, p, d, from, to);
}

/* The length of D(1) - D(0) - (D'(0) + D'(1)) / 2, which is 0 for parabolas. */
static double find_defect(const double low[3], const double high[3], const double low_slope[3],
                          const double high_slope[3], double width)
{
    double defect[3];
    for (int a = 0; a < 3; a++)
        defect[a] = high[a] - low[a] - width / 2 * (low_slope[a] + high_slope[a]);
    return vec_length(defect);
}

bool ffd_tear_may_jump(const double along[3], const double *const delta[2], const double *const gradient[2])
{
    double slope[2][3];
    for (int end = 0; end < 2; end++)
        mat_apply(gradient[end], along, slope[end]);
    return !(find_defect(delta[0], delta[1], slope[0], slope[1], 1) <= NEGLIGIBLE * vec_length(along));
}

/* What acts at a place of an edge whose one end stays: of blocks that which the place is in, or near. */
static field_by goes_on(const tear_field *field, const cut_edge *edge, double t)
{
    const bool moves = edge->moves_last ? t >= 1 : t <= 0;
    return field->chain->blocks && !moves ? FIELD_BETWEEN : FIELD_SECOND;
}

static void place_at(const tear_field *field, const cut_edge *edge, double t, field_place *place)
{
    memcpy(place->ends, edge->ends, sizeof place->ends);
    place->by = field->continues ? goes_on(field, edge, t)
                : t <= 0         ? FIELD_FIRST
                : t >= 1         ? FIELD_SECOND
                                 : FIELD_BETWEEN;
    place->along = edge->along;
    for (int a = 0; a < 3; a++)
        place->x[a] = edge->start[a] + t * edge->along[a];
}

static cut_place take(const cut_edge *edge, double t, const field_place *from)
{
    cut_place place = {.t = t};
    memcpy(place.delta, from->delta, sizeof place.delta);
    memcpy(place.exits, from->exits, sizeof place.exits);
    place.holder = from->holder;
    mat_apply(from->gradient, edge->along, place.slope);
    return place;
}

/* Makes a part. Returns whether the displacement may jump along it. */
static bool make_part(const cut_edge *edge, const cut_place *low, const cut_place *high, cut_part *part)
{
    *part = (cut_part){.low = *low, .high = *high};
    part->defect = find_defect(low->delta, high->delta, low->slope, high->slope, high->t - low->t);
    return part->defect > NEGLIGIBLE * edge->length;
}

static cut_part *waiting_at(const cut_edge *edge, size_t p)
{
    return edge->waiting + CUT_RUN * p;
}

static void let_wait(cut_edge *edge, const cut_part *part)
{
    size_t at = 0;
    if (edge->count < PARTS) {
        *waiting_at(edge, edge->count++) = *part;
        return;
    }
    for (size_t p = 1; p < PARTS; p++)
        if (waiting_at(edge, p)->defect < waiting_at(edge, at)->defect)
            at = p;
    if (part->defect > waiting_at(edge, at)->defect)
        *waiting_at(edge, at) = *part;
}

/* Takes the waiting part with the largest defect, if it is promising. */
static void take_next(cut_edge *edge)
{
    size_t at = 0;
    for (size_t p = 1; p < edge->count; p++)
        if (waiting_at(edge, p)->defect > waiting_at(edge, at)->defect)
            at = p;
    edge->is_cut = edge->count > 0 && waiting_at(edge, at)->defect > PROMISING * edge->step.length;
    if (!edge->is_cut)
        return;
    edge->part = *waiting_at(edge, at);
    *waiting_at(edge, at) = *waiting_at(edge, --edge->count);
}

static bool precedes(const double a[3], const double b[3])
{
    for (int c = 0; c < 3; c++)
        if (a[c] != b[c])
            return a[c] < b[c];
    return false;
}

static void begin_edge(const cut_work *work, uint64_t key, size_t e)
{
    cut_edge *const edge = &work->cuts->edges[e];
    const uint32_t of_key[2] = {(uint32_t)(key >> 32), (uint32_t)(key & UINT32_MAX)};
    const double *const a = work->field->faces->positions + 3 * (size_t)of_key[0];
    const double *const b = work->field->faces->positions + 3 * (size_t)of_key[1];
    const int first = precedes(b, a);
    edge->is_cut = false;
    edge->waiting = &work->cuts->waiting[0][e];
    edge->count = 0;
    edge->step = (tear_step){0, FFD_TEAR_NONE};
    edge->ends[0] = of_key[work->field->continues ? 1 : first];
    edge->ends[1] = of_key[work->field->continues ? 1 : 1 - first];
    edge->moves_last = !first;
    memcpy(edge->start, first ? b : a, sizeof edge->start);
    for (int c = 0; c < 3; c++)
        edge->along[c] = (first ? a : b)[c] - edge->start[c];
    edge->length = vec_length(edge->along);
    double size = work->size;
    for (int c = 0; c < 3; c++)
        size = larger_of(size, larger_of(fabs(a[c]), fabs(b[c])));
    edge->margin = lesser_of(MARGIN * DBL_EPSILON * size / edge->length, 1.0 / 16);
}

static void add_place(place_list *list, double t)
{
    if (!(t > 0 && t < 1) || list->count == FIRST_PLACES - 1)
        return;
    size_t at = list->count++;
    for (; list->t[at - 1] > t; at--)
        list->t[at] = list->t[at - 1];
    list->t[at] = t;
}

/* The tangent at t of the cubic with the ends of a way that bends, and with their derivatives: the points
   start + s along, of which that with s = t touches. */
static void find_tangent(const edge_way *way, double t, double start[3], double along[3])
{
    for (int a = 0; a < 3; a++) {
        const double chord = way->x[1][a] - way->x[0][a];
        const double low = way->slope[0][a] - chord, high = way->slope[1][a] - chord;
        const double bulge = t * (1 - t) * ((1 - t) * low - t * high);
        along[a] = chord + (1 - t) * (1 - 3 * t) * low + t * (3 * t - 2) * high;
        start[a] = way->x[0][a] + t * chord + bulge - t * along[a];
    }
}

/* Follows a way that bends from where its chord meets the border of a box to where it does itself: by
   Newton's method. last: that where it leaves the box, else where it enters. */
static double follow_bend(const chain_link *link, const edge_way *way, double t, bool last)
{
    double start[3], along[3], from, to;
    for (int turn = 0; turn < BEND_TURNS && t > 0 && t < 1; turn++) {
        find_tangent(way, t, start, along);
        if (!ffd_link_clip(link, start, along, &from, &to))
            break;
        t = last ? to : from;
    }
    return t;
}

/* Adds places of an edge just before and behind the border of a box. A way that bends is known less well. */
static void add_borders(const chain_link *link, const cut_edge *edge, const edge_way *way, double from,
                        double to, place_list *list)
{
    const double margin =
        way->bends ? larger_of(4 * edge->margin, BEND_MARGIN) : larger_of(4 * edge->margin, NARROWEST / 2);
    const double enters = way->bends ? follow_bend(link, way, from, false) : from;
    const double leaves = way->bends ? follow_bend(link, way, to, true) : to;
    if (from > 0) {
        add_place(list, enters - margin);
        add_place(list, enters + margin);
    }
    if (to < 1) {
        add_place(list, leaves - margin);
        add_place(list, leaves + margin);
    }
}

/* Adds places of an edge where a link begins or ends: beside the borders of a box, and within one that it may
   lead through. Of other volumes only the bounds are known. way: the edge as the links before leave it. */
static void add_crossings(const chain_link *link, const cut_edge *edge, const edge_way *way, place_list *list)
{
    const int pieces = link->is_convex ? 1 : PIECES;
    double from, to, along[3];
    for (int a = 0; a < 3; a++)
        along[a] = way->x[1][a] - way->x[0][a];
    if (!ffd_link_clip(link, way->x[0], along, &from, &to))
        return;
    if (link->is_convex)
        add_borders(link, edge, way, from, to, list);
    if (!link->is_convex || way->parts || (from > 0 && to < 1))
        for (int piece = 0; piece < pieces; piece++)
            add_place(list, from + (piece + FIRST_CUT) / pieces * (to - from));
}

/* Context of visit_link and visit_block. */
typedef struct crossing_work {
    const tear_field *field;
    tear_cuts *cuts;
    size_t edges; /* visit_link: how many; visit_block: which */
} crossing_work;

/* Moves the ends of a way to where the last link has moved them, if it has moved both. x: the ends now;
   places: theirs, with what all links before have done. */
static void move_way(const cut_edge *edge, const double x[6], const field_place places[2], edge_way *way)
{
    way->bends = (way->bends || way->follows) && !way->parts;
    for (size_t end = 0; end < 2; end++) {
        for (size_t a = 0; a < 3; a++) {
            way->x[end][a] += way->follows ? x[3 * end + a] - way->last[end][a] : 0;
            way->last[end][a] = x[3 * end + a];
        }
        if (!way->bends)
            continue;
        mat_apply(places[end].gradient, edge->along, way->slope[end]);
        for (size_t a = 0; a < 3; a++)
            way->slope[end][a] += edge->along[a];
    }
}

/* Lists where edges meet a link. What only one end gets from the links before does not count: the places
   between mostly do not get it. */
static void visit_link(void *context, size_t link, const double *x)
{
    const crossing_work *const work = context;
    const chain_link *const of = &work->field->chain->links[link];
    for (size_t e = 0; e < work->edges; e++) {
        cut_edge *const edge = &work->cuts->edges[e];
        edge_way *const way = &work->cuts->ways[e];
        move_way(edge, x + 6 * e, &work->cuts->places[2 * e], way);
        const bool first = ffd_marks_take(&work->field->marks, edge->ends[0], link);
        const bool second = ffd_marks_take(&work->field->marks, edge->ends[1], link);
        if (!of->is_still && (!(first && second) || work->field->parts))
            add_crossings(of, edge, way, &work->cuts->lists[e]);
        way->follows = first && second;
        way->parts = way->parts || (!of->is_still && first != second);
    }
}

static bool visit_block(void *context, uint32_t block)
{
    const crossing_work *const work = context;
    const size_t e = work->edges;
    add_crossings(&work->field->chain->links[block], &work->cuts->edges[e], &work->cuts->ways[e],
                  &work->cuts->lists[e]);
    return true;
}

/* Finds the ends of all edges, and lists the places where they are cut first. */
static ffd_status begin_ends(const cut_work *work, size_t count)
{
    static const double none[3] = {0, 0, 0};
    tear_cuts *const cuts = work->cuts;
    const tear_field *const field = work->field;
    crossing_work crossings = {field, cuts, count};
    const field_visitor visitor = {visit_link, &crossings};
    for (size_t e = 0; e < count; e++) {
        cuts->lists[e] = (place_list){.t = {0}, .count = 1};
        for (size_t end = 0; end < 2; end++) {
            place_at(field, &cuts->edges[e], (double)end, &cuts->places[2 * e + end]);
            memcpy(cuts->ways[e].x[end], cuts->places[2 * e + end].x, sizeof cuts->ways[e].x[end]);
        }
        cuts->ways[e].follows = cuts->ways[e].bends = cuts->ways[e].parts = false;
    }
    TRY(ffd_tear_field_find(field, cuts->places, 2 * count, &visitor, cuts->field, work->error));
    for (size_t e = 0; e < count; e++) {
        const field_place *const ends = &cuts->places[2 * e];
        bounds box;
        for (int a = 0; a < 3; a++) { /* blocks may have moved the ends to their borders */
            cuts->edges[e].start[a] = cuts->ways[e].x[0][a] = ends[0].x[a];
            cuts->edges[e].along[a] = ends[1].x[a] - ends[0].x[a];
            cuts->ways[e].x[1][a] = ends[1].x[a];
            box.lo[a] = lesser_of(ends[0].x[a], ends[1].x[a]);
            box.hi[a] = larger_of(ends[0].x[a], ends[1].x[a]);
        }
        crossings.edges = e;
        if (field->chain->blocks)
            ffd_box_tree_visit_box(&field->chain->tree, &box, none, visit_block, &crossings);
        cuts->lists[e].t[cuts->lists[e].count++] = 1;
        cuts->low[e] = take(&cuts->edges[e], 0, &ends[0]);
        cuts->high[e] = take(&cuts->edges[e], 1, &ends[1]);
    }
    return FFD_OK;
}

/* Makes the parts between the first places of an edge. places: those between its ends. */
static void begin_parts(tear_cuts *cuts, size_t e, const field_place *places)
{
    const place_list *const list = &cuts->lists[e];
    cut_edge *const edge = &cuts->edges[e];
    cut_place low = cuts->low[e];
    for (size_t i = 1; i < list->count; i++) {
        const cut_place high = i == list->count - 1 ? cuts->high[e] : take(edge, list->t[i], &places[i - 1]);
        cut_part part;
        if (high.t > low.t && make_part(edge, &low, &high, &part))
            let_wait(edge, &part);
        low = high;
    }
    take_next(edge);
}

/* Cuts all edges first, as many edges at once as have room. */
static ffd_status begin_edges(const cut_work *work, size_t count)
{
    tear_cuts *const cuts = work->cuts;
    TRY(begin_ends(work, count));
    for (size_t first = 0, end; first < count; first = end) {
        size_t places = 0;
        for (end = first; end < count && places + cuts->lists[end].count <= FIELD_RUN; end++)
            for (size_t i = 1; i + 1 < cuts->lists[end].count; i++)
                place_at(work->field, &cuts->edges[end], cuts->lists[end].t[i], &cuts->places[places++]);
        if (places > 0)
            TRY(ffd_tear_field_find(work->field, cuts->places, places, NULL, cuts->field, work->error));
        places = 0;
        for (size_t e = first; e < end; places += cuts->lists[e++].count - 2)
            begin_parts(cuts, e, cuts->places + places);
    }
    return FFD_OK;
}

/* How much the step along a part depends on where along it the jump is. */
static double doubt_of(const cut_place *low, const cut_place *high)
{
    double bend[3];
    for (int a = 0; a < 3; a++)
        bend[a] = high->slope[a] - low->slope[a];
    return vec_length(bend) * (high->t - low->t);
}

/* Whether a part is narrow enough for a measurement: a first one, or if there was one, an exact one. */
static bool is_narrow(const cut_part *part)
{
    const double width = part->high.t - part->low.t;
    if (width > NARROW || part->known.length == 0)
        return width <= NARROW;
    return width <= NARROWEST || doubt_of(&part->low, &part->high) <= EXACT * part->known.length;
}

/* The two places between which a narrow part is measured. */
static void place_pair(const cut_work *work, const cut_edge *edge, field_place pair[2])
{
    const double from = edge->part.low.t - edge->margin, to = edge->part.high.t + edge->margin;
    place_at(work->field, edge, from > 0 ? from : 0, &pair[0]);
    place_at(work->field, edge, to < 1 ? to : 1, &pair[1]);
}

static void settle(cut_edge *edge)
{
    if (edge->part.known.length > edge->step.length)
        edge->step = edge->part.known;
    take_next(edge);
}

/* Judges the jump along a narrow part, by two places round it: the difference of both displacements in the
   middle between them, where their slopes lead. Goes on if there is none, or if it is exact. */
static void judge(cut_edge *edge, const cut_place *low, const cut_place *high, ffd_tear_cause cause)
{
    cut_part *const part = &edge->part;
    const tear_step step = {find_defect(low->delta, high->delta, low->slope, high->slope, high->t - low->t),
                            cause};
    const double doubt = doubt_of(low, high);
    const bool jumps = step.length > NEGLIGIBLE * edge->length;
    part->is_judged = true;
    if (jumps && step.length > doubt) /* else it may be a kink */
        part->known = step;
    if (!jumps || doubt <= EXACT * step.length || part->high.t - part->low.t <= NARROWEST)
        settle(edge);
}

static void judge_pair(cut_edge *edge, const field_place pair[2], ffd_tear_cause cause)
{
    const double from = edge->part.low.t - edge->margin, to = edge->part.high.t + edge->margin;
    const cut_place low = take(edge, from > 0 ? from : 0, &pair[0]);
    const cut_place high = take(edge, to < 1 ? to : 1, &pair[1]);
    judge(edge, &low, &high, cause);
}

/* Whether one end of a part is held by a link that does not move both ends of the edge, and the other end by
   none: the jump between them is that link's. If others follow, they get the two places of a pair apart. */
static bool leaves_link(const tear_field *field, const cut_part *part)
{
    const lattice_chain *const chain = field->chain;
    size_t link = part->low.holder + part->high.holder;
    const bool leaves = link > 0 && (part->low.holder == 0 || part->high.holder == 0);
    while (leaves && link < chain->count && chain->links[link].is_still)
        link++;
    return leaves && link == chain->count;
}

static bool is_to_be_judged(const cut_edge *edge)
{
    return edge->is_cut && !edge->part.is_judged && is_narrow(&edge->part);
}

/* Judges the parts at hand that are narrow, until none is. */
static ffd_status judge_all(const cut_work *work, size_t count)
{
    tear_cuts *const cuts = work->cuts;
    ffd_tear_cause causes[CUT_RUN];
    uint32_t judged[CUT_RUN];
    size_t pairs;
    do {
        pairs = 0;
        for (size_t e = 0; e < count; e++) {
            cut_edge *const edge = &cuts->edges[e];
            while (is_to_be_judged(edge) && leaves_link(work->field, &edge->part))
                judge(edge, &edge->part.low, &edge->part.high, FFD_TEAR_LATTICES);
            if (is_to_be_judged(edge)) {
                place_pair(work, edge, &cuts->places[2 * pairs]);
                judged[pairs++] = (uint32_t)e;
            }
        }
        TRY(ffd_tear_field_compare(work->field, cuts->places, pairs, cuts->field, causes, work->error));
        for (size_t i = 0; i < pairs; i++)
            judge_pair(&cuts->edges[judged[i]], &cuts->places[2 * i], causes[i]);
    } while (pairs > 0);
    return FFD_OK;
}

/* Goes on with the half of a part that has the larger defect; the other one waits. Returns false if the
   displacement jumps along neither. */
static bool go_on(cut_edge *edge, const cut_place *middle)
{
    const cut_part whole = edge->part;
    const double half = (whole.high.t - whole.low.t) / 2;
    cut_part halves[2];
    bool jumps[2];
    for (int h = 0; h < 2; h++) {
        jumps[h] = make_part(edge, h ? middle : &whole.low, h ? &whole.high : middle, &halves[h]);
        halves[h].is_half = true;
        halves[h].slow = halves[h].high.t - halves[h].low.t > 1.01 * half ? whole.slow + 1 : 0;
        halves[h].known = whole.known;
    }
    const int next = halves[1].defect > halves[0].defect;
    edge->part = halves[next];
    if (jumps[1 - next])
        let_wait(edge, &halves[1 - next]);
    return jumps[next];
}

/* Where to cut a part whose one end, at `from`, is inside, and should leave the lattice on the way to the
   other end after `exit`: ever closer before that border, and then once behind it. A search close behind a
   border takes long. Returns false if the border should not be in the part. */
static bool aim(const cut_edge *edge, double from, double to, double exit, double *t)
{
    const double way = fabs(exit), whole = fabs(to - from);
    const double aside = larger_of(way, larger_of(4 * edge->margin, NARROWEST));
    const double next = way > NEAR ? way - way * lesser_of(ASIDE, way) : way + aside;
    *t = from + copysign(next, to - from);
    return way < whole && next < whole;
}

/* Where the part at hand is cut: beside the border of a lattice, if the derivatives lead to one in it, else
   in halves. Where jumps within volumes count too, a place in its middle may show others first. */
static double choose_cut(const tear_field *field, const cut_edge *edge)
{
    const cut_part *const part = &edge->part;
    const cut_place *const low = &part->low, *const high = &part->high;
    const bool by_high = -high->exits[0] < low->exits[1];
    double t;
    const bool aims = part->slow < SLOW && (part->is_half || !field->parts);
    if (aims && (by_high ? aim(edge, high->t, low->t, high->exits[0], &t)
                         : aim(edge, low->t, high->t, low->exits[1], &t)))
        return t;
    return low->t + (high->t - low->t) * (part->is_half ? 0.5 : FIRST_CUT);
}

/* Cuts the parts at hand of all edges. *some: whether there are any. */
static ffd_status cut_all(const cut_work *work, size_t count, bool *some)
{
    tear_cuts *const cuts = work->cuts;
    double t[CUT_RUN];
    size_t places = 0;
    for (size_t e = 0; e < count; e++)
        if (cuts->edges[e].is_cut) {
            t[e] = choose_cut(work->field, &cuts->edges[e]);
            place_at(work->field, &cuts->edges[e], t[e], &cuts->places[places++]);
        }
    *some = places > 0;
    TRY(*some ? ffd_tear_field_find(work->field, cuts->places, places, NULL, cuts->field, work->error)
              : FFD_OK);
    places = 0;
    for (size_t e = 0; e < count; e++)
        if (cuts->edges[e].is_cut) {
            const cut_place middle = take(&cuts->edges[e], t[e], &cuts->places[places++]);
            if (!go_on(&cuts->edges[e], &middle))
                settle(&cuts->edges[e]);
        }
    return FFD_OK;
}

ffd_status ffd_tear_cut(const tear_field *field, const uint64_t *edges, size_t count, tear_step *steps,
                        tear_cuts *cuts, ffd_error *error)
{
    cut_work work = {field, cuts, 0, error};
    const lattice_chain *const chain = field->chain;
    bool some = true;
    for (size_t l = 0; l < chain->count; l++)
        for (int a = 0; a < 3; a++)
            work.size = larger_of(work.size, larger_of(fabs(chain->links[l].locator->hull.lo[a]),
                                                       fabs(chain->links[l].locator->hull.hi[a])));
    for (size_t e = 0; e < count; e++)
        begin_edge(&work, edges[e], e);
    TRY(begin_edges(&work, count));
    while (some) {
        TRY(judge_all(&work, count));
        TRY(cut_all(&work, count, &some));
    }
    for (size_t e = 0; e < count; e++)
        steps[e] = cuts->edges[e].step;
    return FFD_OK;
}

field_scratch *ffd_tear_cuts_scratch(const tear_cuts *cuts)
{
    return cuts->field;
}

tear_cuts *ffd_tear_cuts_make(void)
{
    tear_cuts *const cuts = ffd_alloc(1, sizeof *cuts);
    field_scratch *const field = ffd_tear_field_scratch();
    if (!cuts || !field) {
        ffd_free(cuts);
        ffd_free(field);
        return NULL;
    }
    cuts->field = field;
    return cuts;
}

void ffd_tear_cuts_free(tear_cuts *cuts)
{
    if (!cuts)
        return;
    ffd_free(cuts->field);
    ffd_free(cuts);
}
