/* vertex_rounding.h - what vertices stand for, in the lattice's space (mesh/rounding.h). */
#ifndef FFD_JOB_PASS_VERTEX_ROUNDING_H
#define FFD_JOB_PASS_VERTEX_ROUNDING_H

#include "job/pass/vertex_transform.h"

/* The file's position of a point of the lattice's space; as good as it gets where there is no inverse. */
void ffd_vertex_in_file(const vertex_transform *transform, const double x[3], double position[3]);

/* Takes half a cell from the file's space to the lattice's, in place. */
void ffd_vertex_rounding_place(const vertex_transform *transform, double half[3]);

/* Of which parts a document's vertices are, in the order of `ffd embed`. */
typedef struct vertex_owners {
    const mesh_document *document;
    size_t *parts,
        *first; /* count parts that have vertices of their own, and the number of each one's first */
    size_t count;
} vertex_owners;

/* Lists the owners; they are freed with ffd_vertex_owners_free in every case. Errors: FFD_E_MEMORY. */
ffd_status ffd_vertex_owners_list(const mesh_document *document, vertex_owners *owners, ffd_error *error);
/* Frees the list. */
void ffd_vertex_owners_free(vertex_owners *owners);

/* Half the cell of a document's vertex, by its number, in the lattice's space. x: where it has been moved to
   there; NULL: it is where the file has it. */
void ffd_vertex_rounding(const vertex_owners *owners, size_t vertex, const double x[3], double half[3]);

#endif
