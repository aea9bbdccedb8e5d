#include "job/measure/tear_edges.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include "job/measure/tear_cut.h"
#include "lattice/lattice.h"
#include "mesh/positions.h"
#include <string.h>

/* Memory for each edge: the keys, twice while the list grows or is sorted, and entries for its ends in the
   table of positions. */
#define EDGE_BYTES (2 * sizeof(uint64_t) + 2 * POSITION_TABLE_BYTES)

typedef struct list_work {
    const tear_mesh *mesh;
    tear_kind kind;
    size_t layers, spare;
    /* If edges may lead through other lattices: of each block, whether an earlier one overlaps it; of a chain
       the bits of links that move something, a byte for each plane of bits. Else NULL. */
    uint8_t *others;
    /* With others, of each link of a chain: how far the links before it move a point at most, and those
       behind it. */
    double *before, *behind;
    edge_list *edges;
    size_t capacity;
} list_work;

static const double *position_of(const list_work *work, uint32_t vertex)
{
    return work->mesh->faces->positions + 3 * (size_t)vertex;
}

bool ffd_tear_alike(const tear_mesh *mesh, uint32_t a, uint32_t b, size_t planes)
{
    const uint8_t *bytes = mesh->marks.bytes;
    for (size_t p = 0; p < planes; p++, bytes += mesh->marks.points)
        if (bytes[a] != bytes[b])
            return false;
    return true;
}

static bool ends_before(const void *range, const void *vertex)
{
    return ((const vertex_range *)range)->end <= *(const uint32_t *)vertex;
}

bool ffd_tear_is_hidden(const tear_mesh *mesh, uint32_t of_faces)
{
    const vertex_range *const hidden = mesh->hidden;
    const uint32_t vertex = ffd_faces_document_vertex(mesh->faces, of_faces);
    const size_t count = mesh->hidden_count,
                 at = lower_bound(&vertex, hidden, count, sizeof *hidden, ends_before);
    return at < count && hidden[at].first <= vertex;
}

/* Undoes what a weight above 0 does to a displacement and its gradient: d' = w d, E' = w E + d g^T. */
static void undo_weight(double weight, const double *slope, double delta[3], double gradient[9])
{
    for (size_t r = 0; r < 3; r++) {
        delta[r] /= weight;
        for (size_t c = 0; c < 3; c++)
            gradient[3 * r + c] = (gradient[3 * r + c] - (slope ? delta[r] * slope[c] : 0)) / weight;
    }
}

/* Whether the displacement may jump between two vertices in different parts of the volumes that move them.
   The ends' displacements, where they are known, rule most edges out. */
static bool may_jump(const list_work *work, uint32_t a, uint32_t b)
{
    const tear_mesh *const mesh = work->mesh;
    const uint32_t ends[2] = {a, b};
    double along[3], delta[2][3], gradients[2][9], slope[3];
    if (!mesh->deformed || !mesh->gradients)
        return true;
    for (int end = 0; end < 2; end++) {
        const size_t index = ffd_faces_document_vertex(mesh->faces, ends[end]);
        const double weight = ffd_tear_weight(mesh, ends[end]);
        for (int c = 0; c < 3; c++)
            delta[end][c] = mesh->deformed[3 * index + (size_t)c] - position_of(work, ends[end])[c];
        memcpy(gradients[end], mesh->gradients + 9 * index, sizeof gradients[end]);
        if (!(weight > 0)) /* what it would have been is not known */
            return true;
        if (weight < 1)
            undo_weight(weight, ffd_vertex_slope(mesh->weights, mesh->state, index, slope), delta[end],
                        gradients[end]);
    }
    ffd_tear_along(work->mesh->faces, a, b, along);
    return ffd_tear_may_jump(along, (const double *const[]){delta[0], delta[1]},
                             (const double *const[]){gradients[0], gradients[1]});
}

/* Edges on their way through the lattices. */
typedef struct edge_way {
    const list_work *work;
    const uint32_t *corners; /* of equal marks, or those of one edge */
    bounds box, deformed; /* round them, at rest and deformed; the latter of a chain only, if it is known */
    unsigned owner;       /* blocks: theirs */
    bool clips;           /* corners are one edge, which is clipped; else boxes do */
} edge_way;

static bool boxes_meet(const bounds *a, const bounds *b)
{
    return a->lo[0] <= b->hi[0] && b->lo[0] <= a->hi[0] && a->lo[1] <= b->hi[1] && b->lo[1] <= a->hi[1] &&
           a->lo[2] <= b->hi[2] && b->lo[2] <= a->hi[2];
}

/* Stops at a block that moves places of the edges, but not their ends. */
static bool visit_block(void *context, uint32_t block)
{
    const edge_way *const way = context;
    const list_work *const work = way->work;
    const lattice_chain *const chain = work->mesh->chain;
    double from, to, along[3];
    if (block == (way->owner & ~OWNER_NEAREST) || (block > way->owner && !(way->owner & OWNER_NEAREST)))
        return true; /* of what two blocks hold the earlier one has all */
    if (!boxes_meet(&way->box, &chain->boxes[block]) || !way->clips)
        return !boxes_meet(&way->box, &chain->boxes[block]);
    ffd_tear_along(work->mesh->faces, way->corners[0], way->corners[1], along);
    return !ffd_link_clip(&chain->links[block], position_of(work, way->corners[0]), along, &from, &to);
}

/* Whether it is known where the links move the vertices: with weights these end elsewhere. */
static bool knows_deformed(const list_work *work)
{
    return work->mesh->deformed && !work->mesh->weights;
}

static const double *deformed_of(const list_work *work, uint32_t vertex)
{
    return work->mesh->deformed + 3 * (size_t)ffd_faces_document_vertex(work->mesh->faces, vertex);
}

/* Whether a link of a chain may move places of the edges, but not their ends. The ends are where the links
   before have moved them: that is near their places at rest, and near the deformed ones. */
static bool may_meet(const edge_way *way, size_t link)
{
    const list_work *const work = way->work;
    const chain_link *const of = &work->mesh->chain->links[link];
    const bool deformed = knows_deformed(work) && work->behind[link] < work->before[link];
    const double reach = deformed ? work->behind[link] : work->before[link];
    bounds box = deformed ? way->deformed : way->box;
    double from, to, along[3];
    if (of->is_still || ffd_marks_take(&work->mesh->marks, way->corners[0], link))
        return false;
    for (int c = 0; c < 3; c++) {
        box.lo[c] -= reach;
        box.hi[c] += reach;
    }
    if (!boxes_meet(&box, &work->mesh->chain->boxes[link]) || !way->clips || reach > 0)
        return boxes_meet(&box, &work->mesh->chain->boxes[link]);
    const double *const start =
        deformed ? deformed_of(work, way->corners[0]) : position_of(work, way->corners[0]);
    const double *const end =
        deformed ? deformed_of(work, way->corners[1]) : position_of(work, way->corners[1]);
    for (int c = 0; c < 3; c++)
        along[c] = end[c] - start[c];
    return ffd_link_clip(of, start, along, &from, &to);
}

/* The box round positions of the corners. */
static bounds box_of(const list_work *work, const uint32_t *corners, size_t count, bool deformed)
{
    bounds box;
    for (size_t i = 0; i < count; i++) {
        const double *const p = deformed ? deformed_of(work, corners[i]) : position_of(work, corners[i]);
        if (i == 0) {
            memcpy(box.lo, p, sizeof box.lo);
            memcpy(box.hi, p, sizeof box.hi);
        }
        bounds_add(&box, p);
    }
    return box;
}

/* Whether edges between these corners, of equal marks, may lead through a lattice that does not move them.
   clips: the corners are two; the answer is then exact for boxes. */
static bool may_pass(const list_work *work, const uint32_t *corners, size_t count, bool clips)
{
    static const double none[3] = {0, 0, 0};
    const lattice_chain *const chain = work->mesh->chain;
    const mark_planes *const marks = &work->mesh->marks;
    edge_way way = {.work = work, .corners = corners, .clips = clips};
    bool some = false;
    if (!work->others)
        return false;
    if (chain->blocks) {
        way.owner = ffd_marks_owner(chain, marks, corners[0]);
        for (size_t c = 1; c < count; c++)
            way.owner |= ffd_marks_owner(chain, marks, corners[c]) & OWNER_NEAREST;
        some = way.owner & OWNER_NEAREST || work->others[way.owner];
    }
    for (size_t p = 0; p < chain->marks.kept && !chain->blocks; p++)
        some = some || marks->bytes[p * marks->points + corners[0]] & work->others[p];
    if (!some)
        return false;
    way.box = box_of(work, corners, count, false);
    if (knows_deformed(work) && !chain->blocks)
        way.deformed = box_of(work, corners, count, true);
    for (size_t l = 0; l < chain->count && !chain->blocks; l++)
        if (may_meet(&way, l))
            return true;
    return chain->blocks && !ffd_box_tree_visit_box(&chain->tree, &way.box, none, visit_block, &way);
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
static bool goes_first(const list_work *work, uint32_t a, uint32_t b)
{
    const lattice_chain *const chain = work->mesh->chain;
    const unsigned owner_a = ffd_marks_owner(chain, &work->mesh->marks, a) & ~OWNER_NEAREST;
    const unsigned owner_b = ffd_marks_owner(chain, &work->mesh->marks, b) & ~OWNER_NEAREST;
    for (size_t l = 0; l < work->layers; l++)
        if (ffd_marks_keep(&work->mesh->marks, a, l) != ffd_marks_keep(&work->mesh->marks, b, l))
            return ffd_marks_keep(&work->mesh->marks, a, l);
    if (owner_a != owner_b)
        return owner_a > owner_b;
    for (size_t p = chain->marks.parts; p < chain->marks.planes; p++) {
        const uint8_t *const plane = work->mesh->marks.bytes + p * work->mesh->marks.points;
        if (plane[a] != plane[b])
            return plane[a] > plane[b];
    }
    return precedes(position_of(work, a), position_of(work, b));
}

/* Whether an edge of two vertices that move is to be cut. */
static bool is_cut(const list_work *work, uint32_t a, uint32_t b)
{
    const lattice_chain *const chain = work->mesh->chain;
    if (!vec_is_finite(position_of(work, a)) || !vec_is_finite(position_of(work, b)))
        return false;
    if (!ffd_tear_alike(work->mesh, a, b, chain->marks.kept))
        return true;
    if (chain->marks.owners && (ffd_marks_owner(chain, &work->mesh->marks, a) & ~OWNER_NEAREST) !=
                                   (ffd_marks_owner(chain, &work->mesh->marks, b) & ~OWNER_NEAREST))
        return true;
    return (work->mesh->planes > chain->marks.parts && !ffd_marks_are_near(chain, &work->mesh->marks, a, b) &&
            may_jump(work, a, b)) ||
           may_pass(work, (const uint32_t[]){a, b}, 2, true);
}

/* Whether a vertex moves with a piece, and not as the lattices move it. */
static bool is_rigid(const list_work *work, uint32_t vertex)
{
    const tear_mesh *const mesh = work->mesh;
    return mesh->rigid && mesh->rigid->pieces[ffd_faces_document_vertex(mesh->faces, vertex)] != MESH_NONE;
}

/* Makes the key of an edge of the kind at hand. Returns false if it is none. */
static bool make_key(const list_work *work, uint32_t a, uint32_t b, uint64_t *key)
{
    if (is_rigid(work, a) || is_rigid(work, b))
        return false;
    const bool by_a = ffd_marks_take_any(&work->mesh->marks, a, work->layers);
    const bool by_b = ffd_marks_take_any(&work->mesh->marks, b, work->layers);
    if (work->kind == TEAR_STAYS ? by_a == by_b : !by_a || !by_b || !is_cut(work, a, b))
        return false;
    const bool first = work->kind == TEAR_STAYS ? by_b : goes_first(work, a, b);
    *key = first ? (uint64_t)a << 32 | b : (uint64_t)b << 32 | a;
    return true;
}

static bool is_uniform(const list_work *work, const uint32_t *corners, size_t count)
{
    for (size_t c = 1; c < count; c++)
        if (!ffd_tear_alike(work->mesh, corners[c], corners[0], work->mesh->planes))
            return false;
    return true;
}

/* Adds an edge to the list. */
static ffd_status add_key(list_work *work, uint64_t key, ffd_error *error)
{
    edge_list *const edges = work->edges;
    if (edges->count == work->capacity) {
        TRY(ffd_budget_check(work->mesh->budget, edges->count + 1, EDGE_BYTES + work->spare, error));
        if (!ffd_grow((void **)&edges->keys, &work->capacity, edges->count + 1, sizeof *edges->keys))
            return ffd_fail_memory(error);
    }
    edges->keys[edges->count++] = key;
    return FFD_OK;
}

static ffd_status list_all(list_work *work, ffd_error *error)
{
    const mesh_faces *const faces = work->mesh->faces;
    for (size_t f = 0; f < faces->face_count; f++) {
        const uint32_t *const corners = faces->corners + faces->start[f];
        const size_t size = faces->start[f + 1] - faces->start[f];
        uint64_t key;
        if (is_uniform(work, corners, size) &&
            (work->kind == TEAR_STAYS || !may_pass(work, corners, size, false)))
            continue;
        if (ffd_tear_is_hidden(work->mesh, corners[0]))
            continue;
        for (size_t c = 0; c < size; c++)
            if (make_key(work, corners[c], corners[c + 1 < size ? c + 1 : 0], &key))
                TRY(add_key(work, key, error));
    }
    return FFD_OK;
}

/* Merges ends that share a position. */
static ffd_status join_ends(const list_work *work, ffd_error *error)
{
    position_table table;
    edge_list *const edges = work->edges;
    TRY(ffd_positions_begin(&table, work->mesh->faces->positions, 2 * edges->count, error));
    for (size_t i = 0; i < edges->count; i++) {
        const uint32_t first = ffd_positions_add(&table, ffd_tear_first(edges->keys[i]));
        const uint32_t second = ffd_positions_add(&table, ffd_tear_second(edges->keys[i]));
        edges->keys[i] = (uint64_t)first << 32 | second;
    }
    ffd_positions_end(&table);
    return FFD_OK;
}

/* Context of meet_earlier. */
typedef struct overlap_search {
    const bounds *boxes;
    uint32_t block;
} overlap_search;

/* Stops at an earlier block whose box overlaps that of the block by more than a rounding. */
static bool meet_earlier(void *context, uint32_t other)
{
    const overlap_search *const search = context;
    const bounds *const a = &search->boxes[search->block], *const b = &search->boxes[other];
    bool overlap = other < search->block;
    for (int c = 0; c < 3; c++) {
        const double rounding = 1e-9 * (a->hi[c] - a->lo[c]);
        overlap = overlap && a->hi[c] - b->lo[c] > rounding && b->hi[c] - a->lo[c] > rounding;
    }
    return !overlap;
}

/* Returns how far a lattice moves a point at most. */
static double reach_of(const ffd_lattice *lattice)
{
    double most = 0;
    for (size_t i = 0; i < lattice->count; i++)
        if (lattice->moved[i] & POINT_MOVED)
            most = larger_of(most, vec_length(lattice->difference + 3 * i));
    return lattice->weights_moved ? most + lattice->diagonal : most;
}

/* Finds the lattices that can lie between two points of another one: links of a chain that move something,
   and blocks that overlap a later one. */
static ffd_status find_others(list_work *work, ffd_error *error)
{
    static const double none[3] = {0, 0, 0};
    const lattice_chain *const chain = work->mesh->chain;
    double before = 0, behind = 0;
    if (!work->mesh->passes)
        return FFD_OK;
    work->others = ffd_alloc_zero(chain->count, sizeof *work->others);
    work->before = ffd_alloc(chain->count, sizeof *work->before);
    work->behind = ffd_alloc(chain->count, sizeof *work->behind);
    if (!work->others || !work->before || !work->behind)
        return ffd_fail_memory(error);
    for (size_t l = 0; l < chain->count; l++) {
        overlap_search search = {chain->boxes, (uint32_t)l};
        if (chain->blocks)
            work->others[l] =
                chain->links[l].is_convex && /* the parts of others tell more */
                !ffd_box_tree_visit_box(&chain->tree, &chain->boxes[l], none, meet_earlier, &search);
        else if (!chain->links[l].is_still)
            work->others[ffd_kept_plane(l)] |= ffd_kept_bit(l);
    }
    for (size_t l = 0; l < chain->count && !chain->blocks; l++) {
        work->before[l] = before;
        before += reach_of(ffd_link_mover(&chain->links[l]));
        work->behind[chain->count - 1 - l] = behind;
        behind += reach_of(ffd_link_mover(&chain->links[chain->count - 1 - l]));
    }
    return FFD_OK;
}

ffd_status ffd_tear_edges_list(const tear_mesh *mesh, tear_kind kind, size_t spare, edge_list *edges,
                               ffd_error *error)
{
    list_work work = {
        .mesh = mesh, .kind = kind, .layers = ffd_chain_layers(mesh->chain), .spare = spare, .edges = edges};
    *edges = (edge_list){NULL, 0};
    ffd_status status;
    TRY_END(kind == TEAR_MOVES ? find_others(&work, error) : FFD_OK);
    TRY_END(list_all(&work, error));
end:
    ffd_free(work.others);
    ffd_free(work.before);
    ffd_free(work.behind);
    if (status || edges->count == 0)
        return status;
    TRY(join_ends(&work, error));
    return ffd_edges_sort(edges, error);
}
