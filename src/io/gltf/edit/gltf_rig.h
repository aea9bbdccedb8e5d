/* gltf_rig.h - how the nodes, skins and animations of a file change to follow the deformation (src/maths.md
   9.5): a part of the file's edit. ffd_gltf_follow (gltf_rig_follow.c) makes it for one deformation, by the
   steps of gltf_rig_nodes.c, gltf_rig_skins.c and gltf_rig_channels.c; saving reads it, by gltf_rig_edit.c.
 */
#ifndef FFD_IO_GLTF_EDIT_GLTF_RIG_H
#define FFD_IO_GLTF_EDIT_GLTF_RIG_H

#include "io/gltf/model/gltf_animation.h"
#include "io/gltf/read/gltf_document.h"
#include "mesh/places.h"
#include "json/json_edit.h"
#include <float.h>

/* Tolerances: for products of several rotation matrices, and for offsets in eps of the coordinates. */
#define RIG_TURN_ROUNDING 1e-12
#define RIG_PLACE_ROUNDING (64 * DBL_EPSILON)

/* The new local transform of a node. */
typedef struct gltf_moved_node {
    size_t node;
    bool translates, rotates; /* what changes; for a node with a matrix both mean some of its numbers */
    double translation[3], rotation[4];
    double matrix[16]; /* column by column; if the node has a matrix */
} gltf_moved_node;

/* How animated values of a node change. */
typedef struct gltf_node_motion {
    size_t moved;    /* index in gltf_rig's nodes; GLTF_NONE: the node's transform does not change */
    bool turns;      /* rotations q become turn q */
    double turn[4];  /* a unit quaternion x,y,z,w */
    bool carries;    /* translations, relative to the default pose, become carry t */
    double carry[9]; /* a matrix, row by row */
} gltf_node_motion;

/* A further sampler of an animation, for channels that need another output than those with the original
   sampler. */
typedef struct gltf_sampler_copy {
    /* The original sampler; index of its output in the edit's contents, GLTF_NONE: the original output. */
    size_t sampler, content;
} gltf_sampler_copy;

/* How an animation changes. */
typedef struct gltf_rig_animation {
    /* Per sampler: index of its output in the edit's contents, GLTF_NONE: unchanged; NULL: the whole
       animation is unchanged. */
    size_t *contents;
    /* Per channel: the index of its sampler; the copies come after the original samplers. */
    size_t *channels;
    gltf_sampler_copy *copies;
    size_t copy_count, copy_capacity;
} gltf_rig_animation;

typedef struct gltf_rig {
    /* New world matrices, per node, as in gltf_document; NULL: nothing follows. */
    double *world;
    gltf_node_motion *motions; /* per node */
    gltf_moved_node *nodes;    /* the nodes whose local transforms change, parents before children */
    size_t node_count;
    gltf_animations animations;  /* of the file, without keys */
    gltf_rig_animation *changes; /* per animation */
    /* Of the nodes that stay, with what they place, because this is not selected: the one that is farthest
       from where it would be; and the node that follows, the same or one above it. GLTF_NONE: there is
       none. */
    size_t left, left_below;
    /* Channels whose pointers lead to changed transforms in a way that is not supported. */
    size_t pointers_left;
    /* Per skin: index in the edit's contents of its inverse bind matrices; GLTF_NONE: unchanged. */
    size_t *skin_contents;
} gltf_rig;

/* Frees a rig. Nothing follows the deformation then, and no part is carried. */
void ffd_gltf_free_rig(gltf_document *document, gltf_rig *rig);

/* Sets used[a] for each accessor a whose original content a skin or an animation has in the output. */
void ffd_gltf_mark_rig_originals(const gltf_document *document, const gltf_rig *rig, bool *used);

/* Fills the rig's world, motions and nodes, and `became` of the moves (one per place). Errors:
   FFD_E_MEMORY. */
ffd_status ffd_gltf_follow_nodes(const gltf_document *document, const mesh_places *places,
                                 mesh_place_move *moves, mesh_following *following, ffd_error *error);

/* Fills the rig's skin_contents and sets the parts' carry; call it after ffd_gltf_follow_nodes. Errors:
   FFD_E_INVALID (a matrix that floats cannot hold), FFD_E_MEMORY. */
ffd_status ffd_gltf_follow_skins(gltf_document *document, const mesh_places *places,
                                 const mesh_place_move *moves, ffd_error *error);

/* Fills the rig's animations and changes; call it after ffd_gltf_follow_nodes. Errors: those of loading the
   keys of an animation that changes, FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_gltf_follow_animations(gltf_document *document, ffd_error *error);

/* Edits the transforms of nodes: only numbers that differ are replaced. */
void ffd_gltf_edit_nodes(const gltf_document *document, json_edits *edits);

/* Edits the skins to name the accessors of their new inverse bind matrices. outputs: the accessor of each of
   the edit's contents. */
void ffd_gltf_edit_skins(const gltf_document *document, const size_t *outputs, json_edits *edits);

/* Adds the further samplers of animations, and edits samplers to name the accessors of their new outputs.
   outputs: as above. */
void ffd_gltf_edit_animations(const gltf_document *document, const size_t *outputs, json_edits *edits);

#endif
