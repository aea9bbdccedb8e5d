/* view_picture.h - a scene as a picture: before and after side by side, or a row of steps from one to the
   other. */
#ifndef FFD_VIEW_VIEW_PICTURE_H
#define FFD_VIEW_VIEW_PICTURE_H

#include "base/file/output.h"
#include "mesh/memory_budget.h"
#include "mesh/mesh_log.h"
#include "view/page_options.h"
#include "view/view_frame.h"
#include "view/view_scene.h"

#define VIEW_PICTURE_WIDTH 1600
#define VIEW_PICTURE_HEIGHT 900
/* The most frames in one row. */
#define VIEW_FRAMES 64

typedef struct view_picture_options {
    uint32_t width, height; /* of each frame, in pixels; 0: VIEW_PICTURE_WIDTH, VIEW_PICTURE_HEIGHT */
    uint32_t frames;        /* frames in a row, 2 or more; 0: before and after side by side in one frame */
    uint32_t rows; /* rows of poses of scene->animation: 2, or 1 where nothing is deformed; 0: no animation */
    ffd_view_color color;
    double camera[3]; /* as in view_page_options */
    ffd_up up;
    int threads;
    const view_frame *frame;     /* NULL: that of the scene itself */
    const memory_budget *budget; /* limits the memory for drawing */
    const mesh_log *log;         /* gets warnings, as of images that cannot be decoded; may be NULL */
} view_picture_options;

/* Checks the size of the picture and the number of frames. Errors: FFD_E_ARGUMENT. */
ffd_status ffd_view_picture_check(const view_picture_options *options, ffd_error *error);

/* Fills the frame of a scene, which is drawn with these options. Errors: FFD_E_ARGUMENT, FFD_E_MEMORY. */
ffd_status ffd_view_picture_measure(const view_scene *scene, const view_picture_options *options,
                                    view_frame *frame, ffd_error *error);
/* Draws the scene and writes a PNG into the file that output began last; the caller commits it. Errors:
   FFD_E_ARGUMENT, FFD_E_LIMIT, FFD_E_MEMORY, FFD_E_IO, FFD_E_UNSUPPORTED (the module that writes PNG is
   missing). */
ffd_status ffd_view_picture_write(const view_scene *scene, const view_picture_options *options,
                                  file_output *output, ffd_error *error);

#endif
