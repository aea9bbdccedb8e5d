#include "view/page_texcoords.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include <math.h>
#include <string.h>

#define STEPS 65535
/* Coordinates beyond are drawn at 0: a picture of a texture that is repeated so often is noise. */
#define FARTHEST 1e6

/* Nearly all vertices have few wedges. */
#define NEAR_WEDGES 8

/* Lists of wedges, which end in VIEW_NONE: of each vertex up to NEAR_WEDGES, and by hash the others, which
   most meshes have none of. */
typedef struct wedge_table {
    uint32_t *first, *next;
    size_t far_lists;
    uint32_t *far; /* first wedge + 1; 0: none. Pages that are not used take no memory */
} wedge_table;

static float fit(float x)
{
    return fabsf(x) <= (float)FARTHEST ? x : 0;
}

static bool is_wedge(const page_texcoords *t, uint32_t at, uint32_t vertex, const float *uv)
{
    return t->vertices[at] == vertex && memcmp(t->values + t->width * at, uv, t->width * sizeof *uv) == 0;
}

static uint32_t add(page_texcoords *t, uint32_t vertex, const float *uv)
{
    const uint32_t at = (uint32_t)t->count++;
    memcpy(t->values + t->width * at, uv, t->width * sizeof *uv);
    t->vertices[at] = vertex;
    return at;
}

static uint32_t find_far(page_texcoords *t, wedge_table *table, uint32_t vertex, const float *uv)
{
    uint32_t *const first = &table->far[ffd_page_corner_list(vertex, uv, t->width, table->far_lists)];
    for (uint32_t at = *first - 1; at != VIEW_NONE; at = table->next[at])
        if (is_wedge(t, at, vertex, uv))
            return at;
    const uint32_t made = add(t, vertex, uv);
    table->next[made] = *first - 1;
    *first = made + 1;
    return made;
}

/* Returns the wedge of a vertex with these coordinates, which is added if it is new. */
static uint32_t find(page_texcoords *t, wedge_table *table, uint32_t vertex, const float *uv)
{
    int seen = 0;
    for (uint32_t at = table->first[vertex]; at != VIEW_NONE; at = table->next[at], seen++)
        if (is_wedge(t, at, vertex, uv))
            return at;
    if (seen == NEAR_WEDGES)
        return find_far(t, table, vertex, uv);
    const uint32_t made = add(t, vertex, uv);
    table->next[made] = table->first[vertex];
    return table->first[vertex] = made;
}

static void collect(const page_mesh *mesh, wedge_table *table, page_texcoords *t)
{
    for (size_t v = 0; v < mesh->vertex_count; v++)
        table->first[v] = VIEW_NONE;
    for (size_t i = 0; i < t->corner_count; i++) {
        float uv[4];
        for (size_t a = 0; a < t->width; a++)
            uv[a] = fit(mesh->texcoords[t->width * i + a]);
        t->corners[i] = find(t, table, mesh->triangles[i], uv);
    }
}

static void measure(page_texcoords *t)
{
    double high[4] = {0};
    for (size_t i = 0; i < t->count; i++)
        for (size_t a = 0; a < t->width; a++) {
            const double x = t->values[t->width * i + a];
            t->low[a] = i == 0 ? x : lesser_of(t->low[a], x);
            high[a] = i == 0 ? x : larger_of(high[a], x);
        }
    for (size_t a = 0; a < t->width; a++)
        t->step[a] = (high[a] - t->low[a]) / STEPS;
}

ffd_status ffd_page_texcoords_make(const page_mesh *mesh, page_texcoords *t, ffd_error *error)
{
    *t = (page_texcoords){0};
    if (!mesh->texcoords)
        return FFD_OK;
    t->width = mesh->texcoord_width;
    t->corner_count = 3 * mesh->triangle_count;
    t->corners = ffd_alloc_whole(t->corner_count, sizeof *t->corners);
    t->vertices = ffd_alloc(t->corner_count, sizeof *t->vertices);
    t->values = ffd_alloc(t->corner_count, t->width * sizeof *t->values);
    wedge_table table = {.far_lists = ffd_page_corner_lists(t->corner_count)};
    table.first = ffd_alloc(mesh->vertex_count, sizeof *table.first);
    table.next = ffd_alloc(t->corner_count, sizeof *table.next);
    table.far = ffd_alloc_sparse(table.far_lists, sizeof *table.far);
    const bool made = t->corners && t->vertices && t->values && table.first && table.next && table.far;
    if (made) {
        collect(mesh, &table, t);
        measure(t);
    }
    ffd_free(table.first);
    ffd_free(table.next);
    ffd_free(table.far);
    return made ? FFD_OK : ffd_fail_memory(error);
}

static void fill_corners(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const page_texcoords *const t = of;
    for (size_t i = 0; i < 3 * count; i++)
        store_u32(bytes + 4 * i, t->corners[3 * first + i]);
}

static void fill_vertices(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const page_texcoords *const t = of;
    for (size_t i = 0; i < count; i++)
        store_u32(bytes + 4 * i, t->vertices[first + i]);
}

static void fill_values(const void *of, size_t first, size_t count, unsigned char *bytes)
{
    const page_texcoords *const t = of;
    for (size_t i = first; i < first + count; i++)
        for (size_t a = 0; a < t->width; a++, bytes += 2) {
            const double q =
                t->step[a] > 0 ? nearest_integer((t->values[t->width * i + a] - t->low[a]) / t->step[a]) : 0;
            store_u16(bytes, (uint16_t)(q > STEPS ? STEPS : q));
        }
}

void ffd_page_texcoords_write(const page_texcoords *t, page_writer *w)
{
    if (!t->corners)
        return;
    ffd_page_write_block(w, "data-wedge", t->count, 4, fill_vertices, t);
    ffd_page_write_block(w, "data-texcoord", t->count, 2 * t->width, fill_values, t);
    ffd_page_write_block(w, "data-corner", t->corner_count / 3, 12, fill_corners, t);
}

void ffd_page_texcoords_describe(const page_texcoords *t, json_text *json)
{
    if (!t->corners)
        return;
    ffd_json_count(json, "wedges", t->count);
    ffd_json_vector(json, "texcoordLow", t->low, t->width);
    ffd_json_vector(json, "texcoordStep", t->step, t->width);
}

void ffd_page_texcoords_free(page_texcoords *t)
{
    ffd_free(t->corners);
    ffd_free(t->vertices);
    ffd_free(t->values);
    *t = (page_texcoords){0};
}
