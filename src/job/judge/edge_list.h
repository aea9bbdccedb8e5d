/* edge_list.h - the edges of a mesh, each once. */
#ifndef FFD_JOB_JUDGE_EDGE_LIST_H
#define FFD_JOB_JUDGE_EDGE_LIST_H

#include "base/fail.h"
#include "mesh/mesh.h"

/* Unordered pairs of different vertices, ascending: the lesser number in the upper 32 bits. */
typedef struct edge_list {
    uint64_t *keys;
    size_t count;
} edge_list;

/* Bytes of memory that the list needs for each corner of the faces, at the most. */
#define EDGE_LIST_BYTES 16

/* Errors: FFD_E_MEMORY; *edges is then empty. */
ffd_status ffd_edges_collect(const mesh_faces *faces, edge_list *edges, ffd_error *error);
/* Sorts the keys and drops repeats. Needs 8 bytes more for each. Errors: FFD_E_MEMORY. */
ffd_status ffd_edges_sort(edge_list *edges, ffd_error *error);
/* Frees the list. */
void ffd_edges_free(edge_list *edges);

#endif
