/* tears.h - counts the torn edges of a mesh (src/maths.md 7.4). */
#ifndef FFD_JOB_JUDGE_TEARS_H
#define FFD_JOB_JUDGE_TEARS_H

#include "base/fail.h"
#include "job/chain/marks.h"
#include "job/judge/torn_edges.h"
#include "mesh/mesh.h"
#include <stdint.h>

/* Vertices [first, end). */
typedef struct vertex_range {
    size_t first, end;
} vertex_range;

typedef struct tear_question {
    const mesh_faces *faces; /* at rest; all faces, or all whose corners differ in marks */
    const lattice_chain *chain;
    /* Marks of the vertices (job/chain/marks.h), in planes of faces->vertex_count bytes. Changed if some have
       KEPT_ALWAYS: vertices at one position get equal marks. */
    uint8_t *marks;
    /* Also count edges whose ends have equal marks, and which lead through another lattice. */
    bool passes;
    /* As in mesh_pass, of the document's vertices; NULL: not known. */
    const double *deformed, *gradients;
    const vertex_range *
        hidden; /* hidden_count ranges of vertices of the document, ascending: hidden edges are not counted */
    size_t hidden_count;
    torn_edges *torn; /* gets the edges with the largest steps, in the document's numbers; or NULL */
    const memory_budget *budget;
    int threads; /* never change the result */
} tear_question;

typedef struct tear_count {
    uint64_t edges;  /* number of torn edges */
    double largest;  /* largest step; 0 if none is torn */
    uint32_t vertex; /* index in faces of that edge's staying end; of equal steps the lowest */
    ffd_tear_cause cause;
} tear_count;

/* Counts the edges whose step exceeds 1e-3 of their length at rest. Vertices that share a position are one,
   so an edge between two parts counts once. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
ffd_status ffd_tears_count(const tear_question *question, tear_count *count, ffd_error *error);

#endif
