/* morph_clip.h - an animation of the weights of morph targets, as one line of text (`--clip`). */
#ifndef FFD_MESH_MORPH_MORPH_CLIP_H
#define FFD_MESH_MORPH_MORPH_CLIP_H

#include "base/fail.h"
#include "base/memory/intern.h"

/* Many viewers do not support more morph targets of a mesh. */
#define MORPHS_PLAYED 8

/* An animation of weights. All zeros: empty. */
typedef struct morph_clip morph_clip;

typedef struct clip_weight {
    uint32_t target; /* index of its name */
    double weight;
} clip_weight;

struct morph_clip {
    char *name;
    float *times;   /* key_count, ascending, in seconds */
    size_t *starts; /* key_count + 1 offsets of the weights of each key */
    size_t key_count;
    clip_weight *weights;
    size_t weight_count, key_capacity, start_capacity, weight_capacity;
    intern_table names; /* names of the targets */
};

/* Parses "NAME: TIME TARGET=WEIGHT ..., TIME ...". The caller frees clip in every case. Names with blanks,
   '=' or ',', and clip names with ':', must be in single quotes, in which '' stands for a quote. A target
   that a key does not name has the weight 0 there. Errors: FFD_E_ARGUMENT, FFD_E_MEMORY. */
ffd_status ffd_morph_clip_parse(const char *text, morph_clip *clip, ffd_error *error);
/* Checks that all targets of the clips are known, and that their names are distinct. The message for an
   unknown target suggests the most similar one. Errors: FFD_E_ARGUMENT. */
ffd_status ffd_morph_clips_check(const morph_clip *clips, size_t count, const intern_table *known,
                                 ffd_error *error);
/* Sets weights[i] to the weight of target name i of the clip at a key. */
void ffd_morph_clip_weights(const morph_clip *clip, size_t key, double *weights);
/* Frees a clip and empties it. */
void ffd_morph_clip_free(morph_clip *clip);

#endif
