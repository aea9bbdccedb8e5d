/* view_scene.h - what `ffd view` shows: a mesh before and after its deformation, the cages, and where it went
   wrong. Apart from jobs and formats: job/view.c fills it, the page and the picture draw it. */
#ifndef FFD_VIEW_VIEW_SCENE_H
#define FFD_VIEW_VIEW_SCENE_H

#include "base/fail.h"
#include "mesh/material.h"
#include "mesh/rig.h"
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* No material. */
#define VIEW_NONE UINT32_MAX

/* A control lattice: its points with u fastest, then v, then w. */
typedef struct view_cage {
    char *name;     /* of the lattice file */
    size_t size[3]; /* points along u, v, w */
    bool closed[3]; /* the last point of a row is joined to the first */
    double *rest;   /* 3 a point */
    double *deformed;
} view_cage;

/* Triangles, segments and points of one name that follow each other. */
typedef struct view_part {
    char *name;        /* as the file has it, any bytes; "": none */
    uint32_t material; /* or VIEW_NONE */
    size_t first_triangle, triangle_count;
} view_part;

/* An edge that is torn (src/maths.md 7.4). */
typedef struct view_tear {
    uint32_t vertices[2];
    double step;
} view_tear;

/* What moves the mesh before, or after. */
typedef struct view_rig {
    mesh_skeleton *skeleton; /* NULL: nothing does; that after may be the one before */
    mesh_anchors anchors;
} view_rig;

/* An animation of the mesh before and the one of the same name after. */
typedef struct view_animation {
    char *name;
    size_t of[2]; /* in the skeleton before and in that after; RIG_NONE: it has none, or it cannot be read */
} view_animation;

typedef struct view_scene {
    char *name;   /* of the mesh, for a title */
    char *output; /* of the deformed mesh, or NULL: it is in memory only */
    size_t vertex_count;
    double *before, *after; /* 3 a vertex; may be not finite */
    uint64_t *numbers;      /* of each vertex in the order of `ffd embed`; NULL: 0, 1, 2 .. */
    uint8_t *statuses;      /* ffd_vertex_status of each; NULL: there is no deformation to speak of */
    double *dets;           /* det F at each, NaN where it is not known; NULL likewise */
    double *colors;         /* 4 a vertex: red, green, blue, alpha, 0 to 1, sRGB; NULL: there are none */
    size_t triangle_count;
    uint32_t *triangles; /* 3 vertices each, counter-clockwise from outside */
    float *texcoords;    /* 2 a corner, v upwards; NULL: there are none */
    uint8_t *flipped;    /* one a triangle: its face is flipped; NULL: none is */
    uint64_t flipped_faces;
    size_t segment_count, point_count;
    uint32_t *segments, *points; /* lines and points of the mesh: 2 and 1 vertices each */
    view_part *parts;
    size_t part_count;
    mesh_materials materials;
    view_cage *cages;
    size_t cage_count;
    view_tear *tears; /* those with the largest steps */
    size_t tear_count;
    uint64_t tear_edges; /* all */
    bool has_witness;    /* the deformed volume folds: */
    double witness_rest[3], witness_deformed[3], witness_uvw[3], witness_det;
    size_t witness_cage;
    double displacement_max;
    view_rig rigs[2]; /* before and after */
    view_animation *animations;
    size_t animation_count;
    size_t animation;      /* that is shown first; animation_count or more: none */
    char *report;          /* JSON as data/schema/formats.md 2 has it; NULL: there is none */
    uint64_t vertices_all; /* of the mesh, where vertex_count is what a reduction left; else equal */
} view_scene;

/* Frees its rigs and animations, whose documents must still be open. */
void ffd_view_scene_free_rigs(view_scene *scene);
/* Frees what a scene holds, its rigs too; leaves an empty one. */
void ffd_view_scene_free(view_scene *scene);

#endif
