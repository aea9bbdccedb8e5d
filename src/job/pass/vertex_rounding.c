#include "job/pass/vertex_rounding.h"
#include "base/lower_bound.h"
#include "base/memory/memory.h"
#include "mesh/morphs.h"
#include <math.h>
#include <string.h>

void ffd_vertex_in_file(const vertex_transform *transform, const double x[3], double position[3])
{
    memcpy(position, x, 3 * sizeof *position);
    if (transform->identity || transform->singular)
        return;
    for (int a = 0; a < 3; a++)
        position[a] -= transform->offset[a];
    mat_apply(transform->inverse, position, position);
}

void ffd_vertex_cell(const mesh_document *document, mesh_state state, size_t part, size_t vertex,
                     const double position[3], double half[3])
{
    const mesh_part *const p = &document->parts[part];
    double stored[3], all[3] = {0, 0, 0};
    if (state == MESH_STORED || p->shape_count == 0) {
        ffd_rounding_cell(&p->rounding, position, half);
        return;
    }
    memcpy(stored, position, sizeof stored);
    for (size_t k = 0; k < p->shape_count; k++) {
        const mesh_shape *const shape = &p->shapes[k];
        double offset[3], cell[3];
        if (shape->weight == 0 || !shape->has[MESH_POSITIONS])
            continue;
        document->format->morphs->read_offsets(document, part, k, MESH_POSITIONS, vertex, 1, offset);
        ffd_rounding_cell(&shape->rounding, offset, cell);
        for (int a = 0; a < 3; a++) {
            stored[a] -= shape->weight * offset[a];
            all[a] += fabs(shape->weight) * cell[a];
        }
    }
    ffd_rounding_cell(&p->rounding, stored, half);
    for (int a = 0; a < 3; a++)
        half[a] += all[a];
}

void ffd_vertex_rounding_place(const vertex_transform *transform, double half[3])
{
    if (!transform->identity)
        ffd_rounding_transform(transform->linear, half);
}

ffd_status ffd_vertex_owners_list(const mesh_document *document, vertex_owners *owners, ffd_error *error)
{
    size_t index = 0;
    *owners = (vertex_owners){.document = document};
    owners->parts = ffd_alloc(document->part_count, sizeof *owners->parts);
    owners->first = ffd_alloc(document->part_count, sizeof *owners->first);
    if (!owners->parts || !owners->first)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < document->part_count; i++) {
        const mesh_part *part = &document->parts[i];
        if (part->repeats_positions || part->vertex_count == 0)
            continue;
        owners->parts[owners->count] = i;
        owners->first[owners->count++] = index;
        index += part->vertex_count;
    }
    return FFD_OK;
}

void ffd_vertex_owners_free(vertex_owners *owners)
{
    ffd_free(owners->parts);
    ffd_free(owners->first);
    *owners = (vertex_owners){0};
}

/* Returns the transform of vertex i of a part. own, inverse: memory for that of a skinned one. */
static vertex_transform transform_of(const mesh_document *document, size_t part, size_t i, double own[12],
                                     double inverse[9])
{
    const mesh_part *const p = &document->parts[part];
    if (!p->skinned)
        return (vertex_transform){p->linear, p->offset, p->inverse, p->identity, p->singular};
    document->format->read_transforms(document, part, i, 1, own, NULL);
    return (vertex_transform){own, own + 9, inverse, false, !mat_invert(own, inverse)};
}

static bool starts_up_to(const void *first, const void *vertex)
{
    return *(const size_t *)first <= *(const size_t *)vertex;
}

void ffd_vertex_rounding(const vertex_owners *owners, mesh_state state, size_t vertex, const double x[3],
                         double half[3])
{
    const mesh_document *const document = owners->document;
    const size_t owner =
        last_up_to(&vertex, owners->first, owners->count, sizeof *owners->first, starts_up_to);
    const size_t part = owners->parts[owner], i = vertex - owners->first[owner];
    double position[3], own[12], inverse[9];
    const vertex_transform transform = transform_of(document, part, i, own, inverse);
    document->format->read(document, part, MESH_POSITIONS, state, i, 1, position);
    if (x)
        ffd_vertex_in_file(&transform, x, position);
    ffd_vertex_cell(document, state, part, i, position, half);
    ffd_vertex_rounding_place(&transform, half);
}
