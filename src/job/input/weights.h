/* weights.h - `--weight`: how far each vertex takes part in the deformation (src/maths.md 9.7). weights.c
   reads the weights, weight_slopes.c finds how they change along the surface, weight_splits.c where it tears.
 */
#ifndef FFD_JOB_INPUT_WEIGHTS_H
#define FFD_JOB_INPUT_WEIGHTS_H

#include "mesh/slopes.h"
#include "mesh/twins.h"
#include "mesh/weights.h"

/* A vertex whose weight is another than that of the first vertex at its position. */
typedef struct weight_split {
    uint32_t vertex, first;
    double position[3]; /* in the lattice's space */
} weight_split;

/* Weights of a document's vertices. All zeros: none are given. */
typedef struct vertex_weights {
    double *values; /* of each vertex in the order of `ffd embed`, from 0 to 1; NaN: it is not selected */
    size_t count;
    size_t *first; /* of each part, the index of its first vertex */
    bool differ;   /* not all are equal */
    ffd_weight_figures figures;
    /* By mesh_state, in the lattice's space; without sums all are 0, or not known. */
    slope_sums slopes[2];
    weight_split *splits; /* split_count entries, ascending by vertex; NULL: not known */
    size_t split_count;
} vertex_weights;

/* Reads what users write: FILE.npy, attribute:NAME and so on, or one of them after "1-". The name points into
   text. Errors: FFD_E_ARGUMENT. */
ffd_status ffd_weight_source_parse(const char *text, weight_source *source, ffd_error *error);

/* Fills weights, which are all zeros, with those of the selected vertices: clamped to 0 to 1, of which the
   log is warned, and then inverted if that is asked for. name: of the mesh. To be freed in every case.
   Errors: FFD_E_INVALID (also for a number that is not finite; the message has the vertex), FFD_E_IO,
   FFD_E_LIMIT, FFD_E_MEMORY. */
ffd_status ffd_vertex_weights_load(const ffd_weight_source *given, mesh_document *document, const char *name,
                                   int threads, const mesh_log *log, vertex_weights *weights,
                                   ffd_error *error);
/* Frees the arrays; leaves zeros. */
void ffd_vertex_weights_free(vertex_weights *weights);

/* The most temporary bytes of a search for splits for each vertex. */
#define SPLIT_BYTES (REPEAT_BYTES + 4 * sizeof(uint32_t) + sizeof(weight_split) + 3 * sizeof(double))

/* Finds the selected and visible vertices, in this state, whose weights split positions, unless they are
   known. Call it before results replace positions. Errors: FFD_E_LIMIT, FFD_E_MEMORY, those of the deadline.
 */
ffd_status ffd_vertex_weights_find_splits(vertex_weights *weights, const mesh_document *document,
                                          mesh_state state, int threads, const memory_budget *budget,
                                          ffd_error *error);
/* The same, of `count` vertices whose positions others may have: the list, which changes. */
ffd_status ffd_vertex_weights_take_repeats(vertex_weights *weights, const mesh_document *document,
                                           mesh_state state, const repeat_filter *filter, uint32_t *list,
                                           size_t count, ffd_error *error);
/* Reads the positions of all vertices, in the lattice's space, and adds them to a filter. *largest: the
   greatest magnitude of a finite coordinate; may be NULL. Errors: FFD_E_MEMORY, those of the deadline. */
ffd_status ffd_vertex_weights_filter(const vertex_weights *weights, const mesh_document *document,
                                     mesh_state state, const repeat_filter *filter, double *largest,
                                     ffd_error *error);
/* Reads the positions of `count` vertices, in the lattice's space, which are listed in ascending order: 3
   numbers each, by at most this many threads. Errors: those of the deadline. */
ffd_status ffd_vertex_weights_read_listed(const vertex_weights *weights, const mesh_document *document,
                                          mesh_state state, const uint32_t *list, size_t count, int threads,
                                          double *positions, ffd_error *error);

/* Finds the slopes of a state, unless they are known. faces: all faces in this state, or NULL: they are read.
   judged: also find the splits, which are of this state. The log is warned of a mesh without faces, whose
   slopes are 0. Errors: as above, and those of reading faces. */
ffd_status ffd_vertex_weights_find_slopes(vertex_weights *weights, mesh_document *document, mesh_state state,
                                          bool judged, const mesh_faces *faces, int threads, ffd_isa isa,
                                          memory_budget *budget, const mesh_log *log, ffd_error *error);

/* Returns the weight of a vertex of the document. */
static inline double ffd_vertex_weight(const vertex_weights *weights, size_t vertex)
{
    return weights->values[vertex];
}

/* Fills `slope` with that at a vertex, and returns it; NULL: it is 0. */
static inline const double *ffd_vertex_slope(const vertex_weights *weights, mesh_state state, size_t vertex,
                                             double slope[3])
{
    if (!weights->slopes[state].sums)
        return NULL;
    ffd_slope_at(&weights->slopes[state], vertex, slope);
    return slope;
}

#endif
