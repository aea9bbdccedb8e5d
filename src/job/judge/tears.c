#include "job/judge/tears.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "job/chain/chain.h"
#include "job/judge/edge_list.h"
#include "mesh/positions.h"
#include <string.h>

/* An edge is torn if its step exceeds this part of its length. */
#define TORN 1e-3

/* Memory for each edge between a moving and a staying vertex: the sorted keys, and entries for its ends in
   the table of positions. */
#define EDGE_BYTES (2 * sizeof(uint64_t) + 2 * POSITION_TABLE_BYTES)

typedef struct tear_work {
    const tear_question *question;
    size_t planes;
    tear_count *count;
    edge_list torn; /* keys, if there are further marks: an edge torn in several modes must count once */
    size_t torn_capacity;
} tear_work;

static uint8_t marks_of(const tear_work *work, size_t plane, uint32_t vertex)
{
    return work->question->marks[plane * work->question->faces->vertex_count + vertex];
}

static bool is_always(const tear_work *work, uint32_t vertex)
{
    return marks_of(work, 0, vertex) & KEPT_ALWAYS;
}

static bool is_kept(const tear_work *work, uint32_t vertex, size_t link)
{
    return ffd_tear_is_kept(work->question->marks, work->question->faces->vertex_count, vertex, link);
}

bool ffd_tear_takes_part(const uint8_t *marks, size_t vertex_count, uint32_t vertex, size_t acting)
{
    if (marks[vertex] & KEPT_ALWAYS)
        return false;
    for (size_t l = 0; l < acting; l++)
        if (!ffd_tear_is_kept(marks, vertex_count, vertex, l))
            return true;
    return false;
}

/* Whether the first link that moves only one of the two vertices moves `moves`. */
static bool is_left_first(const tear_work *work, uint32_t stays, uint32_t moves)
{
    size_t l = 0;
    while (l < work->question->acting && is_kept(work, stays, l) == is_kept(work, moves, l))
        l++;
    return l < work->question->acting && is_kept(work, stays, l);
}

/* Whether an edge with this staying and this moving end belongs to the mode. */
static bool leads(const tear_work *work, size_t mode, uint32_t stays, uint32_t moves)
{
    const tear_question *const question = work->question;
    const size_t mark = question->acting + mode - TEAR_MARKED;
    if (is_always(work, moves) || is_always(work, stays) != (mode == TEAR_UNMOVABLE))
        return false;
    if (mode == TEAR_UNMOVABLE)
        return ffd_tear_takes_part(question->marks, question->faces->vertex_count, moves, question->acting);
    return mode == TEAR_BORDER ? is_left_first(work, stays, moves)
                               : is_kept(work, stays, mark) && !is_kept(work, moves, mark);
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

static bool is_uniform(const tear_work *work, const uint32_t *corners, size_t count)
{
    for (size_t p = 0; p < work->planes; p++)
        for (size_t c = 1; c < count; c++)
            if (marks_of(work, p, corners[c]) != marks_of(work, p, corners[0]))
                return false;
    return true;
}

/* Lists the edges of a mode, the staying end in the upper 32 bits. keys NULL: only count them. */
static size_t list_edges(const tear_work *work, size_t mode, uint64_t *keys)
{
    const mesh_faces *const faces = work->question->faces;
    size_t count = 0;
    for (size_t f = 0; f < faces->face_count; f++) {
        const uint32_t *const corners = faces->corners + faces->start[f];
        const size_t size = faces->start[f + 1] - faces->start[f];
        if (is_uniform(work, corners, size) || is_hidden(work, corners[0]))
            continue;
        for (size_t c = 0; c < size; c++) {
            const uint32_t a = corners[c], b = corners[c + 1 < size ? c + 1 : 0];
            const bool forth = leads(work, mode, a, b);
            if (!forth && !leads(work, mode, b, a))
                continue;
            if (keys)
                keys[count] = forth ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
            count++;
        }
    }
    return count;
}

/* Merges ends that share a position. */
static ffd_status join_ends(const tear_work *work, edge_list *edges, ffd_error *error)
{
    position_table table;
    ffd_status status =
        ffd_positions_begin(&table, work->question->faces->positions, 2 * edges->count, error);
    for (size_t i = 0; i < edges->count && !status; i++) {
        const uint32_t stays = ffd_positions_add(&table, (uint32_t)(edges->keys[i] >> 32));
        const uint32_t moves = ffd_positions_add(&table, (uint32_t)(edges->keys[i] & UINT32_MAX));
        edges->keys[i] = (uint64_t)stays << 32 | moves;
    }
    ffd_positions_end(&table);
    return status;
}

static ffd_status collect(const tear_work *work, size_t mode, edge_list *edges, ffd_error *error)
{
    edges->count = list_edges(work, mode, NULL);
    if (edges->count == 0)
        return FFD_OK;
    ffd_status status = ffd_budget_check(work->question->budget, edges->count, EDGE_BYTES, error);
    if (status)
        return status;
    edges->keys = ffd_alloc(edges->count, sizeof *edges->keys);
    if (!edges->keys)
        return ffd_fail_memory(error);
    list_edges(work, mode, edges->keys);
    status = join_ends(work, edges, error);
    return status ? status : ffd_edges_sort(edges, error);
}

/* Records a torn edge for the count without duplicates. */
static ffd_status note_torn(tear_work *work, uint64_t key, ffd_error *error)
{
    const uint64_t a = key >> 32, b = key & UINT32_MAX;
    edge_list *const torn = &work->torn;
    if (!ffd_grow((void **)&torn->keys, &work->torn_capacity, torn->count + 1, sizeof *torn->keys))
        return ffd_fail_memory(error);
    torn->keys[torn->count++] = a < b ? a << 32 | b : b << 32 | a;
    return FFD_OK;
}

/* Judges an edge by its step. */
static ffd_status judge_edge(tear_work *work, size_t mode, uint64_t key, double step, ffd_error *error)
{
    const mesh_faces *const faces = work->question->faces;
    const double *const positions = faces->positions;
    const uint32_t stays = (uint32_t)(key >> 32), moves = (uint32_t)(key & UINT32_MAX);
    tear_count *const count = work->count;
    double along[3];
    for (size_t a = 0; a < 3; a++)
        along[a] = positions[3 * (size_t)moves + a] - positions[3 * (size_t)stays + a];
    if (!(step > TORN * vec_length(along)))
        return FFD_OK;
    if (step > count->largest || (step >= count->largest && stays < count->vertex)) {
        count->largest = step;
        count->vertex = stays;
        count->mode = mode;
    }
    count->edges++;
    if (work->question->torn && ffd_torn_edges_add(work->question->torn, ffd_faces_number(faces, stays),
                                                   ffd_faces_number(faces, moves), step, error))
        return FFD_E_MEMORY;
    return work->question->links > work->question->acting ? note_torn(work, key, error) : FFD_OK;
}

/* Whether two vertices have equal marks, so that the same links move them. */
static bool are_marked_alike(const tear_work *work, uint32_t a, uint32_t b)
{
    for (size_t p = 0; p < work->planes; p++)
        if (marks_of(work, p, a) != marks_of(work, p, b))
            return false;
    return true;
}

/* Whether some link moves the staying end and not the moving one. */
static bool is_left_too(const tear_work *work, uint64_t key)
{
    const uint32_t stays = ffd_tear_end_stays(key), moves = ffd_tear_end_moves(key);
    for (size_t l = 0; l < work->question->acting; l++)
        if (is_kept(work, moves, l) && !is_kept(work, stays, l))
            return true;
    return false;
}

/* Whether an edge needs a step of its own, or has the same one as the edge before it. */
static bool is_next(const tear_work *work, size_t mode, uint64_t before, uint64_t key)
{
    return mode >= work->question->lone || before >> 32 != key >> 32 || is_left_too(work, key) ||
           !are_marked_alike(work, (uint32_t)(before & UINT32_MAX), (uint32_t)(key & UINT32_MAX));
}

/* Judges edges from *first on, until TEAR_RUN steps are used up; *first becomes the next edge. */
static ffd_status judge_run(tear_work *work, size_t mode, const edge_list *edges, size_t *first,
                            ffd_error *error)
{
    const tear_question *const question = work->question;
    uint64_t asked[TEAR_RUN];
    double steps[TEAR_RUN];
    size_t count = 0, end = *first;
    for (; end < edges->count; end++) {
        if (count > 0 && !is_next(work, mode, edges->keys[end - 1], edges->keys[end]))
            continue;
        if (count == TEAR_RUN)
            break;
        asked[count++] = edges->keys[end];
    }
    ffd_status status = question->step(question->context, mode, asked, count, steps, error);
    size_t of = 0;
    for (size_t i = *first; i < end && !status; i++) {
        of += i > *first && is_next(work, mode, edges->keys[i - 1], edges->keys[i]);
        status = judge_edge(work, mode, edges->keys[i], steps[of], error);
    }
    *first = end;
    return status;
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
            for (size_t p = 0; p < work->planes; p++)
                marks[p * count + (turn ? v : other)] = marks[p * count + (turn ? other : v)];
        }
    ffd_positions_end(&table);
    return FFD_OK;
}

ffd_status ffd_tears_count(const tear_question *question, tear_count *count, ffd_error *error)
{
    tear_work work = {.question = question, .planes = ffd_kept_planes(question->links), .count = count};
    *count = (tear_count){.vertex = UINT32_MAX};
    ffd_status status = join_marks(&work, error);
    for (size_t mode = 0; mode < TEAR_MARKED + question->links - question->acting && !status; mode++) {
        edge_list edges = {NULL, 0};
        status = collect(&work, mode, &edges, error);
        for (size_t first = 0; first < edges.count && !status;)
            status = judge_run(&work, mode, &edges, &first, error);
        ffd_edges_free(&edges);
    }
    if (!status && work.torn.count > 0) {
        status = ffd_edges_sort(&work.torn, error);
        count->edges = work.torn.count;
    }
    if (!status && question->torn)
        ffd_torn_edges_thin(question->torn);
    ffd_edges_free(&work.torn);
    return status;
}
