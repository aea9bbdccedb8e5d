#include "view/page_reduce.h"
#include "base/memory/memory.h"
#include "mesh/meshopt/meshopt_simplify.h"
#include <math.h>
#include <string.h>

/* Triangles per call of meshoptimizer, whose memory grows with their number. */
#define RUN_TRIANGLES ((size_t)1 << 21)
/* Triangles at torn edges are all kept if they are at most this share of the target. */
#define TORN_SHARE 0.25
#define PASSES 8
/* Each pass aims at this share of the vertex limit, as simplification seldom hits its target exactly. */
#define AIM 0.97
/* If a pass leaves more than this share of the vertices, the next one may cut surfaces apart (is_rough). */
#define STUCK 0.99

/* Triangles of a part are simplified class by class; torn ones are kept. */
enum { PLAIN, FLIPPED, TORN, CLASSES };

typedef struct reducer {
    page_mesh *mesh;
    double low[3], scale; /* map positions to 0 .. 1 */
    uint8_t *torn;        /* of each vertex of the scene: whether it is an end of a torn edge */
    /* Of each vertex of the scene: its index in the current run; with texture coordinates the first of a list
       of these, by hash. VIEW_NONE between runs. */
    uint32_t *local;
    size_t lists;     /* of local */
    uint32_t *global; /* of each vertex of the run: its index in the scene, */
    uint32_t *next;   /* and the next one of its list, or VIEW_NONE */
    float *texcoords; /* of each vertex of the run, as many as a corner of the mesh has */
    float *positions;
    uint32_t *indices, *result; /* of the run: before and after simplification */
    uint32_t *kept;             /* copy of a part's triangles, sorted by class, */
    float *kept_texcoords;      /* and of their texture coordinates, or NULL */
} reducer;

static void measure(reducer *r)
{
    const view_scene *const scene = r->mesh->scene;
    double high[3] = {-INFINITY, -INFINITY, -INFINITY}, side = 0;
    for (int a = 0; a < 3; a++)
        r->low[a] = INFINITY;
    for (size_t i = 0; i < 3 * r->mesh->triangle_count; i++)
        for (size_t a = 0; a < 3; a++) {
            const double x = scene->before[3 * (size_t)r->mesh->triangles[i] + a];
            r->low[a] = minimum_number(r->low[a], x);
            high[a] = maximum_number(high[a], x);
        }
    for (int a = 0; a < 3; a++)
        side = maximum_number(side, high[a] - r->low[a]);
    r->scale = side > 0 ? 1 / side : 0;
    if (!isfinite(r->scale))
        r->scale = 0;
}

static bool allocate(reducer *r)
{
    const size_t vertices = r->mesh->scene->vertex_count,
                 run = r->mesh->triangle_count < RUN_TRIANGLES ? r->mesh->triangle_count : RUN_TRIANGLES;
    r->torn = ffd_alloc_zero(vertices, 1);
    r->lists = r->mesh->texcoords ? ffd_page_corner_lists(3 * run) : vertices;
    r->local = ffd_alloc(r->lists, sizeof *r->local);
    r->global = ffd_alloc(run, 3 * sizeof *r->global);
    r->next = ffd_alloc(run, 3 * sizeof *r->next);
    r->texcoords = ffd_alloc(run, 3 * r->mesh->texcoord_width * sizeof *r->texcoords);
    r->positions = ffd_alloc(run, 9 * sizeof *r->positions);
    r->indices = ffd_alloc(run, 3 * sizeof *r->indices);
    r->result = ffd_alloc(run, 3 * sizeof *r->result);
    return r->torn && r->local && r->global && r->next && r->texcoords && r->positions && r->indices &&
           r->result;
}

static void free_reducer(reducer *r)
{
    void *const blocks[] = {r->torn,      r->local,   r->global, r->next, r->texcoords,
                            r->positions, r->indices, r->result, r->kept, r->kept_texcoords};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        ffd_free(blocks[i]);
}

static int class_of(const reducer *r, size_t triangle)
{
    const uint32_t *const corners = r->mesh->triangles + 3 * triangle;
    if (r->torn[corners[0]] || r->torn[corners[1]] || r->torn[corners[2]])
        return TORN;
    return r->mesh->flipped && r->mesh->flipped[triangle] ? FLIPPED : PLAIN;
}

/* Marks the ends of torn edges; marks none if keeping their triangles would leave too little of the target
   for the rest of the mesh. */
static void mark_torn(reducer *r, double ratio)
{
    const view_scene *const scene = r->mesh->scene;
    size_t count = 0;
    for (size_t i = 0; i < scene->tear_count; i++)
        for (int end = 0; end < 2; end++)
            r->torn[scene->tears[i].vertices[end]] = 1;
    for (size_t t = 0; t < r->mesh->triangle_count; t++)
        count += class_of(r, t) == TORN;
    if ((double)count > TORN_SHARE * ratio * (double)r->mesh->triangle_count)
        memset(r->torn, 0, scene->vertex_count);
}

/* uv: NULL if there are none. */
static uint32_t *local_of(const reducer *r, uint32_t v, const float *uv)
{
    return &r->local[uv ? ffd_page_corner_list(v, uv, r->mesh->texcoord_width, r->lists) : v];
}

static void enter_vertex(reducer *r, uint32_t v, const float *uv, uint32_t at)
{
    uint32_t *const local = local_of(r, v, uv);
    for (size_t a = 0; a < 3; a++)
        r->positions[3 * (size_t)at + a] =
            (float)((r->mesh->scene->before[3 * (size_t)v + a] - r->low[a]) * r->scale);
    if (uv)
        memcpy(r->texcoords + r->mesh->texcoord_width * at, uv, r->mesh->texcoord_width * sizeof *uv);
    r->global[at] = v;
    r->next[at] = *local;
    *local = at;
}

/* Returns the index in the run of a vertex with these texture coordinates (NULL: none); VIEW_NONE: it has
   none. */
static uint32_t find_vertex(const reducer *r, uint32_t v, const float *uv)
{
    const size_t width = r->mesh->texcoord_width;
    uint32_t at = *local_of(r, v, uv);
    while (uv && at != VIEW_NONE &&
           (r->global[at] != v || memcmp(r->texcoords + width * at, uv, width * sizeof *uv) != 0))
        at = r->next[at];
    return at;
}

/* Gives the vertices of a run their local indices and scaled positions. A vertex has several where it has
   several texture coordinates: at one place they are simplified as one, and the texture is not torn. Returns
   their number. */
static size_t enter_run(reducer *r, const uint32_t *corners, const float *texcoords, size_t count)
{
    size_t vertices = 0;
    for (size_t i = 0; i < count; i++) {
        const float *const uv = texcoords ? texcoords + r->mesh->texcoord_width * i : NULL;
        uint32_t at = find_vertex(r, corners[i], uv);
        if (at == VIEW_NONE) {
            at = (uint32_t)vertices++;
            enter_vertex(r, corners[i], uv, at);
        }
        r->indices[i] = at;
    }
    for (size_t i = 0; i < vertices; i++)
        *local_of(r, r->global[i], texcoords ? r->texcoords + r->mesh->texcoord_width * i : NULL) = VIEW_NONE;
    return vertices;
}

/* Simplifies the triangles of a run in place. *count: their number before and after. */
static ffd_status reduce_run(reducer *r, double ratio, bool is_rough, uint32_t *corners, float *texcoords,
                             size_t *count, ffd_error *error)
{
    const size_t vertices = enter_run(r, corners, texcoords, 3 * *count),
                 target = 3 * (size_t)(ratio * (double)*count);
    const meshopt_mesh run = {r->positions, vertices, r->indices, 3 * *count};
    size_t left = 0;
    if (vertices == 0)
        return FFD_OK;
    const ffd_status status = ffd_meshopt_simplify(&run, target, is_rough, r->result, &left, error);
    /* A run that would vanish is kept as it was: no part may disappear unnoticed. */
    if (status || left == 0)
        return status;
    for (size_t i = 0; i < left; i++)
        corners[i] = r->global[r->result[i]];
    const size_t width = r->mesh->texcoord_width;
    for (size_t i = 0; texcoords && i < left; i++)
        memcpy(texcoords + width * i, r->texcoords + width * r->result[i], width * sizeof *texcoords);
    *count = left / 3;
    return FFD_OK;
}

/* Copies a part's triangles into kept, sorted by class. */
static void sort_part(reducer *r, const page_part *part, size_t counts[CLASSES])
{
    const size_t wide = 3 * r->mesh->texcoord_width;
    size_t at = 0;
    for (int kind = 0; kind < CLASSES; kind++) {
        const size_t first = at;
        for (size_t t = part->first_triangle; t < part->first_triangle + part->triangle_count; t++)
            if (class_of(r, t) == kind) {
                memcpy(r->kept + 3 * at, r->mesh->triangles + 3 * t, 3 * sizeof *r->kept);
                if (r->kept_texcoords)
                    memcpy(r->kept_texcoords + wide * at, r->mesh->texcoords + wide * t,
                           wide * sizeof *r->kept_texcoords);
                at++;
            }
        counts[kind] = at - first;
    }
}

/* Appends triangles to the mesh. texcoords: NULL if it has none. */
static void put_back(page_mesh *mesh, const uint32_t *corners, const float *texcoords, size_t count, int kind)
{
    const size_t wide = 3 * mesh->texcoord_width;
    if (count)
        memcpy(mesh->triangles + 3 * mesh->triangle_count, corners, 3 * count * sizeof *corners);
    if (count && texcoords)
        memcpy(mesh->texcoords + wide * mesh->triangle_count, texcoords, wide * count * sizeof *texcoords);
    if (mesh->flipped)
        memset(mesh->flipped + mesh->triangle_count, kind == FLIPPED, count);
    mesh->triangle_count += count;
}

/* Appends torn triangles. They may also be flipped, which marks tells. */
static void put_torn(page_mesh *mesh, const uint8_t *marks, const uint32_t *corners, const float *texcoords,
                     size_t count)
{
    const size_t first = mesh->triangle_count;
    put_back(mesh, corners, texcoords, count, TORN);
    for (size_t i = 0; mesh->flipped && i < count; i++)
        mesh->flipped[first + i] = marks[i];
}

/* start: in kept. */
static ffd_status reduce_class(reducer *r, double ratio, bool is_rough, int kind, size_t start, size_t count,
                               ffd_error *error)
{
    for (size_t done = 0; done < count;) {
        size_t run = count - done < RUN_TRIANGLES ? count - done : RUN_TRIANGLES;
        uint32_t *const corners = r->kept + 3 * (start + done);
        float *const texcoords =
            r->kept_texcoords ? r->kept_texcoords + 3 * r->mesh->texcoord_width * (start + done) : NULL;
        done += run;
        TRY(reduce_run(r, ratio, is_rough, corners, texcoords, &run, error));
        put_back(r->mesh, corners, texcoords, run, kind);
    }
    return FFD_OK;
}

/* Copies the flipped marks of a part's torn triangles, in order. */
static void note_flipped(const reducer *r, const page_part *part, uint8_t *marks)
{
    for (size_t t = part->first_triangle; t < part->first_triangle + part->triangle_count; t++)
        if (r->mesh->flipped && class_of(r, t) == TORN)
            *marks++ = r->mesh->flipped[t];
}

static ffd_status reduce_part(reducer *r, double ratio, bool is_rough, page_part *part, ffd_error *error)
{
    size_t counts[CLASSES];
    sort_part(r, part, counts);
    uint8_t *const marks = ffd_alloc(counts[TORN], 1);
    if (!marks)
        return ffd_fail_memory(error);
    note_flipped(r, part, marks);
    part->first_triangle = r->mesh->triangle_count;
    size_t at = 0;
    ffd_status status = FFD_OK;
    for (int kind = PLAIN; kind < TORN; kind++) {
        TRY_END(reduce_class(r, ratio, is_rough, kind, at, counts[kind], error));
        at += counts[kind];
    }
end:
    put_torn(r->mesh, marks, r->kept + 3 * at,
             r->kept_texcoords ? r->kept_texcoords + 3 * r->mesh->texcoord_width * at : NULL, counts[TORN]);
    part->triangle_count = r->mesh->triangle_count - part->first_triangle;
    ffd_free(marks);
    return status;
}

/* Keeps this share of the elements, evenly spaced. Returns their number. */
static size_t thin_out(uint32_t *indices, size_t count, size_t corners, double ratio)
{
    size_t left = 0;
    for (size_t i = 0; i < count; i++)
        if (floor_of((double)(i + 1) * ratio) > floor_of((double)i * ratio))
            memmove(indices + corners * left++, indices + corners * i, corners * sizeof *indices);
    return left;
}

static ffd_status reduce_once(reducer *r, double ratio, bool is_rough, ffd_error *error)
{
    page_mesh *const mesh = r->mesh;
    mesh->segment_count = thin_out(mesh->segments, mesh->segment_count, 2, ratio);
    mesh->point_count = thin_out(mesh->points, mesh->point_count, 1, ratio);
    ffd_free(r->kept);
    ffd_free(r->kept_texcoords);
    size_t largest = 0;
    for (size_t i = 0; i < mesh->part_count; i++)
        largest = mesh->parts[i].triangle_count > largest ? mesh->parts[i].triangle_count : largest;
    r->kept = ffd_alloc(largest, 3 * sizeof *r->kept);
    r->kept_texcoords =
        mesh->texcoords ? ffd_alloc(largest, 3 * mesh->texcoord_width * sizeof *r->kept_texcoords) : NULL;
    if (!r->kept || (mesh->texcoords && !r->kept_texcoords))
        return ffd_fail_memory(error);
    /* Triangles are written back in place: no part grows, so none is overwritten before it is read. */
    mesh->triangle_count = 0;
    for (size_t i = 0; i < mesh->part_count; i++)
        TRY(reduce_part(r, ratio, is_rough, &mesh->parts[i], error));
    return FFD_OK;
}

/* The last resort, for meshes that simplification cannot reduce, such as unconnected triangles: drops
   triangles evenly. */
static void drop_triangles(page_mesh *mesh, double ratio)
{
    const size_t wide = 3 * mesh->texcoord_width;
    size_t left = 0;
    for (size_t i = 0; i < mesh->part_count; i++) {
        page_part *const part = &mesh->parts[i];
        const size_t first = left, end = part->first_triangle + part->triangle_count;
        for (size_t t = part->first_triangle; t < end; t++)
            if (floor_of((double)(t + 1) * ratio) > floor_of((double)t * ratio)) {
                memmove(mesh->triangles + 3 * left, mesh->triangles + 3 * t, 3 * sizeof *mesh->triangles);
                if (mesh->flipped)
                    mesh->flipped[left] = mesh->flipped[t];
                if (mesh->texcoords)
                    memmove(mesh->texcoords + wide * left, mesh->texcoords + wide * t,
                            wide * sizeof *mesh->texcoords);
                left++;
            }
        *part = (page_part){first, left - first};
    }
    mesh->triangle_count = left;
    mesh->segment_count = thin_out(mesh->segments, mesh->segment_count, 2, ratio);
    mesh->point_count = thin_out(mesh->points, mesh->point_count, 1, ratio);
}

/* Returns the share of triangles that a pass aims at. A mesh of several runs is first reduced until one run
   holds it, because borders between runs are kept and would show. */
static double choose_ratio(const page_mesh *mesh, size_t limit, size_t used)
{
    const double wanted = AIM * (double)limit / (double)used;
    if (mesh->triangle_count <= RUN_TRIANGLES)
        return wanted;
    return maximum_number(wanted, 0.5 * (double)RUN_TRIANGLES / (double)mesh->triangle_count);
}

ffd_status ffd_page_reduce(page_mesh *mesh, size_t limit, ffd_error *error)
{
    reducer r = {.mesh = mesh};
    size_t used = ffd_page_mesh_mark(mesh);
    if (used <= limit)
        return FFD_OK;
    ffd_status status;
    TRY_END(allocate(&r) ? FFD_OK : ffd_fail_memory(error));
    memset(r.local, 0xff, r.lists * sizeof *r.local);
    measure(&r);
    mark_torn(&r, (double)limit / (double)used);
    bool is_rough = false;
    for (int pass = 0; pass < PASSES && used > limit; pass++) {
        const size_t before = used;
        TRY_END(reduce_once(&r, choose_ratio(mesh, limit, used), is_rough, error));
        used = ffd_page_mesh_mark(mesh);
        is_rough = (double)used > STUCK * (double)before;
    }
    while (used > limit) {
        drop_triangles(mesh, AIM * (double)limit / (double)used);
        used = ffd_page_mesh_mark(mesh);
    }
end:
    free_reducer(&r);
    return status;
}
