#include "picture/points.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/vector/vec.h"
#include <math.h>

#define TILE 4096
/* Discs are moved towards the eye by this many pixels, so that points on a surface are visible. */
#define NEARER 1.5
/* Splats end at this many standard deviations. */
#define SPLAT_END 3.0
/* Variance that is added in pixels, so that the smallest splats are seen (3DGS has 0.3 too). */
#define SPLAT_LEAST 0.3
/* Weights below this are not drawn. */
#define LEAST_WEIGHT (1.0 / 255)

static const int32_t sample_x[SAMPLES] = SAMPLE_X, sample_y[SAMPLES] = SAMPLE_Y;

typedef struct place_work {
    placed_points *points;
    projection by;
} place_work;

/* Returns the covariance of a splat between two directions of the picture. */
static double spread(const float *of, const double a[3], const double b[3])
{
    return a[0] * (of[0] * b[0] + of[1] * b[1] + of[2] * b[2]) +
           a[1] * (of[1] * b[0] + of[3] * b[1] + of[4] * b[2]) +
           a[2] * (of[2] * b[0] + of[4] * b[1] + of[5] * b[2]);
}

/* Projects the ellipsoid to an ellipse (Zwicker et al. 2001, EWA splatting; the projection is parallel, so
   that it is exact). One that is not finite stays a disc. */
static void place_splat(const projection *by, const float *covariance, placed_point *to)
{
    const double square = by->scale * by->scale;
    const double across = square * spread(covariance, by->camera.right, by->camera.right) + SPLAT_LEAST,
                 down = square * spread(covariance, by->camera.up, by->camera.up) + SPLAT_LEAST,
                 mixed = -square * spread(covariance, by->camera.right, by->camera.up);
    const double determinant = across * down - mixed * mixed;
    if (!(across > 0 && down > 0 && determinant > 0 && across < 1e18 && down < 1e18))
        return;
    to->a = (float)(down / determinant);
    to->b = (float)(-mixed / determinant);
    to->c = (float)(across / determinant);
    to->reach_x = SPLAT_END * sqrt(across);
    to->reach_y = SPLAT_END * sqrt(down);
    to->is_splat = true;
}

static void place_points(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    const place_work *const work = context;
    const picture_points *const of = work->points->of;
    (void)tile;
    (void)worker;
    for (size_t i = begin; i < end; i++) {
        placed_point *const to = &work->points->list[i];
        const size_t vertex = of->points[i];
        *to = (placed_point){.reach_x = of->radius, .reach_y = of->radius};
        projection_apply(&work->by, of->positions + 3 * vertex, to->at);
        if (of->covariances)
            place_splat(&work->by, of->covariances + 6 * vertex, to);
        else
            to->at[2] -= NEARER;
    }
}

ffd_status ffd_points_make(const picture_points *of, const projection *by, int threads, placed_points *result,
                           ffd_error *error)
{
    *result = (placed_points){.of = of, .list = ffd_alloc(of->count, sizeof *result->list)};
    if (!result->list)
        return ffd_fail_memory(error);
    place_work work = {result, *by};
    ffd_parallel_tiles(of->count, TILE, threads, place_points, &work);
    return FFD_OK;
}

void ffd_points_free(placed_points *of)
{
    ffd_free(of->list);
    *of = (placed_points){.of = NULL};
}

bool ffd_points_rows(const void *placed, size_t point, int64_t *first, int64_t *last)
{
    const placed_point *const p = &((const placed_points *)placed)->list[point];
    const double low = p->at[1] - p->reach_y, high = p->at[1] + p->reach_y;
    if (!(vec_is_finite(p->at) && low > -1e9 && high < 1e9 && fabs(p->at[0]) < 1e9))
        return false;
    *first = integer_below(low);
    *last = integer_below(high);
    return true;
}

/* Returns about exp(-x / 2), by multiplications only: (1 - x / 64)^32. */
static double falloff(double x)
{
    double y = x < 64 ? 1 - x / 64 : 0;
    for (int i = 0; i < 5; i++)
        y *= y;
    return y;
}

/* The pixels [left, right] and [top, bottom] of a point that are in the target. */
typedef struct box {
    int64_t left, right, top, bottom;
} box;

static box box_of(const placed_point *p, const samples *into)
{
    const double x = p->at[0], y = p->at[1];
    const double left = floor_of(x - p->reach_x), right = floor_of(x + p->reach_x),
                 top = floor_of(y - p->reach_y), bottom = floor_of(y + p->reach_y);
    const double ends[2] = {into->left + into->width - 1.0, into->top + into->rows - 1.0};
    return (box){(int64_t)larger_of(left, into->left), (int64_t)lesser_of(right, ends[0]),
                 (int64_t)larger_of(top, into->top), (int64_t)lesser_of(bottom, ends[1])};
}

static size_t index_of(const samples *into, int64_t px, int64_t py)
{
    return (size_t)(py - into->top) * (size_t)into->width + (size_t)(px - into->left);
}

static void draw_disc(const placed_point *p, double radius, uint64_t color, box in, samples *into)
{
    const float depth = (float)p->at[2];
    for (int64_t py = in.top; py <= in.bottom; py++)
        for (int64_t px = in.left; px <= in.right; px++)
            for (int i = 0; i < SAMPLES; i++) {
                const size_t at = SAMPLES * index_of(into, px, py) + (size_t)i;
                const double x = (double)px + sample_x[i] * (1.0 / SUBPIXELS) - p->at[0],
                             y = (double)py + sample_y[i] * (1.0 / SUBPIXELS) - p->at[1];
                if (x * x + y * y > radius * radius || !(depth < into->depth[at]))
                    continue;
                into->depth[at] = depth;
                into->color[at] = color;
            }
}

/* Returns the samples of a pixel in front of which the depth is. */
static uint32_t samples_behind(const samples *into, size_t pixel, float depth)
{
    uint32_t found = 0;
    for (size_t i = 0; i < SAMPLES; i++)
        found |= depth < into->depth[SAMPLES * pixel + i] ? 1u << i : 0;
    return found;
}

static void draw_splat(const placed_point *p, double opacity, uint64_t color, box in, samples *into)
{
    layer fragment = {.depth = (float)p->at[2]};
    for (int64_t py = in.top; py <= in.bottom; py++)
        for (int64_t px = in.left; px <= in.right; px++) {
            const double x = (double)px + 0.5 - p->at[0], y = (double)py + 0.5 - p->at[1];
            const double square = p->a * x * x + 2.0 * p->b * x * y + p->c * y * y;
            const double weight = square < SPLAT_END * SPLAT_END ? opacity * falloff(square) : 0;
            const size_t pixel = index_of(into, px, py);
            if (weight < LEAST_WEIGHT || !(fragment.samples = samples_behind(into, pixel, fragment.depth)))
                continue;
            fragment.color = color | (uint64_t)linear_from(weight) << 48;
            ffd_layers_add(into->layers, pixel, &fragment);
        }
}

void ffd_points_draw(const placed_points *of, const linear_tables *tables, size_t point, samples *into)
{
    const placed_point *const p = &of->list[point];
    const picture_points *const from = of->of;
    const uint8_t *const own = from->colors ? from->colors + 4 * (size_t)from->points[point] : NULL;
    const uint8_t *const bytes = own ? own : from->color;
    const uint64_t color =
        linear_pack(tables->light[bytes[0]], tables->light[bytes[1]], tables->light[bytes[2]]);
    const double opacity = own ? own[3] / 255.0 : 1;
    const box in = box_of(p, into);
    if (!from->covariances || !p->is_splat)
        draw_disc(p, from->radius, color, in, into);
    else if (into->layers)
        draw_splat(p, opacity, color, in, into);
    else if (opacity >= 0.5)
        draw_disc(p, from->radius, color, in, into);
}
