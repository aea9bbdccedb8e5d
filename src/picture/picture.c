#include "picture/picture.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "mesh/bounds.h"
#include "picture/panel.h"

/* What a thread needs: the samples of a band of the widest panel, and the pixels of a band. */
typedef struct scratch {
    float *depth, *blocks;
    uint64_t *color, *pixels;
} scratch;

typedef struct drawing {
    const picture *of;
    layout layout;
    linear_tables tables;
    ffd_bounds seen;
    panel *panels;
    size_t panels_made;
    scratch *scratch;
    band_means means;
    uint8_t *pixels;
} drawing;

/* Bytes that are taken for each vertex, triangle and point of a cage: places, light and lists. */
#define VERTEX_BYTES 48
#define TRIANGLE_BYTES 40
#define POINT_BYTES 64

static ffd_status check_size(const picture *of, const memory_budget *budget, ffd_error *error)
{
    const uint64_t pixels = (uint64_t)of->width * of->height;
    if (of->width == 0 || of->height == 0 || of->width > PICTURE_MOST_SIDE ||
        of->height > PICTURE_MOST_SIDE || pixels > PICTURE_MOST_PIXELS || of->panel_count == 0 ||
        of->panel_count > of->width)
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "a picture of %lu x %lu pixels; it has 1 to %d a side, and %llu at most",
                        (unsigned long)of->width, (unsigned long)of->height, PICTURE_MOST_SIDE,
                        (unsigned long long)PICTURE_MOST_PIXELS);
    uint64_t bytes = 3 * pixels;
    for (size_t p = 0; p < of->panel_count; p++) {
        for (size_t m = 0; m < of->panels[p].mesh_count; m++) {
            const picture_mesh *const mesh = &of->panels[p].meshes[m];
            if (mesh->triangle_count >= UINT32_MAX || mesh->vertex_count >= UINT32_MAX)
                return ffd_fail(error, FFD_E_LIMIT, "the mesh has more than %lu triangles or vertices",
                                (unsigned long)UINT32_MAX);
            bytes +=
                VERTEX_BYTES * (uint64_t)mesh->vertex_count + TRIANGLE_BYTES * (uint64_t)mesh->triangle_count;
        }
        for (size_t c = 0; c < of->panels[p].cage_count; c++)
            bytes += POINT_BYTES *
                     ((uint64_t)of->panels[p].cages[c].point_count + of->panels[p].cages[c].segment_count);
    }
    return budget ? ffd_budget_check(budget, bytes, 1, error) : FFD_OK;
}

/* What is seen, along the camera's axes. */
static ffd_bounds find_bounds(const picture *of)
{
    ffd_bounds seen = ffd_bounds_empty();
    if (of->bounds) {
        for (int corner = 0; corner < 8; corner++) {
            const double point[3] = {corner & 1 ? of->bounds->max[0] : of->bounds->min[0],
                                     corner & 2 ? of->bounds->max[1] : of->bounds->min[1],
                                     corner & 4 ? of->bounds->max[2] : of->bounds->min[2]};
            ffd_camera_widen(&of->camera, point, 1, &seen);
        }
        return seen;
    }
    for (size_t p = 0; p < of->panel_count; p++) {
        for (size_t m = 0; m < of->panels[p].mesh_count; m++)
            ffd_camera_widen(&of->camera, of->panels[p].meshes[m].positions,
                             of->panels[p].meshes[m].vertex_count, &seen);
        for (size_t c = 0; c < of->panels[p].cage_count; c++)
            ffd_camera_widen(&of->camera, of->panels[p].cages[c].points, of->panels[p].cages[c].point_count,
                             &seen);
    }
    return seen;
}

static ffd_status make(drawing *d, ffd_error *error)
{
    const picture *const of = d->of;
    const size_t widest = of->width / of->panel_count + 1;
    d->panels = ffd_alloc_zero(of->panel_count, sizeof *d->panels);
    d->scratch = ffd_alloc_zero((size_t)d->means.threads, sizeof *d->scratch);
    d->pixels = ffd_alloc_whole((size_t)of->width * of->height, 3);
    if (!d->panels || !d->scratch || !d->pixels)
        return ffd_fail_memory(error);
    for (int t = 0; t < d->means.threads; t++) {
        scratch *const s = &d->scratch[t];
        s->depth = ffd_alloc(widest * BAND_ROWS * SAMPLES, sizeof *s->depth);
        s->blocks = ffd_alloc(widest / BLOCK + 1, sizeof *s->blocks);
        s->color = ffd_alloc(widest * BAND_ROWS * SAMPLES, sizeof *s->color);
        s->pixels = ffd_alloc((size_t)of->width * BAND_ROWS, sizeof *s->pixels);
        if (!s->depth || !s->blocks || !s->color || !s->pixels)
            return ffd_fail_memory(error);
    }
    ffd_status status = FFD_OK;
    for (size_t p = 0; !status && p < of->panel_count; p++) {
        status = ffd_panel_make(&d->layout, p, &d->seen, &d->means, &d->panels[p], error);
        d->panels_made += !status;
    }
    return status;
}

static void clear(const drawing *d, samples *into)
{
    for (int32_t i = 0; i <= into->width / BLOCK; i++)
        into->blocks[i] = SAMPLE_EMPTY;
    for (int32_t row = 0; row < into->rows; row++) {
        const uint64_t color = ffd_layout_background(&d->layout, &d->tables, into->top + row);
        const size_t count = SAMPLES * (size_t)into->width, first = count * (size_t)row;
        for (size_t i = first; i < first + count; i++)
            into->depth[i] = SAMPLE_EMPTY;
        for (size_t i = first; i < first + count; i++)
            into->color[i] = color;
    }
}

/* The mean of a pixel's samples; each channel's two lowest bits are below what a byte shows. */
static uint64_t mean(const uint64_t *color)
{
    const uint64_t bits = UINT64_C(0x3fff3fff3fff3fff);
    uint64_t sum = 0;
    for (int i = 0; i < SAMPLES; i++)
        sum += color[i] >> 2 & bits;
    return sum;
}

static void resolve(const samples *from, const stroke_target *into)
{
    for (int32_t row = 0; row < from->rows; row++) {
        const uint64_t *color = from->color + SAMPLES * (size_t)row * (size_t)from->width;
        uint64_t *to = into->pixels + (size_t)row * (size_t)into->width + (size_t)(from->left - into->left);
        for (int32_t x = 0; x < from->width; x++, color += SAMPLES)
            to[x] = mean(color);
    }
}

/* Cages are drawn into the panel's own columns. */
static void draw_panel(const drawing *d, const panel *of, size_t band, const scratch *s,
                       const stroke_target *into)
{
    samples at = {of->left, into->top, of->right - of->left, into->rows, s->depth, s->color, s->blocks};
    clear(d, &at);
    ffd_panel_draw_meshes(of, &d->tables, band, &at);
    /* The samples' own colours are not needed any more: the first of them become the panel's pixels. */
    const stroke_target own = {at.left, at.top, at.width, at.rows, s->color, &at};
    resolve(&at, &own);
    ffd_panel_draw_cages(of, &d->tables, band, &own);
    for (int32_t row = 0; row < at.rows; row++)
        for (int32_t x = 0; x < at.width; x++)
            into->pixels[(size_t)row * (size_t)into->width + (size_t)(at.left + x)] =
                own.pixels[(size_t)row * (size_t)at.width + (size_t)x];
}

static void draw_band(void *context, size_t band, size_t begin, size_t end, int worker)
{
    const drawing *const d = context;
    const scratch *const s = &d->scratch[worker];
    const stroke_target into = {0,   (int32_t)begin, (int32_t)d->of->width, (int32_t)(end - begin), s->pixels,
                                NULL};
    for (size_t p = 0; p < d->of->panel_count; p++)
        draw_panel(d, &d->panels[p], band, s, &into);
    ffd_layout_draw(&d->layout, &d->tables, &into);
    uint8_t *to = d->pixels + (size_t)3 * d->of->width * begin;
    const size_t count = (size_t)d->of->width * (end - begin);
    for (size_t i = 0; i < count; i++)
        for (int c = 0; c < 3; c++)
            *to++ = linear_to_byte(&d->tables, linear_part(s->pixels[i], c));
}

static void free_drawing(drawing *d)
{
    for (size_t p = 0; p < d->panels_made; p++)
        ffd_panel_free(&d->panels[p]);
    for (int t = 0; d->scratch && t < d->means.threads; t++) {
        ffd_free(d->scratch[t].depth);
        ffd_free(d->scratch[t].blocks);
        ffd_free(d->scratch[t].color);
        ffd_free(d->scratch[t].pixels);
    }
    ffd_free(d->panels);
    ffd_free(d->scratch);
}

/* As many as are asked for, and as the budget has scratch for. */
static int thread_count(const picture *of, const memory_budget *budget)
{
    const uint64_t pixel = SAMPLES * (sizeof(float) + sizeof(uint64_t)) + sizeof(uint64_t);
    const int threads = of->threads > 1 ? of->threads : 1;
    return budget ? ffd_budget_threads(budget, threads, (uint64_t)of->width * BAND_ROWS * pixel) : threads;
}

ffd_status ffd_picture_draw(const picture *of, const memory_budget *budget, uint8_t **pixels,
                            ffd_error *error)
{
    *pixels = NULL;
    ffd_status status = check_size(of, budget, error);
    if (status)
        return status;
    drawing d = {.of = of, .layout = ffd_layout_make(of), .means = {thread_count(of, budget), budget}};
    ffd_linear_fill(&d.tables);
    d.seen = find_bounds(of);
    status = make(&d, error);
    if (!status)
        ffd_parallel_tiles(of->height, BAND_ROWS, d.means.threads, draw_band, &d);
    free_drawing(&d);
    if (status)
        ffd_free(d.pixels);
    else
        *pixels = d.pixels;
    return status;
}
