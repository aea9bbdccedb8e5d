/* picture_scene.h - what a picture shows: meshes, cages, captions, the scale of colours. */
#ifndef FFD_PICTURE_PICTURE_SCENE_H
#define FFD_PICTURE_PICTURE_SCENE_H

#include "base/fail.h"
#include "picture/camera.h"
#include "picture/texture.h"
#include <ffd/job.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef struct picture_material {
    double color[4];        /* base colour and alpha, 0 to 1, linear */
    const texture *texture; /* multiplied by it, or NULL */
    texture_wrap wrap[2];   /* along u and v */
    double alpha_cutoff;    /* drawn where alpha is not less; 0: everywhere */
    bool is_double_sided;   /* else faces that are seen from behind are not drawn */
} picture_material;

typedef struct picture_mesh {
    const double *positions; /* 3 a vertex; triangles with one that is not finite are left out */
    size_t vertex_count;
    const uint32_t *triangles; /* 3 vertices each, counter-clockwise from outside */
    size_t triangle_count;
    const float *texcoords; /* 2 a corner, v upwards; NULL: none */
    const uint8_t *colors;  /* red, green, blue, alpha a vertex, sRGB; NULL: none */
    const uint32_t
        *materials; /* one a triangle; NULL, or a number that is not in the list: grey, under colours white */
    const picture_material *material_list;
    size_t material_count;
    const uint32_t *twins; /* of each vertex the first one at its place, so that light does not break at seams
                              (ffd_positions_twins); NULL: each is its own */
} picture_mesh;

/* Segments with points at their ends, as a control lattice has. What a mesh hides is drawn faintly. */
typedef struct picture_cage {
    const double *points; /* 3 each */
    size_t point_count;
    const uint32_t *segments; /* 2 points each */
    size_t segment_count;
    uint8_t color[3]; /* sRGB */
    double width;     /* of the lines in pixels; 0: as fits the picture */
    double radius;    /* of the points in pixels; 0: as fits the picture; less: none */
} picture_cage;

/* One view: what is in it, and what is written above it. */
typedef struct picture_panel {
    const char *caption; /* UTF-8, of which ASCII is drawn; NULL: none */
    const picture_mesh *meshes;
    size_t mesh_count;
    const picture_cage *cages;
    size_t cage_count;
} picture_panel;

/* What colours mean, below the panels: a bar from the first colour to the last with labels in equal steps, or
   a field of each colour with its label. */
typedef struct picture_scale {
    const char *title;          /* or NULL */
    const uint8_t (*colors)[3]; /* sRGB */
    size_t color_count;
    const char *const *labels; /* of a bar 2 or more; of fields as many as colours */
    size_t label_count;
    bool is_fields;
} picture_scale;

/* All panels have one camera and one scale, so that lengths compare. */
typedef struct picture {
    uint32_t width, height;      /* of all, in pixels */
    const picture_panel *panels; /* row by row, side by side, of the same size */
    size_t panel_count;
    size_t rows;                /* each of as many panels; 0: one */
    const picture_scale *scale; /* or NULL */
    camera camera;
    /* What is to be seen, along the camera's axes (ffd_camera_widen); NULL: all points of all panels. */
    const ffd_bounds *seen;
    /* Fills panel `number` just before it is drawn; what the panel before it had may go then, so that one at
       a time takes memory. Captions are there from the beginning. NULL: all is there; else `seen` is needed.
     */
    ffd_status (*fill)(void *context, size_t number, ffd_error *error);
    void *context;
    int threads;
} picture;

#endif
