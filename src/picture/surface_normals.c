/* surface_normals.c - vertex normals from faces, with several normals at creases. */
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/vector/vec.h"
#include "picture/surface.h"
#include <string.h>

/* Squared cosine of 60 degrees: faces that meet at a greater angle make a crease. */
#define CREASE_SQUARE 0.25
/* Squared cosine of 30 degrees: if all faces at a vertex are within this angle of their mean, there is no
   crease. */
#define MEAN_SQUARE 0.75
/* The most faces at a vertex that are compared with each other; more are at the tip of a cone, or a flaw. */
#define MOST_FACES 64

/* Estimated bytes for a corner at a crease: its list entry, its index in the triangles, and a vertex of its
   own. */
#define SPLIT_BYTES 64

typedef struct crease_work {
    const picture_mesh *mesh;
    double scale;
    surface_normals *result;
    size_t normal_capacity, origin_capacity;
    float *faces;        /* normals, 3 numbers for each triangle; 0: no normal */
    uint8_t *has_crease; /* for each position */
    size_t *first;       /* for each position with a crease: index after its last corner */
    size_t *corners;     /* 3 * triangle + corner */
} crease_work;

/* The corners at one position. */
typedef struct fan {
    size_t count;
    double faces[MOST_FACES][3];
    double sums[MOST_FACES][3]; /* normals for the corners */
    uint32_t vertices[MOST_FACES];
    uint32_t given[MOST_FACES]; /* their vertices in the surface */
} fan;

/* Returns the representative of the vertices at the same position, which share normals. */
static uint32_t place_of(const picture_mesh *mesh, uint32_t vertex)
{
    return mesh->twins ? mesh->twins[vertex] : vertex;
}

/* Computes the normal of a face; its length is twice the area in pixels. Returns false if it has none, or is
   not drawn. */
static bool face_normal(const picture_mesh *mesh, double scale, size_t triangle, double normal[3])
{
    const uint32_t *const t = mesh->triangles + 3 * triangle;
    if (t[0] >= mesh->vertex_count || t[1] >= mesh->vertex_count || t[2] >= mesh->vertex_count)
        return false;
    const double *const p = mesh->positions + 3 * (size_t)t[0], *const q = mesh->positions + 3 * (size_t)t[1],
                        *const r = mesh->positions + 3 * (size_t)t[2];
    double a[3], b[3];
    for (int i = 0; i < 3; i++) {
        a[i] = (q[i] - p[i]) * scale;
        b[i] = (r[i] - p[i]) * scale;
    }
    vec_cross(a, b, normal);
    const double square = vec_dot(normal, normal);
    return square > 0 && square < 1e30;
}

/* Sums the face normals at each position, and stores them for later. */
static void add_faces(const crease_work *work)
{
    const picture_mesh *const mesh = work->mesh;
    double n[3];
    for (size_t t = 0; t < mesh->triangle_count && !ffd_deadline_passed_at(t); t++) {
        float *const face = work->faces + 3 * t;
        if (!face_normal(mesh, work->scale, t, n))
            n[0] = n[1] = n[2] = 0;
        for (int a = 0; a < 3; a++)
            face[a] = (float)n[a];
        for (size_t c = 0; c < 3 && vec_dot(n, n) > 0; c++) {
            float *const sum = work->result->normals + 3 * (size_t)place_of(mesh, mesh->triangles[3 * t + c]);
            for (int a = 0; a < 3; a++)
                sum[a] += face[a];
        }
    }
}

static bool is_within(const double a[3], const double b[3], double cosine_square)
{
    const double dot = vec_dot(a, b);
    return dot > 0 && dot * dot >= cosine_square * vec_dot(a, a) * vec_dot(b, b);
}

/* Marks the positions with a face far from their mean. Returns whether there are any. */
static bool find_creases(const crease_work *work)
{
    const picture_mesh *const mesh = work->mesh;
    bool any = false;
    for (size_t t = 0; t < mesh->triangle_count; t++) {
        const float *const face = work->faces + 3 * t;
        const double n[3] = {face[0], face[1], face[2]}, square = vec_dot(n, n);
        for (size_t c = 0; c < 3 && square > 0; c++) {
            const uint32_t v = place_of(mesh, mesh->triangles[3 * t + c]);
            const float *const sum = work->result->normals + 3 * (size_t)v;
            const double mean[3] = {sum[0], sum[1], sum[2]};
            if (!is_within(n, mean, MEAN_SQUARE)) {
                work->has_crease[v] = true;
                any = true;
            }
        }
    }
    return any;
}

/* Counts or lists all corners at creases. */
static void visit_corners(const crease_work *work, bool lists)
{
    const picture_mesh *const mesh = work->mesh;
    for (size_t corner = 3 * mesh->triangle_count; corner-- > 0;) {
        const uint32_t vertex = mesh->triangles[corner];
        const uint32_t place = vertex < mesh->vertex_count ? place_of(mesh, vertex) : UINT32_MAX;
        if (place == UINT32_MAX || !work->has_crease[place])
            continue;
        if (lists)
            work->corners[--work->first[place]] = corner;
        else
            work->first[place]++;
    }
}

/* Returns the vertex with this normal; a new one if no earlier corner has the same normal. Returns UINT32_MAX
   if memory runs out. */
static uint32_t give_vertex(crease_work *work, const fan *f, size_t corner)
{
    surface_normals *const result = work->result;
    const uint32_t vertex = f->vertices[corner];
    bool is_new = true;
    for (size_t i = 0; i < corner; i++)
        if (f->vertices[i] == vertex) {
            is_new = false;
            if (memcmp(f->sums[i], f->sums[corner], sizeof f->sums[i]) == 0)
                return f->given[i];
        }
    const size_t next = work->mesh->vertex_count + result->split_count;
    uint32_t given = vertex;
    if (!is_new) {
        if (next >= UINT32_MAX ||
            !ffd_grow((void **)&result->normals, &work->normal_capacity, next + 1, 3 * sizeof(float)) ||
            !ffd_grow((void **)&result->origins, &work->origin_capacity, result->split_count + 1,
                      sizeof *result->origins))
            return UINT32_MAX;
        result->origins[result->split_count++] = vertex;
        given = (uint32_t)next;
    }
    for (int a = 0; a < 3; a++)
        result->normals[3 * (size_t)given + (size_t)a] = (float)f->sums[corner][a];
    return given;
}

/* Sums the faces that meet the face of a corner without a crease, in a fixed order. */
static void add_neighbours(fan *f, size_t corner)
{
    double *const sum = f->sums[corner];
    sum[0] = sum[1] = sum[2] = 0;
    for (size_t i = 0; i < f->count; i++)
        if (i == corner || is_within(f->faces[i], f->faces[corner], CREASE_SQUARE))
            for (int a = 0; a < 3; a++)
                sum[a] += f->faces[i][a];
}

static bool split_place(crease_work *work, const size_t *corners, size_t count)
{
    fan f = {.count = count};
    if (count > MOST_FACES)
        return true;
    for (size_t i = 0; i < count; i++) {
        f.vertices[i] = work->mesh->triangles[corners[i]];
        if (!face_normal(work->mesh, work->scale, corners[i] / 3, f.faces[i]))
            f.faces[i][0] = f.faces[i][1] = f.faces[i][2] = 0;
    }
    for (size_t i = 0; i < count; i++) {
        add_neighbours(&f, i);
        f.given[i] = give_vertex(work, &f, i);
        if (f.given[i] == UINT32_MAX)
            return false;
        work->result->triangles[corners[i]] = f.given[i];
    }
    return true;
}

static ffd_status split_places(crease_work *work, const memory_budget *budget, ffd_error *error)
{
    const picture_mesh *const mesh = work->mesh;
    size_t total = 0;
    work->first = ffd_alloc_zero(mesh->vertex_count + 1, sizeof *work->first);
    if (!work->first)
        return ffd_fail_memory(error);
    visit_corners(work, false);
    for (size_t v = 0; v <= mesh->vertex_count; v++) {
        total += work->first[v];
        work->first[v] = total;
    }
    TRY(budget ? ffd_budget_check(budget, total, SPLIT_BYTES, error) : FFD_OK);
    work->corners = ffd_alloc(total, sizeof *work->corners);
    work->result->triangles = ffd_alloc(mesh->triangle_count, 3 * sizeof *mesh->triangles);
    if (!work->corners || !work->result->triangles)
        return ffd_fail_memory(error);
    memcpy(work->result->triangles, mesh->triangles, 3 * mesh->triangle_count * sizeof *mesh->triangles);
    visit_corners(work, true);
    for (size_t v = 0; v < mesh->vertex_count; v++)
        if (work->has_crease[v] &&
            !split_place(work, work->corners + work->first[v], work->first[v + 1] - work->first[v]))
            return ffd_fail_memory(error);
    return FFD_OK;
}

/* Copies to every vertex the normal of its position. */
static void spread(const picture_mesh *mesh, float *normals)
{
    for (size_t v = 0; mesh->twins && v < mesh->vertex_count; v++)
        memcpy(normals + 3 * v, normals + 3 * (size_t)mesh->twins[v], 3 * sizeof *normals);
}

ffd_status ffd_surface_normals(const picture_mesh *mesh, double scale, const memory_budget *budget,
                               surface_normals *result, ffd_error *error)
{
    *result = (surface_normals){.normals = ffd_alloc_zero(mesh->vertex_count, 3 * sizeof(float))};
    crease_work work = {.mesh = mesh,
                        .scale = scale,
                        .result = result,
                        .normal_capacity = mesh->vertex_count,
                        .faces = ffd_alloc_whole(mesh->triangle_count, 3 * sizeof(float)),
                        .has_crease = ffd_alloc_zero(mesh->vertex_count, 1)};
    ffd_status status;
    TRY_END(result->normals && work.has_crease && work.faces ? FFD_OK : ffd_fail_memory(error));
    add_faces(&work);
    TRY_END(ffd_deadline_check(error));
    const bool any = find_creases(&work);
    spread(mesh, result->normals);
    if (any)
        TRY_END(split_places(&work, budget, error));
end:
    ffd_free(work.has_crease);
    ffd_free(work.faces);
    ffd_free(work.first);
    ffd_free(work.corners);
    if (status) {
        ffd_free(result->normals);
        ffd_free(result->origins);
        ffd_free(result->triangles);
        *result = (surface_normals){.normals = NULL};
    }
    return status;
}
