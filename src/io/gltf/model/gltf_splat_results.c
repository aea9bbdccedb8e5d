/* gltf_splat_results.c - reads the rotations and scales of splats, and stores the results of these and of the
   harmonics. */
#include "base/memory/memory.h"
#include "io/gltf/model/gltf_splats.h"
#include "io/gltf/read/gltf_encode.h"
#include "io/gltf/read/gltf_read.h"
#include "splat/harmonics.h"
#include <float.h>
#include <math.h>
#include <string.h>

/* Splats read at a time. */
#define STEP ((size_t)64)

/* Returns the stream of an attribute of a part's splats. */
static gltf_stream *stream_of(const gltf_document *d, size_t part, size_t attribute)
{
    return &d->parts[d->parts[part].first_splat + attribute / GLTF_DEFORMED]
                .streams[attribute % GLTF_DEFORMED];
}

static size_t attribute_count(const gltf_document *d, size_t part)
{
    return GLTF_SPLAT_HARMONICS + (size_t)harmonics_count(d->mesh_parts[part].form.degree);
}

/* Allocates the result of a stream, unless it has one. */
static ffd_status make_result(gltf_document *d, size_t count, gltf_stream *stream, ffd_error *error)
{
    if (stream->result)
        return FFD_OK;
    const size_t size = stream->components * sizeof *stream->result;
    const ffd_status status = ffd_budget_take(&d->base.budget, count, size, error);
    if (status)
        return status;
    stream->result = ffd_alloc_whole(count, size);
    return stream->result ? FFD_OK : ffd_fail_memory(error);
}

static void drop_result(gltf_document *d, size_t count, gltf_stream *stream)
{
    if (stream->result)
        ffd_budget_return(&d->base.budget, count, stream->components * sizeof *stream->result);
    ffd_free(stream->result);
    stream->result = NULL;
}

ffd_status ffd_gltf_begin_splats(gltf_document *d, ffd_error *error)
{
    ffd_status status = FFD_OK;
    atomic_store(&d->unturned, 0);
    for (size_t i = 0; i < d->base.part_count && status == FFD_OK; i++) {
        const mesh_part *const part = &d->mesh_parts[i];
        const bool follows = (!part->skipped || part->carried) && !part->singular &&
                             !part->repeats_positions && !d->morph_name && !d->base.converted;
        for (size_t a = 0; part->has_ellipsoids && a < attribute_count(d, i) && status == FFD_OK; a++)
            if (follows)
                status = make_result(d, part->vertex_count, stream_of(d, i, a), error);
            else
                drop_result(d, part->vertex_count, stream_of(d, i, a));
    }
    return status;
}

void ffd_gltf_warn_of_splats(const gltf_document *d, const mesh_log *log)
{
    const size_t unturned = atomic_load(&d->unturned);
    if (unturned > 0)
        ffd_log_line(log, FFD_LOG_WARNING,
                     "%zu Gaussian splat%s spherical harmonics that are not numbers, or too large: they are "
                     "not turned",
                     unturned, unturned == 1 ? " has" : "s have");
}

/* glTF stores quaternions as x, y, z, w. */
void ffd_gltf_read_splats(const mesh_document *document, size_t part, size_t first, size_t count,
                          splat_ellipsoid *splats)
{
    const gltf_document *d = ffd_gltf_of(document);
    const size_t rotations = stream_of(d, part, GLTF_SPLAT_ROTATION)->accessor,
                 scales = stream_of(d, part, GLTF_SPLAT_SCALE)->accessor;
    double rotation[4 * STEP], scale[3 * STEP];
    for (size_t done = 0; done < count; done += STEP) {
        const size_t some = count - done < STEP ? count - done : STEP;
        ffd_gltf_read(d, rotations, first + done, some, 4, rotation);
        ffd_gltf_read(d, scales, first + done, some, 3, scale);
        for (size_t i = 0; i < some; i++) {
            const double *const q = rotation + 4 * i, *const s = scale + 3 * i;
            splats[done + i] =
                (splat_ellipsoid){.rotation = {q[3], q[0], q[1], q[2]}, .scale = {s[0], s[1], s[2]}};
        }
    }
}

/* Writes an element of a result: values rounded to the accessor's type, or the file's element if values is
   NULL. */
static void write_element(const gltf_document *d, const gltf_stream *stream, size_t i, const double *values)
{
    float *const result = stream->result + stream->components * i;
    if (!values) {
        ffd_gltf_original(d, stream->accessor, i, stream->components, result);
        return;
    }
    for (size_t c = 0; c < stream->components; c++)
        result[c] = ffd_gltf_round(&d->model.accessors[stream->accessor], values[c]);
}

/* Whether floats can hold a channel's turned coefficients. */
static bool fit(const double c[HARMONICS_MOST], int count)
{
    for (int m = 0; m < count; m++)
        if (!(fabs(c[m]) <= FLT_MAX))
            return false;
    return true;
}

/* Takes over turned coefficients. Returns false if floats cannot hold those of some channel, which then
   stay. */
static bool take_turned(const harmonics_block turned, int count, harmonics_block c)
{
    bool all = true;
    for (int k = 0; k < HARMONICS_CHANNELS; k++) {
        const bool fits = fit(turned[k], count);
        for (int m = 0; m < count && fits; m++)
            c[k][m] = turned[k][m];
        all = all && fits;
    }
    return all;
}

/* Turns the coefficients of the listed splats, at most STEP. Returns the number of splats with a channel that
   stays. */
static size_t turn_listed(const splat_turn *turns, int degree, const size_t *listed, size_t count,
                          harmonics_block *c)
{
    harmonics_block turned[STEP];
    splat_turn own[STEP];
    size_t unturned = 0;
    if (count == 0)
        return 0;
    for (size_t k = 0; k < count; k++) {
        memcpy(turned[k], c[listed[k]], sizeof turned[k]);
        own[k] = turns[listed[k]];
    }
    ffd_harmonics_turn(FFD_ISA_AUTO, own, degree, count, turned);
    for (size_t k = 0; k < count; k++)
        unturned +=
            !take_turned((const double(*)[HARMONICS_MOST])turned[k], harmonics_count(degree), c[listed[k]]);
    return unturned;
}

static void write_harmonics(gltf_document *d, size_t part, size_t first, size_t count,
                            const splat_turn *turns, const uint8_t *changed)
{
    const int degree = d->mesh_parts[part].form.degree, functions = harmonics_count(degree);
    harmonics_block c[STEP] = {{{0}}};
    size_t listed[STEP], open = 0;
    for (int m = 0; m < functions; m++) {
        double values[STEP][HARMONICS_CHANNELS];
        ffd_gltf_read(d, stream_of(d, part, GLTF_SPLAT_HARMONICS + (size_t)m)->accessor, first, count,
                      HARMONICS_CHANNELS, values[0]);
        for (size_t i = 0; i < count; i++)
            for (int k = 0; k < HARMONICS_CHANNELS; k++)
                c[i][k][m] = values[i][k];
    }
    for (size_t i = 0; i < count && functions > 0; i++)
        if (changed[i] && turns[i].is_turn)
            listed[open++] = i;
    const size_t unturned = turn_listed(turns, degree, listed, open, c);
    for (int m = 0; m < functions; m++) {
        const gltf_stream *const stream = stream_of(d, part, GLTF_SPLAT_HARMONICS + (size_t)m);
        for (size_t i = 0; i < count; i++) {
            const double values[HARMONICS_CHANNELS] = {c[i][0][m], c[i][1][m], c[i][2][m]};
            write_element(d, stream, first + i, changed[i] && turns[i].is_turn ? values : NULL);
        }
    }
    if (unturned > 0)
        atomic_fetch_add(&d->unturned, unturned);
}

void ffd_gltf_write_splats(mesh_document *document, size_t part, size_t first, size_t count,
                           const splat_ellipsoid *splats, const splat_turn *turns, const uint8_t *changed)
{
    gltf_document *const d = (gltf_document *)document;
    const gltf_stream *const rotation = stream_of(d, part, GLTF_SPLAT_ROTATION), *const scale = stream_of(
                                                                                     d, part,
                                                                                     GLTF_SPLAT_SCALE);
    if (!rotation->result)
        return;
    for (size_t i = 0; i < count; i++) {
        const double *const q = splats[i].rotation;
        write_element(d, rotation, first + i, changed[i] ? (double[4]){q[1], q[2], q[3], q[0]} : NULL);
        write_element(d, scale, first + i, changed[i] ? splats[i].scale : NULL);
    }
    for (size_t done = 0; done < count; done += STEP)
        write_harmonics(d, part, first + done, count - done < STEP ? count - done : STEP, turns + done,
                        changed + done);
}
