/* picture_scene.h - the content of a picture: meshes, points, cages, captions, the colour scale. */
#ifndef FFD_PICTURE_PICTURE_SCENE_H
#define FFD_PICTURE_PICTURE_SCENE_H

#include "base/fail.h"
#include "picture/camera.h"
#include "picture/texture.h"
#include <ffd/job.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Diagonal stripes of two colours, by which the colour-blind too tell marks from the scales. */
typedef enum picture_stripes { STRIPES_NONE, STRIPES_RISING, STRIPES_FALLING } picture_stripes;

typedef struct picture_material {
    double color[4];        /* base colour and alpha, 0 to 1, linear */
    const texture *texture; /* multiplied by color; may be NULL */
    texture_wrap wrap[2];   /* along u and v */
    const texture *opacity; /* takes the place of the texture's alpha; NULL: none */
    texture_wrap opacity_wrap[2];
    double emission[3];  /* linear, beside the light; 0 or more */
    const texture *glow; /* multiplied by emission; may be NULL */
    texture_wrap glow_wrap[2];
    double alpha_cutoff;  /* drawn only where alpha is at least this; 0: everywhere */
    bool is_see_through;  /* lets through what is behind it, as alpha says; else alpha matters only for the
                             cutoff */
    bool is_unlit;        /* no lamp lights it */
    bool is_double_sided; /* false: faces seen from behind are not drawn */
    /* Every second stripe is nearly black, where alpha is below one half. */
    picture_stripes stripes;
} picture_material;

typedef struct picture_mesh {
    const double *positions; /* 3 numbers for each vertex; triangles with a vertex that is not finite are
                                omitted */
    size_t vertex_count;
    const uint32_t *triangles; /* 3 vertices each, counter-clockwise seen from outside */
    size_t triangle_count;
    const float *texcoords;      /* 2 numbers for each corner, v upwards; NULL: none */
    const float *glow_texcoords; /* of the texture of the emission; NULL: the same */
    const uint8_t *colors;       /* sRGB red, green, blue, alpha for each vertex; NULL: none */
    const uint32_t *materials;   /* index for each triangle; NULL, or an index out of range: grey, or white if
                                    there are vertex colours */
    const picture_material *material_list;
    size_t material_count;
    const uint32_t *twins; /* for each vertex the first one at the same position, so that shading is
                              continuous across seams (ffd_positions_twins); NULL: all are distinct */
} picture_mesh;

/* Points of a mesh: discs, or Gaussian splats. */
typedef struct picture_points {
    const double *positions; /* 3 numbers for each vertex; points that are not finite are omitted */
    size_t vertex_count;
    const uint32_t *points; /* count vertices */
    size_t count;
    const uint8_t *colors; /* as of a mesh; NULL: all have `color` */
    uint8_t color[3];      /* sRGB */
    double radius;         /* of the discs, in pixels */
    /* For each vertex the covariance of its splat: xx, xy, xz, yy, yz, zz; the alpha of its colour is its
       opacity in the middle. NULL: discs, which are opaque. */
    const float *covariances;
} picture_points;

/* Line segments with points at their ends, such as a control lattice. Parts that a mesh hides are drawn
   faintly. */
typedef struct picture_cage {
    const double *points; /* 3 numbers each */
    size_t point_count;
    const uint32_t *segments; /* 2 point indices each */
    size_t segment_count;
    uint8_t color[3];      /* sRGB */
    const uint8_t *colors; /* sRGB red, green, blue, alpha for each point; NULL: `color` */
    uint8_t second[3];     /* of every second stripe */
    picture_stripes stripes;
    double width;    /* of the lines, in pixels; 0: automatic */
    double radius;   /* of the points, in pixels; 0: automatic; negative: no points */
    bool is_covered; /* parts that a mesh hides are not drawn at all */
} picture_cage;

/* A view with a caption above it. */
typedef struct picture_panel {
    const char *caption; /* UTF-8, of which only ASCII is drawn; NULL: none */
    const picture_mesh *meshes;
    size_t mesh_count;
    const picture_cage *cages;
    size_t cage_count;
    const picture_points *points; /* point_count, each a list of points */
    size_t point_count;
} picture_panel;

/* The colour scale below the panels: a bar from the first to the last colour with labels at equal distances,
   or a field for each colour with its label. */
typedef struct picture_scale {
    const char *title;          /* may be NULL */
    const uint8_t (*colors)[3]; /* sRGB */
    size_t color_count;
    const char *const *labels; /* for a bar at least 2; for fields one for each colour */
    size_t label_count;
    bool is_fields;
} picture_scale;

/* A mark that the legend explains. */
typedef struct picture_mark {
    const char *label;
    uint8_t colors[2][3]; /* sRGB, of its stripes */
    picture_stripes stripes;
    bool is_line;
} picture_mark;

/* A picture. All panels have the same camera and scale, so that lengths can be compared. */
typedef struct picture {
    uint32_t width, height;      /* of the whole picture, in pixels */
    const picture_panel *panels; /* panels of the same size, row by row */
    size_t panel_count;
    size_t rows;                /* number of rows, with equal numbers of panels; 0: one */
    const picture_scale *scale; /* may be NULL */
    const picture_mark *marks;  /* mark_count, below the scale */
    size_t mark_count;
    bool has_mark_row; /* the legend has the row of marks even where there are none */
    bool sees_through; /* a panel has materials that are see-through, or splats; without it these are drawn as
                          if they were opaque */
    camera camera;
    /* Visible bounds along the axes of the camera (ffd_camera_widen); NULL: all points of all panels. */
    const ffd_bounds *seen;
    /* Callback that fills panel `number` just before it is drawn; it may free the content of the previous
       panel, so that only one needs memory. Captions must be set from the start. NULL: all panels are filled;
       otherwise `seen` is required. */
    ffd_status (*fill)(void *context, size_t index, ffd_error *error);
    void *context;
    int threads;
} picture;

#endif
