/* gltf_rig.h - the nodes, skins and animations of a file as they follow the deformation (src/maths.md 9.5):
   what of them is written otherwise. Made by ffd_gltf_follow for one deformation, read by saving. */
#ifndef FFD_IO_GLTF_RIG_GLTF_RIG_H
#define FFD_IO_GLTF_RIG_GLTF_RIG_H

#include "base/memory/intern.h"
#include "io/gltf/animation/gltf_animation.h"
#include "io/gltf/document/gltf_document.h"
#include <float.h>

/* What turns that come out of several matrices are off by, and offsets, in eps of the coordinates. */
#define RIG_TURN_ROUNDING 1e-12
#define RIG_PLACE_ROUNDING (64 * DBL_EPSILON)

/* A node's own transform as it is written. */
typedef struct gltf_moved_node {
    size_t node;
    bool translates, rotates; /* what is written otherwise; of a matrix, both mean some of its numbers */
    double translation[3], rotation[4];
    double matrix[16]; /* column by column; of a node that has one */
} gltf_moved_node;

/* How what is animated at a node is carried along. */
typedef struct gltf_node_motion {
    size_t moved;    /* in gltf_rig's nodes; GLTF_NONE: the node is not written otherwise */
    bool turns;      /* rotations get: */
    double turn[4];  /* before them, a unit quaternion */
    bool carries;    /* translations, less that of the default pose, get: */
    double carry[9]; /* before them */
} gltf_node_motion;

/* New elements of an accessor. */
typedef struct gltf_rig_content {
    size_t accessor;     /* GLTF_NONE: there is none yet, of MAT4 */
    size_t count, width; /* elements; numbers of one */
    float *values;
} gltf_rig_content;

/* A sampler that an animation gets beside its own, for channels that want another output. */
typedef struct gltf_sampler_copy {
    size_t sampler, content; /* the one that it is a copy of; its output, GLTF_NONE: as it was */
} gltf_sampler_copy;

/* What becomes of an animation. */
typedef struct gltf_rig_animation {
    size_t *contents; /* of each sampler: its output, GLTF_NONE: as it was; NULL: the animation stays */
    size_t *channels; /* of each channel: its sampler's number, copies behind the others */
    gltf_sampler_copy *copies;
    size_t copy_count, copy_capacity;
} gltf_rig_animation;

typedef struct gltf_rig {
    double *world;             /* of each node as written, as gltf_document's */
    gltf_node_motion *motions; /* of each node */
    gltf_moved_node *nodes;    /* those that are written otherwise, parents first */
    size_t node_count;
    gltf_rig_content *contents; /* no two are equal */
    size_t content_count, content_capacity;
    intern_table known;          /* their hashes */
    memory_budget *budget;       /* the document's, of which they have taken theirs */
    gltf_animations animations;  /* of the file, without their keys */
    gltf_rig_animation *changes; /* of each animation */
    size_t pointers_left;        /* channels that drive a changed part of a node in a way that is not known */
    size_t *skin_contents; /* of each skin: its inverse bind matrices in contents; GLTF_NONE: as they were */
} gltf_rig;

/* Frees document->rig: nothing follows any more, and no part is carried. */
void ffd_gltf_free_rig(gltf_document *document);

/* Makes the values of new elements, out of the budget. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_make_elements(gltf_rig *rig, gltf_rig_content *content, ffd_error *error);
/* Frees them, where they are not added. */
void ffd_gltf_free_elements(gltf_rig *rig, gltf_rig_content *content);
/* Adds new elements, unless they are there already: the values are not the caller's any more, also when it
   fails. Returns their number, GLTF_NONE where memory runs out. */
size_t ffd_gltf_add_content(gltf_rig *rig, gltf_rig_content *content);

/* Sets used[a] for each accessor a whose original content a skin or an animation has in the output. */
void ffd_gltf_mark_rig_originals(const gltf_document *document, bool *used);

#endif
