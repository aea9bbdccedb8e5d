#include "view/page_data.h"
#include "base/little_endian.h"
#include <math.h>
#include <string.h>

#define POSITION_STEPS 65535
#define MOVE_STEPS 32767

static const double *before_of(const page_mesh *mesh, size_t vertex)
{
    return mesh->scene->before + 3 * (size_t)mesh->vertices[vertex];
}

static const double *after_of(const page_mesh *mesh, size_t vertex)
{
    const view_scene *const scene = mesh->scene;
    return (scene->after ? scene->after : scene->before) + 3 * (size_t)mesh->vertices[vertex];
}

static size_t index_size(const page_mesh *mesh)
{
    const uint64_t *const indices = mesh->scene->indices;
    bool is_plain = true, is_short = true;
    for (size_t v = 0; v < mesh->vertex_count; v++) {
        const uint64_t index = indices ? indices[mesh->vertices[v]] : mesh->vertices[v];
        is_plain = is_plain && index == v;
        is_short = is_short && index <= UINT32_MAX;
    }
    return is_plain ? 0 : is_short ? 4 : 8;
}

void ffd_page_data_measure(const page_mesh *mesh, page_data *data)
{
    double high[3] = {0}, most = 0;
    *data = (page_data){.mesh = mesh, .index_size = index_size(mesh)};
    for (size_t v = 0; v < mesh->vertex_count; v++)
        for (int a = 0; a < 3; a++) {
            const double x = before_of(mesh, v)[a], y = after_of(mesh, v)[a];
            data->low[a] = v == 0 ? minimum_number(x, y) : minimum_number(data->low[a], minimum_number(x, y));
            high[a] = v == 0 ? maximum_number(x, y) : maximum_number(high[a], maximum_number(x, y));
            most = maximum_number(most, fabs(y - x));
        }
    for (int a = 0; a < 3; a++)
        data->step[a] = (high[a] - data->low[a]) / POSITION_STEPS;
    data->move_step = most / MOVE_STEPS;
}

/* Returns the nearest step, at most `most` in absolute value; 0 where the step is 0 (a flat box, or an extent
   so small that the step underflows). */
static double quantize(double x, double step, double most)
{
    const double q = step > 0 ? nearest_integer(x / step) : 0;
    return q > most ? most : q < -most ? -most : q;
}

static void fill_before(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const page_data *const data = of;
    for (size_t v = first; v < first + count; v++)
        for (int a = 0; a < 3; a++, bytes += 2)
            store_u16(bytes, (uint16_t)quantize(before_of(data->mesh, v)[a] - data->low[a], data->step[a],
                                                POSITION_STEPS));
}

static void fill_moves(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const page_data *const data = of;
    for (size_t v = first; v < first + count; v++)
        for (int a = 0; a < 3; a++, bytes += 2) {
            const double move = after_of(data->mesh, v)[a] - before_of(data->mesh, v)[a];
            store_u16(bytes, (uint16_t)(int16_t)quantize(move, data->move_step, MOVE_STEPS));
        }
}

static void fill_statuses(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const page_mesh *const mesh = ((const page_data *)of)->mesh;
    for (size_t v = 0; v < count; v++)
        bytes[v] = mesh->scene->statuses[mesh->vertices[first + v]];
}

/* Clamps to the range of a float. */
static float to_float(double x)
{
    const double most = 3.4e38;
    return (float)(x > most ? most : x < -most ? -most : x);
}

static void fill_dets(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const page_mesh *const mesh = ((const page_data *)of)->mesh;
    for (size_t v = 0; v < count; v++)
        store_float(bytes + 4 * v, to_float(mesh->scene->dets[mesh->vertices[first + v]]));
}

static void fill_colors(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const page_mesh *const mesh = ((const page_data *)of)->mesh;
    for (size_t v = first; v < first + count; v++)
        for (size_t c = 0; c < 4; c++) {
            const double x = mesh->scene->colors[4 * (size_t)mesh->vertices[v] + c];
            *bytes++ = (unsigned char)(x > 0 ? (x < 1 ? 255 * x + 0.5 : 255) : 0);
        }
}

static void fill_indices(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const page_data *const data = of;
    const uint64_t *const indices = data->mesh->scene->indices;
    for (size_t v = 0; v < count; v++) {
        const uint32_t vertex = data->mesh->vertices[first + v];
        const uint64_t index = indices ? indices[vertex] : vertex;
        if (data->index_size == 4)
            store_u32(bytes + 4 * v, (uint32_t)index);
        else
            store_double(bytes + 8 * v, (double)index);
    }
}

static void store_indices(const uint32_t *indices, size_t count, unsigned char *bytes)
{
    for (size_t i = 0; i < count; i++)
        store_u32(bytes + 4 * i, indices[i]);
}

static void fill_triangles(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    store_indices(((const page_data *)of)->mesh->triangles + 3 * first, 3 * count, bytes);
}

static void fill_flipped(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    memcpy(bytes, ((const page_data *)of)->mesh->flipped + first, count);
}

static void fill_segments(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    store_indices(((const page_data *)of)->mesh->segments + 2 * first, 2 * count, bytes);
}

static void fill_points(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    store_indices(((const page_data *)of)->mesh->points + first, count, bytes);
}

void ffd_page_data_write(const page_data *data, page_writer *w)
{
    const page_mesh *const mesh = data->mesh;
    const view_scene *const scene = mesh->scene;
    if (!scene->edit) { /* else in doubles (page_edit.h) */
        ffd_page_write_block(w, "data-before", mesh->vertex_count, 6, fill_before, data);
        ffd_page_write_block(w, "data-move", mesh->vertex_count, 6, fill_moves, data);
    }
    if (scene->statuses)
        ffd_page_write_block(w, "data-status", mesh->vertex_count, 1, fill_statuses, data);
    if (scene->dets)
        ffd_page_write_block(w, "data-det", mesh->vertex_count, 4, fill_dets, data);
    if (scene->colors)
        ffd_page_write_block(w, "data-color", mesh->vertex_count, 4, fill_colors, data);
    if (data->index_size)
        ffd_page_write_block(w, "data-number", mesh->vertex_count, data->index_size, fill_indices, data);
    if (!mesh->texcoords) /* else they are those of the wedges (page_texcoords.h) */
        ffd_page_write_block(w, "data-triangle", mesh->triangle_count, 12, fill_triangles, data);
    if (mesh->flipped)
        ffd_page_write_block(w, "data-flipped", mesh->triangle_count, 1, fill_flipped, data);
    ffd_page_write_block(w, "data-segment", mesh->segment_count, 8, fill_segments, data);
    ffd_page_write_block(w, "data-point", mesh->point_count, 4, fill_points, data);
}

/* Bytes of a control point. */
#define CAGE_POINT 48

static void fill_cage(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const view_cage *const cage = of;
    for (size_t p = first; p < first + count; p++, bytes += CAGE_POINT)
        for (size_t a = 0; a < 3; a++) {
            store_double(bytes + 8 * a, cage->rest[3 * p + a]);
            store_double(bytes + 24 + 8 * a, cage->deformed[3 * p + a]);
        }
}

void ffd_page_data_write_cage(const view_cage *cage, const char *id, page_writer *w)
{
    ffd_page_write_block(w, id, cage->size[0] * cage->size[1] * cage->size[2], CAGE_POINT, fill_cage, cage);
}
