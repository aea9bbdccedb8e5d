/* tears.h - counts the torn edges of a mesh (src/maths.md 7.4). */
#ifndef FFD_JOB_JUDGE_TEARS_H
#define FFD_JOB_JUDGE_TEARS_H

#include "base/fail.h"
#include "job/chain/chain.h"
#include "job/judge/torn_edges.h"
#include "mesh/mesh.h"
#include <stdint.h>

/* Kinds of torn edges. Each further mark has a mode of its own, from TEAR_MARKED on (marks `acting` and
   up). */
enum {
    TEAR_UNMOVABLE, /* no link may move one end */
    TEAR_BORDER,    /* a link moves one end and not the other */
    TEAR_MARKED     /* one end has the first further mark, the other has not */
};

/* Fills steps with the jump of the displacement along each edge. edges: the staying (or marked) end in the
   upper 32 bits, the other end in the lower ones; at most TEAR_RUN edges. */
typedef ffd_status tear_step_function(void *context, size_t mode, const uint64_t *edges, size_t count,
                                      double *steps, ffd_error *error);
#define TEAR_RUN ((size_t)1024)

/* The ends of an edge. */
static inline uint32_t ffd_tear_end_stays(uint64_t edge)
{
    return (uint32_t)(edge >> 32);
}

static inline uint32_t ffd_tear_end_moves(uint64_t edge)
{
    return (uint32_t)(edge & UINT32_MAX);
}

/* Vertices [first, end). */
typedef struct vertex_range {
    size_t first, end;
} vertex_range;

typedef struct tear_question {
    const mesh_faces *faces; /* at rest; all faces, or all whose corners differ in marks */
    /* Marks of the vertices as the chain makes them (KEPT_ALWAYS, ffd_kept_bit), in planes of
       faces->vertex_count bytes. Changed if some have KEPT_ALWAYS: vertices at one position get equal
       marks. */
    uint8_t *marks;
    size_t links;  /* number of marks (ffd_chain_marked) */
    size_t acting; /* the first marks, which stand for links (with blocks: one) */
    size_t lone;   /* the first mode whose steps depend on both ends' positions */
    const vertex_range *
        hidden; /* hidden_count ranges of vertices of the document, ascending: hidden edges are not counted */
    size_t hidden_count;
    tear_step_function *step;
    void *context;
    torn_edges *torn; /* gets the edges with the largest steps, in the document's numbers; or NULL */
    const memory_budget *budget;
} tear_question;

typedef struct tear_count {
    uint64_t edges;  /* number of torn edges */
    double largest;  /* largest step; 0 if none is torn */
    uint32_t vertex; /* index in faces of that edge's staying end; of equal steps the lowest */
    size_t mode;     /* mode of that edge */
} tear_count;

/* Tests a mark of a vertex. vertex_count: size of a plane. */
static inline bool ffd_tear_is_kept(const uint8_t *marks, size_t vertex_count, uint32_t vertex, size_t link)
{
    return marks[ffd_kept_plane(link) * vertex_count + vertex] & ffd_kept_bit(link);
}

/* Whether a link moves the vertex. */
static inline bool ffd_tear_takes(const uint8_t *marks, size_t vertex_count, uint32_t vertex, size_t link)
{
    return !(marks[vertex] & KEPT_ALWAYS) && !ffd_tear_is_kept(marks, vertex_count, vertex, link);
}

/* Whether one of the first `acting` links moves the vertex. */
bool ffd_tear_takes_part(const uint8_t *marks, size_t vertex_count, uint32_t vertex, size_t acting);

/* Counts the edges whose step exceeds 1e-3 of their length at rest. Vertices that share a position are one,
   so an edge between two parts counts once. Errors: FFD_E_MEMORY, FFD_E_LIMIT, those of step. */
ffd_status ffd_tears_count(const tear_question *question, tear_count *count, ffd_error *error);

#endif
