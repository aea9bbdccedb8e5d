/* tear_edges.h - lists the edges that may be torn, by the marks of their ends. */
#ifndef FFD_JOB_MEASURE_TEAR_EDGES_H
#define FFD_JOB_MEASURE_TEAR_EDGES_H

#include "job/chain/marks.h"
#include "job/input/rigid_parts.h"
#include "job/input/weights.h"
#include "job/measure/edge_list.h"
#include "mesh/mesh.h"

/* Kinds of edges. */
typedef enum tear_kind {
    TEAR_STAYS, /* no link moves one end, the first one */
    TEAR_MOVES, /* both ends move */
    TEAR_KINDS
} tear_kind;

/* Vertices [first, end). */
typedef struct vertex_range {
    size_t first, end;
} vertex_range;

typedef struct tear_mesh {
    const mesh_faces *faces; /* at rest; all faces, or all whose corners differ in marks */
    const lattice_chain *chain;
    mark_planes marks; /* of the vertices of faces (job/chain/marks.h) */
    size_t planes;     /* edges whose ends are alike in these first planes are not torn */
    bool stays;        /* some vertices stay */
    /* Also list edges whose ends have equal marks, and which lead through another lattice. */
    bool passes;
    /* Also look for jumps along edges of which one end stays, on the way of what moves the other. */
    bool continues;
    /* As in mesh_pass, of the document's vertices; NULL: not known. They rule out most edges. */
    const double *deformed, *gradients;
    const vertex_weights *weights; /* of the document's vertices, in this state; NULL: all are 1 */
    const rigid_parts *rigid;      /* edges of pieces are not torn; NULL: there are none */
    mesh_state state;
    const vertex_range
        *hidden; /* hidden_count ranges of vertices of the document, ascending: hidden edges are not listed */
    size_t hidden_count;
    const memory_budget *budget;
} tear_mesh;

static inline uint32_t ffd_tear_first(uint64_t key)
{
    return (uint32_t)(key >> 32);
}

static inline uint32_t ffd_tear_second(uint64_t key)
{
    return (uint32_t)(key & UINT32_MAX);
}

static inline void ffd_tear_along(const mesh_faces *faces, uint32_t a, uint32_t b, double along[3])
{
    for (size_t c = 0; c < 3; c++)
        along[c] = faces->positions[3 * (size_t)b + c] - faces->positions[3 * (size_t)a + c];
}

/* Whether two vertices have equal marks in the first planes. */
bool ffd_tear_alike(const tear_mesh *mesh, uint32_t a, uint32_t b, size_t planes);
/* Returns the weight of a vertex of faces. */
static inline double ffd_tear_weight(const tear_mesh *mesh, uint32_t vertex)
{
    return mesh->weights ? ffd_vertex_weight(mesh->weights, ffd_faces_document_vertex(mesh->faces, vertex))
                         : 1;
}
/* Whether a vertex of faces is hidden. */
bool ffd_tear_is_hidden(const tear_mesh *mesh, uint32_t vertex);

/* Lists the edges of a kind, once each: keys, the first end in the upper 32 bits. Of TEAR_MOVES that is the
   end which the first lattice that moves only one end leaves; of blocks that of the later one; else that with
   the greater parameters. Vertices that share a position are one. spare: bytes for each edge that the budget
   must have room for besides. Errors: FFD_E_MEMORY, FFD_E_LIMIT. Call ffd_edges_free in every case. */
ffd_status ffd_tear_edges_list(const tear_mesh *mesh, tear_kind kind, size_t spare, edge_list *edges,
                               ffd_error *error);

#endif
