/* glb_writer.h - the parts of writing a model as glTF: glb_json.c makes the JSON, glb_content.c the buffer,
   and glb_write.c writes both. */
#ifndef FFD_IO_WRITE_GLB_WRITER_H
#define FFD_IO_WRITE_GLB_WRITER_H

#include "io/write/glb_clips.h"
#include "io/write/glb_plan.h"
#include "io/write/sink.h"
#include "json/json_text.h"

/* Bytes converted to base64 at a time: a multiple of 3, so that the pieces join. */
#define GLB_BLOCK 3072

/* Primitives with more vertices have 32-bit indices: the largest 16-bit index is reserved. */
#define GLB_SHORT_INDEX_VERTICES 65535

/* The bufferViews, in this order; empty ones are left out. */
enum {
    VIEW_POSITIONS,
    VIEW_NORMALS,
    VIEW_TEXCOORDS,
    VIEW_COLOURS,
    VIEW_POSITION_OFFSETS, /* those of morph targets */
    VIEW_NORMAL_OFFSETS,
    VIEW_SHORT,
    VIEW_LONG,
    VIEW_CLIPS, /* times and weights of animations */
    VIEW_COUNT
};

typedef struct gltf_writer {
    const mesh_model *model;
    glb_plan plan;
    double *origins;               /* 3 for each mesh: the translation of its node */
    bool byte_colours;             /* colours are sRGB bytes, which are stored as 16-bit linear numbers */
    uint16_t linear_of_bytes[256]; /* the linear number of each byte */
    size_t indices[VIEW_COUNT];    /* of bufferViews */
    uint64_t sizes[VIEW_COUNT], begins[VIEW_COUNT], filled[VIEW_COUNT], total; /* bytes */
    glb_clips clips;
    byte_buffer text;
    json_text json;
    size_t accessors;
    model_sink sink;
    bool base64;
    unsigned char block[GLB_BLOCK]; /* bytes waiting to become base64 */
    size_t used;
    ffd_error *error;
} gltf_writer;

static inline bool glb_has_short_indices(const glb_primitive *primitive)
{
    return primitive->vertex_count <= GLB_SHORT_INDEX_VERTICES;
}

/* The translation of the node of a primitive. */
static inline const double *glb_origin(const gltf_writer *w, const glb_primitive *primitive)
{
    return w->origins + 3 * (size_t)primitive->mesh;
}

/* Whether the node of a mesh has a translation. */
static inline bool glb_is_far(const gltf_writer *w, size_t mesh)
{
    const double *const origin = w->origins + 3 * mesh;
    return origin[0] != 0 || origin[1] != 0 || origin[2] != 0;
}

static inline size_t glb_colour_size(const gltf_writer *w)
{
    return w->byte_colours ? 8 : 16;
}

/* Makes the JSON in w->text; w->text.failed: memory ran out. uri is that of the buffer, NULL for the BIN
   chunk. Returns the offset where the text of the uri ends, 0 without a buffer. */
size_t ffd_glb_make_json(gltf_writer *w, bool on_one_line, const char *uri);

/* Puts the buffer's bytes, w->total in number, into the sink, as base64 if that is set. */
void ffd_glb_put_content(gltf_writer *w);

#endif
