#include "picture/picture.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "mesh/bounds.h"
#include "picture/panel.h"

/* Scratch memory of a thread: the samples of a band of the widest panel, whose colours are resolved to pixels
   in place. */
typedef struct scratch {
    float *depth, *blocks;
    uint64_t *color;
    layers layers; /* empty unless the picture sees through */
} scratch;

/* Panels are prepared and drawn one after the other, so that many panels need the memory of one. */
typedef struct drawing {
    const picture *of;
    memory_budget budget; /* what is left of the caller's */
    layout layout;
    linear_tables tables;
    ffd_bounds seen;
    panel drawn; /* the current panel */
    scratch *scratch;
    band_means means;
    uint8_t *pixels;
} drawing;

/* Estimated bytes for each vertex, triangle and point of a cage: positions, light and lists. */
#define VERTEX_BYTES 48
#define TRIANGLE_BYTES 40
#define POINT_BYTES 64
#define DOT_BYTES 80

/* Bytes of lists and points of cages in a panel, as far as they are not large. */
#define LIST_BYTES ((uint64_t)8 << 20)

uint64_t ffd_picture_bytes(uint64_t pixels, uint64_t vertices, uint64_t triangles)
{
    return 3 * pixels + VERTEX_BYTES * vertices + TRIANGLE_BYTES * triangles + LIST_BYTES;
}

static ffd_status check_size(const picture *of, memory_budget *budget, ffd_error *error)
{
    const uint64_t pixels = (uint64_t)of->width * of->height;
    if (of->width == 0 || of->height == 0 || of->width > PICTURE_MOST_SIDE ||
        of->height > PICTURE_MOST_SIDE || pixels > PICTURE_MOST_PIXELS || of->panel_count == 0 ||
        of->panel_count > of->width || of->rows > of->height || (of->rows && of->panel_count % of->rows))
        return ffd_fail(error, FFD_E_ARGUMENT,
                        "a picture of %lu x %lu pixels; it has 1 to %d a side, and %llu at most",
                        (unsigned long)of->width, (unsigned long)of->height, PICTURE_MOST_SIDE,
                        (unsigned long long)PICTURE_MOST_PIXELS);
    return budget ? ffd_budget_take(budget, pixels, 3, error) : FFD_OK;
}

/* Takes the memory of a panel from the budget. */
static ffd_status check_panel(const picture_panel *filled, memory_budget *budget, ffd_error *error)
{
    uint64_t bytes = 0;
    for (size_t m = 0; m < filled->mesh_count; m++) {
        const picture_mesh *const mesh = &filled->meshes[m];
        if (mesh->triangle_count >= UINT32_MAX || mesh->vertex_count >= UINT32_MAX)
            return ffd_fail(error, FFD_E_LIMIT, "the mesh has more than %lu triangles or vertices",
                            (unsigned long)UINT32_MAX);
        bytes +=
            VERTEX_BYTES * (uint64_t)mesh->vertex_count + TRIANGLE_BYTES * (uint64_t)mesh->triangle_count;
    }
    for (size_t c = 0; c < filled->cage_count; c++)
        bytes += POINT_BYTES * ((uint64_t)filled->cages[c].point_count + filled->cages[c].segment_count);
    for (size_t p = 0; p < filled->point_count; p++)
        bytes += DOT_BYTES * (uint64_t)filled->points[p].count;
    return budget ? ffd_budget_take(budget, bytes, 1, error) : FFD_OK;
}

/* Returns the bounds of the scene along the axes of the camera. */
static ffd_bounds find_bounds(const picture *of)
{
    ffd_bounds seen = ffd_bounds_empty();
    if (of->seen)
        return *of->seen;
    for (size_t p = 0; p < of->panel_count; p++) {
        for (size_t m = 0; m < of->panels[p].mesh_count; m++)
            ffd_camera_widen(&of->camera, of->panels[p].meshes[m].positions,
                             of->panels[p].meshes[m].vertex_count, &seen);
        for (size_t i = 0; i < of->panels[p].point_count; i++)
            ffd_camera_widen(&of->camera, of->panels[p].points[i].positions,
                             of->panels[p].points[i].vertex_count, &seen);
        for (size_t c = 0; c < of->panels[p].cage_count; c++)
            ffd_camera_widen(&of->camera, of->panels[p].cages[c].points, of->panels[p].cages[c].point_count,
                             &seen);
    }
    return seen;
}

/* Returns an upper bound of the width of a panel in pixels. */
static size_t widest_of(const picture *of)
{
    return of->width / (of->panel_count / (of->rows ? of->rows : 1)) + 1;
}

static bool make_layers(size_t pixels, layers *of)
{
    of->counts = ffd_alloc(pixels, sizeof *of->counts);
    of->list = ffd_alloc(pixels, LAYERS_MOST * sizeof *of->list);
    return of->counts && of->list;
}

static ffd_status make(drawing *d, ffd_error *error)
{
    const size_t widest = widest_of(d->of);
    d->scratch = ffd_alloc_zero((size_t)d->means.threads, sizeof *d->scratch);
    d->pixels = ffd_alloc_whole((size_t)d->of->width * d->of->height, 3);
    if (!d->scratch || !d->pixels)
        return ffd_fail_memory(error);
    for (int t = 0; t < d->means.threads; t++) {
        scratch *const s = &d->scratch[t];
        s->depth = ffd_alloc(widest * BAND_ROWS * SAMPLES, sizeof *s->depth);
        s->blocks = ffd_alloc(widest / BLOCK + 1, sizeof *s->blocks);
        s->color = ffd_alloc(widest * BAND_ROWS * SAMPLES, sizeof *s->color);
        if (!s->depth || !s->blocks || !s->color ||
            (d->of->sees_through && !make_layers(widest * BAND_ROWS, &s->layers)))
            return ffd_fail_memory(error);
    }
    return FFD_OK;
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
    if (into->layers)
        ffd_layers_clear(into->layers, (size_t)into->width * (size_t)into->rows);
}

/* Returns the mean of the samples of a pixel. The two lowest bits of each channel are dropped; they are below
   the resolution of a byte. */
static uint64_t mean(const uint64_t *color)
{
    const uint64_t bits = UINT64_C(0x3fff3fff3fff3fff);
    uint64_t sum = 0;
    for (int i = 0; i < SAMPLES; i++)
        sum += color[i] >> 2 & bits;
    return sum;
}

/* Resolves samples to pixels, in place, in the first samples' colours. */
static void resolve(const samples *from)
{
    const size_t count = (size_t)from->rows * (size_t)from->width;
    for (size_t pixel = 0; pixel < count && from->layers; pixel++)
        ffd_layers_blend(from->layers, pixel, from->color + SAMPLES * pixel);
    for (size_t pixel = 0; pixel < count; pixel++)
        from->color[pixel] = mean(from->color + SAMPLES * pixel);
}

static void put_bytes(const drawing *d, const stroke_target *from)
{
    for (int32_t row = 0; row < from->rows; row++) {
        const uint64_t *const pixels = from->pixels + (size_t)row * (size_t)from->width;
        uint8_t *to = d->pixels + 3 * ((size_t)d->of->width * (size_t)(from->top + row) + (size_t)from->left);
        for (int32_t x = 0; x < from->width; x++)
            for (int c = 0; c < 3; c++)
                *to++ = linear_to_byte(&d->tables, linear_part(pixels[x], c));
    }
}

/* Draws the part of a band that belongs to the panel. */
static void draw_band(void *context, size_t band, size_t begin, size_t end, int worker)
{
    const drawing *const d = context;
    const panel *const of = &d->drawn;
    scratch *const s = &d->scratch[worker];
    const int32_t top = (int32_t)begin > of->top ? (int32_t)begin : of->top,
                  bottom = (int32_t)end < of->bottom ? (int32_t)end : of->bottom;
    if (top >= bottom)
        return;
    samples at = {of->left,
                  top,
                  of->right - of->left,
                  bottom - top,
                  s->depth,
                  s->color,
                  s->blocks,
                  d->of->sees_through ? &s->layers : NULL};
    stroke_target into = {at.left, at.top, at.width, at.rows, s->color, &at};
    clear(d, &at);
    ffd_panel_draw_meshes(of, &d->tables, band, &at);
    resolve(&at);
    ffd_panel_draw_cages(of, &d->tables, band, &into);
    into.depths = NULL;
    ffd_layout_draw(&d->layout, &d->tables, &into);
    put_bytes(d, &into);
}

static ffd_status draw_panel(drawing *d, size_t index, ffd_error *error)
{
    const picture *const of = d->of;
    const memory_budget before = d->budget;
    TRY(of->fill ? of->fill(of->context, index, error) : FFD_OK);
    TRY(check_panel(&of->panels[index], d->means.budget, error));
    TRY(ffd_panel_make(&d->layout, index, &d->seen, &d->means, &d->drawn, error));
    ffd_parallel_tiles(of->height, BAND_ROWS, d->means.threads, draw_band, d);
    ffd_panel_free(&d->drawn);
    d->budget = before;
    return FFD_OK;
}

static void free_scratch(drawing *d)
{
    for (int t = 0; d->scratch && t < d->means.threads; t++) {
        ffd_free(d->scratch[t].depth);
        ffd_free(d->scratch[t].blocks);
        ffd_free(d->scratch[t].color);
        ffd_free(d->scratch[t].layers.counts);
        ffd_free(d->scratch[t].layers.list);
    }
    ffd_free(d->scratch);
}

/* Returns the number of threads: as many as requested, limited by the memory budget for scratch memory. */
static int thread_count(const picture *of, const memory_budget *budget)
{
    const uint64_t pixel = SAMPLES * (sizeof(float) + sizeof(uint64_t)) +
                           (of->sees_through ? 1 + LAYERS_MOST * sizeof(layer) : 0);
    const int threads = of->threads > 1 ? of->threads : 1;
    return budget ? ffd_budget_threads(budget, threads, widest_of(of) * BAND_ROWS * pixel) : threads;
}

ffd_status ffd_picture_draw(const picture *of, const memory_budget *budget, uint8_t **pixels,
                            ffd_error *error)
{
    drawing d = {.of = of};
    *pixels = NULL;
    if (budget) {
        d.budget = *budget;
        d.means.budget = &d.budget;
    }
    TRY(check_size(of, d.means.budget, error));
    d.layout = ffd_layout_make(of);
    d.means.threads = thread_count(of, d.means.budget);
    ffd_linear_fill(&d.tables);
    d.seen = find_bounds(of);
    ffd_status status;
    TRY_END(make(&d, error));
    for (size_t p = 0; p < of->panel_count; p++)
        TRY_END(draw_panel(&d, p, error));
end:
    free_scratch(&d);
    if (status)
        ffd_free(d.pixels);
    else
        *pixels = d.pixels;
    return status;
}
