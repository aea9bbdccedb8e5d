/* tear_steps.h - how far the displacement jumps along torn edges. */
#ifndef FFD_JOB_JUDGE_TEAR_STEPS_H
#define FFD_JOB_JUDGE_TEAR_STEPS_H

#include "job/chain/chain.h"
#include "job/judge/tears.h"

/* Of blocks, the mode after TEAR_BORDER: a face that another block moves otherwise. */
#define TEAR_DISAGREES TEAR_MARKED

/* The first mode of edges across seams. */
static inline size_t ffd_tear_seams(const lattice_chain *chain)
{
    return TEAR_MARKED + (chain->blocks ? 1 : 0);
}

typedef struct tear_steps tear_steps;

/* All of these must outlive the steps; the marks are those of the question. NULL where memory runs out. */
tear_steps *ffd_tear_steps_make(const lattice_chain *chain, const mesh_document *document,
                                const mesh_faces *faces, const uint8_t *marks);
/* Frees them; NULL is allowed. */
void ffd_tear_steps_free(tear_steps *steps);

/* A tear_step_function; context: a tear_steps. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
tear_step_function ffd_tear_steps_find;

#endif
