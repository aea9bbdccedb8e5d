#include "job/measure/tears.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/system/thread.h"
#include "base/vector/vec.h"
#include "job/measure/tear_cut.h"
#include "mesh/positions.h"
#include <string.h>

/* Scratch memory of a thread. */
typedef struct tear_worker {
    tear_cuts *cuts;
    ffd_status status;
    ffd_error error;
} tear_worker;

typedef struct tear_work {
    const tear_question *question;
    const tear_mesh *mesh;
    tear_field field;
    tear_field continued; /* for edges of which one end stays */
    lattice_chain room;   /* of its chain */
    tear_count *count;
    /* Of the kind at hand: */
    tear_kind kind;
    edge_list edges;
    tear_step *steps;
    tear_worker *workers;
} tear_work;

/* Whether an edge with an end that stays has the same step as the edge before it. */
static bool is_repeated(const tear_work *work, uint64_t before, uint64_t key)
{
    return ffd_tear_first(before) == ffd_tear_first(key) &&
           ffd_tear_alike(work->mesh, ffd_tear_second(before), ffd_tear_second(key),
                          work->mesh->chain->marks.kept);
}

/* Where what moves the other end jumps on its way to the one that stays, the larger step counts. */
static ffd_status add_jumps(const tear_work *work, const uint64_t *keys, size_t count, tear_step *steps,
                            tear_worker *worker)
{
    tear_step jumps[CUT_RUN];
    TRY(ffd_tear_cut(&work->continued, keys, count, jumps, worker->cuts, &worker->error));
    for (size_t i = 0; i < count; i++)
        steps[i].length = larger_of(steps[i].length,
                                    jumps[i].length * ffd_tear_weight(work->mesh, ffd_tear_second(keys[i])));
    return FFD_OK;
}

/* Where both ends move, the larger of their weights counts. */
static ffd_status find_moves(const tear_work *work, const uint64_t *keys, size_t count, tear_step *steps,
                             tear_worker *worker)
{
    TRY(ffd_tear_cut(&work->field, keys, count, steps, worker->cuts, &worker->error));
    for (size_t i = 0; i < count; i++)
        steps[i].length *= larger_of(ffd_tear_weight(work->mesh, ffd_tear_first(keys[i])),
                                     ffd_tear_weight(work->mesh, ffd_tear_second(keys[i])));
    return FFD_OK;
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
        *place = (field_place){.ends = {ffd_tear_first(keys[i]), ffd_tear_second(keys[i])},
                               .by = work->mesh->chain->blocks ? FIELD_BETWEEN : FIELD_SECOND};
        memcpy(place->x, work->mesh->faces->positions + 3 * (size_t)place->ends[0], sizeof place->x);
    }
    TRY(ffd_tear_field_find(&work->field, places, heads, NULL, ffd_tear_cuts_scratch(worker->cuts),
                            &worker->error));
    for (size_t i = 0; i < count; i++) {
        of += i > 0 && !is_repeated(work, keys[i - 1], keys[i]);
        steps[i].length =
            vec_length(places[of].delta) * ffd_tear_weight(work->mesh, ffd_tear_second(keys[i]));
        steps[i].cause = work->mesh->marks.bytes[ffd_tear_first(keys[i])] & KEPT_ALWAYS ? FFD_TEAR_UNSELECTED
                                                                                        : FFD_TEAR_STAYS;
    }
    return !work->mesh->continues ? FFD_OK : add_jumps(work, keys, count, steps, worker);
}

static void run_tile(void *context, size_t tile, size_t first, size_t last, int worker)
{
    const tear_work *const work = context;
    tear_worker *const own = &work->workers[worker];
    const uint64_t *const keys = work->edges.keys + first;
    (void)tile;
    if (!own->status)
        own->status = ffd_deadline_check(&own->error);
    if (own->status)
        return;
    own->status = work->kind == TEAR_STAYS ? find_stays(work, keys, last - first, work->steps + first, own)
                                           : find_moves(work, keys, last - first, work->steps + first, own);
}

/* Finds the steps of all edges of the kind at hand. */
static ffd_status find_steps(tear_work *work, ffd_error *error)
{
    const size_t tiles = work->edges.count / CUT_RUN + 1;
    const int threads = work->question->threads;
    const size_t workers = tiles < (size_t)threads ? tiles : (size_t)threads;
    ffd_status status = FFD_OK;
    work->steps = ffd_alloc(work->edges.count, sizeof *work->steps);
    work->workers = ffd_alloc_zero(workers, sizeof *work->workers);
    if (!work->steps || !work->workers) {
        ffd_free(work->workers);
        return ffd_fail_memory(error);
    }
    for (size_t i = 0; i < workers; i++) {
        work->workers[i].cuts = ffd_tear_cuts_make();
        TRY_END(work->workers[i].cuts ? FFD_OK : ffd_fail_memory(error));
    }
    ffd_parallel_tiles(work->edges.count, CUT_RUN, (int)workers, run_tile, work);
end:
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
    const mesh_faces *const faces = work->mesh->faces;
    const uint32_t first = ffd_tear_first(key), second = ffd_tear_second(key);
    tear_count *const count = work->count;
    torn_edges *const torn = work->question->torn;
    double along[3];
    ffd_tear_along(faces, first, second, along);
    if (!(step->length > TORN * vec_length(along)))
        return FFD_OK;
    if (step->length > count->largest || (step->length >= count->largest && first < count->vertex)) {
        count->largest = step->length;
        count->vertex = first;
        count->cause = step->cause;
    }
    count->edges++;
    return torn ? ffd_torn_edges_add(torn, ffd_faces_document_vertex(faces, first),
                                     ffd_faces_document_vertex(faces, second), step->length, error)
                : FFD_OK;
}

/* Vertices at one position get equal marks: an unmovable one takes those of a movable one. */
static ffd_status join_marks(const tear_work *work, ffd_error *error)
{
    const mesh_faces *const faces = work->mesh->faces;
    uint8_t *const marks = work->question->marks;
    const size_t count = faces->vertex_count;
    size_t still = 0;
    position_table table;
    for (size_t v = 0; v < count; v++)
        still += marks[v] & KEPT_ALWAYS;
    if (still == 0 || still == count)
        return FFD_OK;
    TRY(ffd_budget_check(work->mesh->budget, still, POSITION_TABLE_BYTES, error));
    TRY(ffd_positions_begin(&table, faces->positions, still, error));
    for (size_t v = 0; v < count; v++)
        if (marks[v] & KEPT_ALWAYS && !ffd_tear_is_hidden(work->mesh, (uint32_t)v))
            ffd_positions_add(&table, (uint32_t)v);
    for (int turn = 0; turn < 2;
         turn++) /* first pass: to the position's representative; second pass: to all others there */
        for (size_t v = 0; v < count; v++) {
            uint32_t other;
            if ((marks[v] & KEPT_ALWAYS) != (turn == 1) || ffd_tear_is_hidden(work->mesh, (uint32_t)v) ||
                !ffd_positions_find(&table, (uint32_t)v, &other))
                continue;
            for (size_t p = 0; p < work->mesh->chain->marks.planes; p++)
                marks[p * count + (turn ? v : other)] = marks[p * count + (turn ? other : v)];
        }
    ffd_positions_end(&table);
    return FFD_OK;
}

/* Counts the torn edges of a kind. */
static ffd_status count_kind(tear_work *work, ffd_error *error)
{
    ffd_status status;
    TRY_END(ffd_tear_edges_list(work->mesh, work->kind, sizeof *work->steps, &work->edges, error));
    if (work->edges.count > 0)
        TRY_END(find_steps(work, error));
    for (size_t i = 0; i < work->edges.count; i++)
        TRY_END(judge_edge(work, work->edges.keys[i], &work->steps[i], error));
end:
    ffd_edges_free(&work->edges);
    ffd_free(work->steps);
    work->steps = NULL;
    return status;
}

ffd_status ffd_tears_count(const tear_question *question, tear_count *count, ffd_error *error)
{
    const tear_mesh *const mesh = &question->mesh;
    atomic_llong left;
    tear_work work = {.question = question,
                      .mesh = mesh,
                      .field = ffd_tear_field_make(mesh->chain, mesh->faces, &mesh->marks,
                                                   mesh->passes || mesh->planes > mesh->chain->marks.parts),
                      .count = count};
    work.continued = ffd_tear_field_continue(&work.field, &work.room);
    *count = (tear_count){.vertex = UINT32_MAX};
    atomic_init(&left, question->most);
    TRY(join_marks(&work, error));
    for (int kind = mesh->stays ? TEAR_STAYS : TEAR_MOVES; kind < TEAR_KINDS; kind++) {
        work.kind = (tear_kind)kind;
        work.field.left = kind == TEAR_MOVES ? &left : NULL;
        TRY(count_kind(&work, error));
    }
    if (question->torn)
        ffd_torn_edges_thin(question->torn);
    return FFD_OK;
}
