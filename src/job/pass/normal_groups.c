#include "job/pass/normal_groups.h"
#include "base/memory/memory.h"
#include "base/memory/slots.h"
#include "base/system/deadline.h"
#include "base/vector/vec.h"
#include "io/openmesh/normals.h"
#include "job/pass/vertex_transform.h"
#include <string.h>

#define BLOCK VERTEX_TRANSFORMS

enum { SIDE_SHOWN, SIDE_MIRRORED, SIDE_SINGULAR };

typedef struct grouping {
    const mesh_document *document;
    mesh_state state;
    const mesh_faces *faces;
    const double *deformed;
    normal_groups *groups;
    double *values; /* 3 a normal: direction in the lattice's space, not normalized */
    uint8_t *sides; /* one a vertex */
    vertex_transforms *transforms;
    uint32_t *corners; /* one a corner: its normal, later its group */
    uint32_t *firsts;  /* one a group: its first corner */
    uint32_t *slots;   /* hash table of groups, open addressing; mask + 1 entries, a power of two */
    size_t mask;
} grouping;

static ffd_status count_normals(grouping *g, ffd_error *error)
{
    uint64_t count = 0;
    for (size_t i = 0; i < g->document->part_count; i++)
        count += g->document->parts[i].normal_count;
    if (count >= NORMAL_NO_GROUP)
        return ffd_fail(error, FFD_E_LIMIT, "%llu normals are too many to be computed from faces",
                        (unsigned long long)count);
    g->groups->normal_count = (size_t)count;
    if (g->faces->start[g->faces->face_count] >= NORMAL_NO_GROUP)
        return ffd_fail(error, FFD_E_LIMIT, "%zu corners of faces are too many for normals from them",
                        g->faces->start[g->faces->face_count]);
    return FFD_OK;
}

static ffd_status allocate(grouping *g, ffd_error *error)
{
    normal_groups *groups = g->groups;
    const size_t corners = g->faces->start[g->faces->face_count], normals = groups->normal_count;
    const size_t most = normals < corners ? normals : corners;
    groups->group = ffd_alloc(normals, sizeof *groups->group);
    g->values = ffd_alloc(normals, 3 * sizeof *g->values);
    g->sides = ffd_alloc_zero(g->faces->vertex_count, 1);
    g->transforms = ffd_alloc(1, sizeof *g->transforms);
    g->corners = ffd_alloc(corners, sizeof *g->corners);
    g->firsts = ffd_alloc(most, sizeof *g->firsts);
    g->slots = ffd_slots_make(most, sizeof *g->slots, &g->mask);
    if (!groups->group || !g->values || !g->sides || !g->transforms || !g->corners || !g->firsts || !g->slots)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < normals; i++)
        groups->group[i] = NORMAL_NO_GROUP;
    return FFD_OK;
}

static ffd_status read_corners(grouping *g, ffd_error *error)
{
    const mesh_format *format = g->document->format;
    if (format->corner_normals)
        return format->corner_normals(g->document, g->faces, g->corners, error);
    memcpy(g->corners, g->faces->corners, g->faces->start[g->faces->face_count] * sizeof *g->corners);
    return FFD_OK;
}

/* Transforms n as the normal of the visible side: M^-T n, whatever the sign of det M. */
static void show(const vertex_transform *transform, double n[3])
{
    if (transform->identity || transform->singular)
        return;
    const double *m = transform->inverse;
    const double transposed[9] = {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
    mat_apply(transposed, n, n);
}

static uint8_t side_of(const vertex_transform *transform)
{
    if (transform->singular)
        return SIDE_SINGULAR;
    return !transform->identity && mat_determinant(transform->linear) < 0 ? SIDE_MIRRORED : SIDE_SHOWN;
}

/* Reads the normals and sides of a part's vertices [first, first + count). */
static void read_block(grouping *g, size_t part, size_t first, size_t count, uint8_t *sides, double *values)
{
    const mesh_part *p = &g->document->parts[part];
    ffd_vertex_transforms_read(g->document, part, first, count, g->transforms, NULL);
    const size_t from = p->normal_start ? p->normal_start[first] : first;
    const size_t end = p->normal_start ? p->normal_start[first + count] : first + count;
    g->document->format->read(g->document, part, MESH_NORMALS, g->state, from, end - from, values + 3 * from);
    for (size_t i = 0; i < count; i++) {
        const vertex_transform transform = ffd_vertex_transform_of(g->transforms, i);
        const size_t v = first + i, own = p->normal_start ? p->normal_start[v] : v;
        const size_t behind = p->normal_start ? p->normal_start[v + 1] : v + 1;
        sides[v] = side_of(&transform);
        for (size_t n = own; n < behind; n++)
            show(&transform, values + 3 * n);
    }
}

static void read_normals(grouping *g, const size_t *first_vertices)
{
    double *values = g->values;
    for (size_t i = 0; i < g->document->part_count; i++) {
        const mesh_part *part = &g->document->parts[i];
        for (size_t at = 0; at < part->vertex_count && part->normal_count && !ffd_deadline_passed();
             at += BLOCK)
            read_block(g, i, at, part->vertex_count - at < BLOCK ? part->vertex_count - at : BLOCK,
                       g->sides + first_vertices[i], values);
        values += 3 * part->normal_count;
    }
}

/* What the corners of a group share. */
typedef struct group_key {
    double numbers[9];
} group_key;

static group_key key_of(const grouping *g, size_t corner)
{
    const size_t vertex = g->faces->corners[corner], normal = g->corners[corner];
    group_key key;
    for (size_t a = 0; a < 3; a++) {
        key.numbers[a] = g->faces->positions[3 * vertex + a] + 0.0; /* makes -0 equal to 0 */
        key.numbers[3 + a] = g->deformed[3 * vertex + a] + 0.0;
        key.numbers[6 + a] = g->values[3 * normal + a] + 0.0;
    }
    return key;
}

/* Applies the finalizer of MurmurHash3 to each word of a key. */
static uint64_t hash_of(const group_key *key)
{
    uint64_t words[9], hash = 0;
    memcpy(words, key->numbers, sizeof words);
    for (int i = 0; i < 9; i++) {
        hash = (hash ^ words[i]) * UINT64_C(0xff51afd7ed558ccd);
        hash = (hash ^ (hash >> 33)) * UINT64_C(0xc4ceb9fe1a85ec53);
        hash ^= hash >> 33;
    }
    return hash;
}

static uint32_t find_or_add(grouping *g, size_t corner)
{
    const group_key key = key_of(g, corner);
    size_t at = (size_t)hash_of(&key) & g->mask;
    for (; g->slots[at] != NORMAL_NO_GROUP; at = (at + 1) & g->mask) {
        const group_key other = key_of(g, g->firsts[g->slots[at]]);
        if (memcmp(&other, &key, sizeof key) == 0)
            return g->slots[at];
    }
    const uint32_t group = (uint32_t)g->groups->group_count++;
    g->firsts[group] = (uint32_t)corner;
    g->slots[at] = group;
    return group;
}

/* All corners of a normal are in one group, because a normal belongs to one vertex. */
static void join_corners(grouping *g)
{
    const size_t corners = g->faces->start[g->faces->face_count];
    for (size_t c = 0; c < corners && !ffd_deadline_passed_at(c); c++) {
        const uint32_t normal = g->corners[c];
        if (normal == MESH_NO_NORMAL || g->sides[g->faces->corners[c]] == SIDE_SINGULAR)
            continue;
        if (g->groups->group[normal] == NORMAL_NO_GROUP)
            g->groups->group[normal] = find_or_add(g, c);
    }
}

static bool has_moved(const grouping *g, size_t vertex)
{
    const double *p = g->faces->positions + 3 * vertex, *q = g->deformed + 3 * vertex;
    return q[0] < p[0] || q[0] > p[0] || q[1] < p[1] || q[1] > p[1] || q[2] < p[2] || q[2] > p[2];
}

/* Replaces the corners' normals by their groups, and marks the groups that have a face with a moved
   vertex. */
static void touch_groups(grouping *g)
{
    const mesh_faces *faces = g->faces;
    for (size_t f = 0; f < faces->face_count; f++) {
        bool moved = false;
        for (size_t c = faces->start[f]; c < faces->start[f + 1] && !moved; c++)
            moved = has_moved(g, faces->corners[c]);
        for (size_t c = faces->start[f]; c < faces->start[f + 1]; c++) {
            const uint32_t normal = g->corners[c];
            g->corners[c] = normal == MESH_NO_NORMAL ? NORMAL_NO_GROUP : g->groups->group[normal];
            if (moved && g->corners[c] != NORMAL_NO_GROUP)
                g->groups->outcomes[g->corners[c]] = NORMAL_NEW;
        }
    }
}

/* Drops the corners of unchanged groups. Returns false if none are left. */
static bool drop_kept(grouping *g)
{
    const size_t corners = g->faces->start[g->faces->face_count];
    bool any = false;
    for (size_t c = 0; c < corners; c++) {
        if (g->corners[c] != NORMAL_NO_GROUP && g->groups->outcomes[g->corners[c]] == NORMAL_KEPT)
            g->corners[c] = NORMAL_NO_GROUP;
        any = any || g->corners[c] != NORMAL_NO_GROUP;
    }
    return any;
}

static ffd_status find_directions(grouping *g, ffd_error *error)
{
    normal_groups *groups = g->groups;
    groups->directions = ffd_alloc_zero(groups->group_count, 3 * sizeof *groups->directions);
    if (!groups->directions)
        return ffd_fail_memory(error);
    TRY(ffd_normals_of_groups(g->faces, g->deformed, g->corners, groups->group_count, g->sides,
                              groups->directions, error));
    for (size_t i = 0; i < groups->group_count; i++) {
        const double *n = groups->directions + 3 * i;
        if (groups->outcomes[i] == NORMAL_NEW && n[0] == 0 && n[1] == 0 && n[2] == 0)
            groups->outcomes[i] = NORMAL_LOST;
    }
    return FFD_OK;
}

static ffd_status make(grouping *g, ffd_error *error)
{
    size_t *first_vertices = NULL;
    TRY(count_normals(g, error));
    TRY(allocate(g, error));
    TRY(ffd_first_vertices(g->document, &first_vertices, error));
    ffd_status status;
    TRY_END(read_corners(g, error));
    read_normals(g, first_vertices);
    TRY_END(ffd_deadline_check(error));
    join_corners(g);
    TRY_END(ffd_deadline_check(error));
    g->groups->outcomes = ffd_alloc_zero(g->groups->group_count, 1);
    if (!g->groups->outcomes)
        TRY_END(ffd_fail_memory(error));
    touch_groups(g);
    TRY_END(ffd_deadline_check(error));
    if (drop_kept(g))
        TRY_END(find_directions(g, error));
end:
    ffd_free(first_vertices);
    return status;
}

ffd_status ffd_normal_groups_make(const mesh_document *document, mesh_state state, const mesh_faces *faces,
                                  const double *deformed, normal_groups *groups, ffd_error *error)
{
    grouping g = {
        .document = document, .state = state, .faces = faces, .deformed = deformed, .groups = groups};
    *groups = (normal_groups){0};
    const ffd_status status = make(&g, error);
    ffd_free(g.values);
    ffd_free(g.sides);
    ffd_free(g.transforms);
    ffd_free(g.corners);
    ffd_free(g.firsts);
    ffd_free(g.slots);
    return status;
}

void ffd_normal_groups_free(normal_groups *groups)
{
    ffd_free(groups->group);
    ffd_free(groups->directions);
    ffd_free(groups->outcomes);
    *groups = (normal_groups){0};
}
