#include "picture/layers.h"
#include "picture/linear.h"
#include <stdbool.h>
#include <string.h>

static uint32_t alpha_of(uint64_t color)
{
    return linear_part(color, 3);
}

static uint64_t pack(const uint32_t parts[3], uint32_t alpha)
{
    return linear_pack(parts[0], parts[1], parts[2]) | (uint64_t)alpha << 48;
}

/* Returns the part of light that goes through both: (1 - a) (1 - b). */
static uint32_t both_clear(uint32_t a, uint32_t b)
{
    return (uint32_t)((uint64_t)(LINEAR_ONE - a) * (LINEAR_ONE - b) / LINEAR_ONE);
}

/* Makes one fragment of two. Where only one of them covers a sample, the other one is weaker by that. */
static layer join(const layer *near, const layer *far)
{
    layer one = {near->depth, near->samples | far->samples, 0};
    uint32_t parts[3], covered[2] = {0, 0}, all = 0;
    for (int i = 0; i < SAMPLES; i++) {
        covered[0] += near->samples >> i & 1;
        covered[1] += far->samples >> i & 1;
        all += one.samples >> i & 1;
    }
    const uint32_t a = alpha_of(near->color) * covered[0] / all, b = alpha_of(far->color) * covered[1] / all;
    const uint32_t alpha = LINEAR_ONE - both_clear(a, b);
    const uint64_t behind = (uint64_t)b * (LINEAR_ONE - a) / LINEAR_ONE;
    for (int c = 0; c < 3; c++) {
        const uint64_t light =
            (uint64_t)linear_part(near->color, c) * a + linear_part(far->color, c) * behind;
        const uint64_t part = a + behind > 0 ? light / (a + behind) : 0;
        parts[c] = (uint32_t)(part < LINEAR_ONE ? part : LINEAR_ONE);
    }
    one.color = pack(parts, alpha);
    return one;
}

void ffd_layers_clear(layers *of, size_t pixels)
{
    memset(of->counts, 0, pixels);
}

/* Whether two fragments are parts of one surface, which an edge between its triangles divides. */
static bool are_parts(const layer *a, const layer *b)
{
    return a->color == b->color && !(a->samples & b->samples);
}

void ffd_layers_add(layers *of, size_t pixel, const layer *fragment)
{
    layer *const list = of->list + LAYERS_MOST * pixel;
    layer added = *fragment, last = added;
    size_t count = of->counts[pixel], at = count;
    while (at > 0 && fragment->depth < list[at - 1].depth)
        at--;
    if (at > 0 && are_parts(&list[at - 1], fragment)) {
        list[at - 1].samples |= fragment->samples;
        return;
    }
    if (count == LAYERS_MOST) {
        last = list[--count];
        /* Sort the two farthest of all, then make one of them. */
        if (!(added.depth < last.depth)) {
            const layer farther = added;
            added = last;
            last = farther;
        }
    }
    for (at = count; at > 0 && added.depth < list[at - 1].depth; at--)
        list[at] = list[at - 1];
    list[at] = added;
    count++;
    if (of->counts[pixel] == LAYERS_MOST)
        list[LAYERS_MOST - 1] = join(&list[LAYERS_MOST - 1], &last);
    of->counts[pixel] = (uint8_t)count;
}

static uint64_t over(uint64_t under, uint64_t color)
{
    const uint64_t alpha = alpha_of(color);
    uint32_t parts[3];
    for (int c = 0; c < 3; c++)
        parts[c] = (uint32_t)((linear_part(color, c) * alpha + linear_part(under, c) * (LINEAR_ONE - alpha) +
                               LINEAR_ONE / 2) /
                              LINEAR_ONE);
    return linear_pack(parts[0], parts[1], parts[2]);
}

void ffd_layers_blend(const layers *of, size_t pixel, uint64_t *colors)
{
    const layer *const list = of->list + LAYERS_MOST * pixel;
    for (size_t n = of->counts[pixel]; n > 0; n--)
        for (int i = 0; i < SAMPLES; i++)
            if (list[n - 1].samples >> i & 1)
                colors[i] = over(colors[i], list[n - 1].color);
}
