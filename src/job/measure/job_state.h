/* job_state.h - the state of `ffd deform` and `ffd check`. */
#ifndef FFD_JOB_MEASURE_JOB_STATE_H
#define FFD_JOB_MEASURE_JOB_STATE_H

#include "base/memory/intern.h"
#include "job/chain/chain.h"
#include "job/figures/pass_totals.h"
#include "job/input/embedding_file.h"
#include "job/input/rigid_parts.h"
#include "job/input/weights.h"
#include "job/measure/details.h"
#include "job/measure/rig.h"
#include "job/measure/stretch.h"
#include "mesh/mesh.h"
#include "mesh/morphs.h"

/* Morph targets and an animation that are chosen when the job has been checked (job/animate). */
typedef struct job_animation {
    /* Fills the following, and the morphs of the job's description, which may stay without any. */
    ffd_status (*plan)(struct job_animation *animation, ffd_error *error);
    void *context;
    ffd_lattice **lattices; /* in place of those of the description; the chain takes them */
    morph_clip *clip;       /* NULL: none; the job takes its content */
    mesh_animated figures;
    intern_table said; /* lines of the log about earlier targets */
} job_animation;

/* The state of a job. */
typedef struct deform_job {
    const ffd_deform_desc *desc;
    bool check;      /* no output will be written; all figures are wanted */
    bool recomputes; /* normals exist, and are to be recomputed from the deformed faces */
    bool stored;     /* set before it runs: judge the base, whatever default weights show */
    bool converts;   /* set before it runs: the results are for another format */
    unsigned losses; /* of mapped inputs, before this job (base/file/mapping.h) */
    int threads;
    mesh_log log;
    mesh_log file_log; /* for messages about the file, not its deformation */
    lattice_chain chain;
    mesh_document *document;
    bool document_is_cached;  /* it comes from the cache */
    embedding_file embedding; /* if the job reuses one */
    vertex_weights
        weights;         /* of the document's vertices; zeros until they are loaded, or if none are given */
    rigid_parts rigid;   /* what moves as one piece; zeros until it is known, or if nothing does */
    turned_parts turned; /* of the document, and how they are stretched */
    rig_places rig;      /* the document's joints, pivots, sockets and so on */
    mesh_following following; /* what --rig follow has done */
    pass_totals totals;
    uint8_t *kept;           /* marks of the vertices (job/chain/marks.h); NULL: no vertices */
    bool blocks_join;        /* ffd_blocks_join; false: not known */
    job_details *details;    /* to be filled, or NULL */
    double *positions;       /* 3 a vertex, like mesh_pass.deformed; NULL: not wanted */
    mesh_model base;         /* the shape before, if a conversion adds the deformation as a morph target */
    ffd_location *locations; /* of the stored vertices in the only link, kept by this job; or NULL */
    bool is_located;         /* they are filled */
    bool forgets_locations;  /* do not keep u,v,w for later passes: no memory, or no later pass */
    morph_clip *clips;       /* clip_count animations of the weights of new morph targets */
    size_t clip_count;
    job_animation *animation; /* or NULL */
} deform_job;

/* Whether the deformation becomes a further morph target. The other ones stay, and are not judged. */
static inline bool ffd_job_adds_target(const deform_job *job)
{
    return job->desc->as_morph && job->document->format->morphs;
}

/* The weights of the vertices; NULL: none are given. */
static inline const vertex_weights *ffd_job_weights(const deform_job *job)
{
    return job->weights.values ? &job->weights : NULL;
}

/* What moves as one piece; NULL: nothing. */
static inline const rigid_parts *ffd_job_rigid(const deform_job *job)
{
    return job->rigid.pieces ? &job->rigid : NULL;
}

/* What the figures are of: what default weights show, because users see that; or the base, if that is asked
   for, or a further morph target refers to it. */
static inline mesh_state ffd_job_judged(const deform_job *job)
{
    return !job->stored && !ffd_job_adds_target(job) && ffd_mesh_shows_shapes(job->document) ? MESH_SHOWN
                                                                                             : MESH_STORED;
}

/* What the results are of: the same in conversions, and if nothing is saved. Else base and targets, as the
   file stores them. */
static inline mesh_state ffd_job_written(const deform_job *job)
{
    return job->check || job->converts ? ffd_job_judged(job) : MESH_STORED;
}

#endif
