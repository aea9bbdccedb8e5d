#include "view/page_texcoords.h"
#include "base/little_endian.h"
#include "base/memory/memory.h"
#include "base/vector/vec.h"
#include <math.h>
#include <string.h>

#define STEPS 65535
/* Coordinates beyond are drawn at 0: a picture of a texture that is repeated so often is noise. */
#define FARTHEST 1e6

/* Lists of wedges by hash, which end in VIEW_NONE. */
typedef struct wedge_table {
    size_t lists;
    uint32_t *first, *next;
} wedge_table;

static float fit(float x)
{
    return fabsf(x) <= (float)FARTHEST ? x : 0;
}

/* Returns the wedge of a vertex with these coordinates, which is added if it is new. */
static uint32_t find(page_texcoords *t, wedge_table *table, uint32_t vertex, const float *uv)
{
    uint32_t *const first = &table->first[ffd_page_corner_list(vertex, uv, t->width, table->lists)];
    uint32_t at = *first;
    while (at != VIEW_NONE &&
           (t->vertices[at] != vertex || memcmp(t->values + t->width * at, uv, t->width * sizeof *uv) != 0))
        at = table->next[at];
    if (at != VIEW_NONE)
        return at;
    at = (uint32_t)t->count++;
    memcpy(t->values + t->width * at, uv, t->width * sizeof *uv);
    t->vertices[at] = vertex;
    table->next[at] = *first;
    return *first = at;
}

static void collect(const page_mesh *mesh, wedge_table *table, page_texcoords *t)
{
    for (size_t i = 0; i < table->lists; i++)
        table->first[i] = VIEW_NONE;
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
    for (size_t i = 0; i < t->width * t->count; i++) {
        const size_t a = i % t->width;
        const double x = t->values[i];
        t->low[a] = i < t->width ? x : lesser_of(t->low[a], x);
        high[a] = i < t->width ? x : larger_of(high[a], x);
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
    t->corners = ffd_alloc(t->corner_count, sizeof *t->corners);
    t->vertices = ffd_alloc(t->corner_count, sizeof *t->vertices);
    t->values = ffd_alloc(t->corner_count, t->width * sizeof *t->values);
    wedge_table table = {.lists = ffd_page_corner_lists(t->corner_count)};
    table.first = ffd_alloc(table.lists, sizeof *table.first);
    table.next = ffd_alloc(t->corner_count, sizeof *table.next);
    const bool made = t->corners && t->vertices && t->values && table.first && table.next;
    if (made) {
        collect(mesh, &table, t);
        measure(t);
    }
    ffd_free(table.first);
    ffd_free(table.next);
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
