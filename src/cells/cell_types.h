/* cell_types.h - the kinds of volume cells whose Jacobian is known, numbered as VTK and meshio number their
   points. */
#ifndef FFD_CELLS_CELL_TYPES_H
#define FFD_CELLS_CELL_TYPES_H

#include <stddef.h>
#include <stdint.h>

/* The most points of a kind that has a number of them. */
#define CELL_MOST_POINTS 27

typedef enum cell_family {
    FAMILY_TETRA,
    FAMILY_PYRAMID,
    FAMILY_WEDGE,
    FAMILY_HEXAHEDRON,
    FAMILY_PRISM, /* with more sides, which is judged as a polyhedron */
    FAMILY_POLYHEDRON
} cell_family;

typedef struct cell_type {
    const char *name; /* meshio's */
    uint8_t number;   /* of VTK */
    uint8_t points;   /* 0: any number */
    cell_family family;
    const uint8_t *order; /* of its points in those of another kind of its family; NULL: the same */
    /* Where the points are in the reference cell: three coordinates in halves. NULL: there is no rule for
       the kind (reference.h). */
    const uint8_t (*places)[3];
} cell_type;

/* Returns the kind of a number of VTK with so many points; NULL: none is known. */
const cell_type *ffd_cell_type(uint8_t number, size_t points);
/* Returns the kind of a name of meshio's; NULL: none is known. "polyhedron12" is one of 12 points there, and
   here a polyhedron. */
const cell_type *ffd_cell_type_named(const char *name);
/* Returns the number of corners, of kinds other than polyhedra. */
size_t ffd_cell_type_corners(const cell_type *type);
/* Returns the index of a kind, below CELL_TYPES. */
size_t ffd_cell_type_index(const cell_type *type);
#define CELL_TYPES 17

#endif
