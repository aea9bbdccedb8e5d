/* view_frame.h - what a picture has to show: how far its mesh and lattices reach as the camera sees them, and
   how far its scale of colours. Pictures that are drawn with one frame can be compared: what is equal in the
   scenes has equal size, place and colour. */
#ifndef FFD_VIEW_VIEW_FRAME_H
#define FFD_VIEW_VIEW_FRAME_H

#include "mesh/bounds.h"

/* Without padding, so that its bytes can be hashed. */
typedef struct view_frame {
    ffd_bounds mesh;     /* along the axes of the camera: before and after, with the ground */
    ffd_bounds lattices; /* of control points, and of the witness of a fold */
    double displacement; /* the largest */
    double det;          /* the largest of det F and 1 / det F, where det F > 0 */
    double away;         /* the largest distance of a deformed vertex from the box round the mesh at rest, in
                            diagonals of that box; 0 where it has none */
    double has_marks;    /* 1: the legend has a row for marks; else 0 */
} view_frame;

/* Returns the frame of nothing. */
static inline view_frame ffd_view_frame_none(void)
{
    return (view_frame){.mesh = ffd_bounds_empty(), .lattices = ffd_bounds_empty()};
}

/* Extends a frame by another one. */
static inline void ffd_view_frame_join(view_frame *frame, const view_frame *other)
{
    ffd_bounds_join(&frame->mesh, &other->mesh);
    ffd_bounds_join(&frame->lattices, &other->lattices);
    frame->displacement = larger_of(frame->displacement, other->displacement);
    frame->det = larger_of(frame->det, other->det);
    frame->away = larger_of(frame->away, other->away);
    frame->has_marks = larger_of(frame->has_marks, other->has_marks);
}

#endif
