/* listing.h - the things of a document that `--only` can name, and what they draw. */
#ifndef FFD_MESH_LISTING_H
#define FFD_MESH_LISTING_H

#include "mesh/mesh.h"

/* All nodes of one name with what is below them, one mesh, all materials of a name, ... */
typedef struct mesh_thing {
    selector_kind kind;
    char *name;               /* owned; NULL: it has none */
    size_t number;            /* without a name: which of its kind, from 0 */
    uint64_t vertices, faces; /* that it draws; each vertex once */
    ffd_bounds bounds;        /* in the lattice's space, of its finite vertices */
} mesh_thing;

struct mesh_listing {
    mesh_thing *things; /* count */
    size_t count, capacity;
    double *xyz;    /* the document's positions in the lattice's space */
    size_t *first;  /* of each part, the number of its first vertex */
    uint32_t *seen; /* by vertex: the thing that drew it last, from 1 */
};

/* Begins the listing of a document; to be freed in any case. Errors: FFD_E_MEMORY, FFD_E_LIMIT: the memory
   budget does not allow it. */
ffd_status ffd_listing_begin(const mesh_document *document, mesh_listing *listing, ffd_error *error);
/* Frees a listing; nothing is left in it. */
void ffd_listing_free(mesh_listing *listing);

/* Adds a thing: what is drawn from now on is its. An empty name is none. Errors: FFD_E_MEMORY. */
ffd_status ffd_listing_add(mesh_listing *listing, selector_kind kind, const char *name, size_t size,
                           size_t number, ffd_error *error);
/* The last thing draws these vertices of a part, each perhaps more than once. */
void ffd_listing_draw(mesh_listing *listing, size_t part, const uint32_t *vertices, size_t count);
/* The same for faces. */
void ffd_listing_draw_faces(mesh_listing *listing, size_t count);

#endif
