/* animate.h - plays a lattice with keys (ffd_lattice_get_keys) as an animation of morph targets. */
#ifndef FFD_ANIMATE_H
#define FFD_ANIMATE_H

#include <ffd/error.h>
#include <ffd/export.h>
#include <ffd/job.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Which shapes of the path become morph targets. AUTO: the fewest of greedy choices with which weights make
   all shapes to within half of the tolerance: the shape that is worst off, one after the other. KEYS: that of
   each key which is not at rest, and, where keys set values, as many between as the tolerance asks for;
   weights go from one to the next. COUNT: as AUTO, so many, and fewer only where all shapes are exact then;
   the tolerance is that of the times alone. */
typedef enum ffd_animate_targets {
    FFD_TARGETS_AUTO = 0,
    FFD_TARGETS_KEYS,
    FFD_TARGETS_COUNT
} ffd_animate_targets;

/* A job of `ffd animate`. Fill with ffd_animate_desc_init, then set job.

   The path of the control points is sampled: at the keys, if they give control points, which go straight
   between them; if they set values, at least frames_per_second times a second, and where the path bends more
   often, until it is nearer to its chords than a quarter of the tolerance (halving each part 8 times at
   most). Morph targets are shapes of the path, which weights add up. A vertex is a mean of control points, so
   that no vertex of any mesh is farther from its place than the worst control point: that is
   ffd_animate_result.bound, to which the rounding of targets and weights to single precision comes, 2^-23 of
   the coordinates and of the sum of the weights' magnitudes times the targets. The bound holds with held
   faces (seam) too, as control points of such a lattice are means of those of the lattice as it is, and with
   weights of vertices, which make a displacement shorter. Times of samples whose weights those of other
   samples reproduce within the tolerance are left out. */
typedef struct ffd_animate_desc {
    size_t struct_size; /* sizeof(ffd_animate_desc) in the caller's header */
    /* One lattice, with keys. The output is a .gltf or .glb (.vrm); another mesh is converted. Excluded are
       as_morph, morphs, clips, blocks, rig, embedding, fail_on, positions, in_place, output_format, has_time
       and FFD_NORMALS_RECOMPUTE. Normals and tangents of morph targets are those of each target alone. */
    const ffd_deform_desc *job;
    /* Of the animation, at most FFD_ANIMATION_NAME - 1 bytes; targets are called "NAME-1", .. in the order of
       their times. Those and an animation of that name which the file has are replaced. NULL: the name of the
       lattice's file without folder and ending. */
    const char *name;
    /* How far a vertex may be from its place, > 0: world units, or with relative a fraction of the diagonal
       of the lattice at rest. Default 1e-3, relative. */
    double tolerance;
    bool relative;
    ffd_animate_targets targets; /* default FFD_TARGETS_AUTO */
    size_t count;                /* of FFD_TARGETS_COUNT: at least 1 */
    double frames_per_second;    /* 1 to 1000; default 60 */
} ffd_animate_desc;

/* Sets desc to defaults. size: sizeof(ffd_animate_desc) in the caller's header. */
FFD_API void ffd_animate_desc_init(ffd_animate_desc *desc, size_t size);

/* How long the parts of such a job took. */
typedef struct ffd_animate_seconds {
    double read, plan, deform, write; /* plan: samples, targets and weights */
} ffd_animate_seconds;

/* The room for the name of an animation. */
#define FFD_ANIMATION_NAME 256

/* What such a job has done. Set struct_size to sizeof(ffd_animate_result) before the call. */
typedef struct ffd_animate_result {
    size_t struct_size; /* sizeof(ffd_animate_result) in the caller's header */
    ffd_status status;
    ffd_error error; /* if status is not FFD_OK */
    ffd_animate_seconds seconds;
    uint64_t vertices, inside, outside, multiple, singular, invalid; /* as of ffd_job_result */
    char name[FFD_ANIMATION_NAME];
    uint64_t targets;      /* that a mesh gets, at most; 0: nothing moves */
    uint64_t keys;         /* times of the animation */
    uint64_t samples;      /* of the path */
    double tolerance;      /* world units */
    double bound;          /* how far a vertex may be from its place, world units */
    double largest_weight; /* magnitude */
    /* By which the files grew: those of the output less those of a glTF that was read. Of a mesh of another
       format the bytes of morph targets and weights. 0 with dry_run. */
    uint64_t bytes;
    const ffd_output_list *outputs; /* that of the job, or NULL */
} ffd_animate_result;

/* Runs the job. The output is complete or absent. result may be NULL, and is filled in every case.
   Thread-safe for jobs that share no objects. Errors: those of ffd_deform_run; FFD_E_INVALID (a lattice
   without keys, or whose moves cannot be done with the values between keys); FFD_E_UNSUPPORTED (weights of
   control points that move); FFD_E_LIMIT (also more than 1024 targets). */
FFD_API ffd_status ffd_animate_run(const ffd_animate_desc *desc, ffd_animate_result *result,
                                   ffd_error *error);

/* Adds the entry of such a job to a report, as ffd_report_add does; outputs must still hold the names. */
FFD_API ffd_status ffd_report_add_animation(ffd_report *report, const char *input, const char *output,
                                            const ffd_animate_result *result, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
