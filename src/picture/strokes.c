#include "picture/strokes.h"
#include "base/vector/vec.h"
#include "picture/linear.h"
#include "picture/stripes.h"

/* Strokes are moved towards the eye by this many pixels, so that lines on a surface are visible. */
#define NEARER 1.5

/* Returns the position of the point of the segment that is nearest to (x, y), as a fraction of its length. */
static double share_at(const double from[3], const double step[3], double square, double x, double y)
{
    const double share = square > 0 ? ((x - from[0]) * step[0] + (y - from[1]) * step[1]) / square : 0;
    return share < 0 ? 0 : share > 1 ? 1 : share;
}

static uint64_t mix(uint64_t under, uint64_t over, double share)
{
    uint32_t parts[3];
    for (int c = 0; c < 3; c++) {
        const double a = linear_part(under, c), b = linear_part(over, c);
        parts[c] = (uint32_t)(a + share * (b - a) + 0.5);
    }
    return linear_pack(parts[0], parts[1], parts[2]);
}

/* Returns the fraction of the samples of a pixel that are behind this depth. */
static double seen_share(const stroke_target *into, size_t pixel, double depth)
{
    int seen = 0;
    for (size_t i = 0; into->depths && i < SAMPLES; i++)
        seen += depth - NEARER <= into->depths->depth[SAMPLES * pixel + i];
    return into->depths ? seen / (double)SAMPLES : 1;
}

static uint64_t color_at(const stroke *with, double share, int32_t px, int32_t py)
{
    if (ffd_stripes_second(with->stripes, with->period, px, py))
        return with->second;
    return with->color == with->end ? with->color : mix(with->color, with->end, share);
}

static void draw_at(const stroke_target *into, const stroke *with, const double from[3], const double step[3],
                    double square, int32_t px, int32_t py)
{
    const double x = px + 0.5, y = py + 0.5, share = share_at(from, step, square, x, y);
    const double away_x = x - from[0] - share * step[0], away_y = y - from[1] - share * step[1];
    const double covered = with->half_width + 0.5 - sqrt(away_x * away_x + away_y * away_y);
    if (!(covered > 0))
        return;
    const size_t pixel = (size_t)(py - into->top) * (size_t)into->width + (size_t)(px - into->left);
    const double seen = seen_share(into, pixel, from[2] + share * step[2]);
    const double strength = (covered < 1 ? covered : 1) * lesser_of(1, 2 * with->half_width);
    into->pixels[pixel] = mix(into->pixels[pixel], color_at(with, share, px, py),
                              strength * (seen + (1 - seen) * with->hidden));
}

/* Finds the integers from low to high that are in [begin, end). */
static void clamp(double low, double high, int32_t begin, int32_t end, int32_t *first, int32_t *last)
{
    *first = low > begin ? (low < end ? (int32_t)floor_of(low) : end) : begin;
    *last = high < end ? (high >= begin ? (int32_t)floor_of(high) : begin - 1) : end - 1;
}

/* Draws a row of pixels: the columns near the intersection of the line with the row. */
static void draw_row(const stroke_target *into, const stroke *with, const double from[3],
                     const double step[3], double square, int32_t py)
{
    const double reach = with->half_width + 0.5, low_y = py + 0.5 - reach, high_y = py + 0.5 + reach;
    double ends[2] = {0, 1};
    if (fabs(step[1]) > 1e-9) {
        const double a = (low_y - from[1]) / step[1], b = (high_y - from[1]) / step[1];
        ends[0] = larger_of(lesser_of(a, b), 0);
        ends[1] = lesser_of(larger_of(a, b), 1);
        if (ends[0] > 1 || ends[1] < 0)
            return;
    }
    const double a = from[0] + ends[0] * step[0], b = from[0] + ends[1] * step[0];
    int32_t first, last;
    clamp(lesser_of(a, b) - reach - 1, larger_of(a, b) + reach + 1, into->left, into->left + into->width,
          &first, &last);
    for (int32_t px = first; px <= last; px++)
        draw_at(into, with, from, step, square, px, py);
}

void ffd_stroke_draw(const stroke_target *into, const stroke *with, const double from[3], const double to[3])
{
    double step[3];
    for (int a = 0; a < 3; a++) {
        /* Strokes that far away are skipped, because their rounding would need special care. */
        if (!(fabs(from[a]) < 1e9 && fabs(to[a]) < 1e9))
            return;
        step[a] = to[a] - from[a];
    }
    const double square = step[0] * step[0] + step[1] * step[1], reach = with->half_width + 1.5;
    int32_t first, last;
    clamp(lesser_of(from[1], to[1]) - reach, larger_of(from[1], to[1]) + reach, into->top,
          into->top + into->rows, &first, &last);
    for (int32_t py = first; py <= last; py++)
        draw_row(into, with, from, step, square, py);
}
