/* view_scene.h - what `ffd view` shows: a mesh before and after its deformation, the control lattices, and
   where the deformation went wrong. It depends on neither jobs nor file formats: job/view fills it, the page
   and the picture draw it. */
#ifndef FFD_VIEW_VIEW_SCENE_H
#define FFD_VIEW_VIEW_SCENE_H

#include "base/fail.h"
#include "mesh/material.h"
#include "mesh/rig.h"
#include <ffd/fold.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* No material. */
#define VIEW_NONE UINT32_MAX

/* A control lattice. Points have u fastest, then v, then w. */
typedef struct view_cage {
    char *name;     /* of the lattice file */
    size_t size[3]; /* points along u, v, w */
    bool closed[3]; /* the last point of a row is joined to the first */
    double *rest;   /* 3 numbers a point */
    double *deformed;
} view_cage;

/* A named run of triangles, segments and points. */
typedef struct view_part {
    char *name;        /* as in the file, any bytes; "": no name */
    uint32_t material; /* or VIEW_NONE */
    size_t first_triangle, triangle_count;
} view_part;

/* A torn edge (src/maths.md 7.4). */
typedef struct view_tear {
    uint32_t vertices[2];
    double step;
} view_tear;

/* What animates the mesh before, or the mesh after. */
typedef struct view_rig {
    mesh_skeleton
        *skeleton; /* NULL: no animation. The side after may share the skeleton of the side before. */
    mesh_anchors anchors;
    size_t *order; /* index in its document of each vertex that the scene numbers; NULL: the number itself */
} view_rig;

/* The weight of morph targets of one name, which a page lets one change. */
typedef struct view_slider {
    char *name;
    double weight; /* of the shapes before and after */
} view_slider;

/* What a morph target moves on one side, by 1 of its weight. */
typedef struct view_target {
    size_t slider;
    size_t rig_weight;  /* index in the weights of the side's skeleton; RIG_NONE: there are none */
    size_t count;       /* of the vertices that it moves */
    uint32_t *vertices; /* of the scene */
    float *offsets;     /* 3 each */
} view_target;

typedef struct view_target_list {
    view_target *list;
    size_t count;
} view_target_list;

/* An animation of the mesh before, and the one of the same name of the mesh after. */
typedef struct view_animation {
    char *name;
    size_t of[2]; /* index in the skeleton before, and in that after; RIG_NONE: it has none, or it cannot be
                     read */
} view_animation;

typedef struct view_scene {
    char *name;   /* of the mesh file, for the title */
    char *output; /* path of the deformed mesh, or NULL: it was not written */
    size_t vertex_count;
    double *before, *after; /* 3 numbers a vertex; may be not finite */
    uint64_t *indices;      /* of each vertex: its index in the order of `ffd embed`; NULL: 0, 1, 2 .. */
    uint8_t *statuses;      /* ffd_vertex_status of each vertex; NULL: no deformation */
    double *dets;           /* det F at each vertex, NaN where unknown; NULL: no deformation */
    double *colors;         /* 4 numbers a vertex: red, green, blue, alpha, 0 to 1, sRGB; NULL: none */
    size_t triangle_count;
    uint32_t *triangles;   /* 3 vertices each, counter-clockwise seen from outside */
    float *texcoords;      /* 2 numbers a corner, v upwards, as the base texture takes them; NULL: none */
    float *glow_texcoords; /* as the texture of the emission takes them; NULL: the same */
    uint8_t *flipped;      /* one flag a triangle: its face is flipped; NULL: no face is */
    uint64_t flipped_faces;
    uint8_t
        *continues; /* one flag a triangle: it is of the same polygon as the one before it; NULL: unknown */
    struct view_edit *edit; /* view_edit.h: the page edits a lattice; NULL: it shows a deformation */
    size_t segment_count, point_count;
    uint32_t *segments, *points;                   /* of the mesh: 2 vertices and 1 vertex each */
    uint32_t *segment_materials, *point_materials; /* of each one: a material, or VIEW_NONE */
    /* Covariances of Gaussian splats before and after, for each vertex xx, xy, xz, yy, yz, zz; all 0: the
       vertex is none. NULL: the mesh has none. The alpha of a splat's colour is its opacity. */
    float *splats[2];
    view_part *parts;
    size_t part_count;
    mesh_materials materials;
    view_cage *cages;
    size_t cage_count;
    view_tear *tears; /* those with the largest steps */
    size_t tear_count;
    uint64_t tear_edges;      /* the number of all torn edges */
    ffd_fold_witness witness; /* of a fold, if the deformed volume folds */
    double displacement_max;
    view_rig rigs[2]; /* before, after */
    view_animation *animations;
    size_t animation_count;
    size_t animation; /* index of the one shown first; animation_count or more: none */
    view_slider *sliders;
    size_t slider_count;
    view_target_list targets[2]; /* before, after */
    bool same_targets;           /* those after are those before; their list is then empty */
    char *report;                /* JSON as in data/schema/formats.md 2; NULL: none */
    uint64_t vertices_all; /* vertices of the mesh in the file, if vertex_count is what a reduction left; else
                              equal to it */
} view_scene;

/* Returns the index of a vertex of the scene in the document before (side 0) or after (side 1). */
static inline size_t ffd_view_vertex_of(const view_scene *scene, int side, size_t vertex)
{
    const size_t index = scene->indices ? (size_t)scene->indices[vertex] : vertex;
    return scene->rigs[side].order ? scene->rigs[side].order[index] : index;
}

/* Frees the rigs and animations. Must be called while their documents are still open. */
void ffd_view_scene_free_rigs(view_scene *scene);
/* Frees the sliders and their targets. */
void ffd_view_scene_free_targets(view_scene *scene);
/* Frees all that a scene owns, its rigs included; leaves an empty scene. */
void ffd_view_scene_free(view_scene *scene);

#endif
