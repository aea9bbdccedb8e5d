/* figures.h - the figures of a job: the table in figures.c describes each of them once. How they are cleared,
   joined, written to a report and read back (job/report) and told to people follows from it. */
#ifndef FFD_JOB_FIGURES_FIGURES_H
#define FFD_JOB_FIGURES_FIGURES_H

#include "job/figures/figure_lines.h"

/* Follows from the type of the member of ffd_job_result. */
typedef enum figure_type {
    FIGURE_NONE = 0,
    FIGURE_FLAG,      /* whether a group is known; not a member of the report */
    FIGURE_COUNT,     /* uint64_t */
    FIGURE_NUMBER,    /* double; null if it is not finite */
    FIGURE_TEXT,      /* null if it is empty */
    FIGURE_VECTOR,    /* three numbers */
    FIGURE_BOX,       /* ffd_bounds */
    FIGURE_STATUSES,  /* counts by ffd_vertex_status: a member of the report for each */
    FIGURE_VERDICT,   /* ffd_fold_verdict, by its name */
    FIGURE_REFERENCE, /* ffd_fold_reference, by its name */
    FIGURE_SEAM,      /* ffd_seam, by its name */
    FIGURE_CAUSE,     /* ffd_tear_cause; not a member of the report */
    FIGURE_BEHIND,    /* an array: ffd_behind of each kind */
    FIGURE_FLAWS,     /* an array: ffd_flaw */
    FIGURE_MORPHS,    /* an array: the results of morph targets */
    FIGURE_RIGID,     /* an array: ffd_rigid_part */
    FIGURE_FACES,     /* an array: of each lattice an array of the names of faces */
    FIGURE_GROUP,     /* an object: the figures that follow, up to FIGURE_END */
    FIGURE_END
} figure_type;

/* How the figures of tiles become those of a pass, and those of morph targets those of a job. */
typedef enum figure_join {
    JOIN_NONE = 0, /* the whole has its own */
    JOIN_SUM,
    JOIN_ANY,
    JOIN_ALL,
    JOIN_LARGEST, /* 0: none */
    JOIN_HIGHEST, /* likewise, of numbers that may be negative; -infinity: none */
    JOIN_LEAST,   /* infinity or UINT64_MAX: none */
    JOIN_WITH,    /* that of the tile or target to which the figure before it belongs */
    JOIN_BOUNDS,  /* a box round all */
    JOIN_SAME,    /* it is the same for all; NaN: not known */
    JOIN_ONLY,    /* that of a single one; NaN: there are several */
    JOIN_FEWEST,  /* that of the target with the fewest vertices inside */
    JOIN_GROUP,   /* a whole group: that of the target in which figure.by is largest */
    JOIN_FOLDS,
    JOIN_BEHIND,
    JOIN_SEAM /* the faces of all, one after the other */
} figure_join;

/* What the report has if not all figures.needs are set: a flag is true, a count or number is above 0, a
   pointer is not NULL. */
typedef enum figure_presence {
    FIGURE_ALWAYS = 0,
    FIGURE_NULL_UNLESS,        /* null if the first need is not set */
    FIGURE_NULL_UNLESS_FINITE, /* null if none of the needs is finite */
    FIGURE_ABSENT_UNLESS       /* no member if none of the needs is set */
} figure_presence;

/* A member of a struct. */
typedef struct figure_member {
    figure_type type;
    uint32_t at; /* its offset */
} figure_member;

enum { FIGURE_NAME = 32 };

typedef struct figure {
    char name[FIGURE_NAME]; /* path of the member of ffd_job_result and of the report: "tear.edges"; "": of
                               a pass only, or an end */
    figure_member result;   /* in ffd_job_result */
    figure_member total;    /* in pass_totals, from which it is filled; or type FIGURE_NONE */
    figure_join tiles, targets;
    figure_presence presence;
    figure_member needs[2];
    uint32_t size, by; /* of a group: its size, and the offset of the number for JOIN_GROUP */
    bool is_held_back; /* it is not in the report */
    bool is_of_job;    /* it is of a whole job, not of each morph target */
    bool is_time;      /* it is not in a report without times */
    figure_lines lines;
} figure;

/* In the order of the report. Without pointers, so that the loader has nothing to relocate at a start. */
extern const figure ffd_figures[];
extern const size_t ffd_figure_count;

/* Returns the name of a figure within its group: "edges" of "tear.edges". */
const char *ffd_figure_key(const figure *f);
/* Returns the value of a member of a result. */
static inline const void *ffd_figure_value(const figure_member *member, const ffd_job_result *result)
{
    return (const char *)result + member->at;
}
/* Whether the report has a value for a figure. If not, *null says whether it has null. */
bool ffd_figure_is_there(const figure *f, const ffd_job_result *result, bool *null);

#endif
