#include "job/judge/tears.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/vector/vec.h"
#include "job/judge/edge_list.h"
#include "job/judge/tear_cut.h"
#include "mesh/positions.h"
#include <string.h>

/* Memory for each edge that is looked at: the sorted keys, entries for its ends in the table of positions,
   and its step. */
#define EDGE_BYTES (2 * sizeof(uint64_t) + 2 * POSITION_TABLE_BYTES + sizeof(tear_step))

/* Kinds of edges. */
typedef enum tear_kind {
    TEAR_STAYS, /* no link moves one end */
    TEAR_MOVES, /* both ends move */
    TEAR_KINDS
} tear_kind;

/* Scratch memory of a thread. */
typedef struct tear_worker {
    tear_cuts *cuts;
    ffd_status status;
    ffd_error error;
} tear_worker;

typedef struct tear_work {
    const tear_question *question;
    mark_planes marks;
    size_t layers;
    tear_field *field;
    tear_count *count;
    /* Of the kind at hand: */
    tear_kind kind;
    edge_list edges; /* the end that stays, or else a rule's choice, in the upper 32 bits */
    tear_step *steps;
    tear_worker *workers;
} tear_work;

static uint32_t first_end(uint64_t key)
{
    return (uint32_t)(key >> 32);
}

static uint32_t second_end(uint64_t key)
{
    return (uint32_t)(key & UINT32_MAX);
}

static const double *position_of(const tear_work *work, uint32_t vertex)
{
    return work->question->faces->positions + 3 * (size_t)vertex;
}

static bool takes_part(const tear_work *work, uint32_t vertex)
{
    return ffd_marks_take_any(&work->marks, vertex, work->layers);
}

/* Whether two vertices have equal marks in the first planes. */
static bool are_alike(const tear_work *work, uint32_t a, uint32_t b, size_t planes)
{
    for (size_t p = 0; p < planes; p++)
        if (work->marks.bytes[p * work->marks.points + a] != work->marks.bytes[p * work->marks.points + b])
            return false;
    return true;
}

static bool ends_before(const void *range, const void *vertex)
{
    return ((const vertex_range *)range)->end <= *(const uint32_t *)vertex;
}

static bool is_hidden(const tear_work *work, uint32_t of_faces)
{
    const vertex_range *const hidden = work->question->hidden;
    const uint32_t vertex = ffd_faces_number(work->question->faces, of_faces);
    const size_t count = work->question->hidden_count,
                 at = lower_bound(&vertex, hidden, count, sizeof *hidden, ends_before);
    return at < count && hidden[at].first <= vertex;
}

static void find_along(const tear_work *work, uint32_t a, uint32_t b, double along[3])
{
    for (int c = 0; c < 3; c++)
        along[c] = position_of(work, b)[c] - position_of(work, a)[c];
}

/* Whether the displacement may jump between two vertices in different parts of the volumes that move them.
   The ends' displacements, where they are known, rule most edges out. */
static bool may_jump(const tear_work *work, uint32_t a, uint32_t b)
{
    const tear_question *const question = work->question;
    const uint32_t ends[2] = {a, b};
    double along[3], delta[2][3];
    const double *gradients[2];
    if (!question->deformed || !question->gradients)
        return true;
    for (int end = 0; end < 2; end++) {
        const size_t number = ffd_faces_number(question->faces, ends[end]);
        for (int c = 0; c < 3; c++)
            delta[end][c] = question->deformed[3 * number + (size_t)c] - position_of(work, ends[end])[c];
        gradients[end] = question->gradients + 9 * number;
    }
    find_along(work, a, b, along);
    return ffd_tear_may_jump(along, (const double *const[]){delta[0], delta[1]}, gradients);
}

/* An edge on its way through the lattices. */
typedef struct edge_way {
    const tear_work *work;
    uint32_t ends[2];
    double along[3];
    unsigned owner; /* blocks: of both ends */
} edge_way;

/* Stops at a lattice that moves places of the edge, but not both ends. */
static bool look_at_lattice(void *context, uint32_t link)
{
    const edge_way *const way = context;
    const tear_work *const work = way->work;
    const lattice_chain *const chain = work->question->chain;
    const unsigned owner = way->owner & ~OWNER_NEAREST;
    double from, to;
    if (chain->blocks && (link == owner || (link > owner && !(way->owner & OWNER_NEAREST))))
        return true; /* of what two blocks hold the earlier one has all */
    if (!chain->blocks &&
        (ffd_marks_take(&work->marks, way->ends[0], link) || !ffd_tear_field_moves(work->field, link)))
        return true;
    return !ffd_link_clip(&chain->links[link], position_of(work, way->ends[0]), way->along, &from, &to);
}

/* Whether an edge whose ends the same lattices move leads through another one. */
static bool passes_another(const tear_work *work, uint32_t a, uint32_t b)
{
    const lattice_chain *const chain = work->question->chain;
    static const double none[3] = {0, 0, 0};
    edge_way way = {.work = work, .ends = {a, b}};
    bounds box;
    if (!work->question->passes)
        return false;
    find_along(work, a, b, way.along);
    for (int c = 0; c < 3; c++) {
        box.lo[c] = lesser_of(position_of(work, a)[c], position_of(work, b)[c]);
        box.hi[c] = larger_of(position_of(work, a)[c], position_of(work, b)[c]);
    }
    for (size_t l = 0; l < chain->count && !chain->blocks; l++)
        if (!look_at_lattice(&way, (uint32_t)l))
            return true;
    if (!chain->blocks)
        return false;
    way.owner =
        ffd_marks_owner(chain, &work->marks, a) | (ffd_marks_owner(chain, &work->marks, b) & OWNER_NEAREST);
    if (!(way.owner & OWNER_NEAREST) && !chain->links[way.owner].is_convex)
        return false; /* its parts tell more */
    return !ffd_box_tree_visit_box(&chain->tree, &box, none, look_at_lattice, &way);
}

static bool precedes(const double a[3], const double b[3])
{
    for (int c = 0; c < 3; c++)
        if (a[c] != b[c])
            return a[c] < b[c];
    return false;
}

/* Chooses which end of an edge that moves is named first: the one that the first lattice which moves only one
   end leaves; of blocks that of the later one; else that with the greater parameters. */
static bool goes_first(const tear_work *work, uint32_t a, uint32_t b)
{
    const lattice_chain *const chain = work->question->chain;
    const unsigned owner_a = ffd_marks_owner(chain, &work->marks, a) & ~OWNER_NEAREST;
    const unsigned owner_b = ffd_marks_owner(chain, &work->marks, b) & ~OWNER_NEAREST;
    for (size_t l = 0; l < work->layers; l++)
        if (ffd_marks_keep(&work->marks, a, l) != ffd_marks_keep(&work->marks, b, l))
            return ffd_marks_keep(&work->marks, a, l);
    if (owner_a != owner_b)
        return owner_a > owner_b;
    for (size_t p = chain->marks.parts; p < chain->marks.planes; p++) {
        const uint8_t *const plane = work->marks.bytes + p * work->marks.points;
        if (plane[a] != plane[b])
            return plane[a] > plane[b];
    }
    return precedes(position_of(work, a), position_of(work, b));
}

/* Whether an edge of two vertices that move is to be cut. */
static bool is_cut(const tear_work *work, uint32_t a, uint32_t b)
{
    const lattice_chain *const chain = work->question->chain;
    if (!vec_is_finite(position_of(work, a)) || !vec_is_finite(position_of(work, b)))
        return false;
    if (!are_alike(work, a, b, chain->marks.kept))
        return true;
    if (chain->marks.owners && (ffd_marks_owner(chain, &work->marks, a) & ~OWNER_NEAREST) !=
                                   (ffd_marks_owner(chain, &work->marks, b) & ~OWNER_NEAREST))
        return true;
    return (!ffd_marks_are_near(chain, &work->marks, a, b) && may_jump(work, a, b)) ||
           passes_another(work, a, b);
}

/* Makes the key of an edge of the kind at hand. Returns false if it is none. */
static bool make_key(const tear_work *work, uint32_t a, uint32_t b, uint64_t *key)
{
    const bool by_a = takes_part(work, a), by_b = takes_part(work, b);
    bool first;
    if (work->kind == TEAR_STAYS ? by_a == by_b : !by_a || !by_b || !is_cut(work, a, b))
        return false;
    first = work->kind == TEAR_STAYS ? by_b : goes_first(work, a, b);
    *key = first ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    return true;
}

static bool is_uniform(const tear_work *work, const uint32_t *corners, size_t count)
{
    for (size_t c = 1; c < count; c++)
        if (!are_alike(work, corners[c], corners[0], work->question->chain->marks.planes))
            return false;
    return true;
}

/* Lists the edges of the kind at hand. keys NULL: only counts them. */
static size_t list_edges(const tear_work *work, uint64_t *keys)
{
    const mesh_faces *const faces = work->question->faces;
    const bool all = work->question->passes && work->kind == TEAR_MOVES;
    size_t count = 0;
    for (size_t f = 0; f < faces->face_count; f++) {
        const uint32_t *const corners = faces->corners + faces->start[f];
        const size_t size = faces->start[f + 1] - faces->start[f];
        uint64_t key;
        if ((!all && is_uniform(work, corners, size)) || is_hidden(work, corners[0]))
            continue;
        for (size_t c = 0; c < size; c++)
            if (make_key(work, corners[c], corners[c + 1 < size ? c + 1 : 0], &key)) {
                if (keys)
                    keys[count] = key;
                count++;
            }
    }
    return count;
}

/* Merges ends that share a position. */
static ffd_status join_ends(tear_work *work, ffd_error *error)
{
    position_table table;
    edge_list *const edges = &work->edges;
    ffd_status status =
        ffd_positions_begin(&table, work->question->faces->positions, 2 * edges->count, error);
    for (size_t i = 0; i < edges->count && !status; i++) {
        const uint32_t first = ffd_positions_add(&table, first_end(edges->keys[i]));
        const uint32_t second = ffd_positions_add(&table, second_end(edges->keys[i]));
        edges->keys[i] = (uint64_t)first << 32 | second;
    }
    ffd_positions_end(&table);
    return status;
}

static ffd_status collect(tear_work *work, ffd_error *error)
{
    edge_list *const edges = &work->edges;
    edges->count = list_edges(work, NULL);
    if (edges->count == 0)
        return FFD_OK;
    ffd_status status = ffd_budget_check(work->question->budget, edges->count, EDGE_BYTES, error);
    if (status)
        return status;
    edges->keys = ffd_alloc(edges->count, sizeof *edges->keys);
    work->steps = ffd_alloc(edges->count, sizeof *work->steps);
    if (!edges->keys || !work->steps)
        return ffd_fail_memory(error);
    list_edges(work, edges->keys);
    status = join_ends(work, error);
    return status ? status : ffd_edges_sort(edges, error);
}

/* Whether an edge with an end that stays has the same step as the edge before it. */
static bool is_repeated(const tear_work *work, uint64_t before, uint64_t key)
{
    return first_end(before) == first_end(key) &&
           are_alike(work, second_end(before), second_end(key), work->question->chain->marks.kept);
}

/* The step of an end that stays is the displacement that it would have by the lattices of its neighbour, as
   they are extended. */
static ffd_status find_stays(const tear_work *work, const uint64_t *keys, size_t count, tear_step *steps,
                             tear_worker *worker)
{
    field_place places[CUT_RUN];
    size_t heads = 0, of = 0;
    for (size_t i = 0; i < count; i++) {
        if (i > 0 && is_repeated(work, keys[i - 1], keys[i]))
            continue;
        field_place *const place = &places[heads++];
        *place = (field_place){.ends = {first_end(keys[i]), second_end(keys[i])},
                               .by = work->question->chain->blocks ? FIELD_BETWEEN : FIELD_SECOND};
        memcpy(place->x, position_of(work, place->ends[0]), sizeof place->x);
    }
    const ffd_status status =
        ffd_tear_field_find(work->field, places, heads, ffd_tear_cuts_scratch(worker->cuts), &worker->error);
    for (size_t i = 0; i < count && !status; i++) {
        of += i > 0 && !is_repeated(work, keys[i - 1], keys[i]);
        steps[i].length = vec_length(places[of].delta);
        steps[i].cause =
            work->marks.bytes[first_end(keys[i])] & KEPT_ALWAYS ? FFD_TEAR_UNSELECTED : FFD_TEAR_STAYS;
    }
    return status;
}

static void run_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const tear_work *const work = context;
    const tear_question *const question = work->question;
    tear_worker *const own = &work->workers[worker];
    const uint64_t *const keys = work->edges.keys + first;
    (void)tile;
    if (own->status)
        return;
    own->status = work->kind == TEAR_STAYS
                      ? find_stays(work, keys, last - first, work->steps + first, own)
                      : ffd_tear_cut(work->field, question->chain, question->faces, keys, last - first,
                                     work->steps + first, own->cuts, &own->error);
}

/* Finds the steps of all edges of the kind at hand. */
static ffd_status find_steps(tear_work *work, ffd_error *error)
{
    const size_t tiles = work->edges.count / CUT_RUN + 1;
    const int threads = work->question->threads;
    const size_t workers = tiles < (size_t)threads ? tiles : (size_t)threads;
    ffd_status status = FFD_OK;
    work->workers = ffd_alloc_zero(workers, sizeof *work->workers);
    if (!work->workers)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < workers && !status; i++) {
        work->workers[i].cuts = ffd_tear_cuts_make();
        status = work->workers[i].cuts ? FFD_OK : ffd_fail_memory(error);
    }
    if (!status)
        ffd_parallel_tiles(work->edges.count, CUT_RUN, (int)workers, run_tile, work);
    for (size_t i = 0; i < workers; i++) {
        if (!status && work->workers[i].status) {
            status = work->workers[i].status;
            if (error)
                *error = work->workers[i].error;
        }
        ffd_tear_cuts_free(work->workers[i].cuts);
    }
    ffd_free(work->workers);
    return status;
}

/* Judges an edge by its step. */
static ffd_status judge_edge(const tear_work *work, uint64_t key, const tear_step *step, ffd_error *error)
{
    const mesh_faces *const faces = work->question->faces;
    const uint32_t first = first_end(key), second = second_end(key);
    tear_count *const count = work->count;
    torn_edges *const torn = work->question->torn;
    double along[3];
    find_along(work, first, second, along);
    if (!(step->length > TORN * vec_length(along)))
        return FFD_OK;
    if (step->length > count->largest || (step->length >= count->largest && first < count->vertex)) {
        count->largest = step->length;
        count->vertex = first;
        count->cause = step->cause;
    }
    count->edges++;
    return torn ? ffd_torn_edges_add(torn, ffd_faces_number(faces, first), ffd_faces_number(faces, second),
                                     step->length, error)
                : FFD_OK;
}

/* Vertices at one position get equal marks: an unmovable one takes those of a movable one. */
static ffd_status join_marks(const tear_work *work, ffd_error *error)
{
    const mesh_faces *const faces = work->question->faces;
    uint8_t *const marks = work->question->marks;
    const size_t count = faces->vertex_count;
    size_t still = 0;
    position_table table;
    for (size_t v = 0; v < count; v++)
        still += marks[v] & KEPT_ALWAYS;
    if (still == 0 || still == count)
        return FFD_OK;
    ffd_status status = ffd_budget_check(work->question->budget, still, POSITION_TABLE_BYTES, error);
    if (!status)
        status = ffd_positions_begin(&table, faces->positions, still, error);
    if (status)
        return status;
    for (size_t v = 0; v < count; v++)
        if (marks[v] & KEPT_ALWAYS && !is_hidden(work, (uint32_t)v))
            ffd_positions_add(&table, (uint32_t)v);
    for (int turn = 0; turn < 2;
         turn++) /* first pass: to the position's representative; second pass: to all others there */
        for (size_t v = 0; v < count; v++) {
            uint32_t other;
            if ((marks[v] & KEPT_ALWAYS) != (turn == 1) || is_hidden(work, (uint32_t)v) ||
                !ffd_positions_find(&table, (uint32_t)v, &other))
                continue;
            for (size_t p = 0; p < work->question->chain->marks.planes; p++)
                marks[p * count + (turn ? v : other)] = marks[p * count + (turn ? other : v)];
        }
    ffd_positions_end(&table);
    return FFD_OK;
}

/* Counts the torn edges of a kind. */
static ffd_status count_kind(tear_work *work, ffd_error *error)
{
    ffd_status status = collect(work, error);
    if (!status && work->edges.count > 0)
        status = find_steps(work, error);
    for (size_t i = 0; i < work->edges.count && !status; i++)
        status = judge_edge(work, work->edges.keys[i], &work->steps[i], error);
    ffd_edges_free(&work->edges);
    ffd_free(work->steps);
    work->steps = NULL;
    return status;
}

ffd_status ffd_tears_count(const tear_question *question, tear_count *count, ffd_error *error)
{
    tear_work work = {.question = question,
                      .marks = {question->marks, question->faces->vertex_count},
                      .layers = ffd_chain_layers(question->chain),
                      .field = ffd_tear_field_make(question->chain, question->faces, question->marks),
                      .count = count};
    *count = (tear_count){.vertex = UINT32_MAX};
    ffd_status status = work.field ? join_marks(&work, error) : ffd_fail_memory(error);
    for (int kind = 0; kind < TEAR_KINDS && !status; kind++) {
        work.kind = (tear_kind)kind;
        status = count_kind(&work, error);
    }
    if (!status && question->torn)
        ffd_torn_edges_thin(question->torn);
    ffd_tear_field_free(work.field);
    return status;
}
