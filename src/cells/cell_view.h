/* cell_view.h - a cell of a mesh. */
#ifndef FFD_CELLS_CELL_VIEW_H
#define FFD_CELLS_CELL_VIEW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The number of polyhedra in VTK. */
#define VTK_POLYHEDRON 42

typedef struct cell_view {
    uint8_t number; /* of its kind in VTK */
    /* Its points, in VTK's order. Of a polyhedron the number of its faces, and for each the number of its
       vertices and these, which go round counterclockwise seen from outside. */
    const uint32_t *words;
    size_t count; /* of words */
} cell_view;

static inline bool cell_is_polyhedron(const cell_view *cell)
{
    return cell->number == VTK_POLYHEDRON;
}

#endif
