/* job_state.h - what `ffd deform` and `ffd check` hold while they run. */
#ifndef FFD_JOB_JUDGE_JOB_STATE_H
#define FFD_JOB_JUDGE_JOB_STATE_H

#include "job/chain/chain.h"
#include "job/input/embedding_file.h"
#include "job/judge/details.h"
#include "job/pass/pass_totals.h"
#include "job/rig/rig_places.h"
#include "mesh/mesh.h"

/* What a job holds while it runs. */
typedef struct deform_job {
    const ffd_deform_desc *desc;
    bool check;          /* nothing will be written; all figures are wanted */
    bool recomputes;     /* there are normals, and they are to be those of the deformed faces */
    bool derives;        /* set before opening: the lattices are to say what comes from placeholders */
    bool only_positions; /* set before opening: nothing asked for looks at normals */
    unsigned losses;     /* of inputs, before this job (base/file/mapping.h) */
    int threads;
    mesh_log log;
    mesh_log file_log; /* of what concerns the file, and not its deformation */
    lattice_chain chain;
    mesh_document *document;
    bool document_is_shared;  /* it is the last job's */
    embedding_file embedding; /* where one is named */
    rig_places rig;           /* what the document places beside vertices */
    mesh_following following; /* what became of it where it follows */
    pass_totals totals;
    uint8_t *kept;        /* marks of the pass (job/chain/chain.h); NULL: no vertices */
    job_details *details; /* to be filled, or NULL */
    double *positions;    /* 3 a vertex, as mesh_pass has them deformed; NULL: they are not asked for */
    mesh_model base; /* the shape before, where a conversion adds the deformation to it as a morph target */
    bool forgets_locations; /* u,v,w are not kept for passes to come: there is no memory for them, or no such
                               pass */
    morph_clip *clips;      /* clip_count, of the weights of several morph targets */
    size_t clip_count;
} deform_job;

#endif
