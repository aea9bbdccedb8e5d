#include "view/page_mesh.h"
#include "base/memory/memory.h"
#include <inttypes.h>
#include <math.h>
#include <string.h>

/* Larger coordinates are treated as not finite, so that the sides of a box do not overflow. */
#define FARTHEST 1e300

static bool is_shown(const double *position)
{
    return fabs(position[0]) <= FARTHEST && fabs(position[1]) <= FARTHEST && fabs(position[2]) <= FARTHEST;
}

/* Whether all indices are less than vertices. */
static bool are_vertices(const uint32_t *indices, size_t count, size_t vertices)
{
    for (size_t i = 0; i < count; i++)
        if (indices[i] >= vertices)
            return false;
    return true;
}

static ffd_status check(const view_scene *scene, ffd_error *error)
{
    const size_t vertices = scene->vertex_count;
    if (vertices >= VIEW_NONE || scene->triangle_count > UINT32_MAX / 3)
        return ffd_fail(error, FFD_E_LIMIT, "a page of %zu vertices and %zu triangles is not possible",
                        vertices, scene->triangle_count);
    bool holds = are_vertices(scene->triangles, 3 * scene->triangle_count, vertices) &&
                 are_vertices(scene->segments, 2 * scene->segment_count, vertices) &&
                 are_vertices(scene->points, scene->point_count, vertices);
    for (size_t i = 0; i < scene->tear_count && holds; i++)
        holds = are_vertices(scene->tears[i].vertices, 2, vertices);
    for (size_t i = 0; i < scene->part_count && holds; i++)
        holds = scene->parts[i].first_triangle <= scene->triangle_count &&
                scene->parts[i].triangle_count <= scene->triangle_count - scene->parts[i].first_triangle;
    return holds ? FFD_OK : ffd_fail(error, FFD_E_ARGUMENT, "an index of the scene is out of range");
}

/* Sets places to 0 for the vertices that are finite before and after, to VIEW_NONE for the others. */
static void find_finite(page_mesh *mesh)
{
    const view_scene *const scene = mesh->scene;
    const double *const after = scene->after ? scene->after : scene->before;
    for (size_t v = 0; v < scene->vertex_count; v++) {
        const bool finite = is_shown(scene->before + 3 * v) && is_shown(after + 3 * v);
        mesh->places[v] = finite ? 0 : VIEW_NONE;
        mesh->not_finite += !finite;
    }
}

static bool can_be_drawn(const page_mesh *mesh, const uint32_t *indices, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (mesh->places[indices[i]] == VIEW_NONE)
            return false;
    return true;
}

/* Copies the elements whose vertices can all be drawn. corners: vertices of an element. Returns their
   number. */
static size_t take_elements(const page_mesh *mesh, const uint32_t *from, size_t count, size_t corners,
                            uint32_t *to)
{
    size_t taken = 0;
    for (size_t i = 0; i < count; i++)
        if (can_be_drawn(mesh, from + corners * i, corners))
            memcpy(to + corners * taken++, from + corners * i, corners * sizeof *to);
    return taken;
}

/* Whether the triangles of a part have a texture. */
static bool is_textured(const view_scene *scene, const view_part *part)
{
    const mesh_materials *const materials = &scene->materials;
    if (!scene->texcoords || part->material >= materials->count)
        return false;
    const mesh_material *const m = &materials->list[part->material];
    return m->base.image < materials->image_count || m->glow.image < materials->image_count ||
           m->opacity.image < materials->image_count;
}

static bool has_textures(const view_scene *scene)
{
    size_t i = 0;
    while (i < scene->part_count && !is_textured(scene, &scene->parts[i]))
        i++;
    return i < scene->part_count;
}

static void take_texcoords(const view_scene *scene, size_t triangle, float *to)
{
    for (size_t corner = 3 * triangle; corner < 3 * triangle + 3; corner++) {
        memcpy(to, scene->texcoords + 2 * corner, 2 * sizeof *to);
        if (scene->glow_texcoords)
            memcpy(to + 2, scene->glow_texcoords + 2 * corner, 2 * sizeof *to);
        to += scene->glow_texcoords ? 4 : 2;
    }
}

static void take_part(page_mesh *mesh, size_t first, size_t count, bool has_texture, page_part *part)
{
    const view_scene *const scene = mesh->scene;
    size_t drawn = first; /* the triangle before it is drawn if this is its number */
    part->first_triangle = mesh->triangle_count;
    for (size_t t = first; t < first + count; t++) {
        const uint32_t *const corners = scene->triangles + 3 * t;
        if (!can_be_drawn(mesh, corners, 3)) {
            mesh->triangles_lost++;
            continue;
        }
        if (mesh->flipped)
            mesh->flipped[mesh->triangle_count] = scene->flipped[t] != 0;
        if (mesh->continues)
            mesh->continues[mesh->triangle_count] = scene->continues[t] && t > first && drawn == t;
        drawn = t + 1;
        if (has_texture)
            take_texcoords(scene, t, mesh->texcoords + 3 * mesh->texcoord_width * mesh->triangle_count);
        memcpy(mesh->triangles + 3 * mesh->triangle_count++, corners, 3 * sizeof *corners);
    }
    part->triangle_count = mesh->triangle_count - part->first_triangle;
}

/* A mesh that has vertices and nothing else is shown as points. */
static void take_lone_points(page_mesh *mesh)
{
    for (size_t v = 0; v < mesh->scene->vertex_count; v++)
        if (mesh->places[v] != VIEW_NONE)
            mesh->points[mesh->point_count++] = (uint32_t)v;
}

static bool allocate(page_mesh *mesh, size_t triangles, size_t points)
{
    const view_scene *const scene = mesh->scene;
    mesh->triangles = ffd_alloc(triangles, 3 * sizeof *mesh->triangles);
    mesh->flipped = scene->flipped ? ffd_alloc(triangles, 1) : NULL;
    mesh->continues = scene->continues ? ffd_alloc(triangles, 1) : NULL;
    mesh->texcoord_width = !has_textures(scene) ? 0 : scene->glow_texcoords ? 4 : 2;
    const size_t texcoords = 3 * mesh->texcoord_width;
    mesh->texcoords = texcoords ? ffd_alloc_sparse(triangles, texcoords * sizeof *mesh->texcoords) : NULL;
    mesh->parts = ffd_alloc_zero(mesh->part_count, sizeof *mesh->parts);
    mesh->segments = ffd_alloc(scene->segment_count, 2 * sizeof *mesh->segments);
    mesh->points = ffd_alloc(points, sizeof *mesh->points);
    mesh->places = ffd_alloc(scene->vertex_count, sizeof *mesh->places);
    return mesh->triangles && (mesh->flipped || !scene->flipped) && (mesh->continues || !scene->continues) &&
           (mesh->texcoords || !texcoords) && mesh->parts && mesh->segments && mesh->points && mesh->places;
}

/* Counts the triangles of all parts, which may overlap. Returns SIZE_MAX on overflow. */
static size_t count_triangles(const view_scene *scene)
{
    size_t count = scene->part_count ? 0 : scene->triangle_count;
    for (size_t i = 0; i < scene->part_count; i++)
        if (!ffd_add_size(count, scene->parts[i].triangle_count, &count))
            return SIZE_MAX;
    return count;
}

ffd_status ffd_page_mesh_take(const view_scene *scene, page_mesh *mesh, ffd_error *error)
{
    *mesh = (page_mesh){.scene = scene, .part_count = scene->part_count ? scene->part_count : 1};
    TRY(check(scene, error));
    const size_t triangles = count_triangles(scene);
    if (triangles > UINT32_MAX / 3)
        return ffd_fail(error, FFD_E_LIMIT, "a page of %zu triangles is not possible", triangles);
    const bool is_cloud = triangles == 0 && scene->segment_count == 0 && scene->point_count == 0;
    if (!allocate(mesh, triangles, is_cloud ? scene->vertex_count : scene->point_count))
        return ffd_fail_memory(error);
    find_finite(mesh);
    for (size_t i = 0; i < scene->part_count; i++)
        take_part(mesh, scene->parts[i].first_triangle, scene->parts[i].triangle_count,
                  is_textured(scene, &scene->parts[i]), &mesh->parts[i]);
    if (scene->part_count == 0)
        take_part(mesh, 0, scene->triangle_count, false, &mesh->parts[0]);
    mesh->segment_count = take_elements(mesh, scene->segments, scene->segment_count, 2, mesh->segments);
    mesh->point_count = take_elements(mesh, scene->points, scene->point_count, 1, mesh->points);
    if (is_cloud)
        take_lone_points(mesh);
    return FFD_OK;
}

static void mark(page_mesh *mesh, const uint32_t *indices, size_t count)
{
    for (size_t i = 0; i < count; i++)
        mesh->places[indices[i]] = 0;
}

size_t ffd_page_mesh_mark(page_mesh *mesh)
{
    size_t count = 0;
    for (size_t v = 0; v < mesh->scene->vertex_count; v++)
        mesh->places[v] = VIEW_NONE;
    mark(mesh, mesh->triangles, 3 * mesh->triangle_count);
    mark(mesh, mesh->segments, 2 * mesh->segment_count);
    mark(mesh, mesh->points, mesh->point_count);
    for (size_t v = 0; v < mesh->scene->vertex_count; v++)
        if (mesh->places[v] != VIEW_NONE)
            mesh->places[v] = (uint32_t)count++;
    return count;
}

static void set_indices(const page_mesh *mesh, uint32_t *indices, size_t count)
{
    for (size_t i = 0; i < count; i++)
        indices[i] = mesh->places[indices[i]];
}

ffd_status ffd_page_mesh_index(page_mesh *mesh, ffd_error *error)
{
    mesh->vertex_count = ffd_page_mesh_mark(mesh);
    mesh->vertices = ffd_alloc(mesh->vertex_count, sizeof *mesh->vertices);
    if (!mesh->vertices)
        return ffd_fail_memory(error);
    for (size_t v = 0; v < mesh->scene->vertex_count; v++)
        if (mesh->places[v] != VIEW_NONE)
            mesh->vertices[mesh->places[v]] = (uint32_t)v;
    set_indices(mesh, mesh->triangles, 3 * mesh->triangle_count);
    set_indices(mesh, mesh->segments, 2 * mesh->segment_count);
    set_indices(mesh, mesh->points, mesh->point_count);
    return FFD_OK;
}

size_t ffd_page_corner_lists(size_t corners)
{
    size_t lists = 1;
    while (lists < corners / 2)
        lists *= 2;
    return lists;
}

size_t ffd_page_corner_list(uint32_t vertex, const float *texcoords, size_t width, size_t lists)
{
    uint64_t hash = vertex;
    for (size_t a = 0; a < width; a++) {
        uint32_t bits;
        memcpy(&bits, &texcoords[a], sizeof bits);
        hash = (hash ^ (hash >> 32) ^ bits) * 0x9e3779b97f4a7c15u; /* 2^64 by the golden ratio */
    }
    return (size_t)(hash >> 32) & (lists - 1);
}

void ffd_page_mesh_free(page_mesh *mesh)
{
    void *const blocks[] = {mesh->triangles, mesh->flipped, mesh->continues, mesh->texcoords, mesh->parts,
                            mesh->segments,  mesh->points,  mesh->vertices,  mesh->places};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        ffd_free(blocks[i]);
    *mesh = (page_mesh){0};
}
