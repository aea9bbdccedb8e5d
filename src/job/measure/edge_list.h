/* edge_list.h - the unique edges of a mesh. */
#ifndef FFD_JOB_MEASURE_EDGE_LIST_H
#define FFD_JOB_MEASURE_EDGE_LIST_H

#include "base/fail.h"
#include "mesh/mesh.h"

/* Pairs of different vertices, the smaller index in the upper 32 bits; ascending. */
typedef struct edge_list {
    uint64_t *keys;
    size_t count;
} edge_list;

/* Upper bound of the list's memory for each corner of the faces, in bytes. */
#define EDGE_LIST_BYTES 16

/* Collects the edges of all faces. Errors: FFD_E_MEMORY; *edges is then empty. */
ffd_status ffd_edges_collect(const mesh_faces *faces, edge_list *edges, ffd_error *error);
/* Sorts the keys and removes duplicates. Needs 8 temporary bytes for each key. Errors: FFD_E_MEMORY. */
ffd_status ffd_edges_sort(edge_list *edges, ffd_error *error);
/* Frees the keys; leaves an empty list. */
void ffd_edges_free(edge_list *edges);

#endif
