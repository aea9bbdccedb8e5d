/* page_rig.h - the animations of a page: skeletons, keys, and the bones that each of its vertices follows. */
#ifndef FFD_VIEW_PAGE_RIG_H
#define FFD_VIEW_PAGE_RIG_H

#include "view/page_mesh.h"
#include "view/page_writer.h"
#include "json/json_text.h"

/* The most bones that a vertex of a page follows. */
#define PAGE_BONES 4

/* The data blocks of one side (before or after the deformation). Little-endian. */
typedef enum page_rig_block {
    PAGE_PARENTS,  /* per node: i32 index of its parent (-1: none), u32 flags (1: joint, 2: has a matrix) */
    PAGE_NODES,    /* per node: 12 floats: translation, rotation, scale and two unused; or its matrix */
    PAGE_BONES_OF, /* per bone: u32 index of its node */
    PAGE_BINDS,    /* per bone: 12 floats, its inverse bind matrix */
    PAGE_WEIGHTS,  /* per morph target: float, its default weight */
    /* Per channel: 7 u32: node (or the first weight, if it animates weights), path, interpolation, number of
       keys, numbers per key, index of its first time, index of its first value. */
    PAGE_CHANNELS,
    PAGE_TIMES,   /* floats, in seconds */
    PAGE_VALUES,  /* floats */
    PAGE_FOLLOWS, /* per vertex: 4 u16 bones, then 4 u16 weights that add up to 65535 */
    PAGE_ANCHORS, /* per vertex: 3 floats */
    PAGE_OFFSETS, /* per vertex that a morph target moves: u32 vertex and 3 floats */
    PAGE_RIG_BLOCKS
} page_rig_block;

typedef struct page_rig_side {
    const view_rig *from;
    byte_buffer blocks[PAGE_RIG_BLOCKS];
    size_t *first_channel;  /* of each animation of the skeleton, and behind the last one */
    size_t *target_offsets; /* of each morph target: the number of its entries in PAGE_OFFSETS */
} page_rig_side;

typedef struct page_rig {
    const page_mesh *mesh;
    page_rig_side sides[2];
    bool is_shared;    /* both sides have the same skeleton */
    bool has_after;    /* the side after has anchors or a skeleton of its own */
    size_t reduced;    /* vertices that follow more than PAGE_BONES bones in the file */
    size_t most_bones; /* the most bones that one of these follows */
} page_rig;

/* Fills the rig from the scene's rigs; leaves it empty where there are none. The mesh must be numbered.
   Errors: FFD_E_LIMIT (more bones than 16 bits can number), FFD_E_MEMORY. Call ffd_page_rig_free in every
   case. */
ffd_status ffd_page_rig_make(const page_mesh *mesh, page_rig *rig, ffd_error *error);
/* Frees the arrays and blocks of a rig. */
void ffd_page_rig_free(page_rig *rig);
/* Whether the page has animations. */
static inline bool ffd_page_rig_is_there(const page_rig *rig)
{
    return rig->sides[0].from;
}
/* Adds the rig to the JSON of the scene, as member "rig". */
void ffd_page_rig_describe(const page_rig *rig, json_text *json);
/* Writes the blocks, and empties them. */
void ffd_page_rig_write(page_rig *rig, page_writer *w);

#endif
