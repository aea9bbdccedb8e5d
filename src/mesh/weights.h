/* weights.h - weights that the vertices of a file have: a mask of how far a deformation moves each of them.
 */
#ifndef FFD_MESH_WEIGHTS_H
#define FFD_MESH_WEIGHTS_H

#include "mesh/mesh.h"

/* What of a file the weights are. */
typedef enum weight_kind {
    WEIGHT_ATTRIBUTE, /* a glTF attribute of one number */
    WEIGHT_COLOR,     /* a channel of the vertex colours */
    WEIGHT_JOINT,     /* the share that the joints of a name have in a vertex */
    WEIGHT_PROPERTY,  /* a PLY property */
    WEIGHT_FILE       /* none of the mesh: a NumPy array beside it */
} weight_kind;

typedef struct weight_source {
    weight_kind kind;
    const char *name; /* of the attribute, joint, property or file; borrowed */
    int channel;      /* of colours: 0 to 3 for r, g, b, a */
    bool is_inverted; /* 1 minus them is meant */
} weight_source;

/* The bit of a kind in a set. */
#define WEIGHT_BIT(kind) (1u << (kind))

/* Fills the weights of all selected vertices, in the order of `ffd embed`, as they are in the file; those of
   others are not set, or any. Errors: FFD_E_INVALID (a selected vertex has none, or it is of a type that does
   not mean a number from 0 to 1; the message names the mesh), FFD_E_UNSUPPORTED, FFD_E_MEMORY. */
typedef ffd_status mesh_read_weights_function(const mesh_document *document, const weight_source *source,
                                              double *weights, ffd_error *error);

struct mesh_weight_calls {
    unsigned kinds; /* the set of kinds that the format has */
    mesh_read_weights_function *read;
};

#endif
