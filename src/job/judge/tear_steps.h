/* tear_steps.h - measures how far the displacement jumps along edges. */
#ifndef FFD_JOB_JUDGE_TEAR_STEPS_H
#define FFD_JOB_JUDGE_TEAR_STEPS_H

#include "job/chain/chain.h"
#include "job/judge/tears.h"

/* Blocks: the mode after TEAR_BORDER, for edges at a face that another block moves differently. */
#define TEAR_DISAGREES TEAR_MARKED

/* Returns the first mode of edges across seams. */
static inline size_t ffd_tear_seams(const lattice_chain *chain)
{
    return TEAR_MARKED + (chain->blocks ? 1 : 0);
}

typedef struct tear_steps tear_steps;

/* Returns NULL if memory runs out. The steps borrow all arguments. marks: as in tear_question. */
tear_steps *ffd_tear_steps_make(const lattice_chain *chain, const mesh_document *document,
                                const mesh_faces *faces, const uint8_t *marks);
/* Accepts NULL. */
void ffd_tear_steps_free(tear_steps *steps);

/* A tear_step_function whose context is a tear_steps. Errors: FFD_E_MEMORY, FFD_E_LIMIT. */
tear_step_function ffd_tear_steps_find;

#endif
