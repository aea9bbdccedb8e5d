/* gltf_animation.h - the animations of an open glTF file (glTF 2.0, 3.11). Each struct keeps the JSON values
   and accessors it was read from, so that they can be written anew. Any file that opens has a list of
   animations; an animation is checked only when its keys are loaded, so that a broken one stops only those
   who use it. */
#ifndef FFD_IO_GLTF_MODEL_GLTF_ANIMATION_H
#define FFD_IO_GLTF_MODEL_GLTF_ANIMATION_H

#include "io/gltf/read/gltf_document.h"

/* What a channel drives. */
typedef enum gltf_path {
    GLTF_TRANSLATION,
    GLTF_ROTATION,
    GLTF_SCALE,
    GLTF_WEIGHTS, /* of the morph targets of a node's mesh */
    GLTF_NO_PATH  /* something else, or nothing */
} gltf_path;

typedef enum gltf_interpolation {
    GLTF_STEP,
    GLTF_LINEAR,
    GLTF_CUBICSPLINE,
    GLTF_NO_INTERPOLATION /* a word that glTF does not know */
} gltf_interpolation;

typedef struct gltf_animation_sampler {
    uint32_t value;       /* in the JSON */
    size_t input, output; /* accessors; GLTF_NONE: absent or out of range */
    gltf_interpolation interpolation;
    size_t key_count;
    size_t width;  /* numbers per value */
    double *times; /* key_count, non-decreasing; NULL: the keys are not loaded */
    /* key_count * width. CUBICSPLINE has three times as many: each key's in-tangent, value and
       out-tangent. */
    double *values;
} gltf_animation_sampler;

typedef struct gltf_channel {
    uint32_t value; /* in the JSON */
    size_t sampler; /* an index in its animation; GLTF_NONE: absent or out of range */
    gltf_path path;
    size_t node;   /* whose path it is; GLTF_NONE with GLTF_NO_PATH */
    char *pointer; /* of KHR_animation_pointer, even if path and node were taken from it; NULL: it has none */
    /* The JSON value that names no node or path but should; JSON_NONE: no fault. */
    uint32_t fault;
} gltf_channel;

typedef struct gltf_animation {
    uint32_t value; /* in the JSON */
    char *name;     /* NULL: it has none */
    gltf_animation_sampler *samplers;
    size_t sampler_count;
    gltf_channel *channels;
    size_t channel_count;
    /* seconds: the times of the first and the last key, once loaded; 0 and 0 without keys. */
    double begin, end;
    uint64_t taken; /* bytes of the document's memory budget that its keys take */
    /* Channels whose KHR_animation_pointer names something other than a property of a node. */
    size_t pointer_count;
} gltf_animation;

typedef struct gltf_animations {
    gltf_animation *list;
    size_t count;
    uint64_t taken; /* bytes of the document's memory budget that the list takes */
} gltf_animations;

/* Lists the animations of a file, without their keys. Free the list with ffd_gltf_free_animations, after an
   error too. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_list_animations(gltf_document *document, gltf_animations *animations, ffd_error *error);
/* Frees the list with all loaded keys, and empties it. */
void ffd_gltf_free_animations(gltf_document *document, gltf_animations *animations);

/* Whether a channel drives a node. Viewers ignore the others. */
static inline bool ffd_gltf_channel_drives(const gltf_channel *channel)
{
    return channel->path != GLTF_NO_PATH;
}

/* Returns the number of morph targets of a node's mesh: one weight drives each. */
static inline size_t ffd_gltf_node_targets(const gltf_document *document, size_t node)
{
    const int mesh = document->model.nodes[node].mesh;
    return mesh < 0 ? 0 : document->mesh_uses[mesh].target_count;
}

/* Loads and checks the keys of all samplers that drive a node: the types and counts of their accessors, that
   times do not fall, that numbers are finite. Loading again changes nothing. Errors: FFD_E_INVALID,
   FFD_E_UNSUPPORTED (an unknown compression), FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_load_animation(gltf_document *document, gltf_animation *animation, ffd_error *error);
/* Frees the keys. */
void ffd_gltf_unload_animation(gltf_document *document, gltf_animation *animation);

#endif
