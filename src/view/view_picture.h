/* view_picture.h - a scene as a picture: before and after side by side, or a row of steps from one to the
   other. */
#ifndef FFD_VIEW_VIEW_PICTURE_H
#define FFD_VIEW_VIEW_PICTURE_H

#include "base/file/output.h"
#include "mesh/memory_budget.h"
#include "mesh/mesh_log.h"
#include "view/page_options.h"
#include "view/view_scene.h"

#define VIEW_PICTURE_WIDTH 1600
#define VIEW_PICTURE_HEIGHT 900
/* The most pictures in one row. */
#define VIEW_FRAMES 64

typedef struct view_picture_options {
    uint32_t width, height; /* of each picture, in pixels; 0: those above */
    uint32_t frames;        /* pictures in one row, 2 or more; 0: before and after share one */
    uint32_t rows;          /* of poses of scene->animation: 2, or 1 where nothing is deformed; 0: no poses */
    view_page_color color;
    double camera[3]; /* as of a page */
    int threads;
    const memory_budget *budget; /* what drawing takes is checked against it */
    const mesh_log *log;         /* gets a line where images cannot be decoded; may be NULL */
} view_picture_options;

/* Refuses sizes and numbers that no picture has: FFD_E_ARGUMENT. */
ffd_status ffd_view_picture_check(const view_picture_options *options, ffd_error *error);

/* Draws the scene and writes a PNG into the file that output began last; the commit is the caller's. Errors:
   FFD_E_ARGUMENT, FFD_E_LIMIT, FFD_E_MEMORY, FFD_E_IO, FFD_E_UNSUPPORTED (the module that writes PNG is
   missing). */
ffd_status ffd_view_picture_write(const view_scene *scene, const view_picture_options *options,
                                  file_output *output, ffd_error *error);

#endif
