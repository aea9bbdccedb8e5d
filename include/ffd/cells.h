/* cells.h - the quality of the cells of a volume mesh in memory: whether they are inverted, and how well they
   are shaped. Jobs of volume meshes count the same (ffd_cell_figures).

   The Jacobian of a cell is the determinant of the map from its reference cell, whose edges have the length
   1: of a tetrahedron six times its volume, of a box its volume, of a pyramid three times its volume where
   its base is a parallelogram. A cell is inverted where the Jacobian is 0 or below. What is looked at
   (src/maths.md 11.1):
   - tetrahedra: the determinant, with the exact sign for these numbers;
   - wedges and pyramids: corners, with exact signs, and Gauss points (2 in each direction, 3 in a triangle);
   - hexahedra and voxels: corners, with exact signs, 8 Gauss points, and the 27 Bezier coefficients of the
     Jacobian, between the least and the greatest of which it lies everywhere. Unknown are cells that have one
     sign at corners and Gauss points, where not all coefficients have it, beyond rounding;
   - quadratic cells: corners, middles of edges, faces and the cell, as far as it has them, and Gauss points
     (3 in each direction; of tetrahedra 4). Unknown where these disagree in sign;
   - prisms with five and six sides, and polyhedra: tetrahedra of an edge of a face, the face's centre and
     the cell's centre (the means of the face's vertices, and of those of all faces); a triangle makes one
     with the latter. Unknown are polyhedra whose faces contradict each other: an edge is not in two faces
     that go along it in the two directions. Jobs turn such faces outwards as they lie at rest.

   A value closer to 0 than rounding may move it is not decided, either, and neither is a cell with a
   coordinate that is not finite. */
#ifndef FFD_CELLS_H
#define FFD_CELLS_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/points.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Cells of one kind, and where their values go. Fill with ffd_cells_desc_init, then set what is there. */
typedef struct ffd_cells_desc {
    size_t struct_size; /* sizeof(ffd_cells_desc) in the caller's header */
    ffd_span points;    /* any unit; at most 2^32 - 1; used during the call only */
    /* The name of the kind in meshio: "tetra", "pyramid", "wedge", "hexahedron", "voxel", "tetra10",
       "pyramid13", "pyramid14", "wedge12", "wedge15", "wedge18", "hexahedron20", "hexahedron24",
       "hexahedron27", "penta_prism", "hexa_prism"; "polyhedron", also with a number behind it. */
    const char *kind;
    /* count cells, each with the indices of its points, numbered as meshio and VTK number them, but "wedge"
       as meshio and Gmsh do: the triangle 0 1 2 looks at the other one, which gives vtkMeshQuality positive
       values, too. Of polyhedra each cell is the number of its faces, and for each the number of its vertices
       and these. A face looks outwards: its vertices go round counterclockwise, seen from outside. */
    const uint32_t *cells;
    size_t count;
    /* Of polyhedra count + 1 ascending numbers: where each cell begins in cells, and where the last one ends.
       Else NULL. */
    const uint64_t *offsets;
    /* count values each, filled; NULL: not wanted. */
    uint8_t *inverted; /* 1: the Jacobian is 0 or below somewhere, for certain */
    uint8_t *unknown;  /* 1: not decided, and inverted is 0 */
    double *jacobian;  /* the least determinant that was looked at, in the cube of the unit; NaN if a
                          coordinate is not finite */
    /* The scaled Jacobian as the Verdict library defines it, which vtkMeshQuality has: 1 for the ideal cell,
       at least -1; of quadratic cells that of their corners. NaN of prisms with five and six sides and
       polyhedra, and if a coordinate is not finite. A corner with an edge of no length has 0, and so has an
       inverted pyramid. */
    double *scaled_jacobian;
} ffd_cells_desc;

/* Returns how many points a cell of a kind has, by its name in meshio; 0: polyhedra have any number; -1: the
   kind is not known. Thread-safe. */
FFD_API int ffd_cells_kind_points(const char *kind);

/* Sets desc to defaults: all members 0 or NULL. size: sizeof(ffd_cells_desc) in the caller's header. */
FFD_API void ffd_cells_desc_init(ffd_cells_desc *desc, size_t size);

/* Measures cells. options: threads never change a bit; may be NULL. Thread-safe. Errors: FFD_E_ARGUMENT (an
   unknown kind, a point that is not there, faces that do not fill their cell: the message has the cell's
   index), FFD_E_CANCELLED, FFD_E_MEMORY. */
FFD_API ffd_status ffd_cells_measure(const ffd_cells_desc *desc, const ffd_run_options *options,
                                     ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
