/* gltf_animation.h - the animations of an open glTF file (glTF 2.0, 3.11). What is read says which values and
   accessors of the file it comes from, so that these can be written anew. A list is made of any file that
   opens; an animation is checked when its keys are loaded, so that a broken one stops only who wants it.
   ffd_gltf_load_animation and ffd_gltf_unload_animation are in gltf_keys.c. */
#ifndef FFD_IO_GLTF_ANIMATION_GLTF_ANIMATION_H
#define FFD_IO_GLTF_ANIMATION_GLTF_ANIMATION_H

#include "io/gltf/document/gltf_document.h"

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
    size_t input, output; /* accessors; GLTF_NONE: it names none that is there */
    gltf_interpolation interpolation;
    size_t key_count;
    size_t width;  /* numbers of one value */
    double *times; /* key_count, never falling; NULL: its keys are not loaded */
    /* key_count * width; of CUBICSPLINE three times as many: of each key the tangent before it, the value and
       the tangent behind it. */
    double *values;
} gltf_animation_sampler;

typedef struct gltf_channel {
    uint32_t value; /* in the JSON */
    size_t sampler; /* of its animation; GLTF_NONE: it names none that is there */
    gltf_path path;
    size_t node;   /* that the path is of; GLTF_NONE: with GLTF_NO_PATH */
    char *pointer; /* of KHR_animation_pointer, also where path and node say the same; NULL: it has none */
    /* The value that should name the node or the path and does not; JSON_NONE: none. */
    uint32_t fault;
} gltf_channel;

typedef struct gltf_animation {
    uint32_t value; /* in the JSON */
    char *name;     /* NULL: it has none */
    gltf_animation_sampler *samplers;
    size_t sampler_count;
    gltf_channel *channels;
    size_t channel_count;
    double begin, end; /* seconds: of the first and the last key, once it is loaded; 0 and 0 without keys */
    uint64_t taken;    /* of the document's memory budget, by its keys */
    size_t pointer_count; /* channels that drive something other than a node by KHR_animation_pointer */
} gltf_animation;

typedef struct gltf_animations {
    gltf_animation *list;
    size_t count;
    uint64_t taken; /* of the document's memory budget, by the list */
} gltf_animations;

/* Lists the animations of a file, without their keys; to be freed in any case. Errors: FFD_E_LIMIT,
   FFD_E_MEMORY. */
ffd_status ffd_gltf_list_animations(gltf_document *document, gltf_animations *animations, ffd_error *error);
/* Frees them, with the keys that are loaded; nothing is left. */
void ffd_gltf_free_animations(gltf_document *document, gltf_animations *animations);

/* Whether a channel drives a node. Others are left out by viewers. */
static inline bool ffd_gltf_channel_drives(const gltf_channel *channel)
{
    return channel->path != GLTF_NO_PATH;
}

/* Returns how many morph targets a node's mesh has, which is how many weights drive it. */
static inline size_t ffd_gltf_node_targets(const gltf_document *document, size_t node)
{
    const int mesh = document->model.nodes[node].mesh;
    return mesh < 0 ? 0 : document->mesh_uses[mesh].target_count;
}

/* Loads the keys of all samplers that drive a node, and checks them: the accessors and their types, how many
   there are, times that do not fall, finite numbers. Loading again changes nothing. Errors: FFD_E_INVALID,
   FFD_E_UNSUPPORTED (compressed by what is not known), FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_load_animation(gltf_document *document, gltf_animation *animation, ffd_error *error);
/* Frees the keys. */
void ffd_gltf_unload_animation(gltf_document *document, gltf_animation *animation);

#endif
