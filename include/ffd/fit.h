/* fit.h - finds the lattice that carries points where they are wanted.

   Of pairs of a source and a target, with weights, it finds the offsets of a lattice's control points: first
   the affine map that is the nearest to the pairs (weighted least squares), then, for what it leaves, the D
   that minimises (1/W) sum w |B D - y|^2 + S s E(D), with those pairs that are exact as constraints. B has
   the basis functions at the sources, E is the energy of a thin plate (Wahba, Spline Models for Observational
   Data, 1990), S has no unit and is chosen by generalised cross-validation (Craven & Wahba 1979) unless it is
   given. src/maths.md has the method. The results are the same bits for any number of threads and any
   instruction set. */
#ifndef FFD_FIT_H
#define FFD_FIT_H

#include <ffd/fold.h>
#include <ffd/job.h>
#include <ffd/points.h>

#ifdef __cplusplus
extern "C" {
#endif

/* How S is found. */
typedef enum ffd_fit_smoothing {
    FFD_FIT_AUTO = 0, /* by cross-validation, at least 0.01; raised until the lattice does not fold. With
                         handles: 0 */
    FFD_FIT_GIVEN,    /* `smooth` */
    FFD_FIT_WITHIN    /* the largest with which no pair is farther from its target than `within` */
} ffd_fit_smoothing;

/* What to fit. Fill with ffd_fit_desc_init, then set base, source and target. */
typedef struct ffd_fit_desc {
    size_t struct_size;      /* sizeof(ffd_fit_desc) in the caller's header */
    const ffd_lattice *base; /* has control points; its own offsets are the start, and what they leave is
                                fitted */
    ffd_span source, target; /* of each pair, world units; as many of both */
    const double *weights;   /* one for each pair, finite, >= 0; of 0: the pair is not used. NULL: all 1 */
    const size_t *exact;     /* exact_count indices of pairs that hold exactly; NULL: none */
    size_t exact_count;      /* at most 4,096 */
    /* Drag the pairs and change the rest as little as possible (direct manipulation: Hsu, Hughes & Kaufman
       1992), without an affine map. */
    bool handles;
    bool robust; /* pairs that are far off count less (Holland & Welsch 1977) */
    /* 1 to 3: each pair also enters mirrored along u, v or w, and the result is symmetric to the bit. The
       base must be one that ffd_lattice_symmetrize takes; its own offsets become symmetric first. 0
       (default): no. The result counts the pairs that were given. */
    int symmetric;
    ffd_fit_smoothing smoothing;
    double smooth;        /* FFD_FIT_GIVEN: S >= 0 */
    double within;        /* FFD_FIT_WITHIN: a length in world units, >= 0 */
    double snap;          /* sources outside by at most this distance are inside, as of ffd_embedding_desc */
    size_t numbered_from; /* what messages call the first pair; default 0 */
} ffd_fit_desc;

/* Sets desc to defaults. size: sizeof(ffd_fit_desc) in the caller's header. */
FFD_API void ffd_fit_desc_init(ffd_fit_desc *desc, size_t size);

/* Why S has its value. */
typedef enum ffd_fit_choice {
    FFD_FIT_BY_GCV = 0, /* the least value of cross-validation */
    FFD_FIT_BY_DEFAULT, /* the pairs do not tell */
    FFD_FIT_BY_WITHIN,
    FFD_FIT_BY_CALLER, /* FFD_FIT_GIVEN */
    FFD_FIT_BY_FOLDS   /* raised, because the lattice would have folded */
} ffd_fit_choice;

/* Returns "gcv", "default", "within", "given" or "folds"; NULL for another value. The string is static.
   Thread-safe. */
FFD_API const char *ffd_fit_choice_name(ffd_fit_choice choice);

/* What a fit found. Lengths are in world units. */
typedef struct ffd_fit_result {
    size_t struct_size; /* sizeof(ffd_fit_result) in the caller's header */
    uint64_t pairs, used;
    uint64_t outside, multiple, singular; /* sources that are not used */
    uint64_t exact, dependent;            /* exact pairs; those of them that others imply */
    double smooth;
    ffd_fit_choice smooth_chosen_by;
    double gcv;        /* NaN: S was not chosen by it */
    double affine[12]; /* the offset's constant, then what it changes by along x, y, z; 0 with handles */
    double residual_max, residual_rms, residual_p95; /* over all used pairs */
    uint64_t worst;                                  /* the pair of residual_max */
    double residual_exact;                           /* the largest of exact pairs; NaN: there are none */
    double largest_offset;
    uint64_t points_without_data; /* control points that no used pair sees */
    uint64_t downweighted;        /* robust: pairs with less than half of their weight */
    uint64_t spread_positions;    /* sources at one position with different targets, by position */
    double spread_largest;        /* the greatest distance of one from their weighted mean */
    uint64_t flops;               /* of the factorisation, about */
    ffd_folds folds;              /* the last member: it may grow */
} ffd_fit_result;

/* Fits. *lattice: a new one, base with offsets that are its own, the affine map and D; the caller destroys
   it. residuals: NULL, or a number for each pair: its distance from its target, NaN if it is not used. result
   may be NULL. options may be NULL. Memory: 8 bytes for each entry of the band, at most 2^31, beside 300
   bytes a pair, twice as many with `symmetric`. Thread-safe. Errors: FFD_E_ARGUMENT; FFD_E_INVALID (a
   coordinate that is not finite or beyond 1e60; a lattice whose diagonal is below 1e-60 or above 1e60, or
   with a cell without volume); FFD_E_UNSUPPORTED (weights of the base move); FFD_E_EMBEDDING (no source is
   inside, or an exact one is not); FFD_E_UNMET (exact pairs that contradict each other, no S that meets
   `within`, pairs that tell too little); FFD_E_LIMIT (more exact pairs or a larger band); FFD_E_CANCELLED,
   FFD_E_MEMORY. */
FFD_API ffd_status ffd_fit_points(const ffd_fit_desc *desc, const ffd_run_options *options,
                                  ffd_lattice **lattice, double *residuals, ffd_fit_result *result,
                                  ffd_error *error);

/* A job of `ffd fit`: reads pairs, fits a lattice to them, and writes it. Fill with ffd_fit_job_init, then
   set job, and after or pairs.

   The pairs are the vertices of `before` and `after`, in the order of `ffd embed`, in the lattice's space, as
   the files store them; or the rows of `pairs`. The base is the lattice of job; without one, a box is laid
   round before, or if there is none round the sources, and all meshes of cover. A base whose box is that of a
   mesh is laid round the same. */
typedef struct ffd_fit_job {
    size_t struct_size; /* sizeof(ffd_fit_job) in the caller's header */
    /* The base (no path, text or object: none) with set and time, the output and so on. only: what of
       `before` is used, and what of it the box goes round. Its meshes are ignored; reading is for `cover`
       too. */
    const ffd_author_desc *job;
    /* A mesh, or a NumPy array (N, 3) whose name ends in .npy: it has no faces, and takes no only and no
       space; or NULL. */
    const ffd_source *before;
    /* The same mesh elsewhere, or such an array; NULL: pairs has the targets. */
    const ffd_source *after;
    /* A table of comma-separated values (data/schema/formats.md); NULL: none. With pairs_bytes only a name,
       or NULL, which stands for "pairs.csv". */
    const char *pairs;
    ffd_bytes pairs_bytes;   /* the content of that file */
    const ffd_source *cover; /* cover_count further meshes that the box goes round */
    size_t cover_count;
    /* The box to lay; NULL: 6 x 6 x 6 control points of degree 3, open, with a margin of 0.05. */
    const ffd_lattice_desc *lattice;
    /* Of before and after: NULL or "area", a third of the areas of the faces at a vertex (all 1 if there are
       none); "uniform", all 1; else a NumPy array (N) of numbers from 0 on. With weights_bytes only a name.
     */
    const char *weights;
    ffd_bytes weights_bytes;
    bool handles, robust; /* these and the following as in ffd_fit_desc */
    int symmetric;
    ffd_fit_smoothing smoothing;
    double smooth, within;
    bool within_relative; /* within is a part of the diagonal of before, or if there is none of the sources */
    double snap;
    bool snap_relative; /* snap is a part of the lattice's diagonal */
    unsigned fail_on;   /* 0 or FFD_GATE_FOLDS: FFD_E_GATE if the lattice folds; nothing is written then */
    ffd_isa isa;
    double timeout; /* in seconds; 0: none. After it the job fails with FFD_E_LIMIT */
    bool (*progress)(void *user, double done); /* as of ffd_run_options; or NULL */
    void *progress_user;                       /* passed to progress */
} ffd_fit_job;

/* Sets job to defaults. size: sizeof(ffd_fit_job) in the caller's header. */
FFD_API void ffd_fit_job_init(ffd_fit_job *job, size_t size);

/* How long the parts of such a job took. */
typedef struct ffd_fit_seconds {
    double read, fit, write;
} ffd_fit_seconds;

/* What such a job has done. Set struct_size to sizeof(ffd_fit_job_result) before the call. */
typedef struct ffd_fit_job_result {
    size_t struct_size; /* sizeof(ffd_fit_job_result) in the caller's header */
    ffd_status status;
    ffd_error error; /* if status is not FFD_OK */
    ffd_fit_seconds seconds;
    bool is_fitted; /* fit is filled; also where a gate failed */
    bool robust;    /* that of the job */
    bool has_rows;  /* the pairs are rows of a table, not vertices */
    ffd_fit_result fit;
} ffd_fit_job_result;

/* Runs the job. The output is complete or absent. result may be NULL, and is filled in every case. Errors:
   those of ffd_fit_points, ffd_lattice_load, ffd_lattice_create, ffd_lattice_save and of reading a mesh;
   FFD_E_ARGUMENT also for settings that do not go together; FFD_E_INVALID for files of another number of
   vertices, and for a row of the table, with its line; FFD_E_GATE. */
FFD_API ffd_status ffd_fit_run(const ffd_fit_job *job, ffd_fit_job_result *result, ffd_error *error);

/* Adds the entry of such a job to a report, as ffd_report_add does. input: of before, or of the pairs. */
FFD_API ffd_status ffd_report_add_fit(ffd_report *report, const char *input, const char *output,
                                      const ffd_fit_job_result *result, ffd_error *error);

/* Returns one line for people: how many pairs, how near, with which smoothing, whether it folds. *text ends
   with a 0 byte; the caller frees it with ffd_free. Thread-safe. Errors: FFD_E_ARGUMENT, FFD_E_MEMORY. */
FFD_API ffd_status ffd_fit_text(const ffd_fit_job_result *result, char **text, ffd_error *error);

#ifdef __cplusplus
}
#endif

#endif
