/* vertex_rounding.h - rounding cells of vertices in the lattice's space (mesh/rounding.h). */
#ifndef FFD_JOB_PASS_VERTEX_ROUNDING_H
#define FFD_JOB_PASS_VERTEX_ROUNDING_H

#include "job/pass/vertex_transform.h"

/* Transforms a point of the lattice's space to the file's; an approximation if the transform is singular. */
void ffd_vertex_in_file(const vertex_transform *transform, const double x[3], double position[3]);

/* Fills half the extents of the rounding cell of a vertex of a part at a position, in the file's space. Of a
   position that default weights show (MESH_SHOWN) it is the sum of those of the stored position and of the
   offsets. */
void ffd_vertex_cell(const mesh_document *document, mesh_state state, size_t part, size_t vertex,
                     const double position[3], double half[3]);

/* Transforms half extents of a rounding cell from the file's space to the lattice's, in place. */
void ffd_vertex_rounding_place(const vertex_transform *transform, double half[3]);

/* The parts that own a document's vertices, in the order of `ffd embed`. */
typedef struct vertex_owners {
    const mesh_document *document;
    size_t *parts, *first; /* count entries: parts with vertices of their own, and the number of the first
                              vertex of each */
    size_t count;
} vertex_owners;

/* Lists the owners. Call ffd_vertex_owners_free in every case. Errors: FFD_E_MEMORY. */
ffd_status ffd_vertex_owners_list(const mesh_document *document, vertex_owners *owners, ffd_error *error);
/* Frees the list; leaves all zeros. */
void ffd_vertex_owners_free(vertex_owners *owners);

/* Fills half the extents of the rounding cell of a document's vertex, in the lattice's space. x: where the
   vertex has been moved to, in that space; NULL: it is at its position in the file. */
void ffd_vertex_rounding(const vertex_owners *owners, mesh_state state, size_t vertex, const double x[3],
                         double half[3]);

#endif
