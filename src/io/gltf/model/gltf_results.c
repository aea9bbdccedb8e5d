#include "io/gltf/model/gltf_results.h"
#include "base/memory/memory.h"
#include "base/vector/array_kernel.h"
#include "io/gltf/model/gltf_functions.h"
#include "io/gltf/model/gltf_parts.h"
#include "io/gltf/model/gltf_refuse.h"
#include "io/gltf/read/gltf_elements.h"
#include <string.h>

static size_t tiles_of(size_t count)
{
    return count / MESH_RANGE_STEP + (count % MESH_RANGE_STEP != 0);
}

static size_t tile_end(const gltf_document *d, size_t part, size_t tile)
{
    const size_t count = d->mesh_parts[part].vertex_count;
    return count - tile * MESH_RANGE_STEP < MESH_RANGE_STEP ? count : (tile + 1) * MESH_RANGE_STEP;
}

/* Copies the original vectors to a tile that is not filled yet: the shown ones, if results are of the shown
   shape. */
static void begin_tile(const gltf_document *d, size_t part, const gltf_stream *stream, size_t tile)
{
    const size_t first = tile * MESH_RANGE_STEP, count = tile_end(d, part, tile) - first;
    double shown[3 * MESH_RANGE_STEP];
    float *const result = stream->result + 3 * first;
    stream->filled[tile] = 1;
    if (d->results.state == MESH_STORED || !d->mesh_parts[part].shows_shapes) {
        ffd_gltf_originals(d, stream->accessor, first, count, result);
        return;
    }
    ffd_gltf_read_shown(d, part, (gltf_semantic)(stream - d->parts[part].streams), MESH_SHOWN, first, count,
                        3, shown);
    for (size_t i = 0; i < 3 * count; i++)
        result[i] = (float)shown[i];
}

/* Fills the tiles of vectors [first, last) before results are written there. whole: all these vectors will be
   written. */
static void begin_tiles(const gltf_document *d, size_t part, const gltf_stream *stream, size_t first,
                        size_t last, bool whole)
{
    for (size_t t = first / MESH_RANGE_STEP; t <= (last - 1) / MESH_RANGE_STEP; t++)
        if (whole && first <= t * MESH_RANGE_STEP && tile_end(d, part, t) <= last)
            stream->filled[t] = 1;
        else if (!stream->filled[t])
            begin_tile(d, part, stream, t);
}

/* Vectors per step, so that the compiler vectorizes these loops. */
#define GROUP 4

gltf_tile_bounds ffd_gltf_find_bounds(const float *xyz, size_t count)
{
    float least[3 * GROUP], largest[3 * GROUP];
    size_t first = 0;
    for (size_t k = 0; k < 3 * GROUP; k++) {
        least[k] = HUGE_VALF;
        largest[k] = -HUGE_VALF;
    }
    for (; count - first >= GROUP; first += GROUP)
        for (size_t k = 0; k < 3 * GROUP; k++) {
            const float value = xyz[3 * first + k];
            least[k] = value < least[k] ? value : least[k];
            largest[k] = value > largest[k] ? value : largest[k];
        }
    for (size_t k = 3 * first; k < 3 * count; k++) {
        least[k % 3] = xyz[k] < least[k % 3] ? xyz[k] : least[k % 3];
        largest[k % 3] = xyz[k] > largest[k % 3] ? xyz[k] : largest[k % 3];
    }
    for (size_t k = 3; k < 3 * GROUP; k++) {
        least[k % 3] = least[k] < least[k % 3] ? least[k] : least[k % 3];
        largest[k % 3] = largest[k] > largest[k % 3] ? largest[k] : largest[k % 3];
    }
    return (gltf_tile_bounds){{least[0], least[1], least[2]}, {largest[0], largest[1], largest[2]}};
}

/* Updates the bounds of a tile while it is in the cache. */
static void note_bounds(const gltf_document *d, size_t part, const gltf_stream *stream, size_t tile)
{
    const size_t first = tile * MESH_RANGE_STEP;
    if (stream->bounds)
        stream->bounds[tile] =
            ffd_gltf_find_bounds(stream->result + 3 * first, tile_end(d, part, tile) - first);
}

void ffd_gltf_complete_results(gltf_document *d)
{
    for (size_t i = 0; i < ffd_gltf_part_count(d); i++)
        for (int s = 0; s < GLTF_DEFORMED; s++) {
            gltf_stream *stream = &d->parts[i].streams[s];
            if (!stream->filled)
                continue;
            for (size_t tile = 0; tile < tiles_of(d->mesh_parts[i].vertex_count); tile++)
                if (!stream->filled[tile]) {
                    begin_tile(d, i, stream, tile);
                    note_bounds(d, i, stream, tile);
                }
            ffd_free(stream->filled);
            stream->filled = NULL;
        }
}

/* Makes the result of a stream. Offsets of a further morph target start as zeros. Other results start as the
   file's content, but a tile is copied only when needed: most tiles are overwritten as a whole, and the
   others were just read and are in the cache. */
static ffd_status make_result(gltf_document *d, size_t part, gltf_semantic semantic, ffd_error *error)
{
    gltf_stream *stream = &d->parts[part].streams[semantic];
    const size_t count = d->mesh_parts[part].vertex_count;
    if (stream->accessor == GLTF_NONE)
        return FFD_OK;
    if (!stream->result) {
        TRY(ffd_budget_take(&d->base.budget, count, 3 * sizeof *stream->result, error));
        stream->result = ffd_alloc_whole(count, 3 * sizeof *stream->result);
        if (!stream->result)
            return ffd_fail_memory(error);
        if (d->morph_name)
            memset(stream->result, 0, count * 3 * sizeof *stream->result);
    }
    ffd_free(stream->filled); /* from an earlier deformation */
    stream->filled = NULL;
    if (d->morph_name)
        return FFD_OK;
    stream->filled = ffd_alloc_zero(tiles_of(count), 1);
    if (semantic == GLTF_POSITION && !stream->bounds)
        stream->bounds = ffd_alloc(tiles_of(count), sizeof *stream->bounds);
    return stream->filled && (stream->bounds || semantic != GLTF_POSITION) ? FFD_OK : ffd_fail_memory(error);
}

/* Frees the result of an earlier deformation. */
static void drop_result(gltf_document *d, size_t part, gltf_semantic semantic)
{
    gltf_stream *stream = &d->parts[part].streams[semantic];
    if (stream->result)
        ffd_budget_return(&d->base.budget, d->mesh_parts[part].vertex_count, 3 * sizeof *stream->result);
    ffd_gltf_free_result(stream);
}

ffd_status ffd_gltf_add_results(gltf_document *d, size_t part, ffd_error *error)
{
    const size_t shapes = d->base.part_count + d->parts[part].first_shape;
    for (size_t k = 0; k <= d->mesh_parts[part].shape_count; k++)
        for (int s = 0; s < GLTF_DEFORMED; s++) {
            const bool repeats = k == 0 && s == GLTF_POSITION && d->mesh_parts[part].repeats_positions;
            if (!repeats && (s == GLTF_POSITION || d->results.directions))
                TRY(make_result(d, k == 0 ? part : shapes + k - 1, (gltf_semantic)s, error));
        }
    return FFD_OK;
}

ffd_status ffd_gltf_begin_results(mesh_document *document, const mesh_results *results, ffd_error *error)
{
    gltf_document *d = (gltf_document *)document;
    TRY(ffd_gltf_refuse_read(d, error));
    TRY(ffd_gltf_refuse_store(d, results->directions, error));
    d->results = *results;
    /* Converted meshes have no morph targets. */
    const bool targets = !d->morph_name && !results->converted;
    for (size_t i = 0; i < (targets ? ffd_gltf_shape_end(d) : d->base.part_count); i++)
        for (int s = 0; s < GLTF_DEFORMED; s++)
            if (s != GLTF_POSITION && !results->directions)
                drop_result(d, i, (gltf_semantic)s);
            else if (!d->mesh_parts[i].skipped && !(s == GLTF_POSITION && d->mesh_parts[i].repeats_positions))
                TRY(make_result(d, i, (gltf_semantic)s, error));
    return FFD_OK;
}

/* Whether results are rounded to the accessor's type. Directions as integers that are not normalized or not
   signed are not valid and cannot represent unit vectors: they become floats. */
static bool has_steps(const gltf_accessor *accessor, gltf_semantic semantic)
{
    if (accessor->component == GLTF_FLOAT)
        return false;
    return semantic == GLTF_POSITION ||
           (accessor->normalized && (accessor->component == GLTF_I8 || accessor->component == GLTF_I16));
}

/* Writes a result as an offset from the file's value. */
static void write_offset(const gltf_document *d, const gltf_stream *stream, size_t i, const double *value)
{
    double original[3];
    ffd_gltf_read(d, stream->accessor, i, 1, 3, original);
    for (size_t c = 0; c < 3; c++)
        stream->result[3 * i + c] = (float)(value[c] - original[c]);
}

/* Whether results are rounded only to float. */
static bool is_plain(const gltf_document *d, const gltf_stream *stream, gltf_semantic semantic)
{
    return !d->morph_name &&
           (d->results.converted || !has_steps(&d->model.accessors[stream->accessor], semantic));
}

static void write_changed(const gltf_document *d, const gltf_stream *stream, bool plain, size_t first,
                          size_t count, const double *values, size_t components, const uint8_t *changed)
{
    const gltf_accessor *accessor = &d->model.accessors[stream->accessor];
    float *const result = stream->result + 3 * first;
    for (size_t i = 0; i < count; i++) {
        const double *const value = values + components * i;
        if (!changed[i])
            continue;
        if (d->morph_name)
            write_offset(d, stream, first + i, value);
        for (size_t c = 0; c < 3 && !d->morph_name; c++)
            result[3 * i + c] = plain ? (float)value[c] : ffd_gltf_round(accessor, value[c]);
    }
}

/* Writes results that are rounded only to float, in runs of consecutive changed vectors. */
static void round_changed(const gltf_stream *stream, size_t first, size_t count, const double *xyz,
                          const uint8_t *changed)
{
    const array_kernel *const arrays = ffd_array_kernel(FFD_ISA_AUTO);
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i; end < count && changed[end];)
            end++;
        if (end > i)
            arrays->round(xyz + 3 * i, 3 * (end - i), stream->result + 3 * (first + i));
        while (end < count && !changed[end])
            end++;
    }
}

static void write_result(mesh_document *document, size_t part, gltf_semantic semantic, size_t first,
                         size_t count, const double *values, size_t components, const uint8_t *changed)
{
    const gltf_document *d = ffd_gltf_of(document);
    const gltf_stream *stream = &d->parts[part].streams[semantic];
    if (!stream->result || count == 0)
        return;
    const bool plain = is_plain(d, stream, semantic), whole = !memchr(changed, 0, count);
    if (stream->filled)
        begin_tiles(d, part, stream, first, first + count, whole);
    if (plain && components == 3) /* the usual case */
        round_changed(stream, first, count, values, changed);
    else
        write_changed(d, stream, plain, first, count, values, components, changed);
    for (size_t t = first / MESH_RANGE_STEP; t <= (first + count - 1) / MESH_RANGE_STEP; t++)
        note_bounds(d, part, stream, t);
}

void ffd_gltf_write(mesh_document *document, size_t part, mesh_stream stream, size_t first, size_t count,
                    const double *values, const uint8_t *changed)
{
    write_result(document, part, (gltf_semantic)stream, first, count, values, stream == MESH_TANGENTS ? 4 : 3,
                 changed);
}

void ffd_gltf_write_offsets(mesh_document *document, size_t part, size_t shape, mesh_stream stream,
                            size_t first, size_t count, const double *xyz, const uint8_t *changed)
{
    const gltf_document *d = ffd_gltf_of(document);
    const size_t target = d->base.part_count + d->parts[part].first_shape + shape;
    write_result(document, target, (gltf_semantic)stream, first, count, xyz, 3, changed);
}

void ffd_gltf_put_results(const gltf_stream *stream, size_t count, double *values)
{
    for (size_t i = 0; i < 3 * count && stream->result; i++) {
        const bool filled = !stream->filled || stream->filled[i / 3 / MESH_RANGE_STEP];
        if (filled && ((float)values[i] < stream->result[i] || (float)values[i] > stream->result[i]))
            values[i] = stream->result[i];
    }
}
