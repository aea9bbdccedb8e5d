#include "job/pass/recompute.h"
#include "base/memory/memory.h"
#include "base/system/deadline.h"
#include "base/vector/vec.h"
#include "deform/attribute.h"
#include "job/pass/normal_groups.h"
#include "job/pass/vertex_transform.h"
#include <ffd/deform.h>
#include <string.h>

/* Vertices per run, and normals per run. */
#define BLOCK VERTEX_TRANSFORMS

typedef struct recomputing {
    mesh_document *document;
    mesh_state state;
    const double *gradients;
    const normal_groups *groups;
    recompute_counts *counts;
    size_t part;
    size_t first_vertex, first_normal; /* of the part in the document */
    vertex_transforms transforms;
    double normals[3 * BLOCK], tangents[4 * BLOCK];
    uint8_t changed[BLOCK];
} recomputing;

/* Transforms a normal to where the part was before its node or skin was moved (cofactors of the inverse
   motion). */
static void carry_direction(const mesh_part *part, double n[3])
{
    double linear[9], cofactor[9];
    mat_add_identity(part->carry, linear);
    mat_cofactor(linear, cofactor);
    mat_apply(cofactor, n, n);
}

/* Finds the stored normal whose direction in the lattice's space is `direction`: M^T of it, the inverse of
   normal_groups.c's show. */
static void bring_back(const mesh_part *part, const vertex_transform *transform, const double direction[3],
                       double n[3])
{
    memcpy(n, direction, 3 * sizeof *n);
    if (part->carried)
        carry_direction(part, n);
    else if (transform->identity)
        return;
    const double *m = transform->linear;
    const double transposed[9] = {m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8]};
    mat_apply(transposed, n, n);
    const double length = vec_length(n);
    for (int a = 0; a < 3; a++)
        n[a] /= length;
}

/* Reads the gradient at a vertex, in the file's space. */
static void read_gradient(const recomputing *r, const vertex_transform *transform, size_t vertex,
                          double gradient[9])
{
    memcpy(gradient, r->gradients + 9 * (r->first_vertex + vertex), 9 * sizeof *gradient);
    if (r->document->parts[r->part].carried)
        ffd_part_carry_gradient(&r->document->parts[r->part], gradient);
    ffd_gradient_to_file(transform, gradient);
}

static bool carry(const recomputing *r, const vertex_transform *transform, size_t vertex, double n[3])
{
    double gradient[9];
    read_gradient(r, transform, vertex, gradient);
    const ffd_direction_outcome outcome = ffd_deform_normal(gradient, n, n);
    r->counts->carried += outcome == FFD_DIRECTION_CARRIED;
    r->counts->collapsed += outcome == FFD_DIRECTION_COLLAPSED;
    return outcome == FFD_DIRECTION_CARRIED;
}

/* Recomputes a normal of the part at a vertex. n: its value, in and out. Returns whether it changed. */
static bool recompute(const recomputing *r, const vertex_transform *transform, size_t vertex, size_t normal,
                      double n[3])
{
    const mesh_part *part = &r->document->parts[r->part];
    if (transform->singular || !ffd_part_selects(part, vertex) ||
        (part->selected_normals && !part->selected_normals[normal]))
        return false;
    const uint32_t group = r->groups->group[r->first_normal + normal];
    const int outcome = group == NORMAL_NO_GROUP ? NORMAL_LOST : r->groups->outcomes[group];
    if (outcome == NORMAL_KEPT)
        return false;
    if (outcome == NORMAL_LOST)
        return carry(r, transform, vertex, n);
    bring_back(part, transform, r->groups->directions + 3 * (size_t)group, n);
    return true;
}

/* Recomputes tangents, one a vertex. Their normals have been recomputed (r->normals). */
static void recompute_tangents(recomputing *r, size_t first, size_t count)
{
    mesh_document *document = r->document;
    document->format->read(document, r->part, MESH_TANGENTS, r->state, first, count, r->tangents);
    for (size_t i = 0; i < count; i++) {
        double gradient[9], *t = r->tangents + 4 * i;
        const vertex_transform transform = ffd_vertex_transform_of(&r->transforms, i);
        if (!r->changed[i])
            continue;
        read_gradient(r, &transform, first + i, gradient);
        r->changed[i] = ffd_tangent_of_normal(gradient, t, r->normals + 3 * i, t) == FFD_DIRECTION_CARRIED;
    }
    document->format->write(document, r->part, MESH_TANGENTS, first, count, r->tangents, r->changed);
}

/* Recomputes normals [from, to) of the part. first: the first vertex of r->transforms. *vertex: the first
   normal's vertex; moved on to the last one's. */
static void recompute_run(recomputing *r, size_t first, size_t from, size_t to, size_t *vertex)
{
    mesh_document *document = r->document;
    const mesh_part *part = &document->parts[r->part];
    const size_t count = to - from;
    document->format->read(document, r->part, MESH_NORMALS, r->state, from, count, r->normals);
    for (size_t i = 0; i < count; i++) {
        while (part->normal_start ? part->normal_start[*vertex + 1] <= from + i : *vertex < from + i)
            (*vertex)++;
        const vertex_transform transform = ffd_vertex_transform_of(&r->transforms, *vertex - first);
        r->changed[i] = recompute(r, &transform, *vertex, from + i, r->normals + 3 * i);
    }
    document->format->write(document, r->part, MESH_NORMALS, from, count, r->normals, r->changed);
    if (part->has_tangents)
        recompute_tangents(r, first, count);
}

static void recompute_part(recomputing *r)
{
    const mesh_part *part = &r->document->parts[r->part];
    for (size_t first = 0; first < part->vertex_count && !ffd_deadline_passed(); first += BLOCK) {
        const size_t last = part->vertex_count - first < BLOCK ? part->vertex_count : first + BLOCK;
        size_t from = part->normal_start ? part->normal_start[first] : first, vertex = first;
        const size_t end = part->normal_start ? part->normal_start[last] : last;
        ffd_vertex_transforms_read(r->document, r->part, first, last - first, &r->transforms, NULL);
        for (size_t to; from < end; from = to) {
            to = end - from > BLOCK ? from + BLOCK : end;
            recompute_run(r, first, from, to, &vertex);
        }
    }
}

static ffd_status recompute_parts(recomputing *r, ffd_error *error)
{
    size_t *first_vertices;
    TRY(ffd_first_vertices(r->document, &first_vertices, error));
    for (r->part = 0; r->part < r->document->part_count; r->part++) {
        const mesh_part *part = &r->document->parts[r->part];
        r->first_vertex = first_vertices[r->part];
        if (part->normal_count && !part->skipped)
            recompute_part(r);
        r->first_normal += part->normal_count;
    }
    ffd_free(first_vertices);
    return ffd_deadline_check(error);
}

ffd_status ffd_recompute_normals(mesh_document *document, mesh_state state, const mesh_faces *faces,
                                 const double *deformed, const double *gradients, recompute_counts *counts,
                                 ffd_error *error)
{
    normal_groups groups = {0};
    recomputing *r = ffd_alloc_zero(1, sizeof *r);
    *counts = (recompute_counts){0};
    ffd_status status;
    TRY_END(r ? FFD_OK : ffd_fail_memory(error));
    TRY_END(ffd_normal_groups_make(document, state, faces, deformed, &groups, error));
    r->document = document;
    r->state = state;
    r->gradients = gradients;
    r->groups = &groups;
    r->counts = counts;
    counts->normals = groups.normal_count;
    TRY_END(recompute_parts(r, error));
end:
    ffd_normal_groups_free(&groups);
    ffd_free(r);
    return status;
}
