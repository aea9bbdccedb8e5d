/* glb_content.c - the binary content of a new glTF file. */
#include "base/arithmetic.h"
#include "base/little_endian.h"
#include "base/text/base64.h"
#include "io/write/glb_values.h"
#include "io/write/glb_writer.h"
#include "mesh/srgb.h"
#include <float.h>
#include <math.h>

static void flush_block(gltf_writer *w)
{
    char text[GLB_BLOCK / 3 * 4];
    ffd_base64_encode(w->block, w->used, text);
    ffd_sink_bytes(&w->sink, text, ffd_base64_length(w->used));
    w->used = 0;
}

static void put_bytes(gltf_writer *w, const unsigned char *bytes, size_t size)
{
    if (!w->base64) {
        ffd_sink_bytes(&w->sink, bytes, size);
        return;
    }
    for (size_t i = 0; i < size; i++) {
        w->block[w->used++] = bytes[i];
        if (w->used == GLB_BLOCK)
            flush_block(w);
    }
}

static void put_floats(gltf_writer *w, const float *values, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        unsigned char bytes[4];
        store_float(bytes, values[i]);
        put_bytes(w, bytes, sizeof bytes);
    }
}

static void put_u16(gltf_writer *w, uint16_t value)
{
    unsigned char bytes[2];
    store_u16(bytes, value);
    put_bytes(w, bytes, sizeof bytes);
}

/* Alpha is linear in every format. */
static void put_byte_colour(gltf_writer *w, const double colour[4])
{
    for (size_t c = 0; c < 4; c++) {
        const unsigned char byte = (unsigned char)floor_of(255 * colour[c] + 0.5);
        put_u16(w, c < 3 ? w->linear_of_bytes[byte] : (uint16_t)(257 * byte));
    }
}

static void put_colour(gltf_writer *w, const model_corner *vertex)
{
    const double *colour = w->model->colours + 4 * (size_t)vertex->position;
    if (w->byte_colours) {
        put_byte_colour(w, colour);
        return;
    }
    for (size_t c = 0; c < 4; c++) {
        const double linear = c < 3 ? ffd_srgb_to_linear(colour[c]) : colour[c];
        const float value = fabs(linear) <= (double)FLT_MAX ? (float)linear : 1;
        put_floats(w, &value, 1);
    }
}

static void put_vertex(gltf_writer *w, const glb_primitive *primitive, const model_corner *vertex, int view,
                       size_t morph)
{
    float values[3] = {0, 0, 0};
    switch (view) {
    case VIEW_POSITIONS:
        ffd_glb_position(w->model, glb_origin(w, primitive), vertex->position, values);
        break;
    case VIEW_NORMALS:
        ffd_glb_normal(w->model, vertex->normal, values);
        break;
    case VIEW_TEXCOORDS:
        ffd_glb_texcoord(w->model, vertex->texcoord, values);
        break;
    case VIEW_POSITION_OFFSETS:
        ffd_glb_position_offset(w->model, morph, vertex->position, values);
        break;
    case VIEW_NORMAL_OFFSETS:
        ffd_glb_normal_offset(w->model, morph, vertex->normal, values);
        break;
    default:
        put_colour(w, vertex);
        return;
    }
    put_floats(w, values, view == VIEW_TEXCOORDS ? 2 : 3);
}

static void put_indices(gltf_writer *w, const glb_primitive *primitive)
{
    const uint32_t *indices = w->plan.indices + primitive->first_index;
    for (size_t i = 0; i < primitive->index_count && w->sink.status == FFD_OK; i++) {
        unsigned char bytes[4];
        store_u32(bytes, indices[i]);
        put_bytes(w, bytes, glb_has_short_indices(primitive) ? 2 : 4);
    }
}

static bool has_view(const gltf_writer *w, const glb_primitive *primitive, int view)
{
    switch (view) {
    case VIEW_NORMALS:
        return primitive->normals;
    case VIEW_TEXCOORDS:
        return primitive->texcoords;
    case VIEW_NORMAL_OFFSETS:
        return primitive->normals;
    case VIEW_SHORT:
        return glb_has_short_indices(primitive);
    case VIEW_LONG:
        return !glb_has_short_indices(primitive);
    default:
        return w->sizes[view] > 0;
    }
}

static void put_vertices(gltf_writer *w, const glb_primitive *primitive, int view, size_t morph)
{
    for (size_t v = 0; v < primitive->vertex_count && w->sink.status == FFD_OK; v++)
        put_vertex(w, primitive, &w->plan.vertices[primitive->first_vertex + v], view, morph);
}

/* The offsets of all morph targets, one target after another. */
static void put_offsets(gltf_writer *w, const glb_primitive *primitive, int view)
{
    for (size_t k = 0; k < w->model->morph_count; k++)
        if (glb_has_morph(&w->plan, primitive, k))
            put_vertices(w, primitive, view, k);
}

void ffd_glb_put_content(gltf_writer *w)
{
    static const unsigned char padding[3] = {0};
    for (int view = 0; view < VIEW_COUNT; view++) {
        for (size_t i = 0; i < w->plan.primitive_count && w->sink.status == FFD_OK; i++) {
            const glb_primitive *primitive = &w->plan.primitives[w->plan.by_mesh[i]];
            if (view == VIEW_CLIPS || !has_view(w, primitive, view))
                continue;
            if (view >= VIEW_SHORT)
                put_indices(w, primitive);
            else if (view == VIEW_POSITION_OFFSETS || view == VIEW_NORMAL_OFFSETS)
                put_offsets(w, primitive, view);
            else
                put_vertices(w, primitive, view, 0);
        }
        if (view == VIEW_CLIPS)
            put_bytes(w, (const unsigned char *)w->clips.bytes.data, w->clips.bytes.size);
        put_bytes(w, padding, (4 - w->sizes[view] % 4) % 4);
    }
    if (w->base64)
        flush_block(w);
}
