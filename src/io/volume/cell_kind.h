/* cell_kind.h - the kinds of cells, by their numbers in VTK, which SU2 has too. */
#ifndef FFD_IO_VOLUME_CELL_KIND_H
#define FFD_IO_VOLUME_CELL_KIND_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum {
    CELL_VERTEX = 1,
    CELL_POLY_VERTEX = 2,
    CELL_LINE = 3,
    CELL_POLYLINE = 4,
    CELL_TRIANGLE = 5,
    CELL_STRIP = 6,
    CELL_POLYGON = 7,
    CELL_PIXEL = 8,
    CELL_QUAD = 9,
    CELL_TETRA = 10,
    CELL_VOXEL = 11,
    CELL_HEXAHEDRON = 12,
    CELL_WEDGE = 13,
    CELL_PYRAMID = 14,
    CELL_QUADRATIC_POLYGON = 36,
    CELL_POLYHEDRON = 42,
    CELL_KINDS = 82
};

typedef struct cell_kind {
    const char *name;  /* NULL: there is no such kind */
    uint8_t dimension; /* 0 to 3 */
    uint8_t base;      /* corners: of a face, or of a volume's base; 0: all points */
    bool is_pointed;   /* a volume with one point opposite to its base; others have a second base */
    uint8_t points;    /* how many it has; 0: any number, but at least as many as corners */
} cell_kind;

/* Returns a kind; NULL: there is none of that number. */
const cell_kind *ffd_cell_kind(uint64_t number);

/* Returns how many points are corners, the others being in the middle of edges, faces and volumes. Not of
   kinds with any number of corners. */
static inline size_t cell_corners(const cell_kind *kind)
{
    if (kind->dimension < 3)
        return kind->base;
    return kind->is_pointed ? (size_t)kind->base + 1 : 2 * (size_t)kind->base;
}

#endif
