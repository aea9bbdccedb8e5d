/* page_rig.h - the animations of a page: skeletons, keys, and what each of the page's vertices follows.
   page_keys.c has ffd_page_keys_put and
   ffd_page_floats_put. */
#ifndef FFD_VIEW_PAGE_RIG_H
#define FFD_VIEW_PAGE_RIG_H

#include "view/page_mesh.h"
#include "view/page_writer.h"
#include "json/json_text.h"

/* Bones that a vertex of a page follows at most. */
#define PAGE_BONES 4

/* The blocks of a side, as bytes. */
typedef enum page_rig_block {
    PAGE_PARENTS,  /* of each node: the number of its parent (-1: none), and flags: 1 joint, 2 matrix; i32 */
    PAGE_NODES,    /* 12 floats each: translation, rotation, scale, two of no meaning; or its matrix */
    PAGE_BONES_OF, /* the node of each bone; u32 */
    PAGE_BINDS,    /* 12 floats a bone */
    PAGE_WEIGHTS,  /* of morph targets by default; floats */
    /* 7 of u32 each: node (of weights: the first weight), path, interpolation, keys, width, the first of its
       times and of its values */
    PAGE_CHANNELS,
    PAGE_TIMES,   /* floats */
    PAGE_VALUES,  /* floats */
    PAGE_FOLLOWS, /* of each vertex: 4 bones and their shares of 65535; u16 */
    PAGE_ANCHORS, /* 3 floats a vertex */
    PAGE_OFFSETS, /* of the targets: a vertex (u32) and 3 floats each */
    PAGE_RIG_BLOCKS
} page_rig_block;

typedef struct page_rig_side {
    const view_rig *from;
    byte_buffer blocks[PAGE_RIG_BLOCKS];
    size_t *first_channel;  /* of each animation of the skeleton, and the end */
    size_t *target_offsets; /* how many of each target */
} page_rig_side;

typedef struct page_rig {
    const page_mesh *mesh;
    page_rig_side sides[2];
    bool is_shared;    /* the skeleton after is that before */
    bool has_after;    /* the mesh after has anchors of its own, or a skeleton of its own */
    size_t reduced;    /* vertices that follow more bones */
    size_t most_bones; /* of these */
} page_rig;

/* Makes what a page has of its scene's rigs; nothing where it has none. The mesh must be numbered. Errors:
   FFD_E_LIMIT (more bones than can be numbered), FFD_E_MEMORY. Free it in every case. */
ffd_status ffd_page_rig_make(const page_mesh *mesh, page_rig *rig, ffd_error *error);
/* Frees it. */
void ffd_page_rig_free(page_rig *rig);
/* Whether there is anything of it. */
static inline bool ffd_page_rig_is_there(const page_rig *rig)
{
    return rig->sides[0].from;
}
/* Describes it, as member "rig". */
void ffd_page_rig_describe(const page_rig *rig, json_text *json);
/* Writes its blocks, which are empty then. */
void ffd_page_rig_write(page_rig *rig, page_writer *w);

/* Appends floats. */
void ffd_page_floats_put(byte_buffer *to, const double *values, size_t count);

/* Puts all loaded animations of a side's skeleton into its blocks, and fills first_channel. What never
   changes has one key. Errors: FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_page_keys_put(page_rig_side *side, ffd_error *error);

#endif
