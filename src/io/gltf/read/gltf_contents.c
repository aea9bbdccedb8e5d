#include "io/gltf/read/gltf_contents.h"
#include "base/memory/memory.h"
#include "base/system/thread.h"
#include "base/text/content.h"
#include "base/vector/array_kernel.h"
#include "io/gltf/read/gltf_elements.h"
#include <math.h>

static void mark_view(const gltf_document *d, int view, bool *is_read)
{
    if (view >= 0 && (size_t)view < d->model.view_count)
        is_read[view] = true;
}

/* Whether a bufferView that is not read as numbers begins where its buffer does. */
static bool begins_with_other(const gltf_document *d, size_t buffer, const bool *is_read)
{
    for (size_t i = 0; i < d->model.view_count; i++) {
        const gltf_view *const view = &d->model.views[i];
        if (!is_read[i] && view->offset == 0 && view->buffer >= 0 && (size_t)view->buffer == buffer)
            return true;
    }
    return false;
}

ffd_status ffd_gltf_check_contents(const gltf_document *d, ffd_error *error)
{
    bool *is_read = ffd_alloc_zero(d->model.view_count, sizeof *is_read);
    if (!is_read)
        return ffd_fail_memory(error);
    for (size_t i = 0; i < d->model.accessor_count; i++) {
        const gltf_accessor *const accessor = &d->model.accessors[i];
        mark_view(d, accessor->view, is_read);
        mark_view(d, accessor->sparse.present ? accessor->sparse.indices_view : -1, is_read);
        mark_view(d, accessor->sparse.present ? accessor->sparse.values_view : -1, is_read);
    }
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < d->buffer_values.count; i++) {
        const gltf_buffer *const buffer = &d->buffers[i];
        const content_kind *const kind =
            buffer->data ? ffd_content_sure_kind(buffer->data, buffer->size) : NULL;
        /* Each buffer that names one file maps it anew, and would keep the pages that were looked at. */
        ffd_file_release_pages(&buffer->file, buffer->file.data, buffer->file.size);
        const uint32_t value = d->buffer_values.values[i], uri = ffd_json_tree_member(&d->tree, value, "uri");
        if (!kind || (!kind->is_stand_in && begins_with_other(d, i, is_read)))
            continue;
        if (buffer->path)
            TRY_END(ffd_json_tree_fail(&d->tree, uri, d->name, FFD_E_INVALID, error,
                                       "the buffer \"%s\" seems to be %s", buffer->path, kind->name));
        else
            TRY_END(ffd_json_tree_fail(&d->tree, uri == JSON_NONE ? value : uri, d->name, FFD_E_INVALID,
                                       error, "the buffer seems to be %s", kind->name));
    }
end:
    ffd_free(is_read);
    return status;
}

/* Positions read at a time. */
#define POSITIONS ((size_t)256)

/* The maximum number of tiles that threads share, and the minimum size of a tile in elements. */
#define TILES 64
#define SMALLEST_TILE ((size_t)1 << 14)

/* How often the largest number of min and max a position may be. */
#define LARGEST_RATIO 1e15

/* Positions that are looked at for text, and how few tell nothing. */
#define TEXT_SEEN ((size_t)64)
#define TEXT_LEAST ((size_t)3)

/* Of the finite positions. */
typedef struct range {
    double min[3], max[3];
    bool has_others; /* positions that are not finite */
} range;

static const range nothing = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}, false};

/* A search for the range of the elements of an accessor, tile by tile. */
typedef struct range_search {
    const gltf_document *document;
    size_t accessor;
    range found[TILES]; /* per tile */
} range_search;

static void widen(range *r, const double *xyz, size_t count)
{
    if (ffd_array_kernel(FFD_ISA_AUTO)->widen(xyz, count, r->min, r->max))
        return;
    for (size_t i = 0; i < 3 * count; i++)
        if (isfinite(xyz[i])) {
            r->min[i % 3] = minimum_number(r->min[i % 3], xyz[i]);
            r->max[i % 3] = maximum_number(r->max[i % 3], xyz[i]);
        } else {
            r->has_others = true;
        }
}

/* Widens the range by floats that lie one after the other. Returns false if they do not, or one is not
 * finite. */
static bool widen_packed(const gltf_document *d, size_t a, size_t first, size_t count, range *r)
{
    const gltf_accessor *const accessor = &d->model.accessors[a];
    const gltf_layout *const layout = &d->layouts[a];
    return layout->data && accessor->component == GLTF_FLOAT && !accessor->sparse.present &&
           layout->stride == 3 * sizeof(float) &&
           ffd_array_kernel(FFD_ISA_AUTO)
               ->widen_floats(layout->data + first * layout->stride, count, r->min, r->max);
}

static void search_tile(void *context, size_t tile, size_t begin, size_t end, int worker)
{
    range_search *const search = context;
    double xyz[3 * POSITIONS];
    (void)worker;
    search->found[tile] = nothing;
    if (widen_packed(search->document, search->accessor, begin, end - begin, &search->found[tile]))
        return;
    for (size_t first = begin; first < end; first += POSITIONS) {
        const size_t size = end - first < POSITIONS ? end - first : POSITIONS;
        ffd_gltf_read(search->document, search->accessor, first, size, 3, xyz);
        widen(&search->found[tile], xyz, size);
    }
}

static range range_of(const gltf_document *d, size_t a)
{
    const size_t count = (size_t)d->model.accessors[a].count, share = count / TILES + 1;
    range_search search = {.document = d, .accessor = a};
    range all = nothing;
    for (size_t t = 0; t < TILES; t++)
        search.found[t] = nothing;
    ffd_parallel_tiles(count, share > SMALLEST_TILE ? share : SMALLEST_TILE, d->threads, search_tile,
                       &search);
    for (size_t t = 0; t < TILES; t++) {
        all.has_others = all.has_others || search.found[t].has_others;
        for (size_t c = 0; c < 3; c++) {
            all.min[c] = minimum_number(all.min[c], search.found[t].min[c]);
            all.max[c] = maximum_number(all.max[c], search.found[t].max[c]);
        }
    }
    return all;
}

/* Reads min or max. Returns false if it is not three numbers. */
static bool read_stated(const gltf_document *d, uint32_t array, double numbers[3])
{
    size_t count = 0;
    for (uint32_t v = ffd_json_tree_first(&d->tree, array); v != JSON_NONE;
         v = ffd_json_tree_after(&d->tree, v), count++)
        if (count == 3 || !ffd_json_tree_number(&d->tree, v, &numbers[count]) || !isfinite(numbers[count]))
            return false;
    return count == 3;
}

bool ffd_gltf_stated(const gltf_document *d, size_t a, double min[3], double max[3])
{
    const uint32_t value = d->accessor_values.values[a];
    return read_stated(d, ffd_json_tree_member(&d->tree, value, "min"), min) &&
           read_stated(d, ffd_json_tree_member(&d->tree, value, "max"), max);
}

static double farthest(const range *r)
{
    double most = 0;
    for (size_t c = 0; c < 3; c++)
        most = maximum_number(most, maximum_number(-r->min[c], r->max[c]));
    return most;
}

static ffd_status compare(gltf_document *d, size_t a, const range *found, ffd_error *error)
{
    const uint32_t value = d->accessor_values.values[a];
    const uint32_t min = ffd_json_tree_member(&d->tree, value, "min");
    const uint32_t max = ffd_json_tree_member(&d->tree, value, "max");
    range stated;
    if (found->has_others && d->base.flaws.strict) /* else its vertices are counted as invalid */
        TRY(ffd_gltf_flaw(d, value, error, "positions are finite, but some of these are not"));
    if (!ffd_gltf_stated(d, a, stated.min, stated.max))
        return FFD_OK;
    double largest = 0;
    for (size_t c = 0; c < 3; c++)
        largest = maximum_number(largest, maximum_number(fabs(stated.min[c]), fabs(stated.max[c])));
    if (largest > 0 && farthest(found) > LARGEST_RATIO * largest)
        return ffd_json_tree_fail(&d->tree, value, d->name, FFD_E_INVALID, error,
                                  "a coordinate of %g is more than 1e15 times the largest number of min and "
                                  "max, %g: the buffer does not hold the bytes of this mesh",
                                  farthest(found) > found->max[0] && farthest(found) > found->max[1] &&
                                          farthest(found) > found->max[2]
                                      ? -farthest(found)
                                      : farthest(found),
                                  largest);
    for (size_t c = 0; c < 3; c++) {
        /* A reader compares in single precision (glTF 2.0, 3.6.2.5). */
        if (found->min[c] < (float)stated.min[c])
            return ffd_gltf_flaw(d, min, error, "a position has %c = %.9g, less than the min %.9g", "xyz"[c],
                                 found -> min[c], stated.min[c]);
        if (found->max[c] > (float)stated.max[c])
            return ffd_gltf_flaw(d, max, error, "a position has %c = %.9g, more than the max %.9g", "xyz"[c],
                                 found -> max[c], stated.max[c]);
        if (!d->base.flaws.strict || found->has_others)
            continue; /* bounds that are too wide mislead nobody */
        if (found->min[c] > (float)stated.min[c])
            return ffd_gltf_flaw(d, min, error, "no position has the min %c = %.9g: the least is %.9g",
                                 "xyz"[c], stated.min[c], found->min[c]);
        if (found->max[c] < (float)stated.max[c])
            return ffd_gltf_flaw(d, max, error, "no position has the max %c = %.9g: the largest is %.9g",
                                 "xyz"[c], stated.max[c], found->max[c]);
    }
    return FFD_OK;
}

/* Whether each byte of the first positions is a character of a text: about one float in twenty is such by
   chance. */
static bool is_text(const gltf_layout *layout, size_t count)
{
    for (size_t i = 0; i < count && i < TEXT_SEEN; i++)
        for (size_t b = 0; b < layout->element_size; b++) {
            const unsigned char byte = layout->data[i * layout->stride + b];
            if (byte >= 127 || (byte < ' ' && byte != '\t' && byte != '\n' && byte != '\r'))
                return false;
        }
    return count >= TEXT_LEAST;
}

/* Checks an accessor once, however many primitives share it. Decoded numbers are rounded by their
   compression, and integers cannot be far off. */
static ffd_status check(gltf_document *d, int a, bool *is_checked, ffd_error *error)
{
    if (a < 0 || is_checked[a] || !d->layouts[a].readable || !d->layouts[a].data ||
        d->layouts[a].packing != GLTF_PLAIN || d->model.accessors[a].component != GLTF_FLOAT)
        return FFD_OK;
    is_checked[a] = true;
    if (is_text(&d->layouts[a], (size_t)d->model.accessors[a].count))
        return ffd_json_tree_fail(&d->tree, d->accessor_values.values[a], d->name, FFD_E_INVALID, error,
                                  "text is where the floats of positions should be: the buffer does not hold "
                                  "the bytes of this mesh");
    const range found = range_of(d, (size_t)a);
    return compare(d, (size_t)a, &found, error);
}

ffd_status ffd_gltf_check_stated(gltf_document *d, ffd_error *error)
{
    bool *is_checked = ffd_alloc_zero(d->model.accessor_count, sizeof *is_checked);
    if (!is_checked)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < d->model.primitive_count; i++) {
        const gltf_primitive *const primitive = &d->model.primitives[i];
        TRY_END(check(d, primitive->accessor[GLTF_POSITION], is_checked, error));
        for (size_t t = 0; t < primitive->target_count; t++)
            TRY_END(
                check(d, primitive->target_accessors[GLTF_DEFORMED * t + GLTF_POSITION], is_checked, error));
    }
end:
    ffd_free(is_checked);
    return status;
}

#define VERTICES ((size_t)64) /* vertices read at a time */

/* Draco and meshopt round weights, so that sums are off in files that are valid. */
#define PACKED_ROUNDING 1e-2

/* The weights of a vertex, over all sets. */
typedef struct weight_sum {
    double total, least;
} weight_sum;

static ffd_status judge(gltf_document *d, size_t index, size_t vertex, const weight_sum *sum,
                        ffd_error *error)
{
    const uint32_t accessor = d->accessor_values.values[index];
    const double rounding = d->layouts[index].packing == GLTF_PLAIN ? WEIGHT_SUM_ROUNDING : PACKED_ROUNDING;
    ffd_status status = FFD_OK;
    if (!isfinite(sum->total))
        return ffd_gltf_flaw(d, accessor, error, "the weights of vertex %zu are not finite: it has no place",
                             vertex);
    if (sum->least < 0)
        status =
            ffd_gltf_flaw(d, accessor, error, "vertex %zu has a negative weight, %g", vertex, sum->least);
    if (status || fabs(sum->total - 1) <= rounding)
        return status;
    if (sum->total > 0)
        return ffd_gltf_flaw(d, accessor, error,
                             "the weights of vertex %zu sum to %.9g, not 1: they are divided by their sum",
                             vertex, sum->total);
    return ffd_gltf_flaw(d, accessor, error,
                         "the weights of vertex %zu sum to %g, not 1: it follows its first joint", vertex,
                         sum->total);
}

static ffd_status judge_block(gltf_document *d, const gltf_primitive *primitive, size_t first, size_t count,
                              ffd_error *error)
{
    weight_sum sums[VERTICES];
    double weights[4 * VERTICES];
    for (size_t i = 0; i < count; i++)
        sums[i] = (weight_sum){0, 0};
    for (size_t s = 0; s < primitive->influence_count; s++) {
        ffd_gltf_read(d, (size_t)primitive->influences[s].weights, first, count, 4, weights);
        for (size_t i = 0; i < 4 * count; i++) {
            sums[i / 4].total += weights[i];
            sums[i / 4].least = minimum_number(sums[i / 4].least, weights[i]);
        }
    }
    for (size_t i = 0; i < count; i++)
        TRY(judge(d, (size_t)primitive->influences[0].weights, first + i, &sums[i], error));
    return FFD_OK;
}

static bool is_readable(const gltf_document *d, const gltf_primitive *primitive)
{
    bool readable = primitive->accessor[GLTF_POSITION] >= 0 && primitive->influence_count > 0;
    for (size_t s = 0; s < primitive->influence_count && readable; s++)
        readable = d->layouts[primitive->influences[s].weights].readable;
    return readable;
}

/* Judges the weights of a primitive. */
static ffd_status judge_primitive(gltf_document *d, const gltf_primitive *primitive, ffd_error *error)
{
    const size_t count = (size_t)d->model.accessors[primitive->influences[0].weights].count;
    for (size_t at = 0; at < count; at += VERTICES)
        TRY(judge_block(d, primitive, at, count - at < VERTICES ? count - at : VERTICES, error));
    return FFD_OK;
}

ffd_status ffd_gltf_judge_weights(gltf_document *d, ffd_error *error)
{
    bool *const judged = ffd_alloc_zero(d->model.accessor_count, sizeof *judged);
    if (!judged)
        return ffd_fail_memory(error);
    ffd_status status = FFD_OK;
    for (size_t i = 0; i < d->instance_count; i++) {
        const gltf_primitive *const primitive = d->instances[i].primitive;
        if (!ffd_gltf_skin_of(d, &d->instances[i]) || !is_readable(d, primitive) ||
            judged[primitive->influences[0].weights])
            continue; /* primitives may share an accessor */
        judged[primitive->influences[0].weights] = true;
        TRY_END(judge_primitive(d, primitive, error));
    }
end:
    ffd_free(judged);
    return status;
}
