/* tears.h - counts the edges of a mesh whose ends part (src/maths.md 7.4). */
#ifndef FFD_JOB_JUDGE_TEARS_H
#define FFD_JOB_JUDGE_TEARS_H

#include "base/fail.h"
#include "job/chain/chain.h"
#include "job/judge/torn_edges.h"
#include "mesh/mesh.h"
#include <stdint.h>

/* What tears an edge. A mode after the last of these is that of a further mark (marks from acting on). */
enum {
    TEAR_UNMOVABLE, /* one end may not move at all */
    TEAR_BORDER,    /* some link moves one end and leaves the other */
    TEAR_MARKED     /* one end has the first further mark, the other does not */
};

/* How far the displacement jumps along edges of a mode, to steps. edges: the end that stays, or that has the
   mark, in the upper 32 bits, the other in the lower ones; TEAR_RUN edges at most. */
typedef ffd_status tear_step_function(void *context, size_t mode, const uint64_t *edges, size_t count,
                                      double *steps, ffd_error *error);
#define TEAR_RUN ((size_t)1024)

/* Its ends. */
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
    const mesh_faces *faces; /* at rest, all of them, or all that marks tell apart */
    /* Marks of the vertices as the chain makes them (KEPT_ALWAYS, ffd_kept_bit), in planes of
       faces->vertex_count bytes. They are changed where some have KEPT_ALWAYS: vertices at one position get
       the same. */
    uint8_t *marks;
    size_t links;               /* that marks are about (ffd_chain_marked); */
    size_t acting;              /* what the first so many move, moves: of blocks one */
    size_t lone;                /* from this mode on a step depends on both ends' positions */
    const vertex_range *hidden; /* hidden_count, ascending, of the document: not shown is not torn */
    size_t hidden_count;
    tear_step_function *step;
    void *context;
    torn_edges *torn; /* gets those with the largest steps, in numbers of the document; or NULL */
    const memory_budget *budget;
} tear_question;

typedef struct tear_count {
    uint64_t edges;  /* that are torn */
    double largest;  /* the largest step of these; 0 without any */
    uint32_t vertex; /* of faces: the end that stays there, of equals the one with the lowest number */
    size_t mode;     /* of that step */
} tear_count;

/* The marks of one vertex, among those of vertex_count. */
static inline bool ffd_tear_is_kept(const uint8_t *marks, size_t vertex_count, uint32_t vertex, size_t link)
{
    return marks[ffd_kept_plane(link) * vertex_count + vertex] & ffd_kept_bit(link);
}

/* Whether the link moves the vertex. */
static inline bool ffd_tear_takes(const uint8_t *marks, size_t vertex_count, uint32_t vertex, size_t link)
{
    return !(marks[vertex] & KEPT_ALWAYS) && !ffd_tear_is_kept(marks, vertex_count, vertex, link);
}

/* Whether one of the first so many links moves the vertex. */
bool ffd_tear_takes_part(const uint8_t *marks, size_t vertex_count, uint32_t vertex, size_t acting);

/* Counts the edges whose step is above 1e-3 of their length at rest. Vertices at equal positions are one, so
   that an edge of two parts counts once. Errors: FFD_E_MEMORY, FFD_E_LIMIT, those of step. */
ffd_status ffd_tears_count(const tear_question *question, tear_count *count, ffd_error *error);

#endif
