/* animation.h - a path of control points over time (path_samples.c), and the few morph targets, weights
   (animation_plan.c) and times (animation_times.c) that play it. */
#ifndef FFD_JOB_ANIMATE_ANIMATION_H
#define FFD_JOB_ANIMATE_ANIMATION_H

#include "lattice/lattice.h"
#include "mesh/memory_budget.h"
#include <ffd/animate.h>

/* The displacements of all control points at several times. All zeros: none. */
typedef struct path_samples {
    size_t count, capacity, places;
    size_t width;    /* numbers of a sample: 3 for each control point */
    double *times;   /* as a file stores them: in single precision, ascending */
    double *offsets; /* count x width; exactly 0 for one at rest */
    bool *is_key, *is_still;
    double chord; /* how far a control point is from the mean of two samples, halfway between them, at most */
} path_samples;

/* How a path is sampled between keys that set values. */
typedef struct sampling {
    double frames;   /* a second */
    double nearness; /* a part is halved while its middle is farther from the mean of its ends */
} sampling;

/* Fills samples, which the caller frees in every case. lattice: with keys and positions; its time changes.
   Errors: those of ffd_lattice_set_time, FFD_E_UNSUPPORTED (weights that move), FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_path_sample(ffd_lattice *lattice, const sampling *by, memory_budget *budget,
                           path_samples *samples, ffd_error *error);
/* Frees the samples, and leaves none. */
void ffd_path_free(path_samples *samples);

/* What plays a path: morph targets, each the shape of a sample, and their weights at some of the times,
   between which they go linearly. All zeros: nothing moves. */
typedef struct animation_plan {
    size_t target_count;
    size_t *targets; /* the sample of each target, ascending */
    size_t key_count;
    size_t *keys;    /* the samples whose times are kept, ascending */
    double *weights; /* of each sample, target_count numbers in single precision */
    double bound;    /* how far a vertex may be from the path */
    double largest_weight;
} animation_plan;

/* Which targets are to be made. */
typedef struct plan_wish {
    ffd_animate_targets kind;
    size_t count;     /* of FFD_TARGETS_COUNT */
    double tolerance; /* world units */
    double still;     /* a control point that is so far from rest, or less, is at rest */
} plan_wish;

/* Chooses targets and weights. of_points: the keys give control points. The caller frees plan in every case.
   Errors: FFD_E_LIMIT, FFD_E_MEMORY, and those of a deadline. */
ffd_status ffd_animation_choose(const path_samples *samples, bool of_points, const plan_wish *wish,
                                memory_budget *budget, animation_plan *plan, ffd_error *error);
/* Drops the times that weights between others reproduce, so that no vertex is farther from the path than
   most, or no time where that cannot be; sets the bound. plan: with targets and weights; gets keys. Errors:
   FFD_E_MEMORY, and those of a deadline. */
ffd_status ffd_animation_drop_times(const path_samples *samples, double most, animation_plan *plan,
                                    ffd_error *error);
/* Returns how far a control point of a sample is from what weights of the targets make, at most. */
double ffd_animation_miss(const path_samples *samples, const animation_plan *plan, size_t sample,
                          const double *weights);
/* Frees the plan, and leaves none. */
void ffd_animation_free(animation_plan *plan);

#endif
