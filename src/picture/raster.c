#include "picture/raster.h"
#include "base/inline.h"
#include <math.h>
#include <string.h>

/* The four samples of a pixel in a SIMD vector. */
typedef int32_t numbers __attribute__((vector_size(16)));
typedef float depths __attribute__((vector_size(16)));

/* If the sides of a triangle's bounds are less than this, in subpixels, its edge functions fit in 32 bits. */
#define SMALL (1 << 14)
/* If they are less than this, four pixels, the triangle has a single colour. */
#define FLAT (4 * SUBPIXELS)
/* How many preceding triangles are compared to find duplicates. */
#define MOST_BEFORE 4

static const int32_t sample_x[SAMPLES] = SAMPLE_X, sample_y[SAMPLES] = SAMPLE_Y;

typedef struct edge {
    int32_t x, y;   /* start */
    int32_t dx, dy; /* vector to the end */
    int32_t bias;   /* -1: samples exactly on the edge belong to the neighbour */
} edge;

typedef struct setup {
    raster_corner corners[3]; /* clockwise as seen */
    int order[3];             /* index of each corner in the triangle */
    edge edges[3];            /* edge i is opposite to corner i */
    int64_t area;             /* twice the area of the triangle */
    double inverse;           /* 1 / area */
    double z_across, z_down;  /* change of depth for a subpixel to the right and down */
    depths z_steps, nearest, farthest;
    int64_t left, right, top, bottom; /* pixels */
    bool is_small, is_flat, has_depths;
} setup;

static int64_t least(int64_t a, int64_t b)
{
    return a < b ? a : b;
}

static int64_t most(int64_t a, int64_t b)
{
    return a > b ? a : b;
}

static int64_t cross(int32_t ax, int32_t ay, int32_t bx, int32_t by)
{
    return (int64_t)ax * by - (int64_t)ay * bx;
}

static bool is_sliver(const uint32_t *t)
{
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/* Returns by how many corners the second triangle is rotated against the first, with the same winding; 3 if
   they are different triangles. */
static size_t turn_between(const uint32_t *t, const uint32_t *other)
{
    size_t turn = 0;
    while (turn < 3 &&
           !(t[0] == other[turn] && t[1] == other[(turn + 1) % 3] && t[2] == other[(turn + 2) % 3]))
        turn++;
    return turn;
}

/* Returns whether both triangles have the same alpha-tested holes in their texture. */
static bool has_same_holes(const surface *of, size_t triangle, size_t other, size_t turn)
{
    const float *const uv = of->mesh->texcoords + 6 * triangle, *const there =
                                                                    of->mesh->texcoords + 6 * other;
    for (size_t k = 0; k < 3; k++)
        if (memcmp(uv + 2 * k, there + 2 * ((turn + k) % 3), 2 * sizeof *uv) != 0)
            return false;
    return true;
}

/* Returns whether the triangle repeats one of the preceding triangles, starting at any corner; then none of
   its samples is nearer. Without this, files that repeat a face many thousand times would take minutes, as
   would a polygon that goes round three corners that often, whose triangles start at each corner in turn. */
static bool repeats(const surface *of, size_t triangle)
{
    const picture_material *const material = ffd_shade_material(of->mesh, triangle);
    const bool has_holes = (material->alpha_cutoff > 0 || material->is_see_through) && of->mesh->texcoords;
    for (size_t back = 1; back <= MOST_BEFORE && back <= triangle; back++) {
        const size_t other = triangle - back,
                     turn = turn_between(of->triangles + 3 * triangle, of->triangles + 3 * other);
        if (turn < 3 && ffd_shade_material(of->mesh, other) == material &&
            (!has_holes || has_same_holes(of, triangle, other, turn)))
            return true;
    }
    return false;
}

bool ffd_raster_rows(const void *surface_pointer, size_t triangle, int64_t *first, int64_t *last)
{
    const surface *const of = surface_pointer;
    const uint32_t *const t = of->triangles + 3 * triangle;
    if (t[0] >= of->vertex_count || t[1] >= of->vertex_count || t[2] >= of->vertex_count)
        return false;
    if (is_sliver(t) || repeats(of, triangle))
        return false;
    const surface_vertex *const a = &of->vertices[t[0]], *const b = &of->vertices[t[1]],
                                *const c = &of->vertices[t[2]];
    if (a->x == VERTEX_NOWHERE || b->x == VERTEX_NOWHERE || c->x == VERTEX_NOWHERE)
        return false;
    if (a->x == VERTEX_FAR || b->x == VERTEX_FAR || c->x == VERTEX_FAR) {
        *first = -GUARD;
        *last = GUARD;
        return true;
    }
    int64_t left, right;
    samples_between(least(least(a->x, b->x), c->x), most(most(a->x, b->x), c->x), &left, &right);
    samples_between(least(least(a->y, b->y), c->y), most(most(a->y, b->y), c->y), first, last);
    return left <= right && *first <= *last;
}

static edge edge_between(const raster_corner *from, const raster_corner *to)
{
    const int32_t dx = to->x - from->x, dy = to->y - from->y;
    /* The top-left rule: a left edge rises, with the triangle to its right; a top edge goes to the right,
       with the triangle below. */
    const bool is_own = dy < 0 || (dy == 0 && dx > 0);
    return (edge){from->x, from->y, dx, dy, is_own ? 0 : -1};
}

/* Computed at the first pixel with a sample in the triangle, because many small triangles have none. */
static void set_depths(setup *s)
{
    s->has_depths = true;
    s->inverse = 1.0 / (double)s->area;
    const raster_corner *const a = &s->corners[0], *const b = &s->corners[1], *const c = &s->corners[2];
    const double bz = (double)b->z - a->z, cz = (double)c->z - a->z;
    s->z_across = (bz * ((double)c->y - a->y) - cz * ((double)b->y - a->y)) * s->inverse;
    s->z_down = (cz * ((double)b->x - a->x) - bz * ((double)c->x - a->x)) * s->inverse;
    float low = a->z, high = a->z;
    low = b->z < low ? b->z : low;
    low = c->z < low ? c->z : low;
    high = b->z > high ? b->z : high;
    high = c->z > high ? c->z : high;
    s->z_steps = (float)s->z_across * (depths)SAMPLE_X + (float)s->z_down * (depths)SAMPLE_Y;
    s->nearest = low - (depths){0};
    s->farthest = high - (depths){0};
}

/* Returns false if no sample can be in the triangle. *side: 0, or 1 if it is seen from behind. */
static bool set_up(const raster_corner corners[3], const samples *into, setup *s, int *side)
{
    int64_t area = cross(corners[1].x - corners[0].x, corners[1].y - corners[0].y,
                         corners[2].x - corners[0].x, corners[2].y - corners[0].y);
    if (area == 0)
        return false;
    /* y points down, so counter-clockwise corners have a negative area. */
    *side = area > 0;
    for (int k = 0; k < 3; k++) {
        s->order[k] = area > 0 ? k : 2 - k;
        s->corners[k] = corners[s->order[k]];
    }
    area = area > 0 ? area : -area;
    s->area = area;
    const raster_corner *const a = &s->corners[0], *const b = &s->corners[1], *const c = &s->corners[2];
    const int64_t low_x = least(least(a->x, b->x), c->x), high_x = most(most(a->x, b->x), c->x),
                  low_y = least(least(a->y, b->y), c->y), high_y = most(most(a->y, b->y), c->y);
    samples_between(low_x, high_x, &s->left, &s->right);
    samples_between(low_y, high_y, &s->top, &s->bottom);
    s->left = most(s->left, into->left);
    s->right = least(s->right, into->left + into->width - 1);
    s->top = most(s->top, into->top);
    s->bottom = least(s->bottom, into->top + into->rows - 1);
    if (s->left > s->right || s->top > s->bottom)
        return false;
    const int64_t size = most(high_x - low_x, high_y - low_y);
    s->is_small = size < SMALL;
    s->is_flat = size < FLAT;
    s->edges[0] = edge_between(b, c);
    s->edges[1] = edge_between(c, a);
    s->edges[2] = edge_between(a, b);
    s->has_depths = false;
    return true;
}

/* Returns a mask (-1) of the samples in the triangle, for the pixel with its corner at (x, y). */
static numbers inside_by_64(const setup *s, int64_t x, int64_t y)
{
    numbers inside = {-1, -1, -1, -1};
    for (int k = 0; k < 3; k++) {
        const edge *const e = &s->edges[k];
        for (int i = 0; i < SAMPLES; i++) {
            const int64_t at = e->dx * (y + sample_y[i] - e->y) - e->dy * (x + sample_x[i] - e->x) + e->bias;
            inside[i] &= at < 0 ? 0 : -1;
        }
    }
    return inside;
}

/* The same for small triangles: the edge functions at the samples of a pixel, and their increments. */
typedef struct walk {
    numbers at[3];
    int32_t across[3], down[3];
} walk;

static ALWAYS_INLINE walk walk_from(const setup *s, int64_t x, int64_t y)
{
    static const numbers sx = SAMPLE_X, sy = SAMPLE_Y;
    walk w;
    for (int k = 0; k < 3; k++) {
        const edge *const e = &s->edges[k];
        w.at[k] = e->dx * ((int32_t)(y - e->y) + sy) - e->dy * ((int32_t)(x - e->x) + sx) + e->bias;
        w.across[k] = -e->dy * SUBPIXELS;
        w.down[k] = e->dx * SUBPIXELS;
    }
    return w;
}

static ALWAYS_INLINE bool any(numbers which)
{
    uint64_t halves[2];
    memcpy(halves, &which, sizeof halves);
    return halves[0] | halves[1];
}

/* Computes the barycentric weights at the mean position of the samples that are drawn. */
static void weigh(const setup *s, int64_t x, int64_t y, numbers drawn, double weights[3])
{
    double px = 0, py = 0, count = 0;
    for (int i = 0; i < SAMPLES; i++)
        if (drawn[i]) {
            px += sample_x[i];
            py += sample_y[i];
            count += 1;
        }
    px = (double)x + px / count;
    py = (double)y + py / count;
    double sum = 0;
    for (int k = 1; k < 3; k++) {
        const edge *const e = &s->edges[k];
        const double weight = (e->dx * (py - e->y) - e->dy * (px - e->x)) * s->inverse;
        weights[s->order[k]] = weight;
        sum += weight;
    }
    weights[s->order[0]] = 1 - sum;
}

typedef struct brush {
    shade shade;
    bool is_layer;           /* of a see-through material */
    bool is_striped;         /* the colour depends on the pixel */
    bool is_begun, is_drawn; /* the colour is known, if the triangle has a single one */
    uint64_t color;
} brush;

static bool pick_color(brush *b, const setup *s, int64_t x, int64_t y, numbers drawn)
{
    double weights[3];
    if (b->is_begun && s->is_flat && !b->is_striped)
        return b->is_drawn;
    if (!b->is_begun)
        ffd_shade_begin(&b->shade);
    b->is_begun = true;
    b->shade.px = x / SUBPIXELS;
    b->shade.py = y / SUBPIXELS;
    if (s->is_flat)
        return b->is_drawn = ffd_shade_middle(&b->shade, &b->color);
    weigh(s, x, y, drawn, weights);
    return ffd_shade_color(&b->shade, weights, &b->color);
}

/* Adds a fragment of a see-through triangle, at the depth of its middle. */
static void add_layer(const brush *b, const numbers drawn, depths at, size_t pixel, const samples *into)
{
    layer fragment = {0, 0, b->color};
    float sum = 0, count = 0;
    for (int i = 0; i < SAMPLES; i++)
        if (drawn[i]) {
            fragment.samples |= 1u << i;
            sum += at[i];
            count += 1;
        }
    fragment.depth = sum / count;
    if (linear_part(b->color, 3) > 0)
        ffd_layers_add(into->layers, pixel, &fragment);
}

/* Draws the samples of a pixel that are in the triangle and nearer than the stored depth. */
static ALWAYS_INLINE void draw_pixel(setup *s, brush *b, int64_t px, int64_t py, numbers inside,
                                     samples *into)
{
    const int64_t x = px * SUBPIXELS, y = py * SUBPIXELS;
    const size_t first =
        SAMPLES * ((size_t)(py - into->top) * (size_t)into->width + (size_t)(px - into->left));
    const raster_corner *const a = &s->corners[0];
    if (!s->has_depths)
        set_depths(s);
    const float z = (float)(a->z + s->z_across * (double)(x - a->x) + s->z_down * (double)(y - a->y));
    depths there, at = z + s->z_steps;
    memcpy(&there, into->depth + first, sizeof there);
    /* Clamped to the depths of the corners, because the plane of a sliver is steep. */
    const numbers low = at<s->nearest, high = at> s->farthest;
    at = (depths)(((numbers)s->nearest & low) | ((numbers)s->farthest & high) | ((numbers)at & ~low & ~high));
    const numbers drawn = inside & (at < there);
    if (!any(drawn) || !pick_color(b, s, x, y, drawn))
        return;
    if (b->is_layer) {
        add_layer(b, drawn, at, first / SAMPLES, into);
        return;
    }
    at = (depths)(((numbers)at & drawn) | ((numbers)there & ~drawn));
    memcpy(into->depth + first, &at, sizeof at);
    /* Without branches, which would be unpredictable. */
    uint64_t *const colors = into->color + first;
    const uint64_t opaque = b->color & LINEAR_LIGHT;
    for (int i = 0; i < SAMPLES; i++) {
        const uint64_t which = (uint64_t)(int64_t)drawn[i];
        colors[i] = (colors[i] & ~which) | (opaque & which);
    }
}

static void draw_small(setup *s, brush *b, samples *into)
{
    walk w = walk_from(s, s->left * SUBPIXELS, s->top * SUBPIXELS);
    for (int64_t py = s->top; py <= s->bottom; py++) {
        numbers first = w.at[0], second = w.at[1], third = w.at[2];
        for (int64_t px = s->left; px <= s->right; px++) {
            const numbers inside = (first | second | third) >= 0;
            if (any(inside))
                draw_pixel(s, b, px, py, inside, into);
            first += w.across[0];
            second += w.across[1];
            third += w.across[2];
        }
        for (int k = 0; k < 3; k++)
            w.at[k] += w.down[k];
    }
}

/* The pixels [left, right] of some rows of a triangle. */
typedef struct block {
    int64_t left, right;
} block;

/* Returns whether all samples of the block are outside of an edge. */
static bool is_outside(const setup *s, block of)
{
    const int64_t left = of.left * SUBPIXELS + SAMPLE_MARGIN,
                  right = (of.right + 1) * SUBPIXELS - SAMPLE_MARGIN,
                  top = s->top * SUBPIXELS + SAMPLE_MARGIN,
                  bottom = (s->bottom + 1) * SUBPIXELS - SAMPLE_MARGIN;
    for (int k = 0; k < 3; k++) {
        const edge *const e = &s->edges[k];
        const int64_t y = e->dx > 0 ? bottom : top, x = e->dy > 0 ? left : right;
        if (e->dx * (y - e->y) - e->dy * (x - e->x) + e->bias < 0)
            return true;
    }
    return false;
}

/* Returns a lower bound of the depth of the triangle in the block: the depth of its plane, reduced by more
   than the rounding of a float. */
static float nearest_in(const setup *s, block of)
{
    const raster_corner *const a = &s->corners[0];
    const double left = (double)(of.left * SUBPIXELS - a->x),
                 right = (double)((of.right + 1) * SUBPIXELS - a->x),
                 top = (double)(s->top * SUBPIXELS - a->y),
                 bottom = (double)((s->bottom + 1) * SUBPIXELS - a->y);
    const double across = s->z_across * (s->z_across > 0 ? left : right),
                 down = s->z_down * (s->z_down > 0 ? top : bottom);
    const double reach =
        fabs(s->z_across) * (fabs(left) + fabs(right)) + fabs(s->z_down) * (fabs(top) + fabs(bottom));
    const float least = (float)(a->z + across + down - 1e-6 * (fabs((double)a->z) + reach));
    return least < s->nearest[0] ? s->nearest[0] : least < s->farthest[0] ? least : s->farthest[0];
}

static float farthest_of(const samples *in, size_t index)
{
    const size_t first = index * BLOCK, width = (size_t)in->width, left = width - first;
    const size_t count = SAMPLES * (left < BLOCK ? left : BLOCK);
    float farthest = 0;
    for (size_t row = 0; row < (size_t)in->rows; row++) {
        const float *const depth = in->depth + SAMPLES * (row * width + first);
        for (size_t i = 0; i < count; i++)
            farthest = i + row == 0 || depth[i] > farthest ? depth[i] : farthest;
    }
    return farthest;
}

static void draw_block(setup *s, brush *b, block of, samples *into)
{
    for (int64_t py = s->top; py <= s->bottom; py++)
        for (int64_t px = of.left; px <= of.right; px++) {
            const numbers inside = inside_by_64(s, px * SUBPIXELS, py * SUBPIXELS);
            if (any(inside))
                draw_pixel(s, b, px, py, inside, into);
        }
}

/* Draws by blocks: most are completely outside of the triangle, or completely hidden. */
static void draw_large(setup *s, brush *b, samples *into)
{
    set_depths(s);
    const size_t last = (size_t)(s->right - into->left) / BLOCK;
    for (size_t i = (size_t)(s->left - into->left) / BLOCK; i <= last; i++) {
        const int64_t first = into->left + (int64_t)i * BLOCK;
        const block of = {most(first, s->left), least(first + BLOCK - 1, s->right)};
        if (is_outside(s, of) || (into->blocks && nearest_in(s, of) >= into->blocks[i]))
            continue;
        draw_block(s, b, of, into);
        if (into->blocks && !b->is_layer)
            into->blocks[i] = farthest_of(into, i);
    }
}

void ffd_raster_corners(const surface *of, const linear_tables *tables, size_t triangle,
                        const raster_corner corners[3], bool is_flat, samples *into)
{
    setup s;
    int side;
    if (!set_up(corners, into, &s, &side))
        return;
    const picture_material *const material = ffd_shade_material(of->mesh, triangle);
    if (side && !material->is_double_sided)
        return;
    s.is_flat |= is_flat;
    brush b = {.shade = {.surface = of, .tables = tables, .triangle = triangle, .side = side},
               .is_layer = material->is_see_through && into->layers,
               .is_striped = material->stripes != STRIPES_NONE};
    if (s.is_small)
        draw_small(&s, &b, into);
    else
        draw_large(&s, &b, into);
}
