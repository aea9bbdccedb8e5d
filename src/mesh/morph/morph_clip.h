/* morph_clip.h - an animation of the weights of morph targets, as one line of text (`--clip`). */
#ifndef FFD_MESH_MORPH_MORPH_CLIP_H
#define FFD_MESH_MORPH_MORPH_CLIP_H

#include "base/fail.h"
#include "base/memory/intern.h"

/* Many viewers have no room for more targets of a mesh. */
#define MORPHS_PLAYED 8

/* All zeros: an empty one. */
typedef struct morph_clip morph_clip;

typedef struct clip_weight {
    uint32_t target; /* number of its name */
    double weight;
} clip_weight;

struct morph_clip {
    char *name;
    float *times;   /* key_count, ascending, in seconds */
    size_t *starts; /* of each key's weights, key_count + 1 of them */
    size_t key_count;
    clip_weight *weights;
    size_t weight_count, key_capacity, start_capacity, weight_capacity;
    intern_table names; /* of the targets */
};

/* Reads "NAME: TIME TARGET=WEIGHT ..., TIME ...", to be freed in every case. Single quotes hold a name with
   blanks, '=' or ',', and a clip's name with ':'; two of them within stand for one. A target that a key does
   not name has the weight 0 there. Errors: FFD_E_ARGUMENT, FFD_E_MEMORY. */
ffd_status ffd_morph_clip_parse(const char *text, morph_clip *clip, ffd_error *error);
/* Refuses (FFD_E_ARGUMENT) a clip that names a target which is not known, and tells the nearest; and a second
   clip of one name. */
ffd_status ffd_morph_clips_check(const morph_clip *clips, size_t count, const intern_table *known,
                                 ffd_error *error);
/* The weights that a key gives the names of a clip, by their numbers. */
void ffd_morph_clip_weights(const morph_clip *clip, size_t key, double *weights);
/* Leaves an empty clip. */
void ffd_morph_clip_free(morph_clip *clip);

#endif
