/* fit_input.h - what a job of `ffd fit` reads: pairs, their weights (fit_weights.c), and the box that a
   lattice goes round. */
#ifndef FFD_JOB_AUTHOR_FIT_INPUT_H
#define FFD_JOB_AUTHOR_FIT_INPUT_H

#include "job/author/author_job.h"
#include "job/author/fit_csv.h"
#include "job/input/shown_box.h"
#include <ffd/fit.h>

typedef struct fit_input {
    const ffd_fit_job *job; /* what is in memory has names */
    const char *const *only;
    size_t only_count;
    author_job *author;
    ffd_source before, after;
    const char *name; /* of what the pairs are from, for messages */
    fit_table table;
    size_t count;
    size_t weightless;         /* vertices that are selected and have no area, beside others that have some */
    double *sources, *targets; /* 3 of each pair */
    double *weights;           /* NULL: all 1 */
    ffd_bounds bounds;         /* of before, or if there is none of the sources */
    ffd_shared_box box;        /* that a lattice goes round */
    double *places;            /* 3 each: what it goes round, if it is made here */
    size_t place_count, place_capacity;
    uint64_t room; /* by which the files raise the limit of memory */
} fit_input;

/* Reads pairs and weights. Errors: FFD_E_INVALID, FFD_E_IO, FFD_E_LIMIT, FFD_E_MEMORY, and those of reading a
   mesh. */
ffd_status ffd_fit_input_read(fit_input *input, ffd_error *error);
/* Frees the arrays. */
void ffd_fit_input_free(fit_input *input);

/* Whether a source is an array of places (.npy), not a mesh. */
bool ffd_fit_is_array(const ffd_source *source);

/* Fills weights by the areas of a document's faces: a third of those at a vertex, in the lattice's space.
 *are_there: some have an area. Errors: FFD_E_MEMORY, FFD_E_LIMIT, those of the format. */
ffd_status ffd_fit_area_weights(mesh_document *document, double *weights, bool *are_there, ffd_error *error);

#endif
