#include "io/gltf/model/gltf_faces.h"
#include "base/memory/memory.h"
#include "io/gltf/model/gltf_refuse.h"
#include "io/gltf/model/gltf_shown.h"
#include "io/gltf/read/gltf_read.h"
#include "io/gltf/read/gltf_restart.h"

#define MOST_TRIANGLES INT32_MAX

/* What a primitive draws for one use. */
typedef struct drawing {
    size_t corners; /* number of indices, or of vertices without indices */
    size_t triangles, lines, points;
} drawing;

static drawing count_drawing(const gltf_document *d, const gltf_primitive *primitive)
{
    drawing counted = {0};
    if (primitive->accessor[GLTF_POSITION] < 0)
        return counted;
    const size_t n = primitive->indices >= 0
                         ? ffd_gltf_drawn_count(d, primitive)
                         : (size_t)d->model.accessors[primitive->accessor[GLTF_POSITION]].count;
    if (primitive->mode == MODE_UNKNOWN)
        return counted;
    counted.corners = n;
    switch (primitive->mode) {
    case MODE_POINTS:
        counted.points = n;
        break;
    case MODE_LINES:
        counted.lines = n / 2;
        break;
    case MODE_LINE_LOOP:
        counted.lines = n > 1 ? n : 0;
        break;
    case MODE_LINE_STRIP:
        counted.lines = n > 1 ? n - 1 : 0;
        break;
    case MODE_TRIANGLES:
        counted.triangles = n / 3;
        break;
    default:
        counted.triangles = n > 2 ? n - 2 : 0;
    }
    return counted;
}

void ffd_gltf_count_drawing(const gltf_document *d, size_t mesh, size_t *triangles, size_t *lines,
                            size_t *points)
{
    for (size_t p = 0; p < d->model.meshes[mesh].primitive_count; p++) {
        const drawing counted = count_drawing(d, &d->model.meshes[mesh].primitives[p]);
        *triangles += counted.triangles;
        *lines += counted.lines;
        *points += counted.points;
    }
}

size_t ffd_gltf_count_triangles(const gltf_document *d, size_t mesh, size_t primitive)
{
    return count_drawing(d, &d->model.meshes[mesh].primitives[primitive]).triangles;
}

static ffd_status refuse_primitive(const gltf_document *d, size_t m, size_t p, ffd_error *error)
{
    const gltf_primitive *primitive = &d->model.meshes[m].primitives[p];
    if (primitive->accessor[GLTF_POSITION] < 0)
        return FFD_OK;
    const ffd_status status = ffd_gltf_refuse_unreadable(d, m, p, primitive->accessor[GLTF_POSITION], error);
    if (status || primitive->indices < 0)
        return status;
    return ffd_gltf_refuse_unreadable(d, m, p, primitive->indices, error);
}

static ffd_status count_all(const gltf_document *d, mesh_faces *faces, ffd_error *error)
{
    uint64_t triangles = 0, lines = 0, points = 0;
    for (size_t m = 0; m < d->model.mesh_count; m++) {
        const size_t nodes = d->mesh_uses[m].node_count;
        for (size_t p = 0; p < d->model.meshes[m].primitive_count && nodes > 0; p++) {
            const ffd_status status = refuse_primitive(d, m, p, error);
            if (status)
                return status;
            const drawing counted = count_drawing(d, &d->model.meshes[m].primitives[p]);
            triangles += (uint64_t)counted.triangles * nodes; /* both are below 2^32 */
            lines += (uint64_t)counted.lines * nodes;
            points += (uint64_t)counted.points * nodes;
            if (triangles > MOST_TRIANGLES)
                return ffd_fail_file(error, FFD_E_LIMIT, d->name, "its scene has more than %d triangles",
                                     MOST_TRIANGLES);
        }
    }
    faces->face_count = (size_t)triangles;
    faces->lines = (size_t)lines;
    faces->points = (size_t)points;
    return FFD_OK;
}

/* Fills in the positions of all parts in order; base[i] becomes the first vertex of part i. */
static void fill_positions(const gltf_document *d, mesh_faces *faces, size_t *base)
{
    size_t at = 0;
    for (size_t i = 0; i < d->base.part_count; i++) {
        const mesh_part *part = &d->mesh_parts[i];
        base[i] = at;
        if (part->repeats_positions)
            continue;
        double *positions = faces->positions + 3 * at;
        ffd_gltf_read_shown(d, i, GLTF_POSITION, 0, part->vertex_count, 3, positions);
        ffd_part_transform(&d->base, i, 0, part->vertex_count, positions);
        at += part->vertex_count;
    }
}

static ffd_status refuse_index(const gltf_document *d, size_t m, size_t p, size_t i, ffd_error *error)
{
    const gltf_primitive *primitive = &d->model.meshes[m].primitives[p];
    const gltf_accessor *positions = &d->model.accessors[primitive->accessor[GLTF_POSITION]];
    uint32_t index;
    ffd_gltf_read_drawn(d, primitive, i, 1, &index);
    return ffd_json_span_fail(&d->tree, ffd_gltf_primitive_value(d, m, p), d->name, FFD_E_INVALID, error,
                              "index %zu is %lu, but the count of vertices is %llu", i, (unsigned long)index,
                              (unsigned long long)positions->count);
}

static ffd_status fill_corners(const gltf_document *d, size_t m, size_t p, size_t count, uint32_t *corners,
                               ffd_error *error)
{
    const gltf_primitive *primitive = &d->model.meshes[m].primitives[p];
    const uint64_t vertices = d->model.accessors[primitive->accessor[GLTF_POSITION]].count;
    if (primitive->indices < 0) {
        for (size_t i = 0; i < count; i++)
            corners[i] = (uint32_t)i;
        return FFD_OK;
    }
    const uint32_t largest = ffd_gltf_read_drawn(d, primitive, 0, count, corners);
    for (size_t i = 0; i < count && largest >= vertices; i++)
        if (corners[i] >= vertices)
            return refuse_index(d, m, p, i, error);
    return FFD_OK;
}

ffd_status ffd_gltf_read_corners(const gltf_document *d, size_t m, size_t p, uint32_t **corners,
                                 size_t *count, ffd_error *error)
{
    ffd_status status = refuse_primitive(d, m, p, error);
    *corners = NULL;
    if (status)
        return status;
    *count = count_drawing(d, &d->model.meshes[m].primitives[p]).corners;
    *corners = ffd_alloc(*count, sizeof **corners);
    if (!*corners)
        return ffd_fail_memory(error);
    status = fill_corners(d, m, p, *count, *corners, error);
    if (status) {
        ffd_free(*corners);
        *corners = NULL;
    }
    return status;
}

static ffd_status add_primitive(const gltf_document *d, size_t m, size_t p, const size_t *base, uint32_t *to,
                                size_t *added, ffd_error *error)
{
    const gltf_primitive *primitive = &d->model.meshes[m].primitives[p];
    const drawing counted = count_drawing(d, primitive);
    const gltf_mesh_uses *uses = &d->mesh_uses[m];
    if (counted.triangles == 0 || uses->node_count == 0)
        return FFD_OK;
    uint32_t *corners;
    size_t count;
    const ffd_status status = ffd_gltf_read_corners(d, m, p, &corners, &count, error);
    for (size_t n = 0; n < uses->node_count && status == FFD_OK; n++) {
        const gltf_instance *instance = &ffd_gltf_instances(d, m, p)[n];
        for (size_t t = 0; t < counted.triangles; t++) {
            uint32_t *triangle = to + 3 * (*added)++;
            gltf_triangle(primitive->mode, t, corners, triangle);
            for (int c = 0; c < 3; c++)
                triangle[c] += (uint32_t)base[instance->part[GLTF_POSITION]];
        }
    }
    ffd_free(corners);
    return status;
}

uint64_t ffd_gltf_most_corners(const gltf_document *d)
{
    uint64_t most = 0;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count; p++) {
            const uint64_t corners = count_drawing(d, &d->model.meshes[m].primitives[p]).corners;
            most = corners > most ? corners : most;
        }
    return most;
}

/* Checks the memory of the faces plus the corners of one primitive. */
static ffd_status check_budget(const gltf_document *d, const mesh_faces *faces, ffd_error *error)
{
    memory_budget budget = d->base.budget;
    const ffd_status status = ffd_mesh_faces_take(faces, 3 * (uint64_t)faces->face_count, &budget, error);
    return status ? status : ffd_budget_check(&budget, ffd_gltf_most_corners(d), sizeof(uint32_t), error);
}

ffd_status ffd_gltf_faces(const mesh_document *document, mesh_faces *faces, ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    *faces = (mesh_faces){0};
    ffd_status status = count_all(d, faces, error);
    if (status)
        return status;
    for (size_t i = 0; i < d->base.part_count; i++)
        faces->vertex_count += d->mesh_parts[i].repeats_positions ? 0 : d->mesh_parts[i].vertex_count;
    status = check_budget(d, faces, error);
    if (status == FFD_OK)
        status = ffd_mesh_faces_make(document, faces, 3 * faces->face_count, error);
    if (status)
        return status;
    size_t *base = ffd_alloc(d->base.part_count, sizeof *base);
    if (!base)
        status = ffd_fail_memory(error);
    else {
        fill_positions(d, faces, base);
        for (size_t i = 0; i <= faces->face_count; i++)
            faces->start[i] = 3 * i;
    }
    size_t added = 0;
    for (size_t m = 0; m < d->model.mesh_count; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count && status == FFD_OK; p++)
            status = add_primitive(d, m, p, base, faces->corners, &added, error);
    ffd_free(base);
    if (status)
        ffd_mesh_faces_free(faces);
    return status;
}

/* Sets the normals of one instance's corners: vertex i of its positions has normal i of its normals. */
static void number_corners(const gltf_instance *instance, const size_t *first_vertices,
                           const size_t *first_normals, const uint32_t *corners, size_t count,
                           uint32_t *normals)
{
    const size_t part = instance->part[GLTF_NORMAL];
    if (part == GLTF_NONE) {
        for (size_t c = 0; c < count; c++)
            normals[c] = MESH_NO_NORMAL;
        return;
    }
    const size_t first = first_vertices[instance->part[GLTF_POSITION]];
    for (size_t c = 0; c < count; c++)
        normals[c] = (uint32_t)(first_normals[part] + (corners[c] - first));
}

ffd_status ffd_gltf_corner_normals(const mesh_document *document, const mesh_faces *faces, uint32_t *normals,
                                   ffd_error *error)
{
    const gltf_document *d = ffd_gltf_of(document);
    size_t *first_normals = ffd_alloc(d->base.part_count, sizeof *first_normals), *first_vertices = NULL;
    ffd_status status =
        first_normals ? ffd_parts_number(document, &first_vertices, error) : ffd_fail_memory(error);
    size_t number = 0, corner = 0;
    for (size_t i = 0; i < d->base.part_count && status == FFD_OK; i++) {
        first_normals[i] = number;
        number += d->mesh_parts[i].normal_count;
    }
    for (size_t m = 0; m < d->model.mesh_count && status == FFD_OK; m++)
        for (size_t p = 0; p < d->model.meshes[m].primitive_count; p++) {
            const size_t count = 3 * count_drawing(d, &d->model.meshes[m].primitives[p]).triangles;
            const gltf_mesh_uses *uses = &d->mesh_uses[m];
            const gltf_instance *instances = ffd_gltf_instances(d, m, p);
            for (size_t n = 0; n < uses->node_count && count > 0; n++, corner += count)
                number_corners(&instances[n], first_vertices, first_normals, faces->corners + corner, count,
                               normals + corner);
        }
    ffd_free(first_normals);
    ffd_free(first_vertices);
    return status;
}
